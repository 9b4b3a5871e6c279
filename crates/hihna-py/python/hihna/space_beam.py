"""Beams in space with supports and loads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy

from ._native import NativeSpaceBeam
from .material import Material
from .section import SpatialSection
from .structure import Equilibrium, Motion, Structure, coordinates_of, given_nodes

#: Vectors of a node: place, slope along the beam if there is one, slopes over its height and across its width.
VECTORS = {"linear-beam-3d": 3, "belt-beam-3d": 4}

_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class SpaceBeam(Structure):
    """A chain of `elements` beams in space, straight from `start` [m].

    `axes` are the unit vectors of its length, height and width, at right angles to each other. `element` is
    ``"belt-beam-3d"`` or ``"linear-beam-3d"``; only the former has `axial_factor` and `bending_factor`. `torsion_factor`
    multiplies the torsion stiffness of sections that stay plane, ks G (∫ y² dA + ∫ z² dA);
    `section.saint_venant_torsion_factor` makes it G J. `nodes`, `(elements + 1, vectors, 3)`, are the vectors of the nodes
    instead of a straight line, strained by it: place r, slope r_x along the beam (not of linear beams), slopes r_y over
    its height and r_z across its width. Supports and loads can be chained. Raises `StructureError`.
    """

    def __init__(
        self,
        length: float,
        elements: int,
        section: SpatialSection,
        material: Material,
        *,
        element: str = "belt-beam-3d",
        start: Sequence[float] = (0.0, 0.0, 0.0),
        axes: Sequence[Sequence[float]] = _AXES,
        axial_factor: float = 1.0,
        bending_factor: float = 1.0,
        torsion_factor: float = 1.0,
        nodes: numpy.ndarray | None = None,
    ) -> None:
        if element != "belt-beam-3d" and (axial_factor, bending_factor) != (1.0, 1.0):
            raise ValueError(f"axial_factor and bending_factor are of belt-beam-3d, not of {element}")
        frame = numpy.array(axes, dtype=float)
        # Rounding of unit vectors that are written with ten digits.
        if frame.shape != (3, 3) or not numpy.allclose(frame @ frame.T, numpy.eye(3), rtol=0, atol=1e-9):
            raise ValueError(f"axes must be three unit vectors at right angles, not {axes!r}")
        self._last = elements
        self._axes = frame
        self._section = section
        self._native = NativeSpaceBeam(
            element,
            length,
            elements,
            [
                section.area,
                section.second_moment_y,
                section.second_moment_z,
                section.fourth_moment_y,
                section.fourth_moment_z,
                section.mixed_fourth_moment,
                section.torsion_constant,
            ],
            [material.youngs_modulus, material.poisson_ratio, material.density],
            list(start),
            frame.tolist(),
            [axial_factor, bending_factor, torsion_factor],
            given_nodes(nodes),
        )
        self._drawn_straight = nodes is None
        super().__init__(self._native, (elements + 1,), VECTORS[element], 3)

    @property
    def last(self) -> int:
        """Number of the last node."""
        return self._last

    def pin(self, node: int) -> SpaceBeam:
        """Hold a node where it is drawn; it may turn."""
        self._native.pin(node)
        return self

    def clamp(self, node: int) -> SpaceBeam:
        """Hold a node and all its slopes as they are drawn."""
        self._native.clamp(node)
        return self

    def clamp_section(self, node: int) -> SpaceBeam:
        """Hold a node and its cross-section as they are drawn. A slope along the beam stays free, so that the section may
        shear against the centre line: the clamp of Timoshenko's beam, with which belt beams are exact."""
        self._native.clamp_section(node)
        return self

    def fix(self, node: int, vector: str, axis: int) -> SpaceBeam:
        """Hold a component of a vector of a node as drawn: ``"position"``, ``"along"``, ``"height"``, ``"width"``."""
        self._native.fix(node, vector, axis)
        return self

    def join_ends(self) -> SpaceBeam:
        """Join the last node to the first, which must lie in one place with equal slopes."""
        self._native.join_ends()
        return self

    def force(self, node: int, force: Sequence[float], *, vector: str = "position") -> SpaceBeam:
        """Add a dead force [N] on a node, or a generalised one [N m] on a slope: ``"along"``, ``"height"``, ``"width"``."""
        self._native.force(node, vector, list(force))
        return self

    def moment(self, node: int, moment: Sequence[float]) -> SpaceBeam:
        """Add a moment [N m] on the cross-section of a node of a straight beam, by its components along x, y and z.

        It is made of dead forces on the slopes r_y and r_z as drawn, twist shared as the section resists it, so that it is
        this moment as long as the section turns little. Where it turns far, apply forces.
        """
        if not self._drawn_straight:
            raise ValueError("moments are of beams drawn straight; give forces on slopes")
        twist, about_height, about_width = self._axes @ numpy.array(moment, dtype=float)
        length, height, width = self._axes
        y, z = self._section.second_moment_y, self._section.second_moment_z
        self.force(node, twist * y / (y + z) * width - about_width * length, vector="height")
        return self.force(node, -twist * z / (y + z) * height + about_height * length, vector="width")

    def gravity(self, field: Sequence[float]) -> SpaceBeam:
        """Add a uniform acceleration [m/s²] on all masses."""
        self._native.gravity(list(field))
        return self

    def line_load(self, load: Sequence[float]) -> SpaceBeam:
        """Add a dead force per undeformed length [N/m]."""
        self._native.line_load(list(load))
        return self

    def prescribe(self, node: int, axis: int, motion: Motion, *, vector: str = "position") -> SpaceBeam:
        """Move a component (axis 0, 1, 2) of a vector of a node by a function of time: value and two derivatives.

        The function is called from within the solver at every iteration, so it is slow.
        """
        self._native.prescribe(node, vector, axis, motion)
        return self

    def eliminate(self, eliminate: bool = True) -> SpaceBeam:
        """Eliminate dependent coordinates instead of using Lagrange multipliers."""
        self._native.eliminate(eliminate)
        return self

    def axial_forces(self, state: Equilibrium | numpy.ndarray) -> numpy.ndarray:
        """Axial force [N] in the middle of every element, in an equilibrium or with a row of a film's `coordinates`."""
        return self._native.axial_forces(coordinates_of(state))
