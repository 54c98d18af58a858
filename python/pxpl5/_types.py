"""Types of the dictionaries that the native module returns."""

from __future__ import annotations

from typing import TypedDict


class PolicyFrame(TypedDict):
    """A frame after TRANSFORM, the argument of a policy."""

    #: Number of the frame, from 0.
    frame: int
    #: Simulated time in seconds.
    time_s: float
    #: Number of regions in a row of the screen.
    columns: int
    #: Number of primitives in the bin of each region, row by row.
    primitives: list[int]
    #: Number of renderers in the machine.
    renderers: int


class EventState(TypedDict):
    """An event of the simulation."""

    #: Simulated time in picoseconds.
    time_ps: int
    #: Board that handles the event.
    board: str
    #: Description of the event.
    what: str


class ProgramState(TypedDict):
    """A program on a processor."""

    #: Priority of the program.
    priority: str
    #: What the program waits for; None if it works.
    waits_for: str | None
    #: Picoseconds until the end of the current work.
    work_left_ps: int | None


class InboxState(TypedDict):
    """A message that a processor has received and not read."""

    arrived_ps: int
    source: int


class ProcessorState(TypedDict):
    """State of a processor."""

    programs: list[ProgramState]
    inbox: list[InboxState]
    #: Receivers that have not accepted a message of the processor.
    unaccepted: list[int]
    #: Lengths of the message chains in progress.
    chains: list[int]
    #: Bytes of memory in use, by purpose.
    memory_bytes: dict[str, int]
    busy_ps: int


class RendererState(TypedDict):
    """State of a renderer."""

    #: Words in the input FIFO; None if the run does not record traffic.
    fifo_words: int | None
    fifo_depth_words: int
    #: True while a copy command waits.
    stands_at_copy: bool
    copying_region: int | None
    stored_regions: int
    busy_ps: int


#: State of a processor or renderer.
BoardState = ProcessorState | RendererState


class SharesData(TypedDict):
    """Shares of time, 0 to 1, of the boards of one kind."""

    #: Mean over all boards.
    mean: float
    #: Share of the busiest board.
    max: float
    #: Number of the busiest board, from 0.
    busiest: int
    #: Number of boards that were busy for less than 1 % of the time.
    idle: int


class GpData(TypedDict):
    """Shares of CPU time of the graphics processors."""

    busy: SharesData
    work: float
    messages: float
    tokens: float


class RendererData(TypedDict):
    """Shares of time of the renderers' controllers."""

    executing: SharesData
    copying: float
    waiting: float


class RingData(TypedDict):
    """Shares of time of the ring's channels, and words a second."""

    channels: SharesData
    words_per_second: float
    capacity: float


class PortData(TypedDict):
    """Share of time of one ring port of a display."""

    port: str
    busy: float


class PortsData(TypedDict):
    """Shares of time of the ring ports of displays."""

    busy: SharesData
    each: list[PortData]


class UtilisationData(TypedDict):
    """Shares of time, 0 to 1, in which boards were busy."""

    of_ms: float
    host: float
    gps: GpData
    renderers: RendererData
    ring: RingData
    ports: PortsData


class PathPartData(TypedDict):
    """Part of a latency during which a picture waits for one resource."""

    resource: str
    share: float
    ms: float
    board: str | None
    share_of_board: float | None


class CriticalPathData(TypedDict):
    """Chain of waits of the last complete pictures."""

    pictures: int
    latency_ms: float
    parts: list[PathPartData]
    limited_by: str
    chain: list[str]


#: Effect of 10 % more of one resource: values without and with the change.
WhatIfData = TypedDict(
    "WhatIfData",
    {
        "resource": str,
        "key": str,
        "from": int,
        "to": int,
        "latency_ms": list[float | None],
        "updates_hz": list[float | None],
        "level": str,
    },
)


class ChangedData(TypedDict):
    """A value that differs between two reports."""

    key: str
    a: object
    b: object
    percent: float | None


class DiffData(TypedDict):
    """Differences between two reports."""

    same_trace: bool
    settings: list[ChangedData]
    results: list[ChangedData]
    equal: int


class RigLatencyData(TypedDict):
    """A latency over the passes of the pendulum, milliseconds."""

    n: int
    mean: float
    sd: float | None
    min: float
    max: float


class RigSideData(TypedDict):
    """Tracking, rendering and total latency, measured from outside or inside the machine."""

    tracking: RigLatencyData
    rendering: RigLatencyData
    total: RigLatencyData


class RigData(TypedDict):
    """A measurement with the pendulum rig, as ``pxpl5 rig --json`` prints it."""

    schema: str
    pipeline: str
    machine: str
    overrides: dict[str, object]
    tracker: str
    seed: int
    photodiode_line: int
    n: int
    outside_ms: RigSideData
    inside_ms: RigSideData
    outside_less_inside_ms: float
    tracking_bound_ms: float
    rendering_early_bound_ms: float
    rendering_bound_ms: float
    agrees: bool
