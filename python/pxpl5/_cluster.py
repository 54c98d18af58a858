"""Points of a sweep on the workers of a Dask cluster.

::

    client --- chunk (numbers of points) ---> scheduler ---> worker
    client <-- rows, several times a second -- scheduler <--- worker

What keeps a sweep going on a cluster whose workers die:

- Rows go to the client as they are finished, as messages, and are in the folder at once. They are no results of Dask tasks: such a
  result stays in its worker's memory until somebody fetches it, is lost with the worker, and whoever fetches it from a worker that
  has just died waits until the connection times out.
- A chunk is as long as the scheduler needs it to be and no longer, by the analytic level's estimate, corrected by how long points have
  taken on these workers so far. So a worker that dies takes little work with it.
- Dask hands a chunk to another worker when its worker dies. When it gives a chunk up (``distributed.scheduler.allowed-failures``), the
  points of it that have no row are handed out in halves.
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

#: Seconds of work that a worker is given at a time: far above what handing it out costs (some milliseconds).
CHUNK_S = 0.5

#: Seconds from one message with rows to the next: what a dying worker may lose besides the point in its hand.
ROWS_S = 0.25

#: Seconds that a chunk must be long for each thread of the cluster, so that scheduler and client have half their time to spare: twice what they
#: spend on a chunk with its messages. Measured: docs/sweeps.md, "A million points".
HANDING_S = 7e-3

#: Seconds that the estimate of a point takes, about (measured there), and which part of its time the client may estimate.
ESTIMATE_S = 8e-4
ESTIMATING = 0.1

#: Most points of a chunk.
MOST_POINTS = 1_000

#: Chunks that wait for each thread of the cluster, besides the one that it works on.
WAITING = 1

#: How often Dask may give up a chunk of one point before the sweep is given up: each time some workers (four, unless its configuration
#: says otherwise) have died over it, and a hundred are not chance.
MOST_GIVEN_UP = 25

#: Points whose costs are estimated at a time.
ESTIMATED = 100

#: Seconds from one look at how many threads the cluster has to the next.
LOOK_S = 2.0


def compute(text: str, path: str, points: list[int], topic: str, every_s: float) -> None:
    """What a worker does with a chunk: it sends the rows of its points under a topic, every so many seconds those that are finished."""
    from distributed import get_worker

    worker = get_worker()
    sweep = _sweep(text, path)
    while points:
        rows = sweep.rows(points, every_s)
        worker.log_event(topic, packed(rows))
        points = points[len(rows) :]


#: Sweeps that this process has made already, by text and path: a worker makes each once, and loads each scene once.
_KNOWN: dict[tuple[str, str], _native.Sweep] = {}


def _sweep(text: str, path: str) -> _native.Sweep:
    known = _KNOWN.get((text, path))
    if known is None:
        known = _KNOWN[(text, path)] = sweep_of_text(text, path)
    return known


def packed(rows: list[tuple[str, float]]) -> bytes:
    """Rows as a message: the scheduler keeps the last thousand of them, and rows of one sweep are much alike."""
    return zlib.compress(json.dumps(rows).encode(), 1)


def unpacked(message: bytes) -> list[tuple[str, float]]:
    """The rows of a message."""
    return [(line, seconds) for line, seconds in json.loads(zlib.decompress(message))]


@dataclass
class Pace:
    """How many seconds points take on the cluster for one that was estimated: old points count less and less.

    Before anything is known a point is taken to need four times its estimate, so that the first chunks are short.
    """

    #: Seconds that points took.
    measured_s: float = 4e-3
    #: Seconds that were estimated for them.
    estimated_s: float = 1e-3
    #: How many they were.
    points: float = 0.0

    def learn(self, measured_s: float, estimated_s: float) -> None:
        """Takes a point in."""
        weight = 1 - min(1.0, measured_s / (20 * CHUNK_S))
        self.measured_s = self.measured_s * weight + measured_s
        self.estimated_s = self.estimated_s * weight + estimated_s
        self.points = self.points * weight + 1

    @property
    def ratio(self) -> float:
        """Measured seconds for one that was estimated."""
        return self.measured_s / self.estimated_s

    @property
    def point_s(self) -> float:
        """Seconds of a point in the mean; without end before anything is known."""
        return self.measured_s / self.points if self.points else float("inf")


@dataclass
class Chunks:
    """Points that nobody has been given yet, as chunks made when they are asked for."""

    space: SweepSpace
    #: Numbers of the points, in order.
    points: list[int]
    pace: Pace = field(default_factory=Pace)
    _at: int = 0
    #: Points whose costs are estimated, and the costs; those before `_at` are handed out and have no row yet.
    _costs: dict[int, float] = field(default_factory=dict)

    def cost(self, point: int) -> float:
        """What a point was estimated to take, seconds; known of points that have been handed out and not learnt of."""
        return self._costs[point]

    def learn(self, point: int, measured_s: float) -> None:
        """Takes in how long a point took. A point may come twice."""
        estimated_s = self._costs.pop(point, None)
        if estimated_s is not None:
            self.pace.learn(measured_s, estimated_s)

    def next(self, most_s: float, threads: int = 1) -> list[int]:
        """The next points, at least one, that take about ``most_s`` seconds at most; none when all are handed out.

        Where so many threads take points faster than all can be estimated, one point of several is, and the next are taken to cost the same.
        """
        chunk: list[int] = []
        left_s = most_s
        while self._at < len(self.points) and len(chunk) < MOST_POINTS:
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

    def add_done_callback(self, told: Callable[[Future], None], /) -> None: ...


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
    """A sweep on a cluster while it goes on."""

    def __init__(
        self, space: SweepSpace, store: _native.Store, client: Client, told: Callable[[int, int], object] | None
    ) -> None:
        self._space = space
        self._store = store
        self._client: Submitting = client
        self._told = told
        missing = store.missing()
        self._missing = set(missing)
        self._chunks = Chunks(space, missing)
        #: Chunks that were given up, to be handed out before others.
        self._again: list[list[int]] = []
        self._given: dict[object, tuple[Future, list[int]]] = {}
        self._made = 0
        self._lost_alone: dict[int, int] = {}
        #: Messages with rows, and futures that ended, in the order in which they came.
        self._news: queue.SimpleQueue[bytes | Future] = queue.SimpleQueue()
        self._threads = 1
        self._looked_s = float("-inf")
        self._topic = f"pxpl5-{uuid.uuid4().hex}"

    def run(self) -> None:
        """Computes all points that are missing. What has come when an exception ends it is in the store.

        Raises :class:`SweepError` for a point over which worker after worker dies, and what a worker raises.
        """
        self._client.subscribe_topic(self._topic, self._heard)
        try:
            while self._hand_out():
                self._take(self._news.get())
        finally:
            self._client.unsubscribe_topic(self._topic)
            self._client.cancel([future for future, _ in self._given.values()])

    def _heard(self, event: tuple[float, bytes]) -> None:
        """Called by the client's own thread with the time of a message, and the message."""
        self._news.put(event[1])

    def _hand_out(self) -> bool:
        """Gives the cluster as much as it should have; whether it has anything to do."""
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
        """Threads of all workers; of a cluster that has none just now, as many as it had."""
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
        """Of a chunk that ended: its rows came before this news, on the same way. What has none is handed out again."""
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
        if lost >= MOST_GIVEN_UP:
            raise SweepError(f"point {point}: workers died over it alone, again and again; the rows of other points are kept")
