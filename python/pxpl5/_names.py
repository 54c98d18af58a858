"""Names that the library takes, as types for type checkers. Generated from the library.

``PXPL5_UPDATE_NAMES=1 pytest python/tests/test_names.py`` writes this file anew.
"""

from typing import Literal

#: Quantities of an outcome.
QuantityName = Literal[
    "latency_fields.mean",
    "latency_fields.sd",
    "latency_fields.min",
    "latency_fields.max",
    "latency_ms.mean",
    "latency_ms.sd",
    "latency_ms.min",
    "latency_ms.max",
    "latency_ms.p50",
    "latency_ms.p95",
    "latency_ms.p99",
    "eye_latency_ms.mean",
    "eye_latency_ms.sd",
    "eye_retraces.mean",
    "eye_retraces.sd",
    "updates_hz",
    "missed_retraces",
    "missed_share",
    "pictures_due",
    "pictures_shown",
    "pictures_late",
    "pictures_incomplete",
    "pictures_missed",
    "region_copy_us",
    "first_copy_ms",
    "last_copy_ms",
    "copies_ms",
    "copy_begins_ms",
    "eye_ms",
    "head_to_light_ms.mean",
    "head_to_light_ms.p50",
    "head_to_light_ms.p95",
    "head_to_light_ms.p99",
    "prediction_interval_error_ms.mean",
    "prediction_interval_error_ms.max",
    "tracking_and_rendering_ms",
    "error_px.n",
    "error_px.mean",
    "error_px.p50",
    "error_px.p90",
    "error_px.p95",
    "error_px.p99",
    "error_px.max",
    "error_deg.mean",
    "rotation_ms",
    "late_regions",
    "lines_never_shown",
    "triangles_possible",
    "pictures",
    "events",
    "transform_ms",
    "render_ms",
    "gp_busy",
    "gp_busy.max",
    "renderer_busy.mean",
    "renderer_busy.max",
    "ring_busy",
    "port_busy",
    "critical_path.retrace",
    "critical_path.ports",
    "critical_path.ring",
    "critical_path.renderers",
    "critical_path.backing_store",
    "critical_path.transform",
    "critical_path.messages",
    "critical_path.host",
    "critical_path.other",
]

#: Pipelines.
PipelineName = Literal[
    "rendering-control",
    "slats",
    "frameless",
    "jitp-field",
    "jitp-field-racing",
    "jitp-scanline",
    "jitp-scanline-racing",
    "jitp-dual-screen",
    "jitp-dual-screen-racing",
    "jitp-dual-view",
    "jitp-dual-view-racing",
    "arp-full",
    "arp-full-line",
    "arp-full-pixel",
    "arp-priority",
    "arp-priority-line",
    "arp-priority-pixel",
    "arp-cells",
    "arp-cells-line",
    "arp-cells-pixel",
    "arp-cells-warp",
    "arp-cells-warp-line",
    "arp-cells-warp-pixel",
    "arp-ideal",
    "arp-ideal-line",
    "arp-ideal-pixel",
]

#: Machines that are built in.
MachineName = Literal[
    "small-hmd",
    "slats",
    "slats-1995",
    "slats-optimised",
    "medium",
    "design-maximum",
    "large",
]

#: Levels of modelling.
LevelName = Literal[
    "transaction",
    "cycle",
    "analytic",
]

#: Choices of computed pixels.
PixelsName = Literal[
    "off",
    "lazy",
    "all",
]
