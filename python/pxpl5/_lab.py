"""Studies of many experiments (figures, limits, comparisons), and lists of the names and keys of the library."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from . import _native
from ._checks import Strict, named, names, optional, whole
from ._drawing import Drawing, plotted
from ._errors import SettingError
from ._experiment import Made
from ._head import Head
from ._machine import Machine, Parameter
from ._names import LevelName, MachineName, PipelineName, QuantityName
from ._native import Table
from ._progress import Progress, reporting
from ._tables import table_of
from ._types import RigData

if TYPE_CHECKING:
    from ._rows import Cell, FigureRow, LevelRow, PipelineRow, InterpretationRow
    from ._study_types import ComparisonData, FigureData


def presets() -> dict[str, str]:
    """Returns the names of the built-in machines, each with a description and the source. Machines of the papers come first."""
    return dict(_native.presets())


def builtin_scenes() -> dict[str, str]:
    """Returns the names of the built-in scenes, each with a description. ``N`` stands for a number of triangles."""
    return dict(_native.builtin_scenes())


def pipelines() -> Table[PipelineRow]:
    """Returns a row for each pipeline: name, family, about, preset, true if it has a closed form, and its keys as JSON."""
    return table_of(_native.pipelines(), {"about": "what it is and where it was published"})


def displays() -> list[str]:
    """Returns the names of the displays, for the key ``display``."""
    return _native.displays()


def quantities() -> dict[QuantityName, str]:
    """Returns the names of the quantities that can be measured, each with its definition."""
    return _native.quantities()


def keys() -> dict[str, str]:
    """Returns all keys of experiments except parameters, each with its effect and its values."""
    return dict(_native.keys())


def tracking_parameters() -> list[Parameter]:
    """Returns the parameters of all trackers, of the host's serial port and of the predictors, for :attr:`Head.tracking`."""
    return [Parameter(**entry) for entry in _native.tracking_parameters()]


FIGURE_DEFINITIONS = {
    "published": "as the paper prints it, in the unit beside it",
    "simulated": "result of the model, in the same unit",
    "error_percent": "(simulated - published) / published, percent",
    "low": "least value when open parameters are varied within their ranges",
    "high": "greatest value when open parameters are varied within their ranges",
    "provenance": "free, interpretation, fitted, rule or derived",
    "misses": "outside of the printed range, or off by more than 3 percent",
}


def figure_ids() -> dict[str, str]:
    """Returns the numbers of the published figures, such as 4b, each with the statement of the paper."""
    return dict(_native.figure_ids())


@named
def figures(
    ids: str | Sequence[str] | None = None, *, level: LevelName | str = "transaction", progress: Progress = None
) -> Table[FigureRow]:
    """Measures the figures of the papers. Returns a row for each figure: published and simulated value, unit, error and source.

    Without ``ids``, the function also computes the intervals (columns low and high), which takes minutes. With ``ids``, it measures only
    these figures, without intervals.

    Raises :class:`SettingError` for the number of an unknown figure.
    """
    rows: list[FigureData]
    with reporting(progress, "figures") as reporter:
        if ids is None:
            rows = _native.figures(level, reporter)
        else:
            rows = []
            wanted = names("ids", ids)
            for done, number in enumerate(wanted, 1):
                rows.append(_native.figure(number, level))
                if reporter is not None:
                    reporter(done, len(wanted))
    return table_of(rows, FIGURE_DEFINITIONS)


@dataclass(frozen=True)
class Limit:
    """The largest number of triangles that a pipeline draws in time, with the tested numbers."""

    #: One less than ``first_miss``; 0 if one triangle misses the goal, and None if the pipeline has no limit.
    triangles: int | None
    #: The smallest tried number of triangles that misses the goal; None if all tried numbers reach the goal.
    first_miss: int | None
    #: The largest tried number of triangles above ``first_miss`` that reaches the goal; None without such a number.
    island: int | None
    #: Least number of triangles from which all numbers up to ``triangles`` were tried. Below, only some numbers were tried.
    unbroken_from: int
    #: How many numbers of triangles were simulated.
    tried: int
    #: Goal of the search.
    goal: str | dict[str, float]
    #: Number of simulated fields for each number of triangles.
    fields: int
    #: Scene whose triangles were drawn.
    scene: str


