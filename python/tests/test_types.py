"""Tests that dictionaries and rows have their types: each key exists, and its value has the type of the key."""

import re
from pathlib import Path
from typing import Any, get_args, is_typeddict

import numpy as np
import pytest

import pxpl5
import pxpl5.result_types
from pxpl5 import _fits, _native, _report_types, _rows, _study_types, _types
from pxpl5._lab import Made


def misfits(value: object, hint: object, place: str = "") -> list[str]:
    return _fits.misfits(value, hint, place, exact=True)


def check_rows(table: pxpl5.Table, row: type) -> None:
    found = table.rows()
    assert found, row.__name__
    assert [error for one in found for error in misfits(one, row, row.__name__)] == []
    assert set(table.names) == row.__required_keys__, row.__name__  # type: ignore[attr-defined]


def test_the_check_finds_what_is_wrong() -> None:
    good: dict[str, object] = {"key": "fields", "a": None, "b": 3, "percent": 1}
    assert misfits(good, _types.ChangedData) == []
    assert misfits({**good, "percent": "1"}, _types.ChangedData) and misfits({**good, "key": True}, _types.ChangedData)
    assert misfits({**good, "c": 1}, _types.ChangedData) and misfits({"key": "fields"}, _types.ChangedData)
    assert misfits([1.5, 2, None], list[float | None]) == [] and misfits([1.5, "2"], list[float]) and misfits({"a": True}, dict[str, int])


EXPERIMENTS: dict[str, dict[str, Any]] = {
    "slats": {"pipeline": "slats", "scene": "mig", "triangles": 100},
    "too heavy": {"pipeline": "slats", "scene": "mig"},
    "head": {"pipeline": "rendering-control", "scene": "mig", "head": "pan:100"},
    "kalman": {"pipeline": "jitp-scanline-racing", "scene": "full-screen:4", "head": pxpl5.Head("synthetic:1", tracker="fastrak", predict="kalman")},
    "faces": {"pipeline": "arp-priority", "scene": "room", "head": "pan:100"},
    "reprojection": {"pipeline": "slats", "scene": "full-screen:4", "head": "pan:100", "settings": {"head.raster": "depth"}},
    "frameless": {"pipeline": "frameless", "scene": "full-screen:1", "fields": 24, "pixels": "off"},
}


@pytest.mark.parametrize("name", EXPERIMENTS)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_reports_have_their_types(name: str) -> None:
    experiment = pxpl5.Experiment(**{"fields": 60, **EXPERIMENTS[name]})
    outcome = experiment.run(progress=False)
    assert misfits(dict(outcome.report), _report_types.ReportData, "report") == []
    if outcome.pixel_errors is not None:
        assert misfits(outcome.pixel_errors, _report_types.PixelErrorsData, "pixel_errors") == []
    assert misfits(experiment._native.parameters(), list[_study_types.ParameterData], "parameters") == []
    for table, row in ((outcome.pictures, _rows.PictureRow), (outcome.stages, _rows.StageRow), (outcome.events, _rows.EventRow)):
        if len(table):
            check_rows(table, row)
    check_rows(outcome.boards, _rows.BoardRow)
    check_rows(experiment.parameter_table(), _rows.ParameterRow)


def test_columns_of_an_outcome_have_their_kinds(mig: pxpl5.Outcome) -> None:
    """The literals for type checkers are the columns of the three tables."""
    tables = [mig.pictures, mig.stages, mig.events]
    numbers = {name for table in tables for name in table.names if isinstance(table[name], np.ndarray)}
    texts = {name for table in tables for name in table.names if isinstance(table[name], list)}
    assert numbers == set(get_args(_rows.NumberColumn)) and texts == set(get_args(_rows.TextColumn))


def test_states_of_boards_have_their_types() -> None:
    stepper = pxpl5.Experiment("rendering-control", "mig", fields=20).stepper()
    for field in range(1, 8):
        stepper.run_to_field(field)
        stepper.step_event("renderer 0")
        for name in ("gp 0", "gp 1", "host"):
            assert misfits(stepper.board(name), _types.ProcessorState | None, name) == []
        assert misfits(stepper.board("renderer 0"), _types.RendererState, "renderer") == []
        assert misfits(stepper.last_event, _types.EventState | None, "event") == []
        assert misfits(stepper._native.channels(), list[_rows.ChannelRow], "channels") == []


