"""Tests of runs in steps, and of all pictures of a run."""

import io
from pathlib import Path

import numpy as np
import pytest

import pxpl5

TEST_CASE = {"pipeline": "rendering-control", "scene": "full-screen:4", "fields": 24}


def experiment(**keywords: object) -> pxpl5.Experiment:
    return pxpl5.Experiment(**{**TEST_CASE, **keywords})  # type: ignore[arg-type]


def test_steps_change_no_result() -> None:
    stepper = experiment().stepper()
    assert (stepper.field, stepper.now_ps) == (0, 0)
    assert stepper.run_to_field(3) == "reached" and stepper.field == 3
    # An NTSC field takes 1001/60000 s.
    assert stepper.now_ps == pytest.approx(3 * 1001 / 60000 * 1e12, abs=2)
    assert stepper.step_line() == "reached" and stepper.step_event("gp 0") == "reached"
    event = stepper.last_event
    assert event is not None and event["board"].lower() == "gp 0"
    board = stepper.board("gp 1")
    assert board is not None and board["busy_ps"] > 0 and stepper.board("display 0") is None
    renderer = stepper.board("renderer 0")
    assert renderer is not None and renderer["busy_ps"] > 0
    picture = stepper.picture("right")
    assert picture is not None and picture.array.shape == (480, 640, 3)
    outcome = stepper.finish()
    assert outcome.trace_hash == experiment().run(progress=False).trace_hash
    with pytest.raises(pxpl5.RunError, match="the run is finished"):
        stepper.step_field()


def test_wrong_steps_are_refused() -> None:
    stepper = experiment().stepper()
    with pytest.raises(pxpl5.SettingError, match="board: expected host, ring, gp N, renderer N or display N, found \"cpu\""):
        stepper.step_event("cpu")
    with pytest.raises(pxpl5.SettingError, match="surface: expected left or right, found middle"):
        stepper.picture("middle")
    with pytest.raises(pxpl5.SettingError, match="field: expected a whole number of 0 or more, found -1"):
        stepper.run_to_field(-1)


def test_a_callback_of_each_field_sees_the_run() -> None:
    seen: list[tuple[int, int]] = []
    outcome = experiment().run(progress=False, each_field=lambda stepper: seen.append((stepper.field, stepper.shown)))
    assert [field for field, _ in seen] == list(range(1, 25))
    assert [shown for _, shown in seen] == sorted(shown for _, shown in seen) and seen[-1][1] > 4
    assert outcome.trace_hash == experiment().run(progress=False).trace_hash

    def stop(stepper: pxpl5.Stepper) -> None:
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        experiment().run(progress=False, each_field=stop)


def test_frames_are_what_a_viewer_saw_in_each_field() -> None:
    """A stepper reads the screen in another way: with the beam at the end of the field."""
    outcome = experiment().run(progress=False)
    frames = list(outcome.frames("left"))
    assert len(frames) == 23
    stepper = experiment().stepper()
    for field in range(10, 23):
        stepper.run_to_field(field + 1)
        seen = stepper.picture("left")
        assert seen is not None and np.array_equal(frames[field].array, seen.array), field
    # The head moves around the aircraft, so a later picture differs from the first.
    moving = list(experiment(scene="mig").frames(first=12, fields=11))
    assert any(not np.array_equal(moving[0].array, later.array) for later in moving[1:])
    both = list(experiment().frames("both", first=20, fields=2))
    assert len(both) == 2 and both[0].array.shape == (480, 1280, 3)
    assert np.array_equal(both[0].array[:, :640], frames[20].array)


def test_frames_can_be_left_early_and_wrong_ones_are_refused() -> None:
    frames = experiment(fields=100_000).frames()
    assert next(frames).array.shape == (480, 640, 3)
    del frames
    with pytest.raises(pxpl5.SettingError, match="surface: expected left or right or both, found 'up'"):
        experiment().frames("up")
    with pytest.raises(pxpl5.SettingError, match="first: expected 0 to 22, found 30"):
        experiment().frames(first=30)
    with pytest.raises(pxpl5.SettingError, match="the display has 2"):
        list(experiment().frames(7))


def test_a_film_has_the_frames(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    experiment().film(tmp_path / "film.png", first=18, fields=4)
    film = image.open(io.BytesIO((tmp_path / "film.png").read_bytes()))
    assert film.n_frames == 4
    for number, frame in enumerate(experiment().frames(first=18, fields=4)):
        film.seek(number)
        assert np.array_equal(np.asarray(film.convert("RGB")), frame.array), number


def test_a_face_of_address_recalculation_is_a_cross() -> None:
    outcome = pxpl5.Experiment("arp-full", "full-screen:4", fields=40).run(progress=False)
    face = outcome.face("left", 0)
    assert face is not None
    height, width, _ = face.array.shape
    assert width * 3 == height * 4 and face.array.max() > 0
    with pytest.raises(pxpl5.SettingError, match="eye: expected left or right, found up"):
        outcome.face("up")
    with pytest.raises(pxpl5.SettingError, match="memory: expected 0 to"):
        outcome.face("left", 99)
    assert experiment().run(progress=False).face() is None
