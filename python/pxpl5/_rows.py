"""Types of the rows and columns of tables. A missing value is None."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from typing_extensions import TypeVar

    #: A value of a table.
    Cell = int | float | str | bool | None

    #: A column of numbers.
    Numbers = NDArray[np.int64] | NDArray[np.float64]

    #: A column of a table: numbers, texts or truth values.
    Column = Numbers | list[str | None] | list[bool | None]

    #: Type of the rows of a table.
    Row = TypeVar("Row", bound=Mapping[str, object], covariant=True, default=dict[str, Cell])


class PictureRow(TypedDict):
    """A picture that was begun. Times are picoseconds."""

    picture: int
    #: 1 if the picture is in the window of the report's statistics.
    steady: int
    #: 1 if the picture was complete in time.
    complete: int
    sampled_at_ps: int | None
    transform_at_ps: int | None
    copied_at_ps: int | None
    shown_at_ps: int | None
    latency_ps: int | None
    send_ps: int | None
    wait_for_edit_ps: int | None
    edit_ps: int | None
    transform_ps: int | None
    wait_for_last_transform_ps: int | None
    last_transform_ps: int | None
    wait_for_render_ps: int | None
    render_ps: int | None
    wait_for_copy_ps: int | None
    copy_ps: int | None
    wait_for_retrace_ps: int | None
    scan_ps: int | None
    measured_at_ps: int | None
    aimed_at_ps: int | None
    light_at_ps: int | None
    head_to_light_ps: int | None


class StageRow(TypedDict):
    """A stage of a picture. Times are picoseconds."""

    picture: int
    #: Name of the stage in lower case, such as transform.
    stage: str
    #: Label of the eye; None for a stage of all surfaces.
    surface: str | None
    begin_ps: int
    #: End of the stage; None if the run ended before.
    end_ps: int | None


class EventRow(TypedDict):
    """An observed event."""

    time_ps: int
    board: str
    picture: int | None
    #: The event in words.
    event: str


#: Columns of numbers in the tables of an outcome.
NumberColumn = Literal[
    "picture",
    "steady",
    "complete",
    "sampled_at_ps",
    "transform_at_ps",
    "copied_at_ps",
    "shown_at_ps",
    "latency_ps",
    "send_ps",
    "wait_for_edit_ps",
    "edit_ps",
    "transform_ps",
    "wait_for_last_transform_ps",
    "last_transform_ps",
    "wait_for_render_ps",
    "render_ps",
    "wait_for_copy_ps",
    "copy_ps",
    "wait_for_retrace_ps",
    "scan_ps",
    "measured_at_ps",
    "aimed_at_ps",
    "light_at_ps",
    "head_to_light_ps",
    "begin_ps",
    "end_ps",
    "time_ps",
]

#: Columns of texts in the tables of an outcome.
TextColumn = Literal["stage", "surface", "board", "event"]


class BoardRow(TypedDict):
    """Shares of time, 0 to 1, of the boards of one kind with one activity."""

    board: str
    activity: str
    mean: float
    max: float | None
    busiest: int | None
    idle: int | None


class ChannelRow(TypedDict):
    """A message that occupies a channel of the ring."""

    channel: int
    source: int
    destination: int
    words: int
    granted_ps: int
    ends_at_ps: int | None


class ParameterRow(TypedDict):
    """A number of a machine or a tracker, as :class:`Parameter`."""

    path: str
    value: float
    unit: str
    provenance: str
    low: float
    high: float
    source: str
    read_only: bool


class PipelineRow(TypedDict):
    """A pipeline."""

    name: str
    family: str
    about: str
    preset: str
    #: The pipeline's own settings as JSON.
    keys: str
    has_closed_form: bool


class PublishedFigure(TypedDict):
    """The values of a published figure that rows of tables and dictionaries share."""

    id: str
    statement: str
    source: str
    experiment: str
    scene: str | None
    published: float | None
    origin: str
    spread: float | None
    simulated: float | None
    unit: str
    error_percent: float | None
    is_met: bool
    provenance: str
    analytic: float | None
    cause: str


class VolumeFigureRow(PublishedFigure):
    """A published figure beside the value of the model."""

    #: Ends of the interval of values that agree with the paper, as JSON.
    accepted: str | None
    unprinted: str | None
    #: Ends of the interval over the open parameters, as JSON.
    interval: str | None
    #: Further numbers as JSON.
    details: str


class FigureRow(VolumeFigureRow):
    """A figure of the machine, with its interval over the open parameters."""

    #: The parameter, rule or row that decides the figure.
    chosen: str | None
    misses: bool
    low: float | None
    high: float | None


class InterpretationRow(TypedDict):
    """An interpretation of the papers' open questions."""

    evaluated_at: str
    words: str
    mean_error_percent: float | None
    greatest_error_percent: float | None
    log_likelihood: float | None
    #: Identifiers of the figures as JSON.
    unexplained: str


class SettingRow(TypedDict):
    """A setting that differs between two outcomes, with its values as text."""

    key: str
    a: str | None
    b: str | None


class ResultRow(SettingRow):
    """A result that differs between two outcomes."""

    #: Difference in percent of a.
    percent: float | None


class PictureDifferenceRow(TypedDict):
    """Differences between the last pictures of a surface."""

    surface: str
    pixels: int
    differing: int | None
    #: Largest difference of a colour, 0 to 255.
    largest: int | None


#: Effect of more of one resource.
WhatIfRow = TypedDict(
    "WhatIfRow",
    {
        "resource": str,
        "key": str,
        "from": int,
        "to": int,
        "latency_ms.before": float | None,
        "latency_ms.after": float | None,
        "updates_hz.before": float | None,
        "updates_hz.after": float | None,
        "level": str,
    },
)

#: A level of modelling.
LevelRow = TypedDict(
    "LevelRow",
    {
        "level": str,
        "times_of_code": bool,
        "published_error_percent": float | None,
        "from_cycle_percent": float | None,
        "from_cycle_percent.median": float | None,
        "from_cycle_percent.low_5": float | None,
        "from_cycle_percent.high_95": float | None,
        "speeds": str,
    },
)
