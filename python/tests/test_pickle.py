"""Tests of pickle and of files of outcomes."""

import pickle
from concurrent.futures import ProcessPoolExecutor
from math import cos, radians, sin
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import pxpl5


def pan(time_s: float) -> tuple[float, ...]:
    """Returns the pose of a head that turns by 100 degrees a second about the vertical axis."""
    half = radians(100 * time_s) / 2
    return (0.0, 0.0, 0.0, cos(half), 0.0, sin(half), 0.0)


def in_turn(frame: dict[str, object]) -> list[tuple[int, int]]:
    """Assigns the regions to the renderers in turn."""
    return [(region, region % frame["renderers"]) for region in range(len(frame["primitives"]))]  # type: ignore[arg-type, operator]


def again(thing: object) -> object:
    return pickle.loads(pickle.dumps(thing))


def pyramid() -> pxpl5.Scene:
    corners = [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 1.5, 0]]
    return pxpl5.Scene.from_arrays(corners, [[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]], name="pyramid")


@pytest.mark.parametrize("make", [pyramid, lambda: pxpl5.Scene.builtin("mig"), lambda: pxpl5.Scene.builtin("molecules").culled()])
def test_a_scene_is_the_same_experiment_afterwards(make) -> None:  # type: ignore[no-untyped-def]
    """The hash covers every vertex, the lighting, the structures and the motion."""
    scene = make()
    copy = again(scene)
    assert isinstance(copy, pxpl5.Scene) and np.array_equal(copy.triangles, scene.triangles)
    hashes = {pxpl5.Experiment("rendering-control", one, fields=30).config_hash for one in (scene, copy)}
    assert len(hashes) == 1


def test_a_motion_has_the_same_poses_afterwards(tmp_path: Path) -> None:
    times = np.linspace(0, 2, 21)
    poses = pxpl5.Motion("synthetic:3").poses(times)
    file = tmp_path / "head.csv"
    rows = [",".join(repr(float(value)) for value in row) for row in np.column_stack([times, poses])]
    file.write_text("time_s,x,y,z,qw,qx,qy,qz\n" + "\n".join(rows) + "\n")
    motions = [
        pxpl5.Motion("synthetic:3"),
        pxpl5.Motion.recording(file, end="hold"),
        pxpl5.Motion.from_arrays(times, poses[:, :3], poses[:, 3:], end="loop"),
        pxpl5.Motion.from_callable(pan, name="pan"),
    ]
    for motion in motions:
        copy = again(motion)
        assert isinstance(copy, pxpl5.Motion)
        assert np.array_equal(copy.poses(times), motion.poses(times)) and copy.ends_s == motion.ends_s
    # The file is not needed any more.
    stored = pickle.dumps(motions[1])
    file.unlink()
    assert np.array_equal(pickle.loads(stored).poses(times), motions[1].poses(times))


def test_an_experiment_keeps_its_hash(tmp_path: Path) -> None:
    head = pxpl5.Head(pan, tracker="fastrak", predict="none")
    experiments = [
        pxpl5.Experiment("slats", "mig", triangles=60, fields=30),
        pxpl5.Experiment("rendering-control", pyramid(), fields=30, machine=pxpl5.Machine("small-hmd", {"n_gps": 7})),
        pxpl5.Experiment("rendering-control", "full-screen:2", head=head, fields=30),
        pxpl5.Experiment(pxpl5.PolicyPipeline(in_turn, shading="gouraud"), "full-screen:2", fields=30),
    ]
    for experiment in experiments:
        copy = again(experiment)
        assert isinstance(copy, pxpl5.Experiment) and copy.config_hash == experiment.config_hash


def test_tables_and_pictures_are_equal_afterwards(mig: pxpl5.Outcome) -> None:
    for table in (mig.pictures, mig.stages, pxpl5.Table.from_rows([{"a": 1.5, "b": "x", "c": True}, {"a": None}])):
        copy = again(table)
        assert isinstance(copy, pxpl5.Table)
        assert list(copy) == list(table) and copy.names == table.names and copy.definitions == table.definitions
    picture = mig.picture()
    assert picture is not None
    copy = again(picture)
    assert isinstance(copy, pxpl5.Picture)
    assert np.array_equal(copy.array, picture.array) and copy.png() == picture.png()


def check_equal(copy: pxpl5.Outcome, outcome: pxpl5.Outcome) -> None:
    assert copy.trace_hash == outcome.trace_hash and copy.config_hash == outcome.config_hash
    assert copy.report == outcome.report and copy.quantities() == outcome.quantities()
    assert list(copy.pictures) == list(outcome.pictures) and list(copy.stages) == list(outcome.stages)
    left, other = copy.picture("left"), outcome.picture("left")
    assert left is not None and other is not None and np.array_equal(left.array, other.array)
    assert copy.surfaces == outcome.surfaces and repr(copy) == repr(outcome)
    difference = copy.diff(outcome)
    assert difference.same_trace and len(difference.results) == len(difference.settings) == 0
    assert [row["differing"] for row in difference.pictures] == [0, 0]


def test_an_outcome_has_its_results_afterwards_and_runs_again_for_the_rest(slats: pxpl5.Outcome) -> None:
    copy = again(slats)
    assert isinstance(copy, pxpl5.Outcome)
    check_equal(copy, slats)
    assert copy.timeline(fields=2).svg == slats.timeline(fields=2).svg


def test_a_file_has_the_outcome_and_its_experiment(slats: pxpl5.Outcome, tmp_path: Path) -> None:
    slats.save(tmp_path / "slats.zip")
    copy = pxpl5.Outcome.load(tmp_path / "slats.zip")
    check_equal(copy, slats)
    assert copy.experiment is not None and copy.experiment.config_hash == slats.config_hash
    scene_outcome = pxpl5.Experiment("rendering-control", pyramid(), fields=50, head="pan:30").run(progress=False)
    scene_outcome.save(tmp_path / "pyramid.zip")
    loaded = pxpl5.Outcome.load(tmp_path / "pyramid.zip")
    assert loaded.pixel_memory(0) is not None and loaded.experiment is not None
    assert loaded.experiment.config_hash == scene_outcome.config_hash


def test_another_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.zip").write_bytes(b"no archive")
    with pytest.raises(pxpl5.SettingError, match="expected a file that Outcome.save has written"):
        pxpl5.Outcome.load(tmp_path / "other.zip")
    with pytest.raises(FileNotFoundError):
        pxpl5.Outcome.load(tmp_path / "nowhere.zip")


def latency(experiment: pxpl5.Experiment) -> pxpl5.Outcome:
    return experiment.run(progress=False)


def test_a_pool_of_processes_runs_experiments() -> None:
    experiments = [pxpl5.Experiment("slats", "mig", triangles=count, fields=30) for count in (20, 40)]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        outcomes = list(pool.map(latency, experiments))
    assert [outcome.trace_hash for outcome in outcomes] == [latency(one).trace_hash for one in experiments]
