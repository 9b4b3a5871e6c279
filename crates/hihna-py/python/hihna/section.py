"""Cross-sections of beams."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ._native import rectangle, trapezoid, tube


@dataclass(frozen=True)
class Section:
    """A cross-section of a planar beam by its area [m²] and its second and fourth moments in the plane [m⁴, m⁶]."""

    area: float
    second_moment: float
    fourth_moment: float

    @classmethod
    def rectangle(cls, width: float, height: float) -> Section:
        """A rectangle, `width` out of the plane and `height` in it [m]."""
        return cls(width * height, width * height**3 / 12, width * height**5 / 80)

    @classmethod
    def circle(cls, radius: float) -> Section:
        """A full circle [m]."""
        return cls(math.pi * radius**2, math.pi * radius**4 / 4, math.pi * radius**6 / 8)

    @classmethod
    def tube(cls, outer_radius: float, inner_radius: float) -> Section:
        """A circular tube [m]."""
        outer, inner = cls.circle(outer_radius), cls.circle(inner_radius)
        return cls(
            outer.area - inner.area,
            outer.second_moment - inner.second_moment,
            outer.fourth_moment - inner.fourth_moment,
        )


@dataclass(frozen=True)
class SpatialSection:
    """A doubly symmetric cross-section of a spatial beam, y over its height and z across its width."""

    #: ∫ dA [m²].
    area: float
    #: ∫ y² dA [m⁴]: bending in the plane of length and height.
    second_moment_y: float
    #: ∫ z² dA [m⁴]: bending in the plane of length and width.
    second_moment_z: float
    #: ∫ y⁴ dA [m⁶].
    fourth_moment_y: float
    #: ∫ z⁴ dA [m⁶].
    fourth_moment_z: float
    #: ∫ y² z² dA [m⁶].
    mixed_fourth_moment: float
    #: Saint-Venant's J [m⁴], of which only `saint_venant_torsion_factor` makes use.
    torsion_constant: float

    @classmethod
    def rectangle(cls, width: float, height: float) -> SpatialSection:
        """A rectangle [m]."""
        return cls(*rectangle(width, height))

    @classmethod
    def circle(cls, radius: float) -> SpatialSection:
        """A full circle [m]."""
        return cls(*tube(radius, 0.0))

    @classmethod
    def tube(cls, outer_radius: float, inner_radius: float) -> SpatialSection:
        """A circular tube [m]."""
        return cls(*tube(outer_radius, inner_radius))

    @classmethod
    def trapezoid(cls, width: float, height: float, flank_angle: float) -> SpatialSection:
        """The section of a V-belt: `width` [m] at its centroid, `height` [m], the angle between its flanks [rad]."""
        return cls(*trapezoid(width, height, flank_angle))

    @property
    def saint_venant_torsion_factor(self) -> float:
        """The `torsion_factor` that gives a beam the torsion stiffness G J of warping sections."""
        return self.torsion_constant / (5 / 6 * (self.second_moment_y + self.second_moment_z))
