"""Sweeps: an experiment at every point of a space of settings, on this computer or on a cluster."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from . import _native
from ._checks import Strict, optional
from ._cluster import Cluster
from ._drawing import Drawing, plotted
from ._native import Table
from ._progress import Progress, reporting
from ._space import SweepSpace
from ._tables import table_of

if TYPE_CHECKING:
    from distributed import Client

    from ._rows import Cell
    from ._study_types import SweepHeaderData


class SweepResults(Strict):
    """The rows of a sweep, in the order of its points."""

    _fields = ("lines", "folder", "header")

    def __init__(self, lines: list[str], folder: Path | None, header: SweepHeaderData) -> None:
        #: The rows as lines of JSON, the same bytes whoever computed them.
        self.lines = lines
        #: The folder with rows.jsonl and results.csv; None if they were not to be kept.
        self.folder = folder
        #: What all rows have in common.
        self.header = header

    def __len__(self) -> int:
        return len(self.lines)

    @property
    def table(self) -> Table[dict[str, Cell]]:
        """A row for each point: point, status, its settings by path, the quantities by name, trace_hash and error."""
        rows = []
        for line in self.lines:
            row = json.loads(line)
            kept = {"point": row["point"], "status": row["status"], **row["parameters"], **row["measured"]}
            rows.append({**kept, "trace_hash": row["trace_hash"], "error": row["error"]})
        return table_of(rows, self.header["measure"])

    def plot(
        self,
        x: str,
        y: str,
        *,
        by: str | Sequence[str] = (),
        band: str | Sequence[str] = "seed",
        where: Mapping[str, object] | None = None,
        x_scale: str = "even",
        y_scale: str = "even",
        title: str = "",
        width_mm: float = 120.0,
    ) -> Drawing:
        """Draws column ``y`` over column ``x`` as ``pxpl5 plot`` does, with the interval of each mean.

        - ``by``: columns whose values have curves of their own; ``band``: columns over which the mean is taken.
        - ``where``: values of columns that a row must have to be drawn.
        - ``x_scale``, ``y_scale``: ``even``, ``zero`` (from 0) or ``log``.

        A row without a number is left out, never drawn as 0. Raises :class:`SettingError` for an unknown column, for a column that
        varies and is not named, and when no row has a number.
        """
        rows = "\n".join([json.dumps(self.header), *self.lines]) + "\n"
        options = {"by": by, "band": band, "where": where, "x_scale": x_scale, "y_scale": y_scale, "title": title}
        return plotted("rows.jsonl", rows, x, y, width_mm, options)

    def __repr__(self) -> str:
        return f"<pxpl5.SweepResults of {len(self)} points>"

    def _repr_html_(self) -> str:
        return self.table._repr_html_()


def sweep(
    space: SweepSpace,
    *,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    threads: int | None = None,
    client: Client | None = None,
    progress: Progress = None,
) -> SweepResults:
    """Runs an experiment at every point; a point that cannot be simulated has a row that says why.

    - ``out``: a folder for rows.jsonl, times.jsonl and results.csv; rows are appended as they come, so that after an interruption
      ``resume=True`` goes on. Without it nothing is kept but what is returned.
    - ``threads``: points at a time on this computer; default: one a core.
    - ``client``: a Dask client: its workers compute the points, in chunks of about half a second by the analytic level's estimate of
      their cost and by how long points took so far. Rows come as they are finished; what a lost worker had not finished is computed
      again, however many are lost. Workers need this package, and the files that the space names.

    The rows are the same bytes, whatever computed them and in whatever order. Raises :class:`SweepError` for a folder that cannot be
    used and for a point over which worker after worker dies, :class:`SettingError` when no point is an experiment.
    """
    if out is not None:
        return _swept(space, Path(out), resume, threads, client, progress, True)
    with TemporaryDirectory(prefix="pxpl5-") as folder:
        return _swept(space, Path(folder), False, threads, client, progress, False)


def _swept(
    space: SweepSpace,
    folder: Path,
    resume: bool,
    threads: int | None,
    client: Client | None,
    progress: Progress,
    keeps: bool,
) -> SweepResults:
    store = _native.Store(space._native, folder, resume)
    with reporting(progress, "points") as told:
        if client is None:
            store.run(optional("threads", threads, 1) or os.cpu_count() or 1, told)
        else:
            Cluster(space, store, client, told).run()
    lines = store.lines()
    store.finish()
    return SweepResults(lines, folder if keeps else None, space.header())
