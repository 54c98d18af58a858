"""Questions over many experiments: figures, limits, comparison; and what there is to choose from."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from . import _native
from ._checks import Strict, names, optional, whole
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
    from ._rows import Cell, FigureRow, LevelRow, PipelineRow, ReadingRow
    from ._study_types import ComparisonData, FigureData


def presets() -> dict[str, str]:
    """Names of the machines that are built in, those of the papers first, each with what it is and its source."""
    return dict(_native.presets())


def builtin_scenes() -> dict[str, str]:
    """Names of the built-in scenes, each with what it is; ``N`` stands for a number of triangles."""
    return dict(_native.builtin_scenes())


def pipelines() -> Table[PipelineRow]:
    """A row for each pipeline: name, family, about, preset, whether it has a closed form, and its keys as JSON."""
    return table_of(_native.pipelines(), {"about": "what it is and where it was published"})


def displays() -> list[str]:
    """Names of the displays that pipelines draw for, for the key ``display``."""
    return _native.displays()


def quantities() -> dict[QuantityName, str]:
    """Names of what can be measured, each with its definition."""
    return _native.quantities()


def keys() -> dict[str, str]:
    """All keys of experiments but the parameters, each with what it sets and takes."""
    return dict(_native.keys())


def tracking_parameters() -> list[Parameter]:
    """Numbers of all trackers, of the host's port and of the predictors, for :attr:`Head.tracking`."""
    return [Parameter(**entry) for entry in _native.tracking_parameters()]


FIGURE_DEFINITIONS = {
    "published": "as the paper prints it, in the unit beside it",
    "simulated": "what the model gives, in the same unit",
    "error_percent": "(simulated - published) / published, percent",
    "low": "least value when open parameters are varied within their ranges",
    "high": "greatest value when open parameters are varied within their ranges",
    "standing": "free check, fitted, or rule",
    "misses": "outside of the printed range, or off by more than 3 percent",
}


def figure_ids() -> dict[str, str]:
    """Numbers of the published figures, such as 4b, each with what the paper states."""
    return dict(_native.figure_ids())


def figures(
    ids: str | Sequence[str] | None = None, *, level: LevelName | str = "transaction", progress: Progress = None
) -> Table[FigureRow]:
    """The papers' figures, measured: a row for each with published and simulated value, unit, error and source.

    Without ``ids`` it takes minutes, since intervals are found too (columns low and high); with them each figure is measured alone.

    Raises :class:`SettingError` for a number that there is not.
    """
    rows: list[FigureData]
    with reporting(progress, "figures") as told:
        if ids is None:
            rows = _native.figures(level, told)
        else:
            rows = []
            wanted = names("ids", ids)
            for done, number in enumerate(wanted, 1):
                rows.append(_native.figure(number, level))
                if told is not None:
                    told(done, len(wanted))
    return table_of(rows, FIGURE_DEFINITIONS)


@dataclass(frozen=True)
class Limit:
    """The most triangles that a pipeline draws in time, and how sure that is."""

    #: One less than the first miss; 0 if the goal was missed with one triangle.
    triangles: int
    #: The least size that was tried and missed the goal; None if all that were tried reached it.
    first_miss: int | None
    #: The greatest size above the first miss that was tried and reaches the goal all the same; None if there is none.
    island: int | None
    #: All sizes from here to ``triangles`` were tried; below it only some were.
    unbroken_from: int
    #: Sizes that were simulated.
    tried: int
    #: What had to hold.
    goal: str | dict[str, float]
    #: Fields that each size was simulated for.
    fields: int
    #: What was drawn at every size.
    scene: str


