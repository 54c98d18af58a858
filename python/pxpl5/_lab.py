"""Questions over many experiments: figures, limits, comparison; and what there is to choose from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any

from . import _native
from ._experiment import Made
from ._head import Head
from ._machine import Machine, Parameter
from ._native import Table
from ._progress import Progress, reporting
from ._tables import table_of


def presets() -> dict[str, str]:
    """Names of the machines that are built in, those of the papers first, each with what it is and its source."""
    return dict(_native.presets())


def builtin_scenes() -> dict[str, str]:
    """Names of the built-in scenes, each with what it is; ``N`` stands for a number of triangles."""
    return dict(_native.builtin_scenes())


def pipelines() -> Table:
    """A row for each pipeline: name, family, about, preset, whether it has a closed form, and its keys as JSON."""
    return table_of(_native.pipelines(), {"about": "what it is and where it was published"})


def displays() -> list[str]:
    """Names of the displays that pipelines draw for, for the key ``display``."""
    return _native.displays()


def quantities() -> dict[str, str]:
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
    ids: Sequence[str] | None = None, *, level: str = "transaction", progress: Progress = None
) -> Table:
    """The papers' figures, measured: a row for each with published and simulated value, unit, error and source.

    Without ``ids`` it takes minutes, since intervals are found too (columns low and high); with them each figure is measured alone.

    Raises :class:`SettingError` for a number that there is not.
    """
    with reporting(progress, "figures") as told:
        if ids is None:
            rows = _native.figures(level, told)
        else:
            rows = []
            for done, number in enumerate(ids, 1):
                rows.append(_native.figure(number, level))
                if told is not None:
                    told(done, len(ids))
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


def limit(
    pipeline: str,
    scene: str | PathLike[str] | None = None,
    *,
    machine: str | Machine | None = None,
    rate_hz: float | None = None,
    latency_fields: float | None = None,
    fields: int | None = None,
    level: str | None = None,
    settings: Mapping[str, object] | None = None,
    **keys: object,
) -> Limit:
    """The most triangles that a pipeline draws in time, found by simulation.

    - ``scene``: ``full-screen`` or ``typical`` triangles, or a built-in scene or model file that is thinned out evenly; default: the
      pipeline's own test.
    - ``rate_hz`` (least updates a second) or ``latency_fields`` (greatest mean latency) replace the pipeline's own goal.

    Raises :class:`SettingError` for a setting that is wrong.
    """
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
        fields=fields,
    )
    return Limit(**found)


class Comparison:
    """Every way to fight latency side by side: :attr:`table` has a row for each, :attr:`data` everything."""

    def __init__(self, data: dict[str, Any]) -> None:
        #: The object of ``pxpl5 compare --json``.
        self.data = data

    @property
    def table(self) -> Table:
        """A row for each pipeline: latency, head to light, rate, errors in pixels and most triangles; nested names with points.

        Means over seeds have ``.mean``, and ``.low``, ``.high`` and ``.method`` of their 95 % intervals. ``due`` and ``not_shown``
        count the pictures, ``error.n`` the evaluated pixels.
        """
        left_out = ("end_to_end", "causes", "predictors", "picture", "errors", "display_counters")
        rows = [{key: value for key, value in row.items() if key not in left_out} for row in self.data["pipelines"]]
        for row in rows:
            if isinstance(row.get("error"), dict):
                row["error"] = {key: value for key, value in row["error"].items() if key != "distribution_px"}
        return table_of(rows)

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
                row.get("triangles_possible"),
            ]
            for row in self.data["pipelines"]
        ]
        return table(head, rows, f"{self.data['scene']} on {self.data['machine']}, {len(self.data['seeds'])} seeds")


def compare(
    scene: str | PathLike[str] = "room",
    *,
    machine: str | Machine = "small-hmd",
    head: str | Head = "synthetic",
    fields: int | None = None,
    only: Sequence[str] = (),
    seeds: int | Sequence[int] = 5,
    limits: bool = False,
    settings: Mapping[str, object] | None = None,
    progress: Progress = None,
    **keys: object,
) -> Comparison:
    """Every pipeline with the same settings, a run for each seed: errors in pixels by cause, latencies, and, on demand, limits.

    ``fields`` is the length of each run: None for the length of a recording, else 300. ``only`` names the rows that are run; all where it is empty. A head of ``synthetic`` moves otherwise in every seed. A motion must have a name here, or be the path of a recording.

    Raises :class:`SettingError` for a setting that is wrong, or a run too short to judge anything.
    """
    made = Made()
    made.put_all(None, scene, machine, head, {**({} if fields is None else {"fields": fields}), **keys, **(settings or {})})
    if made.motion is not None:
        from ._errors import SettingError

        raise SettingError("head: expected a motion with a name, or the path of a recording, found a Motion")
    if not made.settings.has("head.tracker"):
        made.put("head.tracker", "optical")
    numbers = list(range(1, seeds + 1)) if isinstance(seeds, int) else list(seeds)
    with reporting(progress, "runs") as told:
        return Comparison(_native.compare(made.settings, list(only), numbers, limits, told))
