"""Sweeps: an experiment at every point of a space of settings, on this computer or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from . import _native
from ._cluster import Cluster
from ._experiment import toml_of
from ._machine import Machine
from ._native import Table
from ._progress import Progress, reporting
from ._tables import table_of

if TYPE_CHECKING:
    from distributed import Client

@dataclass(frozen=True)
class Range:
    """Whole numbers from ``start`` to ``stop``, both included, in steps."""

    #: The first.
    start: int
    #: The last, if a step meets it.
    stop: int
    #: From one to the next, above 0.
    step: int = 1


class SweepSpace:
    """A space of settings: what all points share, and the axes along which they differ.

    - ``base``: keys of an experiment with their values, such as ``{"pipeline": "slats", "scene": "mig"}``; a :class:`Machine` under
      ``machine`` stands for its preset and its changes.
    - ``grid``: keys with the values that they take, lists or :class:`Range`: all combinations, the
      last key in the order of the alphabet fastest.
    - ``together``: keys that change in step, lists of one length.
    - ``seeds``: so many seeds from 1 on for every point.

    Raises :class:`SettingError` for a space that makes no sense.
    """

    def __init__(
        self,
        base: Mapping[str, object],
        grid: Mapping[str, Sequence[object] | Range] | None = None,
        *,
        together: Mapping[str, Sequence[object] | Range] | None = None,
        seeds: int | None = None,
    ) -> None:
        lines = [f"{_key(path)} = {toml_of(value)}" for path, value in _flat(base)]
        lines.append("[sweep]")
        if seeds is not None:
            lines.append(f"seeds = {toml_of(seeds)}")
        for name, axes in (("grid", grid), ("together", together)):
            if axes:
                lines.append(f"[sweep.{name}]")
                lines += [f"{_key(path)} = {_axis(values)}" for path, values in axes.items()]
        self._take("\n".join(lines) + "\n", Path())

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> SweepSpace:
        """The space of an experiment file with a table ``sweep``, as ``pxpl5 sweep FILE`` takes it.

        Raises :class:`SettingError` with the file and the line.
        """
        space = cls.__new__(cls)
        space._take(Path(path).read_text(encoding="utf-8"), Path(path).absolute())
        return space

    def _take(self, text: str, path: Path) -> None:
        #: The text of an experiment file that says the same.
        self.text = text
        self._path = path
        self._native = made(text, fspath(path))

    @property
    def points(self) -> int:
        """How many points there are."""
        return self._native.points

    def header(self) -> dict[str, Any]:
        """What all rows have in common: schema, version, machine, quantities with their definitions, axes.

        Raises :class:`SettingError` when no point is an experiment.
        """
        return self._native.header()

    def costs(self, points: Sequence[int]) -> list[float]:
        """About how many seconds each of some points will take on one core, by the analytic level."""
        return self._native.costs(list(points))

    def __repr__(self) -> str:
        return f"<pxpl5.SweepSpace of {self.points} points>"


def _flat(base: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    for path, value in base.items():
        if isinstance(value, Machine):
            yield "machine.preset", value.preset
            yield from ((f"machine.{number}", setting) for number, setting in value.changes.items())
        elif path == "machine" and isinstance(value, str):
            yield "machine.preset", value
        else:
            yield path, value


def _key(path: str) -> str:
    return ".".join(part if part.replace("_", "").isalnum() else f'"{part}"' for part in path.split("."))


def _axis(values: Sequence[object] | Range) -> str:
    if isinstance(values, Range):
        return f"{{ from = {values.start}, to = {values.stop}, step = {values.step} }}"
    return toml_of(list(values))


def made(text: str, path: str) -> _native.Sweep:
    """A sweep of its text; names of files in it are relative to the file's folder, if it is one."""
    settings = _native.Settings()
    if path in ("", "."):
        settings.parse(text, "space")
    else:
        settings.load(Path(path))
    return _native.Sweep(settings)


class SweepResults:
    """The rows of a sweep, in the order of its points."""

    def __init__(self, lines: list[str], folder: Path | None, header: dict[str, Any]) -> None:
        #: The rows as lines of JSON, the same bytes whoever computed them.
        self.lines = lines
        #: The folder with rows.jsonl and results.csv; None if they were not to be kept.
        self.folder = folder
        #: What all rows have in common.
        self.header = header

    def __len__(self) -> int:
        return len(self.lines)

    @property
    def table(self) -> Table:
        """A row for each point: point, status, its settings by path, the quantities by name, trace_hash and error."""
        import json

        rows = []
        for line in self.lines:
            row = json.loads(line)
            kept = {"point": row["point"], "status": row["status"], **row["parameters"], **row["measured"]}
            rows.append({**kept, "trace_hash": row["trace_hash"], "error": row["error"]})
        return table_of(rows, self.header["measure"])

    def __repr__(self) -> str:
        return f"<pxpl5.SweepResults of {len(self)} points>"


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
            store.run(threads or os.cpu_count() or 1, told)
        else:
            Cluster(space, store, client, told).run()
    lines = store.lines()
    store.finish()
    return SweepResults(lines, folder if keeps else None, space.header())
