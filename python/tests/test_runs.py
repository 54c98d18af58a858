"""Tests of experiments and outcomes."""

import json
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import pxpl5

KEPT = json.loads((Path(__file__).parent / "experiments.json").read_text())


@pytest.mark.parametrize("kept", KEPT, ids=lambda kept: kept["trace_hash"])
def test_the_same_experiment_has_the_trace_that_rust_finds(kept: dict[str, str]) -> None:
    """tests/front_ends.rs checks the same hashes."""
    experiment = pxpl5.Experiment.from_text(kept["experiment"])
    assert experiment.config_hash == kept["config_hash"]
    outcome = experiment.run(progress=False)
    assert (outcome.trace_hash, outcome.config_hash) == (kept["trace_hash"], kept["config_hash"])


def fingerprint(picture: np.ndarray) -> str:
    """Returns 64 bits of FNV-1a over size and bytes, as in tests/images.rs."""
    hash_ = 0xCBF2_9CE4_8422_2325
    size = picture.shape[1].to_bytes(4, "little") + picture.shape[0].to_bytes(4, "little")
    for byte in size + picture.tobytes():
        hash_ = ((hash_ ^ byte) * 0x100_0000_01B3) & 0xFFFF_FFFF_FFFF_FFFF
    return f"{hash_:016x}"


def test_pictures_are_the_golden_ones_of_rust(root: Path) -> None:
    fingerprints = dict(line.split()[::-1] for line in (root / "tests/golden/fingerprints.txt").read_text().splitlines())
    outcome = pxpl5.Experiment("rendering-control", "full-screen:12", machine="small-hmd", fields=60).run()
    for eye in ("left", "right"):
        picture = outcome.picture(eye)
        assert picture is not None
        assert fingerprint(picture.array) == fingerprints[f"rendering-control-full-screen-12-{eye}"]


def test_slats_shows_every_picture_a_field_after_its_pose(slats: pxpl5.Outcome) -> None:
    """TR94: the rendering latency is one field, always."""
    assert slats.latency_fields.mean == pytest.approx(1, abs=1e-9)
    assert slats.latency_ms.mean == pytest.approx(1001 / 60, abs=1e-6)
    assert slats.missed_retraces == 0


def test_neither_threads_nor_pixels_change_the_trace(slats: pxpl5.Outcome) -> None:
    for pixels, threads in (("off", 0), ("all", 0), ("all", 2)):
        other = pxpl5.Experiment("slats", "mig", triangles=100, fields=60, pixels=pixels).run(threads=threads)
        assert other.trace_hash == slats.trace_hash


def test_pixels_of_a_picture_are_not_copied(slats: pxpl5.Outcome) -> None:
    picture = slats.picture()
    assert picture is not None
    assert np.shares_memory(np.asarray(picture), picture.array) and picture.array.shape == (480, 640, 3)
    assert picture.png().startswith(b"\x89PNG") and picture._repr_png_() == picture.png()


def test_a_copied_region_is_what_pixel_memory_holds() -> None:
    """The colour bits of the last region that a renderer drew must equal the frame buffer's pixels."""
    outcome = pxpl5.Experiment("rendering-control", "full-screen:12", fields=60).run()
    memory = outcome.pixel_memory(0)
    picture = outcome.picture()
    assert memory is not None and picture is not None
    name, first, bits = outcome.pixel_memory_fields[0]
    assert name.endswith("colour") and bits == 24
    weights = 1 << np.arange(24, dtype=np.uint32)
    words = np.tensordot(weights, memory[first : first + 24].astype(np.uint32), axes=1)
    colour = np.stack([words >> 16 & 255, words >> 8 & 255, words & 255], axis=-1).astype(np.uint8)
    screen = picture.array
    regions = [screen[y : y + 128, x : x + 128] for y in range(0, 480, 128) for x in range(0, 640, 128)]
    close = [np.abs(region.astype(int) - colour[: region.shape[0], : region.shape[1]]).mean() for region in regions]
    # The head moves a little between the picture that is shown and the one that is being drawn.
    assert min(close) < 4 and memory.max() == 1


def test_a_picture_that_nobody_computed_is_none() -> None:
    outcome = pxpl5.Experiment("slats", "mig", triangles=50, fields=40, pixels="off").run()
    assert outcome.picture() is None and outcome.pixel_memory(0) is None
    with pytest.raises(pxpl5.SettingError, match="surface: expected left or right, found middle"):
        outcome.picture("middle")


def test_progress_is_told_up_to_the_end() -> None:
    progress: list[tuple[int, int]] = []
    pxpl5.Experiment("slats", "mig", triangles=50, fields=40).run(progress=lambda done, of: progress.append((done, of)))
    assert progress[-1] == (40, 40) and progress == sorted(progress)


