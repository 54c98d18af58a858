"""Types of the report of a run: the object of ``pxpl5 run --json``. A number that was not measured is None."""

from __future__ import annotations

from typing import TypedDict

from ._types import CriticalPathData, UtilisationData


class StatisticsData(TypedDict):
    """Statistics of a list of numbers. They are None where there are too few numbers."""

    n: int
    mean: float | None
    sd: float | None
    min: float | None
    max: float | None


class DefinedStatisticsData(StatisticsData):
    """Statistics with a definition of the numbers."""

    definition: str


class LatencyPartData(DefinedStatisticsData):
    """A part of the latency."""

    name: str
    #: True if the published latency includes the part.
    in_published_latency: bool


class SurfaceLatencyData(DefinedStatisticsData):
    """The latency of one surface, such as that of an eye."""

    #: Name of the surface.
    of: str
    #: Event at which the latency ends.
    until: str


class NamedStatisticsData(StatisticsData):
    """Statistics of a part with a name."""

    name: str


class WindowData(TypedDict):
    """Display periods over which a run is evaluated."""

    first_period: int
    last_period: int


class DueData(WindowData):
    """Pictures that were due in the window."""

    periods_a_picture: int
    due: int
    shown: int
    late: int
    incomplete: int
    missed: int
    pictures: int


class TooHeavyData(TypedDict):
    """Advice for a scene that the machine draws too slowly."""

    pictures_due: int
    missed_retraces: int
    primitives: int
    primitives_in_time: int | None
    advice: str


class LateRegionData(TypedDict):
    """A region that arrived after its first line was lit."""

    field: int
    surface: int
    region: int
    #: Picoseconds.
    lateness: int


class CounterData(TypedDict):
    """A counter of a display."""

    name: str
    count: int


class HmdData(TypedDict):
    """Numbers of the head-mounted display that the viewer wears."""

    eye_separation_m: float
    horizontal_fov_deg: float
    width_px: int
    height_px: int
    near_m: float
    far_m: float
    convergence_m: float | None
    lens_distortion: float


class PercentilesData(TypedDict):
    """Mean and percentiles of a list of numbers."""

    n: int
    mean: float | None
    p50: float | None
    p90: float | None
    p95: float | None
    p99: float | None
    max: float | None


class LatencyPercentilesData(TypedDict):
    """Percentiles of the times of pictures, in milliseconds."""

    latency: PercentilesData
    #: From the head's pose to the light of the picture's middle.
    head_to_light: PercentilesData
    #: Error of the prediction interval.
    prediction_interval_error: PercentilesData


class PixelErrorsData(TypedDict):
    """Distances on the screen between pixels and the right places of their contents."""

    #: Errors in pixels.
    pixels: PercentilesData
    #: Errors in degrees.
    degrees: PercentilesData
    centre_px: PercentilesData
    centre_deg: PercentilesData
    #: Number of evaluated pixels.
    evaluated: int
    #: Numbers of evaluated pixels whose content has left the picture, lies behind the eye, or was found by no device.
    outside: int
    behind: int
    unfilled: int
    #: Numbers of pixels that were left out, by reason.
    empty: int
    incomplete: int
    before: int
    #: Share of the picture that the scene covers.
    covered_share: float | None


class BudgetData(TypedDict):
    """Mean time from the head's pose until its light, in parts."""

    tracking_ms: float | None
    waiting_ms: float | None
    sending_ms: float | None
    drawing_ms: float | None
    showing_ms: float | None
    scanning_ms: float | None
    lighting_ms: float | None
    head_to_light_ms: float | None
    n: int


class PredictorStartData(TypedDict):
    """Uncertainties with which a Kalman filter begins."""

    speed: float
    acceleration: float
    turn: float
    turn_acceleration: float


class PredictorGateData(TypedDict):
    """Limits beyond which a Kalman filter rejects a report."""

    speed: float
    turn: float
    distance: float
    angle: float
    patience: int
    gap: float
    interval: float


class PredictorDecayData(TypedDict):
    """Rates in 1/s at which a Kalman filter lets velocity and acceleration decay."""

    velocity: float
    acceleration: float


