"""Tests of heads, trackers and motions."""

from math import cos, radians, sin
from pathlib import Path

import numpy as np
import pytest

import pxpl5


def pan(time_s: float) -> tuple[float, ...]:
    """Returns the pose of a head that turns by 100 degrees a second about the vertical axis."""
    half = radians(100 * time_s) / 2
    return (0.0, 0.0, 0.0, cos(half), 0.0, sin(half), 0.0)


def errors(head: pxpl5.Head) -> dict[str, float]:
    outcome = pxpl5.Experiment("rendering-control", "full-screen:12", head=head, fields=60, pixels="off").run(progress=False)
    return outcome.report["head"]["error"]["pixels"]


def test_a_pan_turns_at_its_rate() -> None:
    poses = pxpl5.Motion("pan:100").poses(np.array([0.0, 0.5]))
    turn = 2 * np.degrees(np.arccos(np.clip(abs(poses[1, 3]), 0, 1)))
    assert poses.shape == (2, 7) and turn == pytest.approx(50, abs=1e-9)


def test_a_callable_moves_as_the_motion_that_it_describes() -> None:
    times = np.linspace(0, 2, 21)
    assert np.allclose(pxpl5.Motion.from_callable(pan).poses(times), pxpl5.Motion("pan:100").poses(times), atol=1e-12)
    named = errors(pxpl5.Head("pan:100", predict="none"))
    called = errors(pxpl5.Head(pan, predict="none"))
    assert called["mean"] == pytest.approx(named["mean"], rel=1e-6) and named["mean"] > 10


def test_what_a_motion_raises_is_raised_where_it_is_run() -> None:
    def wrong(time_s: float) -> tuple[float, ...]:
        raise ZeroDivisionError("no head")

    with pytest.raises(ZeroDivisionError, match="no head"):
        errors(pxpl5.Head(wrong))
    with pytest.raises(pxpl5.SettingError, match="expected seven finite numbers"):
        errors(pxpl5.Head(lambda time_s: (0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0)))


def test_a_recording_of_arrays_is_that_of_its_file(tmp_path: Path) -> None:
    times = np.linspace(0, 3, 61)
    poses = pxpl5.Motion("synthetic:3").poses(times)
    rows = np.column_stack([times, poses])
    file = tmp_path / "head.csv"
    lines = [",".join(repr(float(value)) for value in row) for row in rows]
    file.write_text("time_s,x,y,z,qw,qx,qy,qz\n" + "\n".join(lines) + "\n")
    of_file = pxpl5.Motion.recording(file)
    of_arrays = pxpl5.Motion.from_arrays(times, poses[:, :3], poses[:, 3:])
    between = np.linspace(0.01, 2.99, 50)
    assert np.array_equal(of_file.poses(between), of_arrays.poses(between))
    assert of_file.ends_s == pytest.approx(3.0)
    assert pxpl5.Motion.recording(file, end="loop").ends_s is None
    head = {"tracker": "fastrak", "predict": "none"}
    assert errors(pxpl5.Head(str(file), **head)) == errors(pxpl5.Head(of_arrays, **head))


def test_a_recording_that_ends_too_soon_is_refused() -> None:
    short = pxpl5.Motion.from_arrays(np.array([0.0, 0.5]), np.zeros((2, 3)), np.tile([1.0, 0, 0, 0], (2, 1)))
    with pytest.raises(pxpl5.SettingError, match="the recording of the head ends after 0.500 s"):
        errors(pxpl5.Head(short))


def test_a_wrong_recording_names_its_line(tmp_path: Path) -> None:
    (tmp_path / "head.csv").write_text("time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,zero,0,1,0,0,0\n")
    with pytest.raises(pxpl5.SettingError, match="line 3"):
        pxpl5.Motion.recording(tmp_path / "head.csv")
    with pytest.raises(pxpl5.SettingError, match=r"quaternions: expected shape \(n, 4\), found \(2, 3\)"):
        pxpl5.Motion.from_arrays(np.zeros(2), np.zeros((2, 3)), np.zeros((2, 3)))
    with pytest.raises(pxpl5.SettingError, match=r"expected shapes \(2, 3\) and \(2, 4\), found \(3, 3\)"):
        pxpl5.Motion.from_arrays(np.zeros(2), np.zeros((3, 3)), np.zeros((3, 4)))


def test_numbers_of_a_tracker_can_be_set() -> None:
    slow = pxpl5.Head("pan:100", tracker="optical", predict="none", tracking={"optical.latency": 40.0})
    assert errors(slow)["mean"] > errors(pxpl5.Head("pan:100", tracker="ideal", predict="none"))["mean"]
    assert any(parameter.path == "tracking.optical.latency" for parameter in pxpl5.tracking_parameters())


def test_studies_take_a_callable_as_the_motion_that_it_describes() -> None:
    def found(motion: object) -> tuple[float, pxpl5.OverLimit]:
        head = pxpl5.Head(motion, predict="none")  # type: ignore[arg-type]
        compared = pxpl5.compare("full-screen:2", head=head, fields=40, seeds=1, only="slats", progress=False)
        limits = {"latency_fields": 1.01, "fields": 30, "high": 6, "progress": False}
        over = pxpl5.limit_over("machine.n_renderers", "slats", "typical:10", head=head, **limits)  # type: ignore[arg-type]
        return compared.data["pipelines"][0]["error"]["mean_px"]["mean"], over

    (named, over), (called, over_called) = found("pan:100"), found(pan)
    assert called == pytest.approx(named, rel=1e-6) and named > 1
    assert over_called == over and over.least == 5
    times = np.linspace(0, 1, 61)
    poses = pxpl5.Motion("pan:100").poses(times)
    recorded = pxpl5.Motion.from_arrays(times, poses[:, :3], poses[:, 3:])
    head = pxpl5.Head(recorded, predict="none")
    # The recording lasts a second: 59 whole fields of 1001/60 ms.
    data = pxpl5.compare("full-screen:2", head=head, seeds=1, only="slats", progress=False).data
    assert data["fields"] == 59 and dict(data["head"])["head.motion"].startswith("given:")


def test_what_a_motion_raises_is_raised_by_studies() -> None:
    def breaks(time_s: float) -> tuple[float, ...]:
        # The hash of a motion covers every eighth of a second, so only a run finds this pose.
        if 0.13 < time_s < 0.2:
            raise ZeroDivisionError("no head")
        return pan(time_s)

    head = pxpl5.Head(breaks, predict="none")
    with pytest.raises(ZeroDivisionError, match="no head"):
        pxpl5.compare("full-screen:2", head=head, fields=40, seeds=1, only="slats", progress=False)
    with pytest.raises(ZeroDivisionError, match="no head"):
        pxpl5.limit("slats", "typical", head=head, progress=False)


def test_a_limit_takes_a_head() -> None:
    """A tracker that reports every field costs no time of the graphics processors: the limit is that without a head."""
    plain = pxpl5.limit("slats", machine="slats", copy="whole", progress=False)
    limit = pxpl5.limit("slats", machine="slats", copy="whole", head=pxpl5.Head("pan:100", predict="none"), progress=False)
    assert limit.triangles == plain.triangles
