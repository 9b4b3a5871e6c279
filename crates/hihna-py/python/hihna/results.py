"""What a run found."""

from __future__ import annotations

import html
import json
import os
from typing import TYPE_CHECKING, Any

import numpy

from ._native import NativeResults

if TYPE_CHECKING:
    import pandas

    from .drive import Drive


class Results:
    """Results of a run: `results["driven.speed"]` is a column of the history.

    Columns, in SI units, are those of `history.csv`; as arrays they are views of one table, not copies.
    """

    def __init__(self, native: NativeResults) -> None:
        self._native = native
        self._columns = {name: i for i, name in enumerate(native.columns())}
        # Everybody who asks sees the same numbers.
        table = native.history().reshape(-1, len(self._columns))
        table.flags.writeable = False
        self._table = table

    @classmethod
    def load(cls, folder: str | os.PathLike[str]) -> Results:
        """Read a result folder of `hihna run`. Raises `ReadError`."""
        return cls(NativeResults.load(os.fspath(folder)))

    @property
    def columns(self) -> list[str]:
        """Names of the columns of the history."""
        return list(self._columns)

    @property
    def history(self) -> numpy.ndarray:
        """The history, a row per output time, a column per name of `columns`."""
        return self._table

    @property
    def time(self) -> numpy.ndarray:
        """Output times [s]."""
        return self["time"]

    def __getitem__(self, column: str) -> numpy.ndarray:
        if column not in self._columns:
            raise KeyError(f"there is no column {column!r}; `results.columns` has {', '.join(self._columns)}")
        return self._table[:, self._columns[column]]

    def __contains__(self, column: object) -> bool:
        return column in self._columns

    @property
    def drive(self) -> Drive:
        """The drive as run."""
        from .drive import Drive

        return Drive(self._native.drive())

    @property
    def summary(self) -> dict[str, Any]:
        """All of `summary.json`."""
        summary: dict[str, Any] = json.loads(self._native.summary())
        return summary

    @property
    def profile(self) -> dict[str, Any]:
        """The belt at the profile times: the columns of `profile.csv` as arrays, `pulley` as a list of names."""
        return self._native.profile()

    @property
    def frames(self) -> dict[str, Any]:
        """The moving belt, columns as of `profile`; empty without `run.frame_interval`."""
        return self._native.frames()

    @property
    def edges(self) -> dict[str, Any]:
        """Both edges of a belt in space beside `frames`: the columns of `edges.csv` as arrays; empty in the plane."""
        return self._native.edges()

    def to_pandas(self, table: str = "history") -> pandas.DataFrame:
        """`history` (by time), `profile`, `frames` or `edges` as a data frame. Needs pandas."""
        import pandas

        if table == "history":
            return pandas.DataFrame(self._table, columns=self.columns).set_index("time")
        if table in ("profile", "frames", "edges"):
            return pandas.DataFrame(getattr(self, table))
        raise ValueError(f"there is no table {table!r}: the tables are history, profile, frames and edges")

    def save(
        self, folder: str | os.PathLike[str], *, overwrite: bool = False, vtk: bool = False, report: bool = False
    ) -> None:
        """Write a result folder as `hihna run` does, with `vtk` and `report` as there.

        Frames are written if the run kept them: set `run.frame_interval`. Raises `FileExistsError`, `ReadError`.
        """
        self._native.save(os.fspath(folder), overwrite, vtk, report)

    def report(self) -> str:
        """The report as one HTML page."""
        return self._native.report()

    def svg(self) -> str:
        """The drive to scale, with the slip at the last profile time."""
        return self._native.svg()

    def __repr__(self) -> str:
        rows, columns = self._table.shape
        return f"<hihna.Results {self.summary['title']!r}: {rows} rows of {columns} columns>"

    def _repr_html_(self) -> str:
        parts = [f"<p><b>{html.escape(self.summary['title'] or 'Belt drive')}</b></p>", self.svg()]
        for caption, header, rows in self._native.tables():
            heads = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
            lines = ("".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows)
            body = "".join(f"<tr>{line}</tr>" for line in lines)
            parts.append(f"<table><caption>{html.escape(caption)}</caption><tr>{heads}</tr>{body}</table>")
        return "".join(parts)