def test_lists_of_the_library_have_their_types() -> None:
    assert misfits(_native.machine_parameters("small-hmd", {"n_gps": 20}), _study_types.MachineData) == []
    assert misfits(_native.pipelines(), list[_study_types.PipelineData]) == []
    assert misfits(_native.tracking_parameters(), list[_study_types.ParameterData]) == []
    assert misfits(_native.levels(), _study_types.LevelRecordData) == []
    check_rows(pxpl5.pipelines(), _rows.PipelineRow)
    check_rows(pxpl5.levels(), _rows.LevelRow)


def test_results_of_studies_have_their_types(slats: pxpl5.Outcome) -> None:
    figures = [_native.figure(number) for number in ("1", "4b", "9", "16")]
    assert misfits(figures, list[_study_types.FigureData]) == []
    check_rows(pxpl5.figures(["9", "10"], progress=False), _rows.FigureRow)
    made = Made()
    made.put_all("slats", "mig", "slats", None, {"level": "analytic"})
    assert misfits(_native.limit(made.settings, of_scene=True), _study_types.LimitData) == []
    over = _native.limit_over(made.settings, "machine.n_gps", low=2.0, high=6.0, fields=20)
    assert misfits(over, _study_types.OverLimitData) == []
    experiment = pxpl5.Experiment("rendering-control", "full-screen:2", fields=30)
    check_rows(experiment.what_if(), _rows.WhatIfRow)
    difference = experiment.run(progress=False).diff(slats)
    check_rows(difference.settings, _rows.SettingRow)
    check_rows(difference.results, _rows.ResultRow)
    check_rows(difference.pictures, _rows.PictureDifferenceRow)


def test_a_comparison_has_its_type() -> None:
    only = ["slats", "ideal", "jitp-field", "arp-priority"]
    found = pxpl5.compare("full-screen:2", fields=40, seeds=2, only=only, progress=False)
    assert misfits(found.data, _study_types.ComparisonData, "comparison") == []


def test_sweeps_volumes_and_profiles_have_their_types() -> None:
    space = pxpl5.SweepSpace({"pipeline": "slats", "scene": "mig", "fields": 20}, {"triangles": [20, 40], "seed": pxpl5.Range(1, 2)})
    assert misfits(space.header(), _study_types.SweepHeaderData) == []
    assert misfits(pxpl5.draw_volume("mig").report(), _study_types.VolumeData) == []
    assert misfits(_native.volume_figures([pxpl5.Scene.builtin("mig")]), _study_types.VolumeFiguresData) == []
    check_rows(pxpl5.volume_figures(["mig"], progress=False), _rows.VolumeFigureRow)
    processor = pxpl5.Processor(pxpl5.assemble("start: mov 3, r5\nend: nop\n"))
    processor.run()
    assert misfits(processor.profile(), _study_types.ProfileData) == []


@pytest.mark.slow
def test_interpretations_have_their_types() -> None:
    assert misfits(_native.interpretations(1, 1, 20), _study_types.InterpretationsData) == []
    check_rows(pxpl5.interpretations(best=1, seeds=1, frames=20, progress=False), _rows.InterpretationRow)


def test_no_signature_has_the_type_any() -> None:
    places = [*Path(str(pxpl5.__file__)).parent.glob("*.py"), *Path(str(pxpl5.__file__)).parent.glob("*.pyi")]
    assert [place.name for place in places if re.search(r"\bAny\b", place.read_text(encoding="utf-8"))] == []


def test_a_table_has_the_type_of_its_rows() -> None:
    """At run time the type is only an annotation."""
    assert get_args(pxpl5.Table[dict[str, float]]) == (dict[str, float],)


def test_all_types_can_be_imported_and_say_what_they_are() -> None:
    modules = (_report_types, _rows, _study_types, _types)
    found = {name for module in modules for name, thing in vars(module).items() if is_typeddict(thing)}
    assert found <= set(pxpl5.result_types.__all__)
    undescribed = {name for name in found if "dict(" in (getattr(pxpl5.result_types, name).__doc__ or "dict(")}
    assert undescribed == {"WhatIfData", "WhatIfRow", "LevelRow"}, "a type with points in its keys can have no docstring"
