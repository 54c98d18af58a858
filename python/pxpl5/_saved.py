"""Outcomes as data, for the module pickle and for files."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict, TypeVar, get_type_hints

from . import _native
from ._errors import SettingError
from ._fits import misfits
from ._names import QuantityName
from ._native import Picture, Table
from ._report_types import PixelErrorsData, ReportData

if TYPE_CHECKING:
    from ._rows import PictureRow, StageRow

T = TypeVar("T")

#: Name and version of the layout of a file.
SCHEMA = "pxpl5-outcome/2"


class Saved(TypedDict):
    """Results of a run. Times are simulated time."""

    #: Hash of the trace and the statistics.
    trace_hash: str
    #: Hash of all settings on which the trace depends.
    config_hash: str
    #: Names of pipeline, machine and scene.
    subject: tuple[str, str, str]
    #: The report as JSON text.
    report: str
    #: All quantities by name.
    quantities: dict[QuantityName, float | None]
    #: The quantities that the experiment lists.
    measured: dict[QuantityName, float | None]
    #: Advice of the library about a machine that was too slow.
    advice: str | None
    #: True if the run has discarded records.
    discarded: bool
    #: The table of pictures; None if records were discarded.
    pictures: Table[PictureRow] | None
    #: The table of stages; None if records were discarded.
    stages: Table[StageRow] | None
    #: Labels of the surfaces.
    surfaces: list[str]
    #: The last picture of each surface.
    last: dict[str, Picture | None]
    #: Both eyes side by side.
    both: Picture | None
    #: Errors in pixels as JSON text.
    pixel_errors: str


class OptionalState(TypedDict, total=False):
    """Parts of an experiment that only some have."""

    #: Arguments of the function that makes the motion.
    motion: list[object]
    #: The scene as JSON text, and warnings about its file.
    scene: tuple[bytes, list[str]]


class ExperimentState(OptionalState):
    """An experiment as plain data."""

    #: Text of an experiment file.
    settings: str
    #: True if a policy's pictures have Phong shading.
    phong: bool


def saved_of(native: _native.Outcome) -> Saved:
    """Returns the results of a run as data."""
    discarded = native.has_discarded_records()
    surfaces = native.surfaces()
    return Saved(
        trace_hash=native.trace_hash,
        config_hash=native.config_hash,
        subject=native.subject(),
        report=native.report_json(),
        quantities=native.quantities(),
        measured=native.measured(),
        advice=native.advice(),
        discarded=discarded,
        pictures=None if discarded else native.pictures(),
        stages=None if discarded else native.stages(),
        surfaces=surfaces,
        last={surface: native.picture(surface) for surface in surfaces},
        both=native.both(),
        pixel_errors=json.dumps(native.pixel_errors()),
    )


def write(path: str | PathLike[str], saved: Saved, experiment: ExperimentState | None) -> None:
    """Writes results and the state of their experiment to a file: a ZIP archive of JSON and PNG.

    Raises OSError if the file cannot be written.
    """
    pictures = {f"{label}.png": picture for label, picture in saved["last"].items() if picture is not None}
    if saved["both"] is not None:
        pictures["both.png"] = saved["both"]
    plain: dict[str, object] = {**saved, "schema": SCHEMA, "experiment": None}
    plain.update({"pictures": _columns(saved["pictures"]), "stages": _columns(saved["stages"])})
    plain.update({"last": [label for label, picture in saved["last"].items() if picture is not None], "both": saved["both"] is not None})
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        if experiment is not None:
            state: dict[str, object] = {**experiment}
            if "scene" in experiment:
                text, state["scene"] = experiment["scene"]
                file.writestr("scene.json", text)
            plain["experiment"] = state
        file.writestr("outcome.json", json.dumps(plain, indent=1))
        for name, picture in pictures.items():
            file.writestr(name, picture.png())


def read(path: str | PathLike[str]) -> tuple[Saved, ExperimentState | None]:
    """Reads results and the state of their experiment, if the file has it.

    Raises :class:`SettingError` for a file that :func:`write` has not written, and OSError if the file cannot be read.
    """

    def contents() -> tuple[Saved, ExperimentState | None]:
        with zipfile.ZipFile(path) as file:
            plain: dict[str, object] = json.loads(file.read("outcome.json"))
            check(plain)
            return _saved(plain, file), _experiment(plain["experiment"], file)

    return read_with(path, contents)


def read_with(path: str | PathLike[str], part: Callable[[], T]) -> T:
    """Reads a part of a file. An exception for damaged contents becomes :class:`SettingError` with the path."""
    try:
        return part()
    except OSError:
        raise
    # The modules zipfile, json and numpy raise exceptions of many types for damaged contents.
    except Exception as error:
        text = str(error)
        if isinstance(error, SettingError) and "expected " in text and "found " in text:
            raise SettingError(f"{Path(path)}: {error}") from None
        found = f"{type(error).__name__}: {error}"
        raise SettingError(f"{Path(path)}: expected a file that Outcome.save has written, found another ({found})") from None


#: Keys of outcome.json, each with a test of its value and the expected value in words.
KEYS: dict[str, tuple[Callable[[object], bool], str]] = {
    "trace_hash": (lambda value: isinstance(value, str), "a text"),
    "config_hash": (lambda value: isinstance(value, str), "a text"),
    "subject": (lambda value: _is_texts(value, 3), "three texts"),
    "report": (lambda value: isinstance(value, str), "JSON as a text"),
    "quantities": (lambda value: _is_numbers(value), "a number or null for each name"),
    "measured": (lambda value: _is_numbers(value), "a number or null for each name"),
    "advice": (lambda value: value is None or isinstance(value, str), "a text or null"),
    "discarded": (lambda value: isinstance(value, bool), "true or false"),
    "pictures": (lambda value: value is None or isinstance(value, list), "a list of columns or null"),
    "stages": (lambda value: value is None or isinstance(value, list), "a list of columns or null"),
    "surfaces": (lambda value: _is_texts(value), "a list of texts"),
    "last": (lambda value: _is_texts(value), "a list of texts"),
    "both": (lambda value: isinstance(value, bool), "true or false"),
    "pixel_errors": (lambda value: isinstance(value, str), "JSON as a text"),
    "experiment": (lambda value: value is None or isinstance(value, dict), "an object or null"),
}

#: Parts of a report that this package reads.
REPORT_KEYS = ("pipeline", "machine", "scene", "latency_ms", "latency_fields", "missed_retraces", "utilisation", "critical_path")


def check(plain: object) -> None:
    """Checks the types of all values of outcome.json.

    Raises :class:`SettingError` for the first value of another type.
    """
    if not isinstance(plain, dict):
        raise SettingError(f"outcome.json: expected an object, found {type(plain).__name__}")
    if plain.get("schema") != SCHEMA:
        raise SettingError(f"outcome.json: expected the schema {SCHEMA}, found {plain.get('schema')}")
    for key, (fits, expected) in KEYS.items():
        if key not in plain or not fits(plain[key]):
            found = repr(plain[key])[:40] if key in plain else "none"
            raise SettingError(f"outcome.json: {key}: expected {expected}, found {found}")
    report = json.loads(plain["report"])
    wrong = misfits(report, dict[str, object], "report")
    wrong = wrong or [f"report.{key}: expected a value, found none" for key in REPORT_KEYS if key not in report]
    hints = get_type_hints(ReportData)
    wrong = wrong or [error for key in hints if key in report for error in misfits(report[key], hints[key], f"report.{key}")]
    wrong = wrong or misfits(json.loads(plain["pixel_errors"]), PixelErrorsData | None, "pixel_errors")
    if wrong:
        raise SettingError(f"outcome.json: {wrong[0]}")


def _is_texts(value: object, count: int | None = None) -> bool:
    is_list = isinstance(value, list) and all(isinstance(text, str) for text in value)
    return is_list and (count is None or len(value) == count)  # type: ignore[arg-type]


def _is_numbers(value: object) -> bool:
    return isinstance(value, dict) and all(number is None or isinstance(number, (int, float)) for number in value.values())


def _saved(plain: Mapping[str, object], file: zipfile.ZipFile) -> Saved:
    """Returns the results in a file whose values have the right types."""
    shown = {label: _picture(file.read(f"{label}.png")) for label in plain["last"]}  # type: ignore[attr-defined]
    surfaces: list[str] = plain["surfaces"]  # type: ignore[assignment]
    others = {
        "pictures": _table(plain["pictures"]),
        "stages": _table(plain["stages"]),
        "last": {surface: shown.get(surface) for surface in surfaces},
        "both": _picture(file.read("both.png")) if plain["both"] else None,
        "subject": tuple(plain["subject"]),  # type: ignore[arg-type]
    }
    saved: Saved = {name: others.get(name, plain.get(name)) for name in Saved.__annotations__}  # type: ignore[assignment]
    return saved


def _experiment(state: object, file: zipfile.ZipFile) -> ExperimentState | None:
    """Returns the state of the experiment in a file."""
    if not isinstance(state, dict):
        return None
    if not isinstance(state.get("settings"), str) or not isinstance(state.get("phong"), bool):
        raise SettingError("outcome.json: experiment: expected settings and phong, found another object")
    experiment = ExperimentState(settings=state["settings"], phong=state["phong"])
    if "motion" in state:
        experiment["motion"] = list(state["motion"])
    if "scene" in state:
        if not _is_texts(state["scene"]):
            raise SettingError("outcome.json: experiment: expected the scene's warnings, found another object")
        experiment["scene"] = (file.read("scene.json"), state["scene"])
    return experiment


def _columns(table: Table[PictureRow] | Table[StageRow] | None) -> object:
    return None if table is None else table.__reduce__()[1][0]


def _table(columns: object) -> object:
    if not isinstance(columns, list):
        return None
    return _native.table_of_columns([tuple(column) for column in columns])


def _picture(png: bytes) -> Picture:
    return _native.picture_of_png(png)
