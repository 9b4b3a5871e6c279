"""Drives: loaded, changed, run."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Callable, Mapping
from typing import Any

from ._native import InputError, NativeDrive
from .results import Results

FrictionLaw = Callable[[float, float], "float | tuple[float, float, float]"]
TorqueLaw = Callable[[float, float], "float | tuple[float, float]"]


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} is neither number, text, list nor dictionary")


def _encoded(value: Any) -> str:
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except ValueError as error:
        raise InputError(f"a field of a drive is no finite number: {error}") from error


def _changes(changes: Mapping[str, Any]) -> list[tuple[str, str]]:
    return [(path.replace("__", "."), _encoded(value)) for path, value in changes.items()]


def _functions(what: str, given: Mapping[str, Any] | None) -> list[tuple[str, Any]]:
    for pulley, function in (given or {}).items():
        if not callable(function):
            raise TypeError(f"{what} of pulley {pulley!r} is not a function but {function!r}; fields are changed by `with_`")
    return list((given or {}).items())


class Drive:
    """A checked drive. It does not change: `with_` makes another."""

    def __init__(self, native: NativeDrive) -> None:
        self._native = native

    @classmethod
    def load(cls, path: str | os.PathLike[str], **changes: Any) -> Drive:
        """Read a drive file, with fields replaced as by `with_`. Raises `InputError`."""
        return cls(NativeDrive.load(os.fspath(path), _changes(changes)))

    @classmethod
    def from_toml(cls, text: str) -> Drive:
        """Read the text of a drive file. Raises `InputError`."""
        return cls(NativeDrive.parse("<text>", text, []))

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> Drive:
        """Make a drive of a dictionary with the fields of a drive file. Raises `InputError`."""
        return cls(NativeDrive.from_json(_encoded(dict(fields))))

    @classmethod
    def built_in(cls) -> Drive:
        """The two-pulley drive of Table 3.1 in Kerkkänen (2006), which `hihna run` runs without a file."""
        return cls(NativeDrive.built_in())

    def with_(self, changes: Mapping[str, Any] | None = None, **more: Any) -> Drive:
        """This drive with fields replaced, by their paths.

        Paths are as for ``--set``, pulleys by name: ``{"pulley.driven.inertia": 0.2}``. As keyword arguments two
        underscores stand for a dot: ``belt__elements=30``. Raises `InputError`.
        """
        return Drive(self._native.changed(_changes({**(changes or {}), **more})))

    def to_dict(self) -> dict[str, Any]:
        """All fields, defaults written out."""
        fields: dict[str, Any] = json.loads(self._native.to_json())
        return fields

    def to_toml(self) -> str:
        """The drive file, defaults written out."""
        return self._native.to_toml()

    def run(
        self,
        progress: Callable[[float, float], object] | None = None,
        *,
        friction: Mapping[str, FrictionLaw] | None = None,
        load: Mapping[str, TorqueLaw] | None = None,
    ) -> Results:
        """Simulate the drive. Other threads go on meanwhile, and Ctrl-C stops it.

        `progress` is called about ten times a second with the time reached and the end time [s].

        `friction` has functions by the names of pulleys that take the place of the friction there: slip velocity [m/s],
        normal force per length of belt [N/m] (of plates per area [N/m²]) -> friction force per length in the direction
        of the slip, alone or as a tuple with its derivatives by both. `load` has functions that take the place of
        `torque` and `load` of a pulley: time [s], speed [rad/s] -> torque [N m], counter-clockwise positive, alone or
        with its derivative by the speed. Derivatives that are not given are differences. The solver calls such a
        function for every point of contact in every iteration, so a run is many times slower.

        Raises `RunError`, and `ValueError` where a function has no pulley to act on. What a function raises is the
        cause of a `RunError` that names it.
        """
        return Results(self._native.run(progress, _functions("friction", friction), _functions("load", load)))

    def steady(self, model: str = "full", closure: str = "length") -> dict[str, Any]:
        """What the drive settles to, by the theory of the extensible string or by finite elements.

        `model` is ``"full"``, ``"centrifugal"`` or ``"capstan"`` for the string, ``"fe"`` for the elements of `run`
        without stepping through time; `closure`, of the string, ``"length"`` or ``"tension-sum"``. The answer has
        `answer` (``"running"``, ``"gross-slip"`` or ``"slack"``) and `message`. Of a drive that runs the string gives
        `pulley`, `span`, `power_in`, `power_out`, `power_lost`, `efficiency` and `capacity`; finite elements give
        `steady` with the same but for `capacity`, which stands beside it, and `model`, `start`, `solver`, `audit`: the
        ``summary.json`` of ``hihna steady --model fe``. Raises `InputError`, `RunError`.
        """
        answer: dict[str, Any] = json.loads(self._native.steady(model, closure))
        return answer

    @property
    def title(self) -> str:
        """The drive's name."""
        return str(self.to_dict()["title"])

    @property
    def pulleys(self) -> list[str]:
        """Names of the pulleys in the order of the belt."""
        return [pulley["name"] for pulley in self.to_dict()["pulley"]]

    def svg(self) -> str:
        """The drive to scale."""
        return self._native.svg()

    def __repr__(self) -> str:
        return f"<hihna.Drive {self.title!r}: pulleys {', '.join(self.pulleys)}>"

    def _repr_html_(self) -> str:
        return f"<p><b>{html.escape(self.title or 'Belt drive')}</b></p>{self.svg()}"
