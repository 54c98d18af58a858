"""Spaces of settings. A sweep runs an experiment at each point of a space."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from . import _native
from ._checks import Strict, named, whole
from ._machine import Machine
from ._toml import toml_of

if TYPE_CHECKING:
    from ._study_types import SweepHeaderData


@named
@dataclass(frozen=True)
class Range:
    """Whole numbers from ``start`` to at most ``stop`` at equal distances."""

    #: First number.
    start: int
    #: Greatest possible number.
    stop: int
    #: Distance between two numbers, above 0.
    step: int = 1


class SweepSpace(Strict):
    """A space of settings: the settings that all points share, and the settings that vary.

    - ``base``: shared keys with their values, such as ``{"pipeline": "slats", "scene": "mig"}``. A :class:`Machine` under the key
      ``machine`` gives its preset and its changes.
    - ``grid``: keys with all of their values, as lists or :class:`Range`. The space has all combinations of the values. From point to
      point, the key that is last in alphabetical order changes fastest.
    - ``together``: keys whose values change together, as lists of equal length.
    - ``seeds``: number of seeds, counted from 1, for every combination.

    Raises :class:`SettingError` for a wrong space.
    """

    _fields = ("text",)

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
            lines.append(f"seeds = {whole('seeds', seeds, 1)}")
        for name, axes in (("grid", grid), ("together", together)):
            if axes:
                lines.append(f"[sweep.{name}]")
                lines += [f"{_key(path)} = {_axis(values)}" for path, values in axes.items()]
        self._take("\n".join(lines) + "\n", Path())

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> SweepSpace:
        """Reads a space from an experiment file with a table ``sweep``, as for ``pxpl5 sweep FILE``.

        Raises :class:`SettingError` with the file and the line of an error.
        """
        space = cls.__new__(cls)
        space._take(Path(path).read_text(encoding="utf-8"), Path(path).absolute())
        return space

    def _take(self, text: str, path: Path) -> None:
        #: Text of an experiment file that describes this space.
        self.text = text
        self._path = path
        self._native = sweep_of_text(text, fspath(path))

    @property
    def points(self) -> int:
        """Number of points of the space."""
        return self._native.points

    def header(self) -> SweepHeaderData:
        """Returns the data that all rows share: schema, version, machine, quantities with their definitions, axes.

        Raises :class:`SettingError` if no point has valid settings of an experiment.
        """
        return self._native.header()

    def costs(self, points: Sequence[int]) -> list[float]:
        """Returns the estimated seconds on one core for each of the given points, by the analytic level."""
        return self._native.costs([whole("points", point) for point in points])

    def __repr__(self) -> str:
        return f"<pxpl5.SweepSpace of {self.points} points>"


def _flat(base: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    for path, value in base.items():
        if isinstance(value, Machine):
            yield "machine.preset", value.preset
            yield from ((f"machine.{number}", setting) for number, setting in value.changes.items())
        elif path == "measure" and isinstance(value, str):
            yield path, [value]
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


def sweep_of_text(text: str, path: str) -> _native.Sweep:
    """Returns the sweep of a text. If ``path`` is the path of a file, file names in the text are relative to its folder."""
    settings = _native.Settings()
    if path in ("", "."):
        settings.parse(text, "space")
    else:
        settings.load(Path(path))
    return _native.Sweep(settings)
