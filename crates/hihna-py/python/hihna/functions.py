"""Functions of the user's, made into tables that the solver evaluates itself.

A function is called once for every point of its table, before the run, so it may be slow; the drive stays plain data
that can be saved and run again.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy


def profile(function: Callable[[float], float], start: float, end: float, count: int = 1001) -> dict[str, Any]:
    """A function of time [s] as a table of `count` points from `start` to `end`, linear between and constant outside.

    For the fields `speed`, `angle` and `torque` of a pulley. The error of linear interpolation is at most
    ``(end - start)² / (8 (count - 1)²)`` times the largest second derivative.
    """
    times = numpy.linspace(start, end, count)
    return {"kind": "table", "time": times.tolist(), "value": [float(function(time)) for time in times]}


def load(function: Callable[[float], float], lowest: float, highest: float, count: int = 1001) -> dict[str, Any]:
    """An external torque [N m] as a function of the pulley's speed [rad/s], for the field `load` of a pulley.

    A table of `count` points from the `lowest` to the `highest` speed, linear between and constant outside; torques
    are positive counter-clockwise.
    """
    speeds = numpy.linspace(lowest, highest, count)
    return {"law": "table", "speed": speeds.tolist(), "torque": [float(function(speed)) for speed in speeds]}
