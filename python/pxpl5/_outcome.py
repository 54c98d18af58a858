"""Outcomes: numbers, tables, pictures and drawings of a run."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, ClassVar, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from . import _html, _native, _saved
from ._checks import Strict, optional, whole
from ._drawing import Drawing
from ._errors import DiscardedError, RunError, SettingError
from ._names import QuantityName
from ._native import Picture, Table
from ._tables import table_of
from ._types import CriticalPathData, UtilisationData

if TYPE_CHECKING:
    from ._experiment import Experiment
    from ._report_types import PixelErrorsData, ReportData, StatisticsData
    from ._rows import BoardRow, EventRow, PictureDifferenceRow, PictureRow, ResultRow, SettingRow, StageRow

T = TypeVar("T")


@dataclass(frozen=True)
class Statistics:
    """Statistics of a set of values: number, mean, sample standard deviation, least and greatest value."""

    #: Number of values.
    n: int
    #: Mean of the values; None without values.
    mean: float | None
    #: Sample standard deviation (n - 1); None with fewer than two values.
    sd: float | None
    #: Least value; None without values.
    min: float | None
    #: Greatest value; None without values.
    max: float | None
    #: Definition of the quantity, as a sentence.
    definition: str = ""


class Report(dict[str, object]):
    """All results of a run as numbers: the object of ``pxpl5 run --json``. Notebooks show the report as a table."""

    def _repr_html_(self) -> str:
        report = cast("ReportData", self)
        rows: list[list[object]] = [
            ["latency_ms", _spread(report["latency_ms"])],
            ["latency_fields", _spread(report["latency_fields"])],
        ]
        rows += [[key, value] for key, value in self.items() if not isinstance(value, (dict, list))]
        return _html.table(["quantity", "value"], rows, f"{self.get('pipeline')} on {self.get('machine')}, {self.get('scene')}")


def _spread(found: StatisticsData) -> str:
    """Returns mean, standard deviation and number of values as text."""
    if found["mean"] is None:
        return "none: no picture was complete in time"
    sd = found["sd"]
    return f"{found['mean']:.4g}" + (f" +- {sd:.3g}" if sd is not None else "") + f" (n {found['n']})"


@dataclass(frozen=True)
class Differences:
    """Differences between two outcomes: settings, results and pictures."""

    #: True if both runs have the same trace and the same statistics.
    same_trace: bool
    #: A row for each different setting: key, a and b.
    settings: Table[SettingRow]
    #: A row for each different result: key, a, b, and percent of a. Computing times are not compared.
    results: Table[ResultRow]
    #: Number of equal results.
    equal: int
    #: A row for each surface with a picture in both outcomes: surface, pixels, differing pixels, largest difference of a colour (0 to 255).
    pictures: Table[PictureDifferenceRow]

    def __repr__(self) -> str:
        trace = "the same trace" if self.same_trace else "another trace"
        return f"<pxpl5.Differences: {trace}, {len(self.settings)} settings and {len(self.results)} results differ, {self.equal} are equal>"

    def _repr_html_(self) -> str:
        return self.settings._repr_html_() + self.results._repr_html_() + self.pictures._repr_html_()


class Outcome(Strict):
    """Results of an experiment, from :meth:`Experiment.run` or :meth:`load`.

    An outcome can be pickled and saved. A saved outcome has the report, the quantities, the tables and the last pictures. For other
    results, the outcome runs its experiment again, with the same trace.
    """

    #: Returns the experiment of a saved state; the module of experiments sets it.
    _experiment_of_state: ClassVar[Callable[[_saved.ExperimentState], Experiment]]

    def __init__(
        self,
        native: _native.Outcome | None,
        experiment: Experiment | None = None,
        saved: _saved.Saved | None = None,
    ) -> None:
        self._run = native
        self._experiment = experiment
        self._saved = saved

    @property
    def _live(self) -> _native.Outcome:
        """The run of this outcome. For a saved outcome, this is a new run with the same trace."""
        if self._run is None:
            if self._experiment is None or self._saved is None:
                raise RunError("expected an outcome with its experiment, found one whose experiment could not be saved")
            run = self._experiment._native.run(None, None, not self._saved["discarded"])
            if run.trace_hash != self._saved["trace_hash"]:
                raise RunError(f"the new run: expected the trace {self._saved['trace_hash']}, found {run.trace_hash}")
            self._run = run
        return self._run

    def _value(self, saved: Callable[[_saved.Saved], T], native: Callable[[_native.Outcome], T]) -> T:
        return native(self._live) if self._saved is None else saved(self._saved)

    @property
    def trace_hash(self) -> str:
        """Hash of all events of the run. The same experiment has the same hash in the command and in Rust."""
        return self._value(lambda saved: saved["trace_hash"], lambda native: native.trace_hash)

    @property
    def config_hash(self) -> str:
        """Hash of all settings on which the trace depends."""
        return self._value(lambda saved: saved["config_hash"], lambda native: native.config_hash)

    @property
    def report(self) -> ReportData:
        """All results as numbers with definitions: the object of ``pxpl5 run --json``. A value that was not measured is None."""
        found: ReportData = self._value(lambda saved: json.loads(saved["report"]), lambda native: native.report())
        return cast("ReportData", Report(found))

    @property
    def latency_ms(self) -> Statistics:
        """Latency of the complete pictures in the window, in milliseconds of simulated time. Each pipeline defines its latency."""
        return Statistics(**self.report["latency_ms"])

    @property
    def latency_fields(self) -> Statistics:
        """Latency of the complete pictures in the window, in periods of the display (fields of 1001/60000 s for NTSC)."""
        return Statistics(**self.report["latency_fields"])

    @property
    def missed_retraces(self) -> int | None:
        """Number of due pictures that were not shown: late, incomplete or missed; None if no picture was due."""
        return self.report["missed_retraces"]

    @property
    def advice(self) -> str | None:
        """Advice of the library if the machine was too slow for the scene, or showed no picture; otherwise None."""
        return self._value(lambda saved: saved["advice"], lambda native: native.advice())

    @property
    def utilisation(self) -> UtilisationData | None:
        """Shares of time, 0 to 1, for which boards were busy: host, gps, renderers, ring and ports."""
        return self.report["utilisation"]

    @property
    def critical_path(self) -> CriticalPathData | None:
        """Chain of waits that makes up the latency of the last complete pictures; None if no picture was complete."""
        return self.report["critical_path"]

    @property
    def boards(self) -> Table[BoardRow]:
        """A row for each kind of board and activity: mean share of time, share of the busiest board, number of the busiest board."""
        return table_of(_board_rows(self.utilisation), BOARD_DEFINITIONS)

    def quantity(self, name: QuantityName | str) -> float | None:
        """Returns a quantity of :func:`quantities` by its name, or None if the run has no value.

        Raises :class:`SettingError` with the nearest name for an unknown name.
        """
        for key, value in [] if self._saved is None else self._saved["quantities"].items():
            if key == name:
                return value
        return self._live.quantity(name)

    def quantities(self) -> dict[QuantityName, float | None]:
        """Returns all quantities by name. Most names end with the unit. A quantity without a value is None."""
        return self._value(lambda saved: dict(saved["quantities"]), lambda native: native.quantities())

    @property
    def measured(self) -> dict[QuantityName, float | None]:
        """The quantities of the experiment's setting ``measure``."""
        return self._value(lambda saved: dict(saved["measured"]), lambda native: native.measured())

    @property
    def has_discarded_records(self) -> bool:
        """True if the run kept only statistics and has discarded records. The outcome then has no tables and timelines."""
        return self._value(lambda saved: saved["discarded"], lambda native: native.has_discarded_records())

    def _check_records(self, what: str) -> None:
        if self.has_discarded_records:
            raise DiscardedError(f"{what}: expected a run with keep=\"everything\", found one that has discarded its records")

    @property
    def pictures(self) -> Table[PictureRow]:
        """A row for each begun picture: times of sample, TRANSFORM, COPY and display, and the parts of the latency.

        Times are whole picoseconds of simulated time. Raises :class:`DiscardedError` if a run with ``keep="statistics"`` has
        discarded rows.
        """
        self._check_records("pictures")
        saved = None if self._saved is None else self._saved["pictures"]
        return self._live.pictures() if saved is None else saved

    @property
    def stages(self) -> Table[StageRow]:
        """A row for each stage of each picture: picture, stage, surface, begin_ps and end_ps.

        Raises :class:`DiscardedError` as :attr:`pictures` does.
        """
        self._check_records("stages")
        saved = None if self._saved is None else self._saved["stages"]
        return self._live.stages() if saved is None else saved

    @property
    def events(self) -> Table[EventRow]:
        """A row for each observed event in the order of time: time_ps, board, picture and event.

        Events are stages of programs, regions that renderers copied, regions that arrived at displays, and swaps. Raises
        :class:`DiscardedError` as :attr:`pictures` does.
        """
        self._check_records("events")
        return self._live.events()

    @property
    def surfaces(self) -> list[str]:
        """Labels of the surfaces that a viewer sees, such as left and right."""
        return self._value(lambda saved: list(saved["surfaces"]), lambda native: native.surfaces())

    def picture(self, surface: str = "left") -> Picture | None:
        """Returns the picture that the viewer of a surface sees at the end of the run, or None if no pixels were computed.

        An NTSC screen has 640 x 480 pixels. Raises :class:`SettingError` with the names of all surfaces for an unknown surface.
        """
        if self._saved is not None and surface in self._saved["last"]:
            return self._saved["last"][surface]
        return self._live.picture(surface)

    def seen(self, field: int, surface: str = "left") -> Picture | None:
        """Returns the picture that the viewer of a surface saw at the end of a field, or None if the record of the field was discarded.

        :meth:`frames` has the pictures of all fields. Raises :class:`SettingError` with the names of all surfaces for an unknown surface.
        """
        return self._live.seen(surface, whole("field", field))

    def frames(self, surface: str | int = "left", *, first: int = 0, fields: int | None = None) -> Iterator[Picture]:
        """Returns an iterator over the pictures of all fields, as :meth:`Experiment.frames` does. The experiment runs once more."""
        return self._source().frames(surface, first=first, fields=fields)

    def film(
        self, path: str | PathLike[str], surface: str | int = "left", *, first: int = 0, fields: int | None = None
    ) -> None:
        """Writes the pictures of :meth:`frames` as an animated PNG, as :meth:`Experiment.film` does."""
        self._source().film(path, surface, first=first, fields=fields)

    def _source(self) -> Experiment:
        if self._experiment is None:
            raise RunError("expected an outcome with its experiment, found one whose experiment could not be saved")
        return self._experiment

    @property
    def experiment(self) -> Experiment | None:
        """The experiment of this outcome; None for a saved outcome whose experiment could not be saved."""
        return self._experiment

    def face(self, eye: str = "left", memory: int = 0) -> Picture | None:
        """Returns the six cube faces of a display memory for an eye at the end of the run, unfolded into a cross.

        The result is None for a display without six faces. Raises :class:`SettingError` for an eye or a memory that does not exist.
        """
        return self._live.face(eye, whole("memory", memory))

    def pixel_memory(self, renderer: int = 0) -> NDArray[np.uint8] | None:
        """Returns the pixel memory of a renderer at the end of the run, or None if the renderer drew nothing.

        The array has the shape (208, 128, 128) for bit, row and column, and the values 0 and 1. :attr:`pixel_memory_fields` lists the
        bits of colour, depth and normals. Raises :class:`SettingError` for a renderer that does not exist.
        """
        return self._live.pixel_memory(whole("renderer", renderer))

    @property
    def pixel_memory_fields(self) -> list[tuple[str, int, int]]:
        """Layout of pixel memory: name, first bit and number of bits of each field. Bits of a field are in order from the lowest."""
        return self._live.pixel_memory_fields()

    @property
    def pixel_errors(self) -> PixelErrorsData | None:
        """Distances between pixels and their right places, in pixels and degrees; None without a tracked head."""
        found: PixelErrorsData | None = self._value(
            lambda saved: json.loads(saved["pixel_errors"]), lambda native: native.pixel_errors()
        )
        return found

    def timeline(
        self,
        *,
        picture: int | None = None,
        first_field: int | None = None,
        fields: int | None = None,
        title: str | None = None,
    ) -> Drawing:
        """Returns a timeline as in the papers: the work of each resource on each picture. A timeline has at most 16 fields.

        The timeline shows the dependencies of one picture, by default the first picture after the warm-up. Raises
        :class:`SettingError` for a picture or a field outside the run, and :class:`DiscardedError` as :attr:`pictures` does.
        """
        self._check_records("timeline")
        numbers = optional("picture", picture), optional("first_field", first_field), optional("fields", fields, 1)
        if first_field is not None and first_field >= self.report["fields"]:
            raise SettingError(f"first_field: expected 0 to {self.report['fields'] - 1}, found {first_field}")
        begun = self.pictures["picture"]
        if picture is not None and picture not in begun:
            expected = f"{begun.min()} to {begun.max()}" if len(begun) else "none, because the run began no picture"
            raise SettingError(f"picture: expected {expected}, found {picture}")
        return Drawing(self._live.timeline(*numbers, title))

    def page(self, name: str = "run") -> str:
        """Returns the results as one page of HTML that contains the pictures and the timeline and loads no other file.

        Raises :class:`DiscardedError` as :attr:`pictures` does.
        """
        self._check_records("page")
        return self._live.page(name)

    def diff(self, other: Outcome) -> Differences:
        """Returns the differences of settings, results and last pictures between this outcome (a) and ``other`` (b)."""
        if not isinstance(other, Outcome):
            raise SettingError(f"other: expected an Outcome, found {type(other).__name__}")
        found = _native.diff(self._report_json(), other._report_json())
        settings = [{"key": row["key"], "a": _cell(row["a"]), "b": _cell(row["b"])} for row in found["settings"]]
        results = [
            {"key": row["key"], "a": _cell(row["a"]), "b": _cell(row["b"]), "percent": row["percent"]} for row in found["results"]
        ]
        pictures = [
            _picture_row(surface, self.picture(surface), other.picture(surface))
            for surface in self.surfaces
            if surface in other.surfaces
        ]
        shown = [row for row in pictures if row is not None]
        return Differences(found["same_trace"], table_of(settings), table_of(results), found["equal"], table_of(shown))

    def _report_json(self) -> str:
        return self._value(lambda saved: saved["report"], lambda native: native.report_json())

    def _data(self) -> _saved.Saved:
        return _saved.saved_of(self._live) if self._saved is None else self._saved

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the outcome to a file, a ZIP archive of JSON and PNG, which :meth:`load` reads.

        The file also has the experiment, unless the experiment has a Python function. Raises OSError if the file cannot be written.
        """
        state = None if self._experiment is None else self._experiment._plain_state()
        _saved.write(path, self._data(), state)

    @staticmethod
    def load(path: str | PathLike[str]) -> Outcome:
        """Reads an outcome that :meth:`save` has written.

        Raises :class:`SettingError` for a foreign or damaged file, with the path, what was expected and what was found. It raises the
        same exception if a model file or a recording that the experiment names is gone, and OSError when the file cannot be read.
        """
        saved, state = _saved.read(path)
        if state is None:
            return Outcome(None, None, saved)
        checked_state = state
        return Outcome(None, _saved.read_with(path, lambda: Outcome._experiment_of_state(checked_state)), saved)

    def __reduce__(self) -> tuple[type[Outcome], tuple[None, Experiment | None, _saved.Saved]]:
        # A function that is defined within another function cannot be pickled. The outcome is then pickled without its experiment.
        experiment = self._experiment
        try:
            pickle.dumps(experiment)
        except (pickle.PicklingError, AttributeError, TypeError):
            experiment = None
        return Outcome, (None, experiment, self._data())

    def __repr__(self) -> str:
        pipeline, machine, scene = self._value(lambda saved: saved["subject"], lambda native: native.subject())
        latency = _spread(self.report["latency_ms"])
        return f"<pxpl5.Outcome {pipeline} on {machine}, {scene}: latency, ms: {latency}; trace {self.trace_hash}>"

    def _repr_html_(self) -> str:
        warning = "" if self.advice is None else _html.warning(self.advice)
        both = self._value(lambda saved: saved["both"], lambda native: native.both())
        shown = _html.picture(both.png(), "what the viewer sees at the end") if both is not None else ""
        return warning + Report(self.report)._repr_html_() + shown


BOARD_DEFINITIONS = {
    "board": "kind of board",
    "activity": "what the time was spent for",
    "mean": "share of the run's time, 0 to 1, mean over all boards of the kind",
    "max": "share of the busiest board",
    "busiest": "number of the busiest board",
    "idle": "number of boards that were busy for less than 1 % of the time",
}


def _board_rows(found: UtilisationData | None) -> list[dict[str, object]]:
    if found is None:
        return []
    gps, renderers = found["gps"], found["renderers"]
    rows: list[dict[str, object]] = [
        {"board": "host", "activity": "busy", "mean": found["host"]},
        {"board": "graphics processors", "activity": "busy", **gps["busy"]},
        {"board": "graphics processors", "activity": "work", "mean": gps["work"]},
        {"board": "graphics processors", "activity": "messages", "mean": gps["messages"]},
        {"board": "graphics processors", "activity": "tokens", "mean": gps["tokens"]},
        {"board": "renderers", "activity": "executing", **renderers["executing"]},
        {"board": "renderers", "activity": "copying", "mean": renderers["copying"]},
        {"board": "renderers", "activity": "waiting", "mean": renderers["waiting"]},
        {"board": "ring", "activity": "channels", **found["ring"]["channels"]},
    ]
    rows += [{"board": port["port"], "activity": "receiving", "mean": port["busy"]} for port in found["ports"]["each"]]
    return rows


def _cell(value: object) -> str | None:
    """Returns a value of a report as text, because a column of differences has values of several types."""
    return value if value is None or isinstance(value, str) else json.dumps(value)


def _picture_row(surface: str, a: Picture | None, b: Picture | None) -> dict[str, object] | None:
    if a is None or b is None:
        return None
    row: dict[str, object] = {"surface": surface, "pixels": a.array.shape[0] * a.array.shape[1]}
    if a.array.shape != b.array.shape:
        return {**row, "differing": None, "largest": None}
    distance = np.abs(a.array.astype(np.int16) - b.array.astype(np.int16)).max(axis=2)
    return {**row, "differing": int(np.count_nonzero(distance)), "largest": int(distance.max())}