class PredictorData(TypedDict):
    """Parameters of a predictor."""

    kind: str
    position_baseline: int
    orientation_baseline: int
    position_noise_m: float
    orientation_noise_deg: float
    position_jerk: float
    orientation_jerk: float
    position_decay: PredictorDecayData
    orientation_decay: PredictorDecayData
    #: Intervals of position and orientation at which the filter is checked, ps.
    check_ps: list[int]
    horizon_ps: int
    start: PredictorStartData
    gate: PredictorGateData


class TrainingData(TypedDict):
    """Data on which a predictor was tuned."""

    interval_ps: int
    sibling: bool
    seconds: float
    reports: int
    seed: int
    mean_m: float
    mean_deg: float
    none_deg: float
    velocity_deg: float


class ReprojectionDeviceData(TypedDict):
    """A device that reprojects pictures."""

    by: str
    every: str | dict[str, int]
    latency_us: int


class HeadData(TypedDict):
    """Results of a tracked head."""

    tracker: str
    predictor: str
    #: Part of the picture for whose light the pose is predicted.
    aim: str
    prediction: PredictorData
    training: TrainingData | None
    fingerprint: str
    evaluated_at_m: float | None
    #: Raster of the display, or the device that reprojects pictures.
    display: str | dict[str, ReprojectionDeviceData]
    end_to_end: BudgetData
    error: PixelErrorsData


class ReprojectionData(TypedDict):
    """Results of a device that reprojects pictures."""

    device: ReprojectionDeviceData
    pixels_per_s: float
    poses_per_s: float
    pose_age_ms: PercentilesData
    checked_pixels: int
    empty_share: float | None
    disoccluded_share: float | None


class EyeData(TypedDict):
    """Results for an eye that follows the scene."""

    smear_px: PercentilesData | None
    reprojection: ReprojectionData | None


class MemoryData(TypedDict):
    """Results of a display memory of address recalculation."""

    updates_hz: float | None
    period_frames: float | None
    updates: int
    segments: int
    regions_copied: int
    missed: int
    translation_latency_ms: StatisticsData | None
    #: Pairs of name and milliseconds.
    translation_latency_parts_ms: list[list[str | float]]
    lateness_ms: float
    bytes: int


class FacesData(TypedDict):
    """Results of address recalculation."""

    schema: str
    face_texels: int
    latch: str
    pipeline_ns: float
    matrix_loads: int
    matrix_refused: int
    memories: list[MemoryData]
    rotation_latency_ms: StatisticsData | None
    rotation_latency_parts_ms: list[NamedStatisticsData]


class HeadReportData(TypedDict, total=False):
    """The parts of a report that only some experiments have."""

    #: Only with a tracked head.
    head: HeadData
    #: Only with a tracked head whose display reprojects pictures.
    eye: EyeData
    #: Only with address recalculation.
    arp: FacesData


class ReportData(HeadReportData):
    """All results of a run, as numbers with definitions."""

    schema: str
    version: str
    commit: str | None
    machine: str
    config_hash: str
    level: str
    seed: int
    pipeline: str
    variant: str
    display: str
    #: Parameters that differ from the papers, by path.
    overrides: dict[str, float]
    warnings: list[str]
    display_faults: list[str]
    n_gps: int
    n_renderers: int
    scene: str
    triangles: int
    spheres: int
    fields: int
    window: WindowData | None
    #: Complete pictures in the window.
    pictures: int
    latency_fields: DefinedStatisticsData
    latency_ms: DefinedStatisticsData
    percentiles_ms: LatencyPercentilesData
    latency_parts_ms: list[LatencyPartData]
    latency_by_eye_ms: list[SurfaceLatencyData]
    shown: int
    updates_hz: float | None
    due: DueData | None
    due_definition: str
    missed_retraces: int | None
    too_heavy: TooHeavyData | None
    ends_complete: bool
    late_regions: int
    first_late_regions: list[LateRegionData]
    display_counters: list[CounterData]
    hmd: HmdData
    utilisation: UtilisationData | None
    critical_path: CriticalPathData | None
    trace_hash: str
    events: int
    vertex_transforms: int
    host_seconds: float | None
