"""A cycle-accurate emulator of Pixel-Planes 5 and its low-latency rendering pipelines.

An :class:`Experiment` runs a pipeline with a scene on a machine and returns an :class:`Outcome` with latencies, pictures and all
observations of the run::

    import pxpl5

    outcome = pxpl5.Experiment("slats", "mig", triangles=100, fields=60).run()
    outcome.latency_fields.mean      # 1.0: one field, always
    outcome.picture("left").array    # (480, 640, 3) uint8

All times are simulated time, except values whose names contain "host". Lengths are in metres and angles in degrees. Axes are
right-handed, with y up. Each number of the machine has a unit, a provenance (``provenance``: published, derived or assumed), a range and
a source: see :attr:`Machine.parameters`.

All exceptions of this package are subclasses of :class:`Pxpl5Error`. The message states the setting, its place, the expected value
and the found value.
"""

from ._drawing import Drawing
from ._errors import (
    AssemblyError,
    DiscardedError,
    Pxpl5Error,
    RunError,
    SettingError,
    SweepError,
    TooShortError,
    UnknownNameError,
)
from ._experiment import Experiment, PolicyPipeline
from ._head import Head
from ._lab import (
    Comparison,
    Limit,
    OverLimit,
    builtin_scenes,
    compare,
    displays,
    figure_ids,
    figures,
    interpretations,
    keys,
    levels,
    limit,
    limit_over,
    pipelines,
    presets,
    quantities,
    rig,
    tracking_parameters,
)
from ._machine import Machine, Parameter
from ._native import Motion, Picture, Processor, Program, Scene, Table, Volume, assemble, disassemble, version
from ._outcome import Differences, Outcome, Report, Statistics
from ._space import Range, SweepSpace
from ._stepper import Stepper
from ._sweep import SweepResults, sweep
from ._types import PolicyFrame
from ._volume import draw_volume, volume_figures, volume_keys

#: Version of the package and of the emulator in it.
__version__ = version()

del version

__all__ = [
    "__version__",
    "AssemblyError",
    "Comparison",
    "Differences",
    "DiscardedError",
    "Drawing",
    "Experiment",
    "Head",
    "Limit",
    "Machine",
    "Motion",
    "Outcome",
    "OverLimit",
    "Parameter",
    "Picture",
    "PolicyFrame",
    "PolicyPipeline",
    "Processor",
    "Program",
    "Pxpl5Error",
    "Range",
    "Report",
    "RunError",
    "Scene",
    "SettingError",
    "Statistics",
    "Stepper",
    "SweepError",
    "SweepResults",
    "SweepSpace",
    "Table",
    "TooShortError",
    "UnknownNameError",
    "Volume",
    "assemble",
    "builtin_scenes",
    "compare",
    "disassemble",
    "displays",
    "draw_volume",
    "figure_ids",
    "figures",
    "interpretations",
    "keys",
    "levels",
    "limit",
    "limit_over",
    "pipelines",
    "presets",
    "quantities",
    "rig",
    "sweep",
    "tracking_parameters",
    "volume_figures",
    "volume_keys",
]
