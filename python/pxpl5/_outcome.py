"""Outcomes: numbers, tables, pictures and drawings of a run."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _html, _native
from ._native import Picture, Table


@dataclass(frozen=True)
class Statistics:
    """How many numbers there are, their mean, sample standard deviation, least and greatest; NaN where there are too few."""

    #: How many numbers there are.
    n: int
    #: Their mean.
    mean: float
    #: Sample standard deviation (n - 1).
    sd: float
    #: The least.
    min: float
    #: The greatest.
    max: float
    #: What they are of, in a sentence.
    definition: str = ""


class Drawing:
    """A drawing as SVG, which notebooks show."""

    def __init__(self, svg: str) -> None:
        #: The document.
        self.svg = svg

    def save(self, path: str | PathLike[str]) -> None:
        """Writes it as a file; raises OSError when it cannot be written."""
        Path(path).write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        """For notebooks, which want the element alone."""
        return self.svg[self.svg.index("<svg") :]

    def __repr__(self) -> str:
        return f"<pxpl5.Drawing of {len(self.svg)} bytes>"


class Report(dict[str, Any]):
    """Everything that a run says, as numbers: the object of ``pxpl5 run --json``, which notebooks show as a table."""

    def _repr_html_(self) -> str:
        rows = [[key, value] for key, value in self.items() if not isinstance(value, (dict, list))]
        for key in ("latency_ms", "latency_fields"):
            spread = self.get(key)
            if isinstance(spread, dict):
                rows.append([key, f"{spread['mean']:.4g} +- {spread['sd']:.3g} (n {spread['n']})"])
        return _html.table(["quantity", "value"], rows, f"{self.get('pipeline')} on {self.get('machine')}, {self.get('scene')}")


class Outcome:
    """What came of an experiment. It is had from :meth:`Experiment.run`."""

    def __init__(self, native: _native.Outcome) -> None:
        self._native = native

    @property
    def trace_hash(self) -> str:
        """Hash of everything that happened: the same experiment has the same one in the command and in Rust."""
        return self._native.trace_hash

    @property
    def config_hash(self) -> str:
        """Name of everything on which the trace depends."""
        return self._native.config_hash

    @property
    def report(self) -> Report:
        """Everything as numbers, with definitions: the object of ``pxpl5 run --json``."""
        return Report(self._native.report())

    @property
    def latency_ms(self) -> Statistics:
        """Latency in milliseconds of simulated time over the complete pictures in the window, as the pipeline defines it."""
        return Statistics(**self.report["latency_ms"])

    @property
    def latency_fields(self) -> Statistics:
        """The same in periods of the display: for NTSC, fields of 1001/60000 s."""
        return Statistics(**self.report["latency_fields"])

    @property
    def missed_retraces(self) -> int | None:
        """Pictures that were due and not shown: late, incomplete or missed; None where none was due."""
        missed = self.report["missed_retraces"]
        return None if missed is None else int(missed)

    def quantity(self, name: str) -> float | None:
        """A quantity of :func:`quantities` by its name; None where the run shows none.

        Raises :class:`SettingError` with the nearest name.
        """
        return self._native.quantity(name)

    def quantities(self) -> dict[str, float | None]:
        """All quantities by name, in the unit that the name ends with; None where the run shows none."""
        return self._native.quantities()

    @property
    def measured(self) -> dict[str, float | None]:
        """The quantities that the experiment named in ``measure``."""
        return self._native.measured()

    @property
    def pictures(self) -> Table:
        """A row for each picture that was begun: when it was sampled, transformed, copied and shown, and where its latency went.

        Times are whole picoseconds of simulated time.
        """
        return self._native.pictures()

    @property
    def stages(self) -> Table:
        """A row for each stage of each picture: picture, stage, surface, begin_ps and end_ps."""
        return self._native.stages()

    @property
    def surfaces(self) -> list[str]:
        """Labels of what somebody looks at, such as left and right."""
        return self._native.surfaces()

    def picture(self, surface: str = "left") -> Picture | None:
        """What the viewer of a surface sees at the end: an NTSC screen is 640 x 480 pixels; None without pixels.

        Raises :class:`SettingError` with the surfaces that there are.
        """
        return self._native.picture(surface)

    def seen(self, field: int, surface: str = "left") -> Picture | None:
        """What the viewer of a surface saw at the end of a field; None of one that is no longer remembered.

        Raises :class:`SettingError` with the surfaces that there are.
        """
        return self._native.seen(surface, field)

    def pixel_memory(self, renderer: int = 0) -> NDArray[np.uint8] | None:
        """Pixel memory of a renderer at the end: shape (208, 128, 128) by bit, row and column, 0 or 1; None where nothing was drawn.

        :attr:`pixel_memory_fields` says which bits are colour, depth and normals. Raises :class:`SettingError` for a renderer that
        there is not.
        """
        return self._native.pixel_memory(renderer)

    @property
    def pixel_memory_fields(self) -> list[tuple[str, int, int]]:
        """How the pipeline divides pixel memory: name, first bit and number of bits of each field, the lowest bit first."""
        return self._native.pixel_memory_fields()

    @property
    def pixel_errors(self) -> dict[str, Any] | None:
        """Where pixels are against where they should be: pixels, degrees, and field by field; None without a tracked head."""
        return self._native.pixel_errors()

    def timeline(
        self,
        *,
        picture: int | None = None,
        first_field: int | None = None,
        fields: int | None = None,
        title: str | None = None,
    ) -> Drawing:
        """Which board worked on which picture when, in the manner of the papers; at most 16 fields.

        Drawn are the dependencies of one picture, by default the first after the warm-up.
        """
        return Drawing(self._native.timeline(picture, first_field, fields, title))

    def page(self, name: str = "run") -> str:
        """The run as one page of HTML, with pictures and timeline, that asks for nothing from outside."""
        return self._native.page(name)

    def __repr__(self) -> str:
        pipeline, machine, scene = self._native.subject()
        return f"<pxpl5.Outcome {pipeline} on {machine}, {scene}: {self.trace_hash}>"

    def _repr_html_(self) -> str:
        both = self._native.both()
        shown = _html.picture(both.png(), "what the viewer sees at the end") if both is not None else ""
        return self.report._repr_html_() + shown
