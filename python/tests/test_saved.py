"""Tests of foreign and damaged files of outcomes, and of damaged pickles."""

import io
import json
import random
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pxpl5
from pxpl5 import _pickle


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Returns the bytes of a file with a scene, a recorded motion, tables and pictures."""
    corners = [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 1.5, 0]]
    scene = pxpl5.Scene.from_arrays(corners, [[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]], name="pyramid")
    times = np.linspace(0, 2, 21)
    poses = pxpl5.Motion("synthetic:3").poses(times)
    head = pxpl5.Head(pxpl5.Motion.from_arrays(times, poses[:, :3], poses[:, 3:], end="hold"), predict="none")
    place = tmp_path_factory.mktemp("saved") / "whole.zip"
    pxpl5.Experiment("slats", scene, head=head, fields=40).run(progress=False).save(place)
    return place.read_bytes()


def check(place: Path) -> None:
    """Checks that a damaged file is refused with its path, the expected and the found contents; or it can be used."""
    try:
        outcome = pxpl5.Outcome.load(place)
    except pxpl5.SettingError as error:
        assert str(error).startswith(str(place)) and "expected" in str(error) and "found" in str(error), str(error)
        return
    except OSError:
        return
    repr(outcome)
    outcome._repr_html_()
    outcome.boards.rows()
    if not outcome.has_discarded_records:
        outcome.pictures.rows()
    outcome.quantities()
    outcome.picture("left")
    assert outcome.latency_ms.n >= 0


def changed(whole: bytes, names: dict[str, bytes | None]) -> bytes:
    """Returns the archive with other contents of some members. None removes a member."""
    new = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(whole)) as old, zipfile.ZipFile(new, "w") as file:
        for name in old.namelist():
            contents = names[name] if name in names else old.read(name)
            if contents is not None:
                file.writestr(name, contents)
    return new.getvalue()


def edited(whole: bytes, edit: Callable[[dict[str, Any]], object]) -> bytes:
    """Returns the archive with a changed outcome.json."""
    with zipfile.ZipFile(io.BytesIO(whole)) as file:
        plain = json.loads(file.read("outcome.json"))
    edit(plain)
    return changed(whole, {"outcome.json": json.dumps(plain).encode()})


def report(plain: dict[str, Any], key: str, value: object) -> None:
    plain["report"] = json.dumps({**json.loads(plain["report"]), key: value})


FOREIGN: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda whole: b"",
    "text": lambda whole: b"a,b\n1,2\n",
    "half": lambda whole: whole[: len(whole) // 2],
    "without the end": lambda whole: whole[:-1],
    "without the begin": lambda whole: whole[100:],
    "no member": lambda whole: changed(b"PK\x05\x06" + bytes(18), {}),
    "without outcome.json": lambda whole: changed(whole, {"outcome.json": None}),
    "without a picture": lambda whole: changed(whole, {"left.png": None}),
    "without the scene": lambda whole: changed(whole, {"scene.json": None}),
    "no JSON": lambda whole: changed(whole, {"outcome.json": b"{"}),
    "no UTF-8": lambda whole: changed(whole, {"outcome.json": b'"\xff\xfe"'}),
    "nested": lambda whole: changed(whole, {"outcome.json": b"[" * 100_000}),
    "a list": lambda whole: changed(whole, {"outcome.json": b"[]"}),
    "a number": lambda whole: changed(whole, {"outcome.json": b"3"}),
    "no PNG": lambda whole: changed(whole, {"left.png": b"P6 1 1 255"}),
    "half a PNG": lambda whole: changed(whole, {"both.png": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"}),
    "no scene": lambda whole: changed(whole, {"scene.json": b"no scene"}),
    "an empty scene": lambda whole: changed(whole, {"scene.json": b"{}"}),
    "another schema": lambda whole: edited(whole, lambda plain: plain.update(schema="pxpl5-outcome/9")),
    "no schema": lambda whole: edited(whole, lambda plain: plain.pop("schema")),
    "a report of another type": lambda whole: edited(whole, lambda plain: plain.update(report="[]")),
    "a report without JSON": lambda whole: edited(whole, lambda plain: plain.update(report="{")),
    "no statistics": lambda whole: edited(whole, lambda plain: report(plain, "latency_ms", 3)),
    "statistics of texts": lambda whole: edited(whole, lambda plain: report(plain, "latency_ms", dict.fromkeys(("n", "mean", "sd", "min", "max", "definition"), "x"))),
    "utilisation of another type": lambda whole: edited(whole, lambda plain: report(plain, "utilisation", {"gps": 1})),
    "a column of another type": lambda whole: edited(whole, lambda plain: plain["pictures"][0].__setitem__(2, "Int8")),
    "a column of texts": lambda whole: edited(whole, lambda plain: plain["pictures"][0].__setitem__(3, ["x"])),
    "a short column": lambda whole: edited(whole, lambda plain: plain["pictures"][0].__setitem__(3, [])),
    "a column of two": lambda whole: edited(whole, lambda plain: plain["stages"].__setitem__(0, ["picture", ""])),
    "no columns": lambda whole: edited(whole, lambda plain: plain.update(stages=[1, 2])),
    "other settings": lambda whole: edited(whole, lambda plain: plain["experiment"].update(settings="pipeline = 'slat'")),
    "settings that are no text": lambda whole: edited(whole, lambda plain: plain["experiment"].update(settings=None)),
    "no poses": lambda whole: edited(whole, lambda plain: plain["experiment"]["motion"].__setitem__(0, "0 0 0")),
    "a motion of numbers": lambda whole: edited(whole, lambda plain: plain["experiment"].update(motion=[1, 2, 3])),
    "a motion that is a number": lambda whole: edited(whole, lambda plain: plain["experiment"].update(motion=7)),
    "a scene without parts": lambda whole: edited(whole, lambda plain: plain["experiment"].update(scene={})),
    "a scene of text": lambda whole: edited(whole, lambda plain: plain["experiment"].update(scene="pyramid")),
}


@pytest.mark.parametrize("name", FOREIGN)
def test_a_foreign_or_damaged_file_is_refused_with_its_path(name: str, whole: bytes, tmp_path: Path) -> None:
    place = tmp_path / "damaged.zip"
    place.write_bytes(FOREIGN[name](whole))
    check(place)
    with pytest.raises((pxpl5.SettingError, OSError)):
        pxpl5.Outcome.load(place)


def test_each_key_of_another_type_is_refused(whole: bytes, tmp_path: Path) -> None:
    with zipfile.ZipFile(io.BytesIO(whole)) as file:
        keys = list(json.loads(file.read("outcome.json")))
    place = tmp_path / "damaged.zip"
    for key in keys:
        for value in (None, 3, [3], {"x": []}, "[" * 3, True):
            place.write_bytes(edited(whole, lambda plain: plain.update({key: value})))
            check(place)
        place.write_bytes(edited(whole, lambda plain: plain.pop(key)))
        with pytest.raises(pxpl5.SettingError, match=key):
            pxpl5.Outcome.load(place)


def test_changed_bytes_raise_only_documented_exceptions(whole: bytes, tmp_path: Path) -> None:
    place = tmp_path / "damaged.zip"
    chance = random.Random(1)
    for _ in range(150):
        damaged = bytearray(whole)
        at = chance.randrange(len(whole) - 400, len(whole)) if chance.random() < 0.5 else chance.randrange(len(whole))
        damaged[at] = chance.randrange(256)
        place.write_bytes(damaged)
        check(place)


def test_a_file_that_cannot_be_read_raises_the_error_of_the_system(tmp_path: Path) -> None:
    for place in (tmp_path, tmp_path / "nothing", tmp_path / "no" / "folder"):
        with pytest.raises(OSError):
            pxpl5.Outcome.load(place)


def test_a_lost_model_file_is_named(tmp_path: Path) -> None:
    model = tmp_path / "model.obj"
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    pxpl5.Experiment("rendering-control", model, fields=40).run(progress=False).save(tmp_path / "run.zip")
    model.unlink()
    with pytest.raises(pxpl5.SettingError, match=r"run\.zip: .*model\.obj"):
        pxpl5.Outcome.load(tmp_path / "run.zip")


COLUMNS: list[Any] = [
    None,
    3,
    "columns",
    {"a": 1},
    [1, 2],
    [("a", "", "Int64")],
    [("a", "", "Int64", 3)],
    [("a", "", "Int64", ["x"])],
    [("a", "", "Int64", [2**70])],
    [("a", "", "Int8", [1])],
    [("a", "", "Boolean", [1])],
    [("a", "", "Utf8", [1])],
    [("a", "", "Float64", "text")],
    [("a", "", "Int64", [1, 2]), ("b", "", "Int64", [1])],
    [(1, "", "Int64", [1])],
]


@pytest.mark.parametrize("columns", COLUMNS, ids=str)
def test_a_damaged_table_is_refused(columns: Any) -> None:
    with pytest.raises(pxpl5.SettingError, match="expected"):
        _pickle.table(columns)


def test_rows_that_are_no_rows_are_refused() -> None:
    for rows in ([1], ["a"], [{"a": object()}], [{"a": {1, 2}}], [[("a", 1)]]):
        with pytest.raises(pxpl5.SettingError, match="expected"):
            pxpl5.Table.from_rows(rows)  # type: ignore[arg-type]
