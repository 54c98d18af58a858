"""Sweeps on a local Dask cluster of two worker processes."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import pxpl5
from pxpl5 import _cluster

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.slow

#: 2,000 points that cost some milliseconds each.
BASE = {"pipeline": "slats", "scene": "typical:100", "fields": 16, "measure": ["latency_fields.mean", "missed_retraces"]}


def space(points: int, fields: int = 16) -> pxpl5.SweepSpace:
    return pxpl5.SweepSpace({**BASE, "fields": fields}, {"triangles": pxpl5.Range(1, 100)}, seeds=points // 100)


@pytest.fixture
def cluster() -> Iterator[Any]:
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as made:
        yield made


def cpu_s(cluster: Any) -> tuple[float, float]:
    """Returns the CPU seconds of this process (with client and scheduler) and of the workers."""
    import psutil

    workers = [worker.process.pid for worker in cluster.workers.values()]
    of_workers = [psutil.Process(pid).cpu_times() for pid in workers]
    return time.process_time(), sum(times.user + times.system for times in of_workers)


def test_a_cluster_gives_the_same_bytes_as_this_computer(cluster: Any, tmp_path: Path) -> None:
    """The test also prints the efficiency relative to two threads, without a limit, because other work shares the computer."""
    made = space(2_000)
    begin, begin_cpu = time.monotonic(), time.process_time()
    pxpl5.sweep(made, out=tmp_path / "threads", threads=2, progress=False)
    by_threads_s, cpu_of_threads_s = time.monotonic() - begin, time.process_time() - begin_cpu
    with distributed.Client(cluster) as client:
        pxpl5.sweep(space(100), client=client, progress=False)
        begin, before = time.monotonic(), cpu_s(cluster)
        pxpl5.sweep(made, out=tmp_path / "dask", client=client, progress=False)
        by_dask_s, after = time.monotonic() - begin, cpu_s(cluster)
    for name in ("rows.jsonl", "results.csv"):
        assert (tmp_path / "dask" / name).read_bytes() == (tmp_path / "threads" / name).read_bytes()
    print(f"threads {by_threads_s:.2f} s, Dask {by_dask_s:.2f} s, efficiency {by_threads_s / by_dask_s:.1%}")
    here_s, workers_s = (now - then for now, then in zip(after, before, strict=True))
    all_s = here_s + workers_s
    print(f"CPU: threads {cpu_of_threads_s:.2f} s, Dask {all_s:.2f} s ({here_s:.2f} of it client and scheduler): {cpu_of_threads_s / all_s:.1%}")


def test_nothing_is_lost_and_nothing_twice_when_workers_are_killed(
    cluster: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import os
    import signal
    import threading

    # The sweep takes more than a minute, even on an idle computer.
    made = space(2_000, 180)
    pxpl5.sweep(made, out=tmp_path / "threads", threads=2, progress=False)
    killed: list[int] = []
    done = threading.Event()

    def kill() -> None:
        while len(killed) < KILLS and not done.wait(PERIOD_S):
            # Kill one worker at a time, and only after all have started: a nanny of Dask gives up a worker that dies at its start.
            processes = [worker.process.pid for worker in cluster.workers.values() if worker.process is not None]
            if len(processes) == 2 and len(cluster.scheduler_info["workers"]) == 2:
                os.kill(processes[len(killed) % 2], signal.SIGKILL)
                killed.append(processes[len(killed) % 2])

    came = 0
    unpacked = _cluster.unpacked

    def counted(message: bytes) -> list[tuple[str, float]]:
        nonlocal came
        rows = unpacked(message)
        came += len(rows)
        return rows

    monkeypatch.setattr(_cluster, "unpacked", counted)
    killer = threading.Thread(target=kill)
    begin = time.monotonic()
    killer.start()
    with distributed.Client(cluster) as client:
        pxpl5.sweep(made, out=tmp_path / "dask", client=client, progress=False)
    took_s = time.monotonic() - begin
    done.set()
    killer.join()
    assert killed, "the sweep was over before a worker was killed"
    rows = (tmp_path / "dask" / "rows.jsonl").read_bytes()
    assert rows == (tmp_path / "threads" / "rows.jsonl").read_bytes()
    assert len(rows.splitlines()) == 1 + 2_000
    print(f"{len(killed)} workers were killed in {took_s:.0f} s; {came} rows came, {came - 2_000} of them again")


#: Number of workers that are killed within a minute.
KILLS = 12

#: Seconds from one killed worker to the next.
PERIOD_S = 5.0