@dataclass(frozen=True)
class OverLimit:
    """Values of a setting with which an experiment reaches a goal."""

    #: Path of the setting.
    over: str
    #: Goal of the search.
    goal: str | dict[str, float]
    #: Number of simulated fields for each value.
    fields: int
    #: Least value of the search.
    low: float
    #: Greatest value of the search.
    high: float
    #: Least value that reaches the goal; None if no smaller tried value misses it.
    least: float | None
    #: Greatest value that reaches the goal; None if no greater tried value misses it.
    most: float | None
    #: True if at least one tried value reaches the goal.
    reached: bool
    #: Tried values in ascending order, each with True if it reaches the goal.
    tried: list[tuple[float, bool]]
    #: A value that misses the goal: the value next to the limit, or the best value if all miss the goal; None if all reach the goal.
    missed_at: float | None
    #: The resource that limits the experiment with ``missed_at``, in words; None if unknown.
    because: str | None


def limit_over(
    over: str,
    pipeline: PipelineName | str,
    scene: str | PathLike[str],
    *,
    low: float | None = None,
    high: float | None = None,
    machine: MachineName | str | Machine | None = None,
    head: str | Head | None = None,
    rate_hz: float | None = None,
    latency_fields: float | None = None,
    fields: int | None = None,
    level: LevelName | str | None = None,
    settings: Mapping[str, object] | None = None,
    progress: Progress = None,
    **keys: object,
) -> OverLimit:
    """Returns the values of a numeric setting with which an experiment reaches a goal, as ``pxpl5 limit --over`` does.

    - ``over``: path of the setting, such as ``machine.n_gps``.
    - ``low``, ``high``: range of the search. The default for a number of boards is 1 to the number in the largest preset. The default for
      another parameter is the range of its sources.
    - ``rate_hz`` (least number of updates a second) or ``latency_fields`` (greatest mean latency): goal instead of the pipeline's goal.

    The search tries both ends of the range and three values between. From a value that reaches the goal, the search continues by
    bisection. Raises :class:`SettingError` for a wrong setting or range.
    """
    made = Made()
    goals = _goals(rate_hz, latency_fields)
    made.put_all(pipeline, scene, machine, head, {"level": level, **goals, **keys, **(settings or {})})
    # An unknown key is refused with the nearest one, before its range is asked for.
    made.settings.copy().set(f"{over}=1", "over")
    with reporting(progress, "values") as reporter:
        found = _native.limit_over(
            made.settings,
            over,
            low=low,
            high=high,
            fields=optional("fields", fields, MIN_FIELDS),
            progress=reporter,
        )
    return OverLimit(
        over=found["over"],
        goal=found["goal"],
        fields=found["fields"],
        low=found["low"],
        high=found["high"],
        least=found["least"],
        most=found["most"],
        reached=found["reached"],
        tried=[(float(value), bool(hit)) for value, hit in found["tried"]],
        missed_at=found["missed_at"],
        because=found["because"],
    )


#: Least number of fields of a search. Shorter runs end during the warm-up of every pipeline.
MIN_FIELDS = 10


def _goals(rate_hz: float | None, latency_fields: float | None) -> dict[str, float | None]:
    """Returns the keys of a goal."""
    for name, value in (("rate_hz", rate_hz), ("latency_fields", latency_fields)):
        if value is not None and not value > 0:
            raise SettingError(f"{name}: expected a number above 0, found {value!r}")
    return {"limit.rate_hz": rate_hz, "limit.latency_fields": latency_fields}


