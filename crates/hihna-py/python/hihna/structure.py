"""What structures of beams and plates have in common: statics, modes, motion, and their answers as arrays."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy

#: A function of time [s] to a value and its first and second derivative by time.
Motion = Callable[[float], tuple[float, float, float]]


@dataclass(frozen=True)
class Equilibrium:
    """A static equilibrium. `nodes` below is one number for beams, two for plates."""

    #: Vectors of the nodes, `(nodes, vectors, dimension)`: places [m], then slopes.
    vectors: numpy.ndarray
    #: Generalised forces of the supports on these vectors [N, N m].
    forces: numpy.ndarray
    #: Places [m] and angle [rad] of the rigid bodies, `(bodies, 3)`.
    bodies: numpy.ndarray
    #: Newton iterations of all load steps.
    iterations: int
    #: Size of each correction [m], load step by load step.
    corrections: list[list[float]]
    #: All coordinates, with zeros at the places of multipliers.
    coordinates: numpy.ndarray
    #: Multipliers of the constraints at their places, zeros elsewhere.
    multipliers: numpy.ndarray

    @property
    def positions(self) -> numpy.ndarray:
        """Places of the nodes [m], `(nodes, dimension)`."""
        return self.vectors[..., 0, :]

    @property
    def reactions(self) -> numpy.ndarray:
        """Forces of the supports on the nodes [N], `(nodes, dimension)`."""
        return self.forces[..., 0, :]


@dataclass(frozen=True)
class Modes:
    """Natural motions by rising frequency: the real part of `(shape + i imaginary shape) exp((growth + i frequency) t)`."""

    #: Circular frequencies [rad/s].
    frequencies: numpy.ndarray
    #: Rates of growth [1/s], positive where the equilibrium is unstable.
    growths: numpy.ndarray
    #: How the nodes move, real parts, `(modes, nodes, dimension)`.
    shapes: numpy.ndarray
    #: Imaginary parts; zero but in a rotating frame.
    imaginary_shapes: numpy.ndarray


@dataclass(frozen=True)
class Film:
    """A motion at equal intervals."""

    #: Times [s].
    time: numpy.ndarray
    #: Vectors of the nodes, `(times, nodes, vectors, dimension)`: places [m], then slopes.
    vectors: numpy.ndarray
    #: Their rates.
    rates: numpy.ndarray
    #: Places [m] and angles [rad] of the rigid bodies, `(times, bodies, 3)`.
    bodies: numpy.ndarray
    #: Their rates.
    body_rates: numpy.ndarray
    #: Kinetic, strain and load energy together [J]; moments and pressures have none.
    energy: numpy.ndarray
    #: All coordinates, `(times, coordinates)`; a row is a `start` of a further motion.
    coordinates: numpy.ndarray
    #: Their rates.
    coordinate_rates: numpy.ndarray
    #: Number of steps.
    steps: int

    @property
    def positions(self) -> numpy.ndarray:
        """Places of the nodes [m], `(times, nodes, dimension)`."""
        return self.vectors[..., 0, :]

    @property
    def velocities(self) -> numpy.ndarray:
        """Velocities of the nodes [m/s], `(times, nodes, dimension)`."""
        return self.rates[..., 0, :]


class _Native(Protocol):
    """What the native structures have in common."""

    def drawn(self) -> numpy.ndarray: ...
    def equilibrium(self, steps: tuple[int, int, float, int]) -> dict[str, Any]: ...
    def linear_displacements(self) -> numpy.ndarray: ...
    def modes(self, about: tuple[numpy.ndarray, numpy.ndarray] | None) -> dict[str, numpy.ndarray]: ...
    def integrate(self, course: dict[str, Any]) -> dict[str, Any]: ...


class Structure:
    """A structure whose nodes have some vectors each. Raises `StructureError`."""

    def __init__(self, native: _Native, nodes: tuple[int, ...], vectors: int, dimension: int) -> None:
        self._structure = native
        self._shape = (*nodes, vectors, dimension)
        self._body_count = 0

    def equilibrium(
        self, *, load_steps: int = 1, halvings: int = 12, max_iterations: int = 40, tolerance: float = 1e-9
    ) -> Equilibrium:
        """The static equilibrium under all loads, with prescribed motions as at time zero.

        Loads grow in `load_steps` equal steps; one that does not converge is halved, up to `halvings` times. Newton's
        method ends when a correction is below `tolerance` by the structure's length.
        """
        found = self._structure.equilibrium((load_steps, halvings, tolerance, max_iterations))
        return Equilibrium(
            self._nodes(found["coordinates"]),
            self._nodes(found["reactions"]),
            self._bodies(found["coordinates"]),
            found["iterations"],
            found["corrections"],
            found["coordinates"],
            found["multipliers"],
        )

    def linear_displacements(self) -> numpy.ndarray:
        """What linear theory says: changes of the nodes' vectors, `(nodes, vectors, dimension)`."""
        return self._nodes(self._structure.linear_displacements())

    def modes(self, about: Equilibrium | None = None) -> Modes:
        """Natural motions about an equilibrium, or about the drawn shape."""
        found = self._structure.modes(None if about is None else (about.coordinates, about.multipliers))
        count = len(found["frequencies"])

        def moved(name: str) -> numpy.ndarray:
            return self._nodes(found[name].reshape(count, -1))[..., 0, :]

        return Modes(found["frequencies"], found["growths"], moved("shapes"), moved("imaginary_shapes"))

    def integrate(
        self,
        end: float,
        step: float,
        *,
        method: str = "auto",
        interval: float | None = None,
        start: Equilibrium | numpy.ndarray | None = None,
        velocities: numpy.ndarray | None = None,
        error_tolerance: float | None = None,
        newton_tolerance: float = 1e-9,
        kinks: Sequence[float] = (),
    ) -> Film:
        """The motion to the time `end` [s], in steps of `step` [s].

        `method` is ``"auto"`` (generalized-alpha, and TR-BDF2 where its steps keep failing), ``"generalized-alpha"``,
        ``"tr-bdf2"`` or ``"runge-kutta"``. States come every `interval` [s], every step without one. It begins as drawn
        and at rest, or with the coordinates of `start` and, by coordinate, `velocities`; both must keep the supports.
        With `error_tolerance` [m/s], the accepted difference between predicted and found velocities, `step` is the
        longest and shorter ones are chosen; `newton_tolerance` [m/s] is what Newton's method may leave over; steps end at
        the `kinks` [s]. Other threads go on meanwhile, and Ctrl-C stops it.
        """
        coordinates = start.coordinates if isinstance(start, Equilibrium) else start
        found = self._structure.integrate(
            {
                "end": end,
                "step": step,
                "interval": step if interval is None else interval,
                "method": method,
                "error_tolerance": error_tolerance,
                "newton_tolerance": newton_tolerance,
                "kinks": list(kinks),
                "coordinates": None if coordinates is None else _numbers(coordinates),
                "velocities": None if velocities is None else _numbers(velocities),
            }
        )
        count = len(found["time"])
        coordinates, rates = (found[name].reshape(count, -1) for name in ("coordinates", "velocities"))
        return Film(
            found["time"],
            self._nodes(coordinates),
            self._nodes(rates),
            self._bodies(coordinates),
            self._bodies(rates),
            found["energy"],
            coordinates,
            rates,
            found["steps"],
        )

    def drawn(self) -> numpy.ndarray:
        """All coordinates as drawn, without places for multipliers: a `start` to change."""
        return self._structure.drawn()

    def _own(self) -> int:
        """Numbers of nodes that are nodes of their own."""
        return len(self._structure.drawn()) - 3 * self._body_count

    def _nodes(self, values: numpy.ndarray) -> numpy.ndarray:
        """Vectors of the nodes in arrays by coordinate: a view, but where the ends are one node."""
        own = self._own()
        *before, _ = values.shape
        if own == math.prod(self._shape):
            return values[..., :own].reshape(*before, *self._shape)
        nodes = values[..., :own].reshape(*before, -1, *self._shape[-2:])
        return numpy.concatenate([nodes, nodes[..., :1, :, :]], axis=-3)

    def _bodies(self, values: numpy.ndarray) -> numpy.ndarray:
        own = self._own()
        *before, _ = values.shape
        return values[..., own : own + 3 * self._body_count].reshape(*before, self._body_count, 3)


def coordinates_of(state: Equilibrium | numpy.ndarray) -> numpy.ndarray:
    """Coordinates of an equilibrium, or of a row of a `Film`, as the solver takes them."""
    return _numbers(state.coordinates if isinstance(state, Equilibrium) else state)


def _numbers(values: numpy.ndarray) -> numpy.ndarray:
    """Numbers as the solver takes them."""
    return numpy.ascontiguousarray(values, dtype=numpy.float64).ravel()


def given_nodes(nodes: numpy.ndarray | None) -> numpy.ndarray | None:
    """Nodal vectors as the solver takes them."""
    return None if nodes is None else _numbers(nodes)
