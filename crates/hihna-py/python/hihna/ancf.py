"""Structures of absolute nodal coordinates: planar beams with supports, loads, statics, modes and motion; thin plates.

>>> from hihna import ancf
>>> steel = ancf.Material(youngs_modulus=2.07e11, poisson_ratio=0.3, density=7850.0)
>>> beam = ancf.Beam(length=2.0, elements=8, section=ancf.Section.rectangle(0.1, 0.1), material=steel)
>>> bent = beam.clamp(0).force(beam.last, (0.0, -1000.0)).equilibrium()
>>> bool(abs(bent.positions[-1, 1] + 1.55e-3) < 2e-5)    # P L³ / 3 E I = 1.546 mm, and shear
True

Nodes are numbered from 0 along the beam. Everything is in SI units and global axes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy

from ._native import NativeBeam
from .material import Material
from .plate import Plate, PlateEquilibrium, PlateModes

__all__ = [
    "Beam",
    "Equilibrium",
    "Film",
    "Material",
    "Modes",
    "Motion",
    "Plate",
    "PlateEquilibrium",
    "PlateModes",
    "Section",
]

#: A function of time [s] to a value and its first and second derivative by time.
Motion = Callable[[float], tuple[float, float, float]]


@dataclass(frozen=True)
class Section:
    """A cross-section by its area [m²] and its second and fourth moments in the plane [m⁴, m⁶]."""

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
class Equilibrium:
    """A static equilibrium."""

    #: Places of the nodes [m], `(nodes, 2)`.
    positions: numpy.ndarray
    #: Forces of the supports on the nodes [N], `(nodes, 2)`.
    reactions: numpy.ndarray
    #: Newton iterations of all load steps.
    iterations: int
    #: All coordinates, with zeros at the places of multipliers.
    coordinates: numpy.ndarray
    #: Multipliers of the constraints at their places, zeros elsewhere.
    multipliers: numpy.ndarray


@dataclass(frozen=True)
class Modes:
    """Natural motions by rising frequency."""

    #: Circular frequencies [rad/s].
    frequencies: numpy.ndarray
    #: Rates of growth [1/s], positive where the equilibrium is unstable.
    growths: numpy.ndarray
    #: How the nodes move, real parts, `(modes, nodes, 2)`.
    shapes: numpy.ndarray


@dataclass(frozen=True)
class Film:
    """A motion at equal intervals."""

    #: Times [s].
    time: numpy.ndarray
    #: Places of the nodes [m], `(times, nodes, 2)`.
    positions: numpy.ndarray
    #: Velocities of the nodes [m/s], `(times, nodes, 2)`.
    velocities: numpy.ndarray
    #: Kinetic, strain and load energy together [J].
    energy: numpy.ndarray


class Beam:
    """A straight chain of `elements` beams, drawn from `start` [m] in the direction `angle` [rad].

    `element` is ``"linear-beam"``, ``"belt-beam"`` or ``"cubic-beam"``. `axial_factor`, `bending_factor` and
    `damping_time` [s] are those of the belt beam. Supports and loads can be chained. Raises `StructureError`.
    """

    def __init__(
        self,
        length: float,
        elements: int,
        section: Section,
        material: Material,
        *,
        element: str = "linear-beam",
        start: tuple[float, float] = (0.0, 0.0),
        angle: float = 0.0,
        axial_factor: float = 1.0,
        bending_factor: float = 1.0,
        damping_time: float = 0.0,
    ) -> None:
        if element != "belt-beam" and (axial_factor, bending_factor, damping_time) != (1.0, 1.0, 0.0):
            raise ValueError(f"axial_factor, bending_factor and damping_time are of belt-beam, not of {element}")
        self._last = elements
        self._native = NativeBeam(
            element,
            length,
            elements,
            (section.area, section.second_moment, section.fourth_moment),
            (material.youngs_modulus, material.poisson_ratio, material.density),
            list(start),
            angle,
            (axial_factor, bending_factor, damping_time),
        )

    @property
    def last(self) -> int:
        """Number of the last node."""
        return self._last

    def pin(self, node: int) -> Beam:
        """Hold a node where it is drawn; it may turn."""
        self._native.pin(node)
        return self

    def clamp(self, node: int) -> Beam:
        """Hold a node and its slopes as they are drawn."""
        self._native.clamp(node)
        return self

    def roller(self, node: int, normal: tuple[float, float]) -> Beam:
        """Let a node slide along a line only: no motion along `normal`."""
        self._native.roller(node, list(normal))
        return self

    def join_ends(self) -> Beam:
        """Join the last node to the first, which must lie in one place."""
        self._native.join_ends()
        return self

    def body(self, name: str, mass: float, inertia: float, place: tuple[float, float], angle: float = 0.0) -> int:
        """Add a rigid body (mass [kg], inertia about its centre of mass [kg m²]) and return its number."""
        return self._native.body(name, mass, inertia, list(place), angle)

    def hinge(self, node: int, body: int) -> Beam:
        """Hinge a node to a rigid body, where both are drawn."""
        self._native.hinge(node, body)
        return self

    def fasten(self, node: int, body: int) -> Beam:
        """Fasten a node to a rigid body: place and slopes move with it."""
        self._native.fasten(node, body)
        return self

    def force(self, node: int, force: tuple[float, float]) -> Beam:
        """Add a dead force [N] on a node."""
        self._native.force(node, list(force))
        return self

    def moment(self, node: int, moment: float) -> Beam:
        """Add a moment [N m], counter-clockwise, on the cross-section of a node."""
        self._native.moment(node, moment)
        return self

    def body_load(self, body: int, force: tuple[float, float], moment: float = 0.0) -> Beam:
        """Add a dead force [N] on a body's centre of mass and a moment [N m]."""
        self._native.body_load(body, list(force), moment)
        return self

    def gravity(self, field: tuple[float, float]) -> Beam:
        """Add a uniform acceleration [m/s²] on all masses."""
        self._native.gravity(list(field))
        return self

    def line_load(self, load: tuple[float, float]) -> Beam:
        """Add a dead force per undeformed length [N/m]."""
        self._native.line_load(list(load))
        return self

    def rotating_frame(self, speed: float) -> Beam:
        """Describe the structure in a frame that turns about the origin with this speed [rad/s]."""
        self._native.rotating_frame(speed)
        return self

    def eliminate(self, eliminate: bool = True) -> Beam:
        """Eliminate dependent coordinates instead of using Lagrange multipliers."""
        self._native.eliminate(eliminate)
        return self

    def turn(self, node: int, angle: Motion) -> Beam:
        """Hold a node and turn its slopes by a function of time: angle [rad] and its two derivatives.

        The function is called from within the solver at every iteration: about a microsecond each, and no other
        Python thread runs during the call.
        """
        self._native.turn(node, angle)
        return self

    def spin_up(self, node: int, speed: float, rise_time: float) -> Beam:
        """Hold a node and turn its slopes, smoothly up to `speed` [rad/s] at `rise_time` [s]."""
        self._native.spin_up(node, speed, rise_time)
        return self

    def prescribe(self, node: int, axis: int, motion: Motion) -> Beam:
        """Move the x (axis 0) or y (axis 1) of a node by a function of time: place [m] and its two derivatives."""
        self._native.prescribe(node, axis, motion)
        return self

    def equilibrium(self) -> Equilibrium:
        """The static equilibrium under all loads."""
        found = self._native.equilibrium()
        return Equilibrium(
            found["positions"].reshape(-1, 2),
            found["reactions"].reshape(-1, 2),
            found["iterations"],
            found["coordinates"],
            found["multipliers"],
        )

    def modes(self, about: Equilibrium | None = None) -> Modes:
        """Natural motions about an equilibrium, or about the drawn shape."""
        where = None if about is None else (about.coordinates.tolist(), about.multipliers.tolist())
        found = self._native.modes(where)
        modes = found["modes"].reshape(-1, 2)
        return Modes(modes[:, 0], modes[:, 1], found["shapes"].reshape(len(modes), -1, 2))

    def integrate(self, end: float, step: float, *, method: str = "auto", interval: float | None = None) -> Film:
        """The motion from rest as drawn to the time `end` [s], in steps of `step` [s].

        `method` is ``"auto"``, ``"generalized-alpha"``, ``"tr-bdf2"`` or ``"runge-kutta"``. States come every
        `interval` [s], every step without one. Other threads go on meanwhile, and Ctrl-C stops it.
        """
        found = self._native.integrate(end, step, method, step if interval is None else interval)
        nodes = self.last + 1
        return Film(
            found["time"],
            found["positions"].reshape(-1, nodes, 2),
            found["velocities"].reshape(-1, nodes, 2),
            found["energy"],
        )
