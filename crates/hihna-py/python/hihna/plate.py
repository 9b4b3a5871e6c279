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

import numpy

from ._native import NativePlate
from .material import Material
from .structure import Equilibrium, Structure, coordinates_of

#: Edges by name: x = 0, x at its largest, y = 0, y at its largest.
EDGES = ("start", "end", "right", "left")


class Plate(Structure):
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
        self._last_and_one = (elements[0] + 1, elements[1] + 1)
        constants = [material.youngs_modulus, material.poisson_ratio, material.density]
        self._native = NativePlate([length, width, thickness], list(elements), constants, bending)
        super().__init__(self._native, self._last_and_one, 3, 3)

    @property
    def last(self) -> tuple[int, int]:
        """The last node."""
        return (self._last_and_one[0] - 1, self._last_and_one[1] - 1)

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

    def hold(self, node: tuple[int, int], vector: str, axis: int) -> Plate:
        """Hold a component of a vector of a node as drawn: ``"position"``, slope ``"along"`` x, slope ``"across"``, y."""
        self._native.hold(list(node), vector, axis)
        return self

    def force(
        self, node: tuple[int, int], force: tuple[float, float, float], *, vector: str = "position"
    ) -> Plate:
        """Add a dead force [N] on a node, or a generalised one [N m] on a slope, ``"along"`` or ``"across"``."""
        self._native.force(list(node), vector, list(force))
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

    def membrane_forces(self, state: Equilibrium | numpy.ndarray) -> numpy.ndarray:
        """Forces per undeformed width [N/m] in the middle of every element, `(along, across, 3)` for xx, yy and xy, of the
        second Piola-Kirchhoff stress; in an equilibrium or with a row of a film's `coordinates`."""
        return self._native.membrane_forces(coordinates_of(state)).reshape(*self.last, 3)
