"""Tests of sweeps on this computer."""

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

import pxpl5
from pxpl5 import _native
from pxpl5._cluster import Chunks, Pace, packed, unpacked

BASE = {"pipeline": "slats", "scene": "typical:100", "fields": 30, "measure": ["latency_fields.mean", "missed_retraces"]}


def space() -> pxpl5.SweepSpace:
    return pxpl5.SweepSpace(BASE, {"triangles": [50, 90], "machine.gp.triangle_ns": [20_000, 90_000]}, seeds=2)


def test_all_combinations_are_run_in_order() -> None:
    results = pxpl5.sweep(space(), progress=False)
    rows = results.table.rows()
    assert [row["point"] for row in rows] == list(range(8))
    assert [row["machine.gp.triangle_ns"] for row in rows] == [20_000] * 4 + [90_000] * 4
    assert [row["triangles"] for row in rows] == [50, 50, 90, 90] * 2
    assert [row["seed"] for row in rows] == [1, 2] * 4
    # 90 triangles of 90 us for two eyes do not fit into a field of 16.7 ms. 50 triangles of 20 us fit.
    assert rows[0]["missed_retraces"] == 0 and rows[-1]["missed_retraces"] > 0


def test_threads_do_not_change_a_byte(tmp_path: Path) -> None:
    files = []
    for threads in (1, 2):
        results = pxpl5.sweep(space(), out=tmp_path / str(threads), threads=threads, progress=False)
        assert results.folder is not None
        files.append([(results.folder / name).read_bytes() for name in ("rows.jsonl", "results.csv")])
    assert files[0] == files[1]


def test_an_interrupted_sweep_goes_on(tmp_path: Path) -> None:
    whole = pxpl5.sweep(space(), out=tmp_path / "whole", progress=False)
    out = tmp_path / "torn"
    pxpl5.sweep(space(), out=out, progress=False)
    lines = (out / "rows.jsonl").read_bytes().splitlines(keepends=True)
    (out / "rows.jsonl").write_bytes(b"".join(lines[:4]) + lines[4][:20])
    with pytest.raises(pxpl5.SweepError, match="3 finished points here already"):
        pxpl5.sweep(space(), out=out, progress=False)
    assert pxpl5.sweep(space(), out=out, resume=True, progress=False).lines == whole.lines
    assert (out / "rows.jsonl").read_bytes() == (tmp_path / "whole" / "rows.jsonl").read_bytes()


def test_a_point_that_cannot_be_run_says_why() -> None:
    """Slats binds 20 regions, four to a renderer: four renderers are too few."""
    rows = pxpl5.sweep(pxpl5.SweepSpace(BASE, {"machine.n_renderers": [4, 5]}), progress=False).table.rows()
    assert [row["status"] for row in rows] == ["failed", "done"] and rows[0]["error"]


def test_spaces_of_files_machines_and_ranges() -> None:
    machine = pxpl5.Machine("slats", {"n_renderers": 6})
    made = pxpl5.SweepSpace({**BASE, "machine": machine}, {"triangles": pxpl5.Range(10, 30, 10)})
    assert made.points == 3 and 'machine.preset = "slats"' in made.text
    with pytest.raises(pxpl5.SettingError, match="there is no key `trangles`; did you mean `triangles`"):
        pxpl5.SweepSpace(BASE, {"trangles": [1]})


def test_the_estimate_grows_with_the_work() -> None:
    made = pxpl5.SweepSpace({**BASE, "scene": "typical:2000", "pipeline": "rendering-control"}, {"triangles": [20, 2000], "fields": [60, 600]})
    cheap, long, heavy, both = made.costs([0, 1, 2, 3])
    assert cheap < long < both and cheap < heavy < both


class Space:
    """A space of points with known costs."""

    def __init__(self, costs: list[float]) -> None:
        self._costs = costs

    def costs(self, points: list[int]) -> list[float]:
        return [self._costs[point] for point in points]


def all_chunks(made: Chunks, most_s: float) -> list[list[int]]:
    return list(iter(lambda: made.next(most_s), []))


def test_chunks_hold_every_point_once_and_no_more_than_is_said() -> None:
    space: Any = Space([0.1, 0.2, 0.3, 5.0, 0.1, 0.1])
    assert all_chunks(Chunks(space, list(range(6)), Pace(1.0, 1.0)), 0.5) == [[0, 1], [2], [3], [4, 5]]
    # Points that take twice the estimated time.
    assert all_chunks(Chunks(space, list(range(6)), Pace(2.0, 1.0)), 0.5) == [[0], [1], [2], [3], [4, 5]]
    many: Any = Space([0.0] * 2_500)
    assert [len(chunk) for chunk in all_chunks(Chunks(many, list(range(2_500))), 0.5)] == [1_000, 1_000, 500]


def test_chunks_follow_how_long_points_take() -> None:
    space: Any = Space([0.01] * 10_000)
    made = Chunks(space, list(range(10_000)))
    # Without measured times, a point counts as four times its estimate: 12 points of 0.04 s are half a second.
    first = made.next(0.5)
    assert len(first) == 12
    # The measured times are ten times the estimates.
    for _ in range(20):
        for point in made.next(0.5):
            made.learn(point, 0.1)
    assert len(made.next(0.5)) == 5
    # A second row of a point changes nothing.
    before = made.pace.ratio
    made.learn(12, 99.0)
    assert made.pace.ratio == before


def test_a_large_cluster_has_some_points_estimated_for_all() -> None:
    asked: list[list[int]] = []

    class Asked(Space):
        def costs(self, points: list[int]) -> list[float]:
            asked.append(points)
            return super().costs(points)

    space: Any = Asked([0.1] * 2_000)
    made = Chunks(space, list(range(2_000)), Pace(0.2, 0.2, 2.0))
    # A thousand threads compute 10,000 points of 0.1 s in a second. A tenth of this second is enough for 125 estimates, one for 80 points.
    assert [len(made.next(7.0, 1_000)) for _ in range(3)] == [70, 70, 70]
    assert asked == [list(range(0, 2_000, 80))]


def test_rows_survive_the_way_to_the_client() -> None:
    rows = [('{"point":0,"error":"2 µs"}', 0.25), ('{"point":1}', 1e-9)]
    assert unpacked(packed(rows)) == rows


INTERRUPTED = """
import pxpl5, time
space = pxpl5.SweepSpace(
    {"pipeline": "rendering-control", "scene": "typical:8000", "fields": 20000, "measure": "latency_ms.mean"},
    {"triangles": [7000, 8000]})
print("begun", flush=True)
try:
    pxpl5.sweep(space, threads=2, progress=False)
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
"""


def test_ctrl_c_ends_the_points_in_progress() -> None:
    """A point takes many minutes. The interrupt must not wait for its end."""
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "begun\n"
    time.sleep(2.0)
    process.send_signal(signal.SIGINT)
    sent_s = time.monotonic()
    out, _ = process.communicate(timeout=60)
    assert "interrupted" in out
    print(f"{float(out.split()[1]) - sent_s:.3f} s from the signal to the exception")


def test_a_point_is_told_once_and_kept_once(tmp_path: Path) -> None:
    made = space()
    store = _native.Store(made._native, tmp_path, False)
    [(line, seconds)] = made._native.rows([3], 0.0)
    assert [store.append(line, seconds), store.append(line, seconds)] == [3, 3]
    assert store.missing() == [0, 1, 2, 4, 5, 6, 7]
