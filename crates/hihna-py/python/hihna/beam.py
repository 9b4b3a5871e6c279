"""Planar beams with supports, rigid bodies and loads."""

from __future__ import annotations

import numpy

from ._native import NativeBeam
from .material import Material
from .section import Section
from .structure import Equilibrium, Motion, Structure, coordinates_of, given_nodes

#: Vectors of a node: place, slope along the beam if there is one, slope across it.
VECTORS = {"linear-beam": 2, "belt-beam": 3, "cubic-beam": 3}


class Beam(Structure):
    """A chain of `elements` planar beams, straight from `start` [m] in the direction `angle` [rad].

    `element` is ``"linear-beam"``, ``"belt-beam"`` or ``"cubic-beam"``. `axial_factor`, `bending_factor` and
    `damping_time` [s] are those of the belt beam. `nodes`, `(elements + 1, vectors, 2)`, are the vectors of the nodes
    instead of a straight line: place r, slope r_x along the beam (not of linear beams), slope r_y across it. Cubic beams
    are free of stress there, `length` being the range of their parameter x; the others are drawn so and strained by it.
    Supports and loads can be chained. Raises `StructureError`.
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
        nodes: numpy.ndarray | None = None,
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
            given_nodes(nodes),
        )
        super().__init__(self._native, (elements + 1,), VECTORS[element], 2)

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
        self._body_count += 1
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

    def prescribe(self, node: int, axis: int, motion: Motion, *, vector: str = "position") -> Beam:
        """Move the x (axis 0) or y (axis 1) of a node by a function of time: place [m] and its two derivatives.

        `vector` is ``"position"``, or the slope ``"along"`` or ``"across"``. The function is called as that of `turn`.
        """
        self._native.prescribe(node, vector, axis, motion)
        return self

    def prescribe_body(self, body: int, index: int, motion: Motion) -> Beam:
        """Move the x (index 0), y (1) or angle (2) of a rigid body by a function of time, called as that of `turn`."""
        self._native.prescribe_body(body, index, motion)
        return self

    def axial_forces(self, state: Equilibrium | numpy.ndarray) -> numpy.ndarray:
        """Axial force [N] in the middle of every element, in an equilibrium or with a row of a film's `coordinates`."""
        return self._native.axial_forces(coordinates_of(state))
