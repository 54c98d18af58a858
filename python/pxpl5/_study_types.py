"""Types of results over many experiments: comparisons, figures, limits, levels, interpretations, sweeps and volumes."""

from __future__ import annotations

from typing import TypedDict

from ._report_types import BudgetData, HmdData, PercentilesData, StatisticsData, WindowData
from ._rows import ParameterRow, PublishedFigure


class ParameterData(ParameterRow):
    """A number of a machine or a tracker, as :class:`Parameter`."""


class MachineData(TypedDict):
    """Boards and parameters of a machine."""

    n_gps: int
    n_renderers: int
    parameters: list[ParameterData]
    warnings: list[str]


class PipelineKeyData(TypedDict):
    """A setting of a pipeline."""

    name: str
    about: str
    values: str


class PipelineData(TypedDict):
    """A pipeline with its settings."""

    name: str
    family: str
    about: str
    preset: str
    keys: list[PipelineKeyData]
    has_closed_form: bool


class DetailData(TypedDict):
    """A further number of a figure."""

    name: str
    value: float | None
    unit: str


class FittedData(TypedDict, total=False):
    """The parameter, rule or row that decides a figure, if there is one."""

    chosen: str


class VolumeFigureData(PublishedFigure, FittedData):
    """A published figure beside the value of the model."""

    accepted: list[float] | None
    unprinted: list[float] | None
    interval: list[float] | None
    details: list[DetailData]


class FigureData(VolumeFigureData):
    """A figure of the machine, with its interval over the open parameters."""

    misses: bool
    low: float | None
    high: float | None


class LimitData(TypedDict):
    """The most triangles that a pipeline draws in time, as :class:`Limit`."""

    triangles: int | None
    first_miss: int | None
    island: int | None
    unbroken_from: int
    tried: int
    goal: str | dict[str, float]
    fields: int
    scene: str


class OverLimitData(TypedDict):
    """Values of a setting that reach a goal, as :class:`OverLimit`."""

    over: str
    goal: str | dict[str, float]
    fields: int
    low: float
    high: float
    least: float | None
    most: float | None
    reached: bool
    #: Pairs of a value, and true if the value reaches the goal.
    tried: list[list[float | bool]]
    missed_at: float | None
    because: str | None


class IntervalData(TypedDict):
    """A mean with its confidence interval."""

    mean: float | None
    low: float | None
    high: float | None
    n: int
    #: Method of the interval, such as student_t or student_t_of_parts.
    method: str


class ErrorSpreadData(TypedDict):
    """Pixel errors of a compared pipeline."""

    mean_px: IntervalData
    mean_deg: IntervalData
    pixels: PercentilesData
    n: int
    #: Share of the pixels whose content has left the picture.
    outside_share: float | None
    distribution_px: list[float]


class CauseData(TypedDict):
    """Share of a cause in the pixel error; the cause is None for the interaction of all causes."""

    cause: str | None
    px: IntervalData


class PredictorMeanData(TypedDict):
    """Mean pixel error with one predictor."""

    kind: str
    mean_px: float | None


class PredictionIntervalErrorMeanData(TypedDict):
    """Mean pixel error if all prediction intervals were longer (later_ms above 0) or shorter."""

    later_ms: int
    mean_px: float | None


class ComparedData(TypedDict):
    """A row of a comparison."""

    pipeline: str
    settings: str
    eyes: int
    seeds: int
    is_precise: bool | None
    latency_definition: str
    latency_ms: StatisticsData
    head_to_light_ms: StatisticsData
    head_to_light_percentiles_ms: PercentilesData
    turn_to_light_ms: StatisticsData
    tracking_and_rendering_ms: IntervalData
    end_to_end: BudgetData
    prediction_interval_ms: StatisticsData
    updates_hz: IntervalData
    pictures_due: int | None
    missed_retraces: int | None
    late_regions: int | None
    error: ErrorSpreadData
    #: Mean error of each seed.
    seed_px: list[float]
    #: Difference to the row with the least error.
    above_best_px: IntervalData | None
    covered_share: float | None
    window: WindowData | None
    causes: list[CauseData]
    prediction_interval_errors: list[PredictionIntervalErrorMeanData]
    predictors: list[PredictorMeanData]
    triangles_possible: int | None
    has_no_limit: bool
    triangles_definition: str
    failure: str | None
    host_seconds: float | None


class ComparisonData(TypedDict):
    """The object of ``pxpl5 compare --json``."""

    schema: str
    version: str
    commit: str | None
    config_hash: str
    #: Every key that was set, options, and hashes of files.
    settings: dict[str, str]
    warnings: list[str]
    machine: str
    #: Numbers of graphics processors and renderers.
    boards: list[int]
    scene: str
    triangles: int
    #: Pairs of a key of the head and its value.
    head: list[list[str]]
    hmd: HmdData
    fields: int
    seeds: list[int]
    confidence: float
    until_precision: str | None
    max_seeds: int | None
    #: First display period that is evaluated.
    evaluated_from: int
    pipelines: list[ComparedData]


class SpreadData(TypedDict):
    """Median and percentiles of deviations, percent."""

    median: float
    low_5: float
    high_95: float