def limit(
    pipeline: PipelineName | str,
    scene: str | PathLike[str] | None = None,
    *,
    machine: MachineName | str | Machine | None = None,
    head: str | Head | None = None,
    rate_hz: float | None = None,
    latency_fields: float | None = None,
    fields: int | None = None,
    level: LevelName | str | None = None,
    settings: Mapping[str, object] | None = None,
    progress: Progress = None,
    **keys: object,
) -> Limit:
    """Finds the largest number of triangles that a pipeline draws in time, by simulation.

    - ``scene``: ``full-screen`` or ``typical``, or a built-in scene or model file, which is decimated; default: the scene in the
      pipeline's own definition of the limit.
    - ``head``: a tracked head. Each simulation then tunes the predictor, unless its numbers are given.
    - ``rate_hz`` (least number of updates a second) or ``latency_fields`` (greatest mean latency): goal instead of the pipeline's goal.

    Raises :class:`SettingError` for a wrong setting.
    """
    made = Made()
    goals = _goals(rate_hz, latency_fields)
    made.put_all(pipeline, scene or "full-screen:1", machine, head, {"level": level, **goals, **keys, **(settings or {})})
    with reporting(progress, "sizes") as reporter:
        found = _native.limit(
            made.settings,
            of_scene=scene is not None,
            fields=optional("fields", fields, MIN_FIELDS),
            progress=reporter,
        )
    return Limit(**found)


class Comparison(Strict):
    """Results of all compared pipelines. :attr:`table` has a row for each pipeline, and :attr:`data` has all results."""

    _fields = ("data",)

    def __init__(self, data: ComparisonData) -> None:
        #: The object of ``pxpl5 compare --json``.
        self.data = data

    @property
    def table(self) -> Table[dict[str, Cell]]:
        """A row for each pipeline: latency, head to light, rate, errors in pixels and largest number of triangles.

        Names of columns contain points. A mean over seeds has the column ``.mean``, and ``.low``, ``.high`` and ``.method`` for its 95 %
        interval. ``pictures_due`` and ``missed_retraces`` count pictures, and ``error.n`` counts evaluated pixels.
        """
        left_out = ("end_to_end", "causes", "predictors", "picture", "errors", "display_counters")
        rows = []
        for compared in self.data["pipelines"]:
            row = {key: value for key, value in compared.items() if key not in left_out}
            row["error"] = {key: value for key, value in compared["error"].items() if key != "distribution_px"}
            rows.append(row)
        return table_of(rows)

    def plot(
        self,
        x: str = "head_to_light_ms.mean",
        y: str = "error.mean_px.mean",
        *,
        by: str | Sequence[str] = "pipeline",
        where: Mapping[str, object] | None = None,
        x_scale: str = "even",
        y_scale: str = "even",
        title: str = "",
        width_mm: float = 120.0,
    ) -> Drawing:
        """Plots column ``y`` against column ``x`` as ``pxpl5 plot`` does; see :meth:`SweepResults.plot`."""
        options = {"by": by, "where": where, "x_scale": x_scale, "y_scale": y_scale, "title": title}
        return plotted("comparison.json", json.dumps(self.data), x, y, width_mm, options)

    def __repr__(self) -> str:
        return f"<pxpl5.Comparison of {len(self.data['pipelines'])} pipelines, {self.data['scene']} on {self.data['machine']}>"

    def _repr_html_(self) -> str:
        from ._html import table

        head = ["pipeline", "latency, ms", "head to light, ms", "figure 19, ms", "due", "not shown", "error, px", "pixels", "triangles"]
        rows = [
            [
                row["pipeline"],
                row["latency_ms"]["mean"],
                row["head_to_light_ms"]["mean"],
                row["tracking_and_rendering_ms"]["mean"],
                row["pictures_due"],
                row["missed_retraces"],
                row["error"]["mean_px"]["mean"],
                row["error"]["n"],
                "no limit" if row["has_no_limit"] else row["triangles_possible"],
            ]
            for row in self.data["pipelines"]
        ]
        return table(head, rows, f"{self.data['scene']} on {self.data['machine']}, {len(self.data['seeds'])} seeds")


