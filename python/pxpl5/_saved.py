"""Outcomes as data, for the module pickle and for files."""

from __future__ import annotations

import io
import json
import zipfile
from os import PathLike
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from . import _native
from ._errors import SettingError
from ._native import Picture, Table

#: Name and version of the layout of a file.
SCHEMA = "pxpl5-outcome/1"


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
    quantities: dict[str, float | None]
    #: The quantities that the experiment lists.
    measured: dict[str, float | None]
    #: Advice of the library about a machine that was too slow.
    advice: str | None
    #: True if the run has discarded records.
    discarded: bool
    #: The table of pictures; None if records were discarded.
    pictures: Table | None
    #: The table of stages; None if records were discarded.
    stages: Table | None
    #: Labels of the surfaces.
    surfaces: list[str]
    #: The last picture of each surface.
    last: dict[str, Picture | None]
    #: Both eyes side by side.
    both: Picture | None
    #: Errors in pixels as JSON text.
    pixel_errors: str


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


def write(path: str | PathLike[str], saved: Saved, experiment: dict[str, Any] | None) -> None:
    """Writes results and the state of their experiment to a file: a ZIP archive of JSON and PNG.

    Raises OSError if the file cannot be written.
    """
    pictures = {f"{label}.png": picture for label, picture in saved["last"].items() if picture is not None}
    if saved["both"] is not None:
        pictures["both.png"] = saved["both"]
    plain: dict[str, Any] = {**saved, "schema": SCHEMA, "experiment": None}
    plain.update({name: _columns(saved[name]) for name in ("pictures", "stages")})
    plain.update({"last": [label for label, picture in saved["last"].items() if picture is not None], "both": saved["both"] is not None})
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        if experiment is not None:
            scene = experiment.pop("scene", None)
            if scene is not None:
                arrays, rest = scene
                buffer = io.BytesIO()
                np.savez(buffer, **arrays)
                file.writestr("scene.npz", buffer.getvalue())
                experiment["scene"] = rest
            plain["experiment"] = experiment
        file.writestr("outcome.json", json.dumps(plain, indent=1))
        for name, picture in pictures.items():
            file.writestr(name, picture.png())


def read(path: str | PathLike[str]) -> tuple[Saved, dict[str, Any] | None]:
    """Reads results and the state of their experiment, if the file has it.

    Raises :class:`SettingError` for a file that :func:`write` has not written, and OSError if the file cannot be read.
    """
    place = Path(path)
    try:
        with zipfile.ZipFile(place) as file:
            plain: dict[str, Any] = json.loads(file.read("outcome.json"))
            if plain.get("schema") != SCHEMA:
                raise SettingError(f"{place}: expected the schema {SCHEMA}, found {plain.get('schema')}")
            experiment = plain.pop("experiment")
            if experiment is not None and "scene" in experiment:
                with np.load(io.BytesIO(file.read("scene.npz")), allow_pickle=False) as arrays:
                    experiment["scene"] = ({name: arrays[name] for name in arrays.files}, experiment["scene"])
            shown = {label: _picture(file.read(f"{label}.png")) for label in plain["last"]}
            both = _picture(file.read("both.png")) if plain["both"] else None
    except (zipfile.BadZipFile, KeyError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise SettingError(f"{place}: expected a file that Outcome.save has written, found another ({error})") from None
    del plain["schema"]
    tables = {name: _table(plain[name]) for name in ("pictures", "stages")}
    last = {surface: shown.get(surface) for surface in plain["surfaces"]}
    subject = tuple(plain["subject"])
    saved: Saved = {**plain, **tables, "last": last, "both": both, "subject": subject}  # type: ignore[typeddict-item]
    return saved, experiment


def _columns(table: Table | None) -> object:
    return None if table is None else table.__reduce__()[1][0]


def _table(columns: list[Any] | None) -> Table | None:
    return None if columns is None else _native.table_of_columns([tuple(column) for column in columns])


def _picture(png: bytes) -> Picture:
    return _native.picture_of_png(png)