class LevelSpeedData(TypedDict):
    """Speed of a level of modelling with one choice of pixels."""

    pixels: str
    simulated_seconds_per_second: float | None


class LevelData(TypedDict):
    """Errors and speeds of a level of modelling."""

    level: str
    times_of_code: bool
    published_error_percent: float | None
    from_cycle_percent: SpreadData | None
    speeds: list[LevelSpeedData]


class LevelRecordData(TypedDict):
    """A measurement of all levels of modelling."""

    schema: str
    experiments: int
    note: str | None
    date: str | None
    host: str | None
    levels: list[LevelData]


class FigureFitData(TypedDict):
    """A figure with one interpretation."""

    id: str
    published: float
    simulated: float | None
    unit: str
    error_percent: float | None
    published_sd: float | None
    simulated_sd: float | None


class InterpretationFitData(TypedDict):
    """The fit of one interpretation of the papers' open questions."""

    interpretation: dict[str, object]
    words: str
    figures: list[FigureFitData]
    mean_error_percent: float | None
    greatest_error_percent: float | None
    log_likelihood: float | None
    unexplained: list[str]


class LeaveOneOutData(TypedDict):
    """The interpretation under which all other figures are likeliest."""

    id: str
    chosen: dict[str, object]
    words: str
    error_percent: float | None


class InterpretationsData(TypedDict):
    """Interpretations of the papers' open questions, ranked."""

    schema: str
    analytic: list[InterpretationFitData]
    transaction: list[InterpretationFitData]
    left_out: list[LeaveOneOutData]


class SweepHeaderData(TypedDict):
    """Data that all rows of a sweep share."""

    schema: str
    version: str
    machine: str
    config_hash: str
    level: str
    seed: int
    title: str | None
    points: int
    #: Definitions of the quantities, by name.
    measure: dict[str, str]
    #: Settings that all points share, by path.
    settings: dict[str, object]
    #: Axes of the space: paths, and either steps or ranges.
    axes: list[dict[str, list[object]]]


class ProfileData(TypedDict):
    """Clocks of an i860 program by cause and by label."""

    clocks: int
    instructions: int
    issue: int
    bus_requests: int
    page_misses: int
    instruction_misses: int
    data_misses: int
    #: Clocks between each label and the next.
    by_label: dict[str, int]


class VolumeDisplayData(TypedDict):
    """Numbers of a volumetric display."""

    name: str
    slices: int
    width: int
    height: int
    spin_rpm: int
    volumes_hz: float


class BrightnessData(TypedDict):
    """Lit voxels by distance from the axis."""

    ring_px: int
    lit_voxels: list[int]


class ModelPartData(TypedDict):
    """A time of the modelled display, with a definition."""

    ms: float
    definition: str


class ModelTimesData(TypedDict):
    """Times of the modelled display for a volume."""

    cpu: ModelPartData
    gpu: ModelPartData
    bus: ModelPartData
    bus_unpacked: ModelPartData


class OverrideData(TypedDict):
    """A setting that differs from the paper."""

    path: str
    value: str | float
    papers: str | float


class VolumeData(TypedDict):
    """The report of a volume: counts, occupancy, times of the modelled display, and the hash of the volume."""

    schema: str
    scene: str
    display: VolumeDisplayData
    clip: str
    projection: str
    seed: int
    renderer: str
    #: Counts and bounds if renderers of Pixel-Planes 5 draw the volume.
    pixel_planes: dict[str, object] | None
    samples: int
    triangles: int
    slices_rendered: int
    passes: int
    draws: int
    draws_unbinned: int
    bin_memberships: int
    fragments_generated: int | None
    fragments_accepted: int | None
    fragments_added: int
    slices_empty: int
    tiles_occupied: int
    tile_occupancy_percent: float
    queries: int
    stencil_clears: int
    bytes_unpacked: int
    bytes_packed: int
    bytes_sent: int
    waste_percent: float
    lit_voxels: int
    connected_percent: float
    brightness_by_radius: BrightnessData
    dead_zone_radius_px: int | None
    innermost_lit_px: int | None
    model_ms: ModelTimesData | None
    volumes_hz_serial: float | None
    volumes_hz_overlapped: float | None
    outside_volume: int
    volume_hash: str
    overrides: list[OverrideData]
    beyond_paper: list[str]
    host_seconds: float


class VolumeDefinitionData(TypedDict):
    """A number that the SpatialGL paper defines."""

    id: str
    statement: str
    value: float
    unit: str
    provenance: str
    source: str


class ShownData(TypedDict):
    """A statement of the SpatialGL paper, and whether the model shows it."""

    statement: str
    evidence: str
    holds: bool


class MeasuredSceneData(TypedDict):
    """Counts and times of a scene."""

    scene: str
    triangles: int
    draws_percent: float
    tile_occupancy_percent: float
    bytes: list[int]
    model_ms: list[float]
    volumes_hz: list[float]
    volume_hash: str


class VolumeFiguresData(TypedDict):
    """Figures and statements of the SpatialGL paper beside those of the model."""

    schema: str
    figures: list[VolumeFigureData]
    definitions: list[VolumeDefinitionData]
    shown: list[ShownData]
    scenes: list[MeasuredSceneData]
