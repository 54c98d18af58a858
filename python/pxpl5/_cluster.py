"""Computation of the points of a sweep on the workers of a Dask cluster.

::

    client --- chunk (numbers of points) ---> scheduler ---> worker
    client <-- rows, several times a second -- scheduler <--- worker

A sweep continues if workers die, for three reasons:

- Workers send finished rows to the client as messages, and the client writes the rows to the folder at once. Rows are not results of
  Dask tasks. A result of a task stays in the memory of the worker until a client fetches the result, and is lost with the worker. A
  client that fetches a result from a dead worker waits until the connection times out.
- Chunks are only as long as the scheduler needs, so little work is lost with a worker. The length of a chunk comes from the estimate of
  the analytic level, corrected by the measured times of finished points.
- If a worker dies, Dask gives its chunk to another worker. After several failures (``distributed.scheduler.allowed-failures``) Dask
  gives up the chunk. The client then divides the points without a row into two new chunks.
"""

from __future__ import annotations

import json
import queue
import time
import uuid
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from . import _native
from ._errors import SweepError
from ._space import SweepSpace, sweep_of_text

if TYPE_CHECKING:
    from distributed import Client

#: Seconds of work in a chunk. The transfer of a chunk costs only some milliseconds.
CHUNK_S = 0.5

#: Seconds between two messages with rows. If a worker dies, the rows of this time are lost, and the current point.
ROWS_S = 0.25

#: Least seconds of a chunk for each thread of the cluster. This is twice the time that scheduler and client spend on a chunk with its
#: messages, so scheduler and client are busy for at most half of the time. Measured: docs/guide/sweep-times.md, "A million points".
HANDING_S = 7e-3

#: Approximate seconds for the estimate of a point (docs/guide/sweep-times.md), and the greatest share of its time that the client spends on estimates.
ESTIMATE_S = 8e-4
ESTIMATING = 0.1

#: Greatest number of points in a chunk.
MAX_POINTS = 1_000

#: Number of waiting chunks for each thread of the cluster, in addition to the chunk in progress.
WAITING = 1

#: Number of times that Dask gives up a chunk of one point before the sweep fails. Each time, four workers have died (the default of
#: Dask). A hundred dead workers are not chance.
MAX_GIVEN_UP = 25

#: Number of points whose costs are estimated together.
ESTIMATED = 100

#: Seconds between two queries of the cluster's number of threads.
LOOK_S = 2.0


def compute(text: str, path: str, points: list[int], topic: str, every_s: float) -> None:
    """Computes a chunk on a worker. Every ``every_s`` seconds, the worker sends the finished rows under a topic."""
    from distributed import get_worker

    worker = get_worker()
    sweep = _sweep(text, path)
    while points:
        rows = sweep.rows(points, every_s)
        worker.log_event(topic, packed(rows))
        points = points[len(rows) :]


#: Sweeps that this process has built, by text and path. So a worker builds each sweep and loads each scene only once.
_SWEEPS: dict[tuple[str, str], _native.Sweep] = {}


def _sweep(text: str, path: str) -> _native.Sweep:
    cached = _SWEEPS.get((text, path))
    if cached is None:
        cached = _SWEEPS[(text, path)] = sweep_of_text(text, path)
    return cached


def packed(rows: list[tuple[str, float]]) -> bytes:
    """Returns rows as a compressed message. The scheduler keeps the last thousand messages, and rows of a sweep compress well."""
    return zlib.compress(json.dumps(rows).encode(), 1)


def unpacked(message: bytes) -> list[tuple[str, float]]:
    """Returns the rows of a message."""
    return [(line, seconds) for line, seconds in json.loads(zlib.decompress(message))]


@dataclass
class Pace:
    """Ratio of measured to estimated seconds of points on the cluster. Old points have less weight than new points.

    The initial ratio is 4, so the first chunks are short.
    """

    #: Weighted sum of the measured seconds of points.
    measured_s: float = 4e-3
    #: Weighted sum of the estimated seconds of the same points.
    estimated_s: float = 1e-3
    #: Weighted number of these points.
    points: float = 0.0

    def learn(self, measured_s: float, estimated_s: float) -> None:
        """Adds the times of a finished point."""
        weight = 1 - min(1.0, measured_s / (20 * CHUNK_S))
        self.measured_s = self.measured_s * weight + measured_s
        self.estimated_s = self.estimated_s * weight + estimated_s
        self.points = self.points * weight + 1

    @property
    def ratio(self) -> float:
        """Measured seconds for each estimated second."""
        return self.measured_s / self.estimated_s

    @property
    def point_s(self) -> float:
        """Mean seconds of a point; infinite before the first point is finished."""
        return self.measured_s / self.points if self.points else float("inf")