def compare(
    scene: str | PathLike[str] = "room",
    *,
    machine: MachineName | str | Machine = "small-hmd",
    head: str | Head = "synthetic",
    fields: int | None = None,
    only: str | Sequence[str] = (),
    all_rows: bool = False,
    seeds: int | Sequence[int] = 5,
    limits: bool = False,
    causes: bool = False,
    predictors: bool = False,
    confidence: float = 0.95,
    until_precision: str | None = None,
    max_seeds: int | None = None,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    settings: Mapping[str, object] | None = None,
    progress: Progress = None,
    **keys: object,
) -> Comparison:
    """Runs several pipelines with the same settings, once for each seed. Returns errors in pixels and latencies.

    ``limits`` adds the largest number of triangles of each row, ``causes`` the error by cause, ``predictors`` the error with every
    predictor. Each of the three takes longer.

    - ``head``: a :class:`Head`, or the name of a motion. The motion ``synthetic`` differs with the seed.
    - ``fields``: number of fields of each run; default: the length of the recording, or 300 without a recording.
    - ``only``: names of the rows to run; default: one or two rows of each family of pipelines.
    - ``all_rows``: True to run all rows.
    - ``limits``: True to add the largest number of triangles of each pipeline.
    - ``confidence``: confidence level of all intervals, between 0 and 1.
    - ``until_precision``: greatest width of the interval of each mean error, from end to end, as a share of the mean (``"10%"``) or in
      pixels (``"0.2px"``). A row gets more seeds until its interval is narrower, up to ``max_seeds`` (default 50). Only for the head
      ``synthetic``.
    - ``out``: a folder. Each row is stored in it as soon as its runs have ended, and comparison.json at the end, as
      ``pxpl5 compare --out`` does, but without pictures. After an interruption, ``resume=True`` keeps the finished rows of the same
      comparison and runs only the others.

    Ctrl-C ends the runs in progress. Raises :class:`SettingError` for a setting that is wrong, or a run
    too short for any result, and :class:`SweepError` for a folder that cannot be used, is in use, or holds another comparison.
    """
    if not 0 < confidence < 1:
        raise SettingError(f"confidence: expected a number between 0 and 1, found {confidence!r}")
    if max_seeds is not None and until_precision is None:
        raise SettingError("max_seeds: expected until_precision beside it, found none")
    if resume and out is None:
        raise SettingError("resume: expected the folder out beside it, found none")
    if all_rows and only:
        raise SettingError(f"all_rows: expected no names in only, found {only!r}")
    made = Made()
    made.put_all(None, scene, machine, head, {**({} if fields is None else {"fields": fields}), **keys, **(settings or {})})
    if isinstance(seeds, int):
        numbers = list(range(1, whole("seeds", seeds, 1) + 1))
    else:
        numbers = [whole("seeds", seed) for seed in seeds]
    folder = None if out is None else Path(out)
    with reporting(progress, "runs") as reporter:
        data = _native.compare(
            made.settings,
            names("only", only),
            numbers,
            all_rows=all_rows,
            limits=limits,
            causes=causes,
            predictors=predictors,
            confidence=confidence,
            until_precision=until_precision,
            max_seeds=optional("max_seeds", max_seeds, 2),
            folder=None if folder is None else folder / "rows",
            resume=resume,
            progress=reporter,
        )
    if folder is not None:
        (folder / "comparison.json").write_text(json.dumps(data, indent=2) + "\n", encoding="utf-8")
    return Comparison(data)


