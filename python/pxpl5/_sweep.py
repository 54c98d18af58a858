"""Sweeps. A sweep runs an experiment at every point of a space of settings, on this computer or on a cluster."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from . import _native
from ._checks import Strict, named, optional
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
        #: Rows as lines of JSON. The bytes do not depend on the computer or the order of the computation.
        self.lines = lines
        #: Folder with rows.jsonl and results.csv; None if :func:`sweep` was called without ``out``.
        self.folder = folder
        #: Data that all rows share.
        self.header = header

    def __len__(self) -> int:
        return len(self.lines)

    @property
    def table(self) -> Table[dict[str, Cell]]:
        """A row for each point: point, status, settings by path, quantities by name, trace_hash and error."""
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
        """Plots column ``y`` against column ``x`` as ``pxpl5 plot`` does, with the interval of each mean.

        - ``by``: columns; each combination of their values gives a curve.
        - ``band``: columns over which the mean is taken.
        - ``where``: values of columns; only rows with these values are drawn.
        - ``x_scale``, ``y_scale``: ``even``, ``zero`` (from 0) or ``log``.

        A row without a number is skipped and not drawn as 0. Raises :class:`SettingError` for an unknown column, for a column that varies
        and is not named, and if no row has a number.
        """
        rows = "\n".join([json.dumps(self.header), *self.lines]) + "\n"
        options = {"by": by, "band": band, "where": where, "x_scale": x_scale, "y_scale": y_scale, "title": title}
        return plotted("rows.jsonl", rows, x, y, width_mm, options)

    def __repr__(self) -> str:
        return f"<pxpl5.SweepResults of {len(self)} points>"

    def _repr_html_(self) -> str:
        return self.table._repr_html_()


@named
def sweep(
    space: SweepSpace,
    *,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    threads: int | None = None,
    client: Client | None = None,
    progress: Progress = None,
) -> SweepResults:
    """Runs an experiment at every point. If a point cannot be simulated, its row has the reason.

    - ``out``: folder for rows.jsonl, times.jsonl and results.csv. The function appends each finished row at once. Without ``out``, no
      files are kept.
    - ``resume``: True to continue an interrupted sweep in the folder ``out``.
    - ``threads``: number of points that are computed at the same time on this computer; default: one for each core.
    - ``client``: Dask client whose workers compute the points. A worker computes a chunk of points, which takes about half a second by the
      estimate of the analytic level and the times of finished points. If a worker is lost, other workers compute its unfinished points.
      Workers need this package and the files that the space names.

    The bytes of the rows do not depend on the computer or the order of the computation. Raises :class:`SweepError` for a folder that
    cannot be used, and if many workers die while they compute the same point. Raises :class:`SettingError` if no point has valid settings
    of an experiment.
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
    with reporting(progress, "points") as reporter:
        if client is None:
            store.run(optional("threads", threads, 1) or os.cpu_count() or 1, reporter)
        else:
            Cluster(space, store, client, reporter).run()
    lines = store.lines()
    store.finish()
    return SweepResults(lines, folder if keeps else None, space.header())