@dataclass
class Chunks:
    """Points that no worker has yet. They are divided into chunks on demand."""

    space: SweepSpace
    #: Numbers of the points, in order.
    points: list[int]
    pace: Pace = field(default_factory=Pace)
    _at: int = 0
    #: Estimated costs of points in seconds. Points before `_at` are assigned to workers and have no row yet.
    _costs: dict[int, float] = field(default_factory=dict)

    def cost(self, point: int) -> float:
        """Estimated seconds of a point that is assigned to a worker and not finished."""
        return self._costs[point]

    def learn(self, point: int, measured_s: float) -> None:
        """Adds the measured time of a point. A point that comes twice counts once."""
        estimated_s = self._costs.pop(point, None)
        if estimated_s is not None:
            self.pace.learn(measured_s, estimated_s)

    def next(self, most_s: float, threads: int = 1) -> list[int]:
        """Returns the next points whose estimated times add up to at most ``most_s`` seconds, but at least one point.

        The list is empty if all points are assigned. If many threads compute points faster than the client can estimate their costs, the
        client estimates only one of several points. The following points then get the same cost.
        """
        chunk: list[int] = []
        left_s = most_s
        while self._at < len(self.points) and len(chunk) < MAX_POINTS:
            point = self.points[self._at]
            if point not in self._costs:
                each = max(1, round(threads * ESTIMATE_S / (ESTIMATING * self.pace.point_s)))
                some = self.points[self._at : self._at + ESTIMATED * each]
                costs = self.space.costs(some[::each])
                self._costs.update((point, costs[number // each]) for number, point in enumerate(some))
            cost_s = self._costs[point] * self.pace.ratio
            if chunk and cost_s > left_s:
                break
            chunk.append(point)
            left_s -= cost_s
            self._at += 1
        return chunk


class Future(Protocol):
    """The part of a future of Dask that is used here."""

    @property
    def key(self) -> object: ...

    @property
    def status(self) -> str | None: ...

    def exception(self) -> BaseException: ...

    def add_done_callback(self, reporter: Callable[[Future], None], /) -> None: ...


class Submitting(Protocol):
    """The part of a client of Dask that is used here. Dask has no types for it."""

    def submit(
        self, work: Callable[[str, str, list[int], str, float], None], /, *arguments: object, key: str
    ) -> Future: ...

    def cancel(self, futures: list[Future], /) -> object: ...

    def nthreads(self) -> dict[str, int]: ...

    def subscribe_topic(self, topic: str, heard: Callable[[tuple[float, bytes]], None], /) -> object: ...

    def unsubscribe_topic(self, topic: str, /) -> object: ...


class Cluster:
    """A running sweep on a cluster."""

    def __init__(
        self, space: SweepSpace, store: _native.Store, client: Client, reporter: Callable[[int, int], object] | None
    ) -> None:
        self._space = space
        self._store = store
        self._client: Submitting = client
        self._told = reporter
        missing = store.missing()
        self._missing = set(missing)
        self._chunks = Chunks(space, missing)
        #: Chunks that Dask gave up. They are assigned before other chunks.
        self._again: list[list[int]] = []
        self._given: dict[object, tuple[Future, list[int]]] = {}
        self._made = 0
        self._lost_alone: dict[int, int] = {}
        #: Messages with rows, and finished futures, in the order of their arrival.
        self._news: queue.SimpleQueue[bytes | Future] = queue.SimpleQueue()
        self._threads = 1
        self._looked_s = float("-inf")
        self._topic = f"pxpl5-{uuid.uuid4().hex}"

    def run(self) -> None:
        """Computes all missing points. After an exception, the store has the rows that arrived before.

        Raises :class:`SweepError` if many workers die while they compute the same point, and exceptions of workers.
        """
        self._client.subscribe_topic(self._topic, self._heard)
        try:
            while self._hand_out():
                self._take(self._news.get())
        finally:
            self._client.unsubscribe_topic(self._topic)
            self._client.cancel([future for future, _ in self._given.values()])

    def _heard(self, event: tuple[float, bytes]) -> None:
        """Receives the time of a message and the message, in the client's own thread."""
        self._news.put(event[1])

    def _hand_out(self) -> bool:
        """Assigns chunks until each thread has enough. Returns true if the cluster has work."""
        threads = self._cluster_threads()
        chunk_s = max(CHUNK_S, threads * HANDING_S)
        while len(self._given) < threads * (1 + WAITING):
            chunk = self._again.pop() if self._again else self._chunks.next(chunk_s, threads)
            if not chunk:
                break
            self._submit(chunk, ROWS_S * chunk_s / CHUNK_S)
        return bool(self._given)

    def _submit(self, chunk: list[int], every_s: float) -> None:
        path = "" if self._space._path == Path() else fspath(self._space._path)
        key = f"{self._topic}-{self._made}"
        self._made += 1
        future = self._client.submit(compute, self._space.text, path, chunk, self._topic, every_s, key=key)
        self._given[key] = (future, chunk)
        future.add_done_callback(self._news.put)

    def _cluster_threads(self) -> int:
        """Returns the number of threads of all workers, or the previous number if the cluster has no worker now."""
        now_s = time.monotonic()
        if now_s - self._looked_s > LOOK_S:
            self._looked_s = now_s
            self._threads = sum(self._client.nthreads().values()) or self._threads
        return self._threads

    def _take(self, news: bytes | Future) -> None:
        if isinstance(news, bytes):
            self._keep(unpacked(news))
        else:
            self._end(news)

    def _keep(self, rows: list[tuple[str, float]]) -> None:
        for line, seconds in rows:
            point = self._store.append(line, seconds)
            self._chunks.learn(point, seconds)
            self._missing.discard(point)
        if self._told is not None:
            self._told(self._space.points - len(self._missing), self._space.points)

    def _end(self, future: Future) -> None:
        """Handles the end of a chunk. Its rows have arrived before. Points without a row are assigned again."""
        from distributed import KilledWorker

        _, chunk = self._given.pop(future.key)
        error = future.exception() if future.status == "error" else None
        if error is not None and not isinstance(error, KilledWorker):
            raise error
        if future.status == "cancelled":
            raise SweepError("the cluster has given the sweep up; the rows of finished points are kept")
        left = [point for point in chunk if point in self._missing]
        if len(left) == 1:
            self._count_lost(left[0])
        middle = (len(left) + 1) // 2
        self._again += [half for half in (left[middle:], left[:middle]) if half]

    def _count_lost(self, point: int) -> None:
        lost = self._lost_alone[point] = self._lost_alone.get(point, 0) + 1
        if lost >= MAX_GIVEN_UP:
            raise SweepError(f"point {point}: workers died over it alone, again and again; the rows of other points are kept")