def test_what_a_callback_raises_ends_the_run() -> None:
    def stop(done: int, of: int) -> None:
        raise LookupError("enough")

    begin = time.monotonic()
    with pytest.raises(LookupError, match="enough"):
        pxpl5.Experiment("rendering-control", "head", fields=100_000, pixels="off").run(progress=stop)
    assert time.monotonic() - begin < 30


def test_other_threads_run_while_an_experiment_does() -> None:
    """Another thread counts during the run, because the run releases the lock of the interpreter."""
    counted = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    begin = time.monotonic()
    pxpl5.Experiment("rendering-control", "mig", fields=600, pixels="all").run(threads=0, progress=False)
    took = time.monotonic() - begin
    done.set()
    thread.join()
    # If the run held the lock, the thread would count once or twice.
    assert counted[0] > min(20, 20 * took)


INTERRUPTED = """
import pxpl5, sys
print("begun", flush=True)
try:
    pxpl5.Experiment("rendering-control", "head", fields=1_000_000, pixels="off"{head}).run(progress=False)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.parametrize("head", ["", ", head=pxpl5.Head('pan:100')"], ids=["run", "dry run"])
def test_ctrl_c_ends_a_run_and_its_dry_run(head: str) -> None:
    """A million fields would take hours. With a head, the dry run comes first."""
    text = INTERRUPTED.format(head=head).replace("1_000_000", "200_000" if head else "1_000_000")
    process = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert "interrupted" in out


INTERRUPTED_SOON = """
import pxpl5, time
experiment = pxpl5.Experiment("rendering-control", "head", fields={fields}, pixels="off", measure="latency_ms.mean", settings={settings})
print("begun", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
"""

HEAD = {"head.motion": "pan:100", "head.tracker": "optical"}


@pytest.mark.parametrize(
    ("call", "fields", "settings"),
    [
        ("experiment.measure()", 1_000_000, {}),
        ("experiment.measure()", 200_000, HEAD),
        ("experiment.measure()", 200_000, {"level": "analytic"}),
        ("list(experiment.frames())", 20_000, {}),
        ("list(experiment.frames(first=150_000))", 200_000, {}),
        ("experiment.film('film.png')", 20_000, {}),
        ("experiment.film('film.png', first=150_000)", 200_000, HEAD),
    ],
)
def test_ctrl_c_ends_measurements_and_films_within_half_a_second(
    call: str, fields: int, settings: dict[str, str], tmp_path: Path
) -> None:
    text = INTERRUPTED_SOON.format(call=call, fields=fields, settings=settings)
    process = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout is not None and process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    sent_s = time.monotonic()
    out, _ = process.communicate(timeout=60)
    assert "interrupted" in out
    assert float(out.split()[1]) - sent_s < 0.5
    assert list(tmp_path.iterdir()) == [], "no half of a film is left"


COMPARED = """
import pxpl5, time
print("begun", flush=True)
try:
    pxpl5.compare("head", fields=20_000, only=["slats", "jitp-field"], out="out", progress=False)
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
    try:
        pxpl5.compare("head", fields=20_000, only=["slats", "jitp-field"], seeds=2, out="out", resume=True, progress=False)
    except pxpl5.SweepError as error:
        print(error)
"""


def interrupted(program: str, folder: Path) -> tuple[float, str]:
    """Runs a program in a folder and sends Ctrl-C after 2 s.

    Returns the seconds from Ctrl-C to the program's line "interrupted", and the program's last line.
    """
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, cwd=folder)
    assert process.stdout is not None and process.stdout.readline() == "begun\n"
    time.sleep(2.0)
    process.send_signal(signal.SIGINT)
    sent_s = time.monotonic()
    out, _ = process.communicate(timeout=60)
    first, last = out.splitlines()
    return float(first.split()[1]) - sent_s, last


def test_ctrl_c_ends_a_comparison_and_leaves_its_folder_free(tmp_path: Path) -> None:
    seconds, second = interrupted(COMPARED, tmp_path)
    assert seconds < 2 and "seeds was [1, 2, 3, 4, 5], expected [1, 2]" in second
    # Rows of stopped runs are not stored.
    assert len((tmp_path / "out" / "rows" / "rows.jsonl").read_text().splitlines()) == 1


STUDY = """
import pxpl5, time
print("begun", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
for _ in range(20):
    before = time.process_time()
    time.sleep(0.25)
    if time.process_time() - before < 0.05:
        print("idle", flush=True)
        break
"""


@pytest.mark.parametrize(
    "call",
    [
        "pxpl5.limit('rendering-control', 'head', rate_hz=15)",
        "pxpl5.limit_over('machine.n_gps', 'rendering-control', 'head', rate_hz=15, fields=2_000)",
        "pxpl5.figures(progress=False)",
        "pxpl5.levels(experiments=200, progress=False)",
        "pxpl5.interpretations(progress=False)",
        "pxpl5.compare('head', fields=100, seeds=1, only='rendering-control', limits=True, progress=False)",
        "pxpl5.rig('rendering-control', passes=2_000)",
    ],
)
def test_ctrl_c_ends_studies_and_their_threads(call: str, tmp_path: Path) -> None:
    seconds, second = interrupted(STUDY.format(call=call), tmp_path)
    assert seconds < 0.5
    assert second == "idle"


def test_a_run_that_is_too_short_says_how_long_it_must_be() -> None:
    with pytest.raises(pxpl5.TooShortError, match="simulate more fields: the next one is shown after about") as raised:
        pxpl5.Experiment("rendering-control", "mig", fields=10).run()
    needed = raised.value.fields_needed
    assert needed is not None and raised.value.partial is not None
    assert raised.value.partial.trace_hash
    assert len(pxpl5.Experiment("rendering-control", "mig", fields=needed + 2).run().pictures) > 4


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"pipeline": "slat", "scene": "mig"}, "there is no pipeline `slat`; did you mean `slats`"),
        ({"pipeline": "slats"}, "scene is missing: give a built-in scene"),
        ({"pipeline": "slats", "scene": "mig", "copi": "whole"}, "there is no key `copi`; did you mean `copy`"),
        ({"pipeline": "slats", "scene": "mig", "fields": 0}, "fields: expected"),
        ({"pipeline": "slats", "scene": "mig", "level": "analytic", "head": "pan:1"}, "level: expected transaction or cycle"),
    ],
)
def test_wrong_settings_are_refused_with_the_words_of_the_library(keywords: dict[str, object], words: str) -> None:
    with pytest.raises(pxpl5.SettingError, match=words):
        pxpl5.Experiment(**keywords)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"level": "cycles"}, "level: there is no level `cycles`; did you mean `cycle`"),
        ({"fields": "abc"}, 'fields: expected a whole number from 1 to 10000000, found "abc"$'),
        ({"settings": {"machine.gp.triangle_ns": -1}}, "machine.gp.triangle_ns: expected a whole number from 0"),
        ({"seed": {1}}, "seed: expected text, a number, a truth value or a list of these, found set"),
        ({"head": "pann"}, "head.motion: there is no motion `pann`; did you mean `pan`"),
    ],
)
def test_an_error_begins_with_the_setting_and_names_the_setting_once(keywords: dict[str, object], words: str) -> None:
    with pytest.raises(pxpl5.SettingError, match=f"^{words}"):
        pxpl5.Experiment("slats", "mig", **keywords)  # type: ignore[arg-type]


def test_the_analytic_level_measures_and_does_not_run() -> None:
    experiment = pxpl5.Experiment("slats", "mig", triangles=100, level="analytic", measure=["latency_fields.mean", "updates_hz"])
    measured = experiment.measure()
    assert measured["latency_fields.mean"] == pytest.approx(1) and measured["updates_hz"] == pytest.approx(59.94, abs=0.01)
    with pytest.raises(pxpl5.SettingError, match="analytic, which has no events"):
        experiment.run()


def test_settings_say_the_same_experiment(slats: pxpl5.Outcome) -> None:
    text = pxpl5.Experiment("slats", "mig", triangles=100, fields=60).settings()
    assert pxpl5.Experiment.from_text(text).config_hash == slats.config_hash


def test_notebooks_are_shown_something(mig: pxpl5.Outcome) -> None:
    assert "image/png" in mig._repr_html_() and "latency_ms" in mig.report._repr_html_()
    assert mig.timeline()._repr_svg_().startswith("<svg")
    assert "TRANSFORM" in mig.timeline(fields=4).svg.upper()
    assert mig.page("Mig").startswith("<!DOCTYPE html>") or "<html" in mig.page("Mig")


def test_quantities_are_those_of_the_report(mig: pxpl5.Outcome) -> None:
    assert mig.quantity("latency_ms.mean") == mig.latency_ms.mean == mig.report["latency_ms"]["mean"]
    assert set(mig.quantities()) == set(pxpl5.quantities())
    with pytest.raises(pxpl5.SettingError, match="did you mean `latency_ms.mean`"):
        mig.quantity("latency_ms.men")
