"""Pixel-Planes 5 and its low-latency rendering pipelines, emulated cycle by cycle.

An :class:`Experiment` runs a pipeline with a scene on a machine, and gives an :class:`Outcome`: latencies, pictures, and everything that
was observed::

    import pxpl5

    outcome = pxpl5.Experiment("slats", "mig", triangles=100, fields=60).run()
    outcome.latency_fields.mean      # 1.0: one field, always
    outcome.picture("left").array    # (480, 640, 3) uint8

Times are simulated time unless a name says host. Lengths are metres, angles degrees; axes are right-handed, y up. Numbers of the machine
have a unit, a standing (published, derived, assumed), a range and a source: :attr:`Machine.parameters`.

Everything that this package raises by itself is a :class:`Pxpl5Error`, with the words of the library: what, where, expected, found.
"""

from ._errors import AssemblyError, Pxpl5Error, RunError, SettingError, SweepError, TooShortError
from ._experiment import Experiment, PolicyPipeline
from ._head import Head
from ._lab import (
    Comparison,
    Limit,
    builtin_scenes,
    compare,
    displays,
    figure_ids,
    figures,
    keys,
    limit,
    pipelines,
    presets,
    quantities,
    tracking_parameters,
)
from ._machine import Machine, Parameter
from ._native import Motion, Picture, Processor, Program, Scene, Table, Volume, assemble, disassemble
from ._outcome import Drawing, Outcome, Report, Statistics
from ._sweep import Range, SweepResults, SweepSpace, sweep
from ._volume import draw_volume, volume_figures, volume_keys

__all__ = [
    "AssemblyError",
    "Comparison",
    "Drawing",
    "Experiment",
    "Head",
    "Limit",
    "Machine",
    "Motion",
    "Outcome",
    "Parameter",
    "Picture",
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
    "SweepError",
    "SweepResults",
    "SweepSpace",
    "Table",
    "TooShortError",
    "Volume",
    "assemble",
    "builtin_scenes",
    "compare",
    "disassemble",
    "displays",
    "draw_volume",
    "figure_ids",
    "figures",
    "keys",
    "limit",
    "pipelines",
    "presets",
    "quantities",
    "sweep",
    "tracking_parameters",
    "volume_figures",
    "volume_keys",
]