@dataclass(frozen=True)
class OverLimit:
    """Values of a setting with which an experiment reaches a goal."""

    #: Path of the setting.
    over: str
    #: What had to hold.
    goal: str | dict[str, float]
    #: Fields that each value was simulated for.
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
    #: A value that misses the goal: next to the limit, or the best if all miss; None if all reach it.
    missed_at: float | None
    #: What limits the experiment with ``missed_at``, in words; None if that is unknown.
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
    """The values of a numeric setting with which an experiment reaches a goal, as ``pxpl5 limit --over``.

    - ``over``: path of the setting, such as ``machine.n_gps``; ``low`` and ``high``: the range that is searched; default: for numbers
      of boards 1 to the number in the largest preset, else the range that the sources allow.
    - ``rate_hz`` (least updates a second) or ``latency_fields`` (greatest mean latency) replace the pipeline's own goal.

    The search tries the ends of the range and three values between, and bisects from one that reaches the goal. Raises
    :class:`SettingError` for a setting or a range that is wrong.
    """
    made = Made()
    made.put_all(pipeline, scene, machine, head, {"level": level, **keys, **(settings or {})})
    if made.motion is not None:
        raise SettingError("head: expected a motion with a name, or the path of a recording, found a Motion")
    _positive("rate_hz", rate_hz)
    _positive("latency_fields", latency_fields)
    # An unknown key is refused with the nearest one, before its range is asked for.
    made.settings.copy().set(f"{over}=1", "over")
    with reporting(progress, "values") as told:
        found = _native.limit_over(
            made.settings,
            over,
            low=low,
            high=high,
            rate_hz=rate_hz,
            latency_fields=latency_fields,
            fields=optional("fields", fields, LEAST_FIELDS),
            progress=told,
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


#: Least fields of a search: shorter runs end during the warm-up of every pipeline.
LEAST_FIELDS = 10


def _positive(name: str, value: float | None) -> None:
    if value is not None and not value > 0:
        raise SettingError(f"{name}: expected a number above 0, found {value!r}")


def limit(
    pipeline: PipelineName | str,
    scene: str | PathLike[str] | None = None,
    *,
    machine: MachineName | str | Machine | None = None,
    rate_hz: float | None = None,
    latency_fields: float | None = None,
    fields: int | None = None,
    level: LevelName | str | None = None,
    settings: Mapping[str, object] | None = None,
    **keys: object,
) -> Limit:
    """The most triangles that a pipeline draws in time, found by simulation.

    - ``scene``: ``full-screen`` or ``typical`` triangles, or a built-in scene or model file that is thinned out evenly; default: the
      pipeline's own test.
    - ``rate_hz`` (least updates a second) or ``latency_fields`` (greatest mean latency) replace the pipeline's own goal.

    Raises :class:`SettingError` for a setting that is wrong.
    """
    _positive("rate_hz", rate_hz)
    _positive("latency_fields", latency_fields)
    made = Made()
    test_scene = scene if scene in ("full-screen", "typical") else None
    model = None if test_scene is not None else scene
    made.put_all(pipeline, model or "full-screen:1", machine, None, {"level": level, **keys, **(settings or {})})
    found = _native.limit(
        made.settings,
        test_scene=None if test_scene is None else str(test_scene),
        thinned=model is not None,
        rate_hz=rate_hz,
        latency_fields=latency_fields,
        fields=optional("fields", fields, LEAST_FIELDS),
    )
    return Limit(**found)


class Comparison(Strict):
    """Every way to fight latency side by side: :attr:`table` has a row for each, :attr:`data` everything."""

    _fields = ("data",)

    def __init__(self, data: ComparisonData) -> None:
        #: The object of ``pxpl5 compare --json``.
        self.data = data

    @property
    def table(self) -> Table[dict[str, Cell]]:
        """A row for each pipeline: latency, head to light, rate, errors in pixels and most triangles; nested names with points.

        Means over seeds have ``.mean``, and ``.low``, ``.high`` and ``.method`` of their 95 % intervals. ``due`` and ``not_shown``
        count the pictures, ``error.n`` the evaluated pixels.
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
        """Draws column ``y`` over column ``x`` as ``pxpl5 plot`` does; see :meth:`SweepResults.plot`."""
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
                row["due"],
                row["not_shown"],
                row["error"]["mean_px"]["mean"],
                row["error"]["n"],
                row["triangles_possible"],
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
    seeds: int | Sequence[int] = 5,
    limits: bool = False,
    confidence: float = 0.95,
    until_precision: str | None = None,
    max_seeds: int | None = None,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    settings: Mapping[str, object] | None = None,
    progress: Progress = None,
    **keys: object,
) -> Comparison:
    """Every pipeline with the same settings, a run for each seed: errors in pixels by cause, latencies, and, on demand, limits.

    - ``fields``: length of each run; default: the length of a recording, else 300.
    - ``only``: names of the rows that are run; all where it is empty.
    - ``head``: a motion with a name, or the path of a recording. A head of ``synthetic`` moves otherwise in every seed.
    - ``confidence``: that of all intervals, between 0 and 1.
    - ``until_precision``: greatest width of the interval of each mean error, from end to end, as a share of the mean (``"10%"``) or in
      pixels (``"0.2px"``). A row gets more seeds until its interval is narrower, up to ``max_seeds`` (default 50). Only for the head
      ``synthetic``.
    - ``out``: a folder. Each row is stored in it as soon as its runs have ended, and comparison.json at the end, as
      ``pxpl5 compare --out`` does, but without pictures. After an interruption, ``resume=True`` keeps the finished rows of the same
      comparison and runs only the others.

    Ctrl-C ends the runs in progress, but not a search for limits. Raises :class:`SettingError` for a setting that is wrong, or a run
    too short to judge anything, and :class:`SweepError` for a folder that cannot be used, is in use, or holds another comparison.
    """
    if not 0 < confidence < 1:
        raise SettingError(f"confidence: expected a number between 0 and 1, found {confidence!r}")
    if max_seeds is not None and until_precision is None:
        raise SettingError("max_seeds: expected until_precision beside it, found none")
    if resume and out is None:
        raise SettingError("resume: expected the folder out beside it, found none")
    made = Made()
    made.put_all(None, scene, machine, head, {**({} if fields is None else {"fields": fields}), **keys, **(settings or {})})
    if made.motion is not None:
        raise SettingError("head: expected a motion with a name, or the path of a recording, found a Motion")
    if not made.settings.has("head.tracker"):
        made.put("head.tracker", "optical")
    if isinstance(seeds, int):
        numbers = list(range(1, whole("seeds", seeds, 1) + 1))
    else:
        numbers = [whole("seeds", seed) for seed in seeds]
    folder = None if out is None else Path(out)
    with reporting(progress, "runs") as told:
        data = _native.compare(
            made.settings,
            names("only", only),
            numbers,
            limits=limits,
            confidence=confidence,
            until_precision=until_precision,
            max_seeds=optional("max_seeds", max_seeds, 2),
            folder=None if folder is None else folder / "rows",
            resume=resume,
            progress=told,
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
    """Latency measured from outside with a pendulum and photodiodes, beside the pipeline's own time stamps, as ``pxpl5 rig``.

    - ``passes``: low points of the pendulum that are measured, 2 to 10,000; ``line``: the line of a field with the photodiode.

    The rig has its own scene, motion and length. Raises :class:`SettingError` for a wrong setting, and for a pipeline whose light does
    not identify a frame.
    """
    given: dict[str, object] = {**keys, **(settings or {})}
    for key in given:
        if key in KEYS_SET_BY_RIG or key.startswith(("motion", "head")):
            raise SettingError(f"{key}: expected no such setting, because the rig has its own scene, motion and length")
    if whole("passes", passes, 2) > MOST_PASSES:
        raise SettingError(f"passes: expected 2 to {MOST_PASSES}, found {passes}")
    made = Made()
    made.put_all(pipeline, "full-screen:2", machine, Head("pendulum", tracker=tracker), {"seed": seed, **given})
    found: RigData = _native.rig(made.settings, passes, optional("line", line))
    return found


#: Settings that the rig determines itself.
KEYS_SET_BY_RIG = ("scene", "triangles", "fields", "pixels")

#: Most passes of the pendulum in a measurement.
MOST_PASSES = 10_000

LEVEL_DEFINITIONS = {
    "times_of_code": "true if the times of primitives come from executed code instead of published or fitted values",
    "published_error_percent": "mean absolute error over the published figures to which nothing was fitted, percent",
    "from_cycle_percent.median": "median of the absolute deviations from the cycle level over random experiments, percent",
    "from_cycle_percent.low_5": "5th percentile of these deviations",
    "from_cycle_percent.high_95": "95th percentile of these deviations",
    "speeds": "simulated seconds a second of the host, by choice of pixels, as JSON",
}


def levels(*, experiments: int | None = None, speeds: bool = False, progress: Progress = None) -> Table[LevelRow]:
    """The levels of modelling beside each other: a row for each, with its errors and its speed.

    By default the measurement that is recorded in the repository. With ``experiments`` the errors are measured now, over so many random
    experiments; with ``speeds`` the speeds too, which needs an idle computer. Raises :class:`RunError` if an experiment fails.
    """
    with reporting(progress, "steps") as told:
        found = _native.levels(optional("experiments", experiments, 1), speeds, told)
    return table_of(found["levels"], LEVEL_DEFINITIONS)


READING_DEFINITIONS = {
    "evaluated_at": "level of modelling of the row",
    "words": "the answers to the papers' open questions",
    "mean_error_percent": "mean of the figures' absolute errors, percent",
    "greatest_error_percent": "largest absolute error of a figure, percent",
    "log_likelihood": "logarithm of the likelihood of the printed means and deviations, up to a constant",
    "unexplained": "numbers of the figures that the interpretation does not explain, as JSON",
}


def readings(*, best: int = 20, seeds: int = 6, frames: int = 150, progress: Progress = None) -> Table[ReadingRow]:
    """Interpretations of the papers' open questions, ranked by how well they explain the figures of Rendering Control.

    A row for each interpretation at the analytic level, then the ``best`` of them at the transaction level. ``seeds`` and ``frames``
    are the size of the fly-throughs. It takes minutes. Raises :class:`RunError` if a figure cannot be simulated.
    """
    with reporting(progress, "runs") as told:
        found = _native.readings(whole("best", best), whole("seeds", seeds, 1), whole("frames", frames, 10), told)
    rows = [
        {"evaluated_at": level, **{key: value for key, value in fit.items() if key in READING_DEFINITIONS}}
        for level, fits in (("analytic", found["analytic"]), ("transaction", found["transaction"]))
        for fit in fits
    ]
    return table_of(rows, READING_DEFINITIONS)