def rig(
    pipeline: PipelineName | str = "rendering-control",
    *,
    machine: MachineName | str | Machine | None = None,
    tracker: str = "optical",
    passes: int = 24,
    line: int | None = None,
    seed: int | None = None,
    settings: Mapping[str, object] | None = None,
    **keys: object,
) -> RigData:
    """Measures latency from outside with a simulated pendulum and photodiodes, as ``pxpl5 rig`` does.

    The result also has the pipeline's own time stamps of the same frames.

    - ``passes``: number of measured passes of the pendulum through its lowest point, 2 to 10,000.
    - ``line``: line of a field at which the photodiode is.

    The rig has its own scene, motion and length. Raises :class:`SettingError` for a wrong setting, and for a pipeline whose light does
    not identify a frame.
    """
    given: dict[str, object] = {**keys, **(settings or {})}
    for key in given:
        if key in KEYS_SET_BY_RIG or key.startswith(("motion", "head")):
            raise SettingError(f"{key}: expected no such setting, because the rig has its own scene, motion and length")
    if whole("passes", passes, 2) > MAX_PASSES:
        raise SettingError(f"passes: expected 2 to {MAX_PASSES}, found {passes}")
    made = Made()
    made.put_all(pipeline, "full-screen:2", machine, Head("pendulum", tracker=tracker), {"seed": seed, **given})
    found: RigData = _native.rig(made.settings, passes, optional("line", line))
    return found


#: Settings that the rig sets itself.
KEYS_SET_BY_RIG = ("scene", "triangles", "fields", "pixels")

#: Greatest number of passes of the pendulum in a measurement.
MAX_PASSES = 10_000

LEVEL_DEFINITIONS = {
    "times_of_code": "true if the times of primitives come from executed code instead of published or fitted values",
    "published_error_percent": "mean absolute error over the published figures to which nothing was fitted, percent",
    "from_cycle_percent.median": "median of the absolute deviations from the cycle level over random experiments, percent",
    "from_cycle_percent.low_5": "5th percentile of these deviations",
    "from_cycle_percent.high_95": "95th percentile of these deviations",
    "speeds": "simulated seconds a second of the host, by choice of pixels, as JSON",
}


@named
def levels(*, experiments: int | None = None, speeds: bool = False, progress: Progress = None) -> Table[LevelRow]:
    """Returns a row for each level of modelling, with its errors and its speed.

    - ``experiments``: number of random experiments over which the errors are measured now. By default, the function returns the
      measurement that is recorded in the repository.
    - ``speeds``: True to measure the speeds too. This measurement needs an idle computer.

    Raises :class:`RunError` if an experiment fails.
    """
    with reporting(progress, "steps") as reporter:
        found = _native.levels(optional("experiments", experiments, 1), speeds, reporter)
    return table_of(found["levels"], LEVEL_DEFINITIONS)


READING_DEFINITIONS = {
    "evaluated_at": "level of modelling of the row",
    "words": "the answers to the papers' open questions",
    "mean_error_percent": "mean of the figures' absolute errors, percent",
    "greatest_error_percent": "largest absolute error of a figure, percent",
    "log_likelihood": "logarithm of the likelihood of the printed means and deviations, up to a constant",
    "unexplained": "numbers of the figures that the interpretation does not explain, as JSON",
}


@named
def interpretations(*, best: int = 20, seeds: int = 6, frames: int = 150, progress: Progress = None) -> Table[InterpretationRow]:
    """Ranks interpretations of the papers' open questions by their agreement with the figures of Rendering Control.

    The table has a row for each interpretation at the analytic level. Rows for the ``best`` interpretations at the transaction level
    follow. ``seeds`` and ``frames`` give the number and the length of the simulated motions. The function takes minutes.

    Raises :class:`RunError` if a figure cannot be simulated.
    """
    with reporting(progress, "runs") as reporter:
        found = _native.interpretations(whole("best", best), whole("seeds", seeds, 1), whole("frames", frames, 10), reporter)
    rows = [
        {"evaluated_at": level, **{key: value for key, value in fit.items() if key in READING_DEFINITIONS}}
        for level, fits in (("analytic", found["analytic"]), ("transaction", found["transaction"]))
        for fit in fits
    ]
    return table_of(rows, READING_DEFINITIONS)
