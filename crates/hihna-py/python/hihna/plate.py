"""Rectangular thin plates of absolute nodal coordinates: supports of their edges, loads, statics, modes.

>>> from hihna import ancf
>>> steel = ancf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
>>> plate = ancf.Plate(length=1.0, width=1.0, thickness=0.01, elements=(8, 8), material=steel)
>>> bent = plate.clamp().pressure(1000.0).equilibrium()
>>> bool(abs(bent.positions[4, 4, 2] - 6.9e-5) < 0.1e-5)    # 0.00126 p a⁴ / D, and what the mesh adds
True

A plate is drawn in the plane of x and y from the origin; node `(i, j)` is the i-th along x, the j-th along y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ._native import NativePlate
from .material import Material

#: Edges by name: x = 0, x at its largest, y = 0, y at its largest.
EDGES = ("start", "end", "right", "left")


@dataclass(frozen=True)
class PlateEquilibrium:
    """A static equilibrium of a plate."""

    #: Places of the nodes [m], `(nodes along, nodes across, 3)`.
    positions: numpy.ndarray
    #: Newton iterations of all load steps.
    iterations: int
    #: All coordinates.
    coordinates: numpy.ndarray


@dataclass(frozen=True)
class PlateModes:
    """Natural motions of a plate by rising frequency."""

    #: Circular frequencies [rad/s].
    frequencies: numpy.ndarray
    #: Rates of growth [1/s], positive where the equilibrium is unstable.
    growths: numpy.ndarray
    #: How the nodes move, real parts, `(modes, nodes along, nodes across, 3)`.
    shapes: numpy.ndarray


class Plate:
    """A plate of `length` along x, `width` along y and `thickness` [m], of so many `elements` along and across.

    `bending` is its stiffness: ``"standard"`` E h³/(12 (1 - nu²)), ``"printed"`` E h³/12 as in Kerkkänen (2006, 4.17), or
    ``"none"`` for a membrane. Supports and loads can be chained. Raises `StructureError`.
    """

    def __init__(
        self,
        length: float,
        width: float,
        thickness: float,
        elements: tuple[int, int],
        material: Material,
        *,
        bending: str = "standard",
    ) -> None:
        self._nodes = (elements[0] + 1, elements[1] + 1)
        constants = [material.youngs_modulus, material.poisson_ratio, material.density]
        self._native = NativePlate([length, width, thickness], list(elements), constants, bending)

    @property
    def last(self) -> tuple[int, int]:
        """The last node."""
        return (self._nodes[0] - 1, self._nodes[1] - 1)

    def clamp(self, *edges: str) -> Plate:
        """Hold edges, all without a name, and the direction of the surface there."""
        self._native.clamp(list(edges or EDGES))
        return self

    def support(self, *edges: str) -> Plate:
        """Hold edges, all without a name, in the plane of the plate; they turn and slide in it."""
        self._native.support(list(edges or EDGES))
        return self

    def bending_only(self) -> Plate:
        """Hold everything in the plane of the plate: what is left is the linear theory of bending."""
        self._native.bending_only()
        return self

    def force(self, node: tuple[int, int], force: tuple[float, float, float]) -> Plate:
        """Add a dead force [N] on a node."""
        self._native.force(list(node), list(force))
        return self

    def pressure(self, pressure: float) -> Plate:
        """Add a pressure [N/m²] that follows the surface, along z as drawn."""
        self._native.pressure(pressure)
        return self

    def end_moment(self, moment: float) -> Plate:
        """Add a moment per width [N m/m] on the edge ``"end"`` that turns it from x towards z."""
        self._native.end_moment(moment)
        return self

    def gravity(self, field: tuple[float, float, float]) -> Plate:
        """Add a uniform acceleration [m/s²]."""
        self._native.gravity(list(field))
        return self

    def equilibrium(self) -> PlateEquilibrium:
        """The static equilibrium under all loads."""
        found = self._native.equilibrium()
        positions = found["positions"].reshape(*self._nodes, 3)
        return PlateEquilibrium(positions, found["iterations"], found["coordinates"])

    def modes(self, about: PlateEquilibrium | None = None) -> PlateModes:
        """Natural motions about an equilibrium, or about the drawn shape."""
        found = self._native.modes(None if about is None else about.coordinates.tolist())
        return PlateModes(found["frequencies"], found["growths"], found["shapes"].reshape(-1, *self._nodes, 3))
