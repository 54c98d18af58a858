"""Tests of machines and their parameters."""

import pytest

import pxpl5


def test_the_machine_of_the_papers_has_13_gps_and_5_renderers() -> None:
    machine = pxpl5.Machine("small-hmd")
    assert (machine.n_gps, machine.n_renderers) == (13, 5)
    word = machine["ring.word_ns"]
    assert (word.value, word.unit, word.provenance) == (50, "ns", "published")
    assert word.source and word.low <= word.value <= word.high


def test_every_parameter_has_a_provenance_a_source_and_a_range() -> None:
    for preset in pxpl5.presets():
        for parameter in pxpl5.Machine(preset).parameters:
            assert parameter.provenance in ("published", "derived", "assumed"), parameter
            assert parameter.source and parameter.low <= parameter.high, parameter


def test_what_is_set_reaches_the_experiment() -> None:
    machine = pxpl5.Machine("slats")
    machine["gp.triangle_ns"] = 20_000
    machine.n_renderers = 7
    experiment = pxpl5.Experiment("slats", "mig", triangles=50, machine=machine)
    values = {parameter.path: parameter.value for parameter in experiment.parameters}
    assert values["gp.triangle_ns"] == 20_000
    assert "n_renderers = 7" in experiment.settings()
    assert machine.changes == {"gp.triangle_ns": 20_000, "n_renderers": 7}


def test_a_wrong_path_names_the_nearest_and_changes_nothing() -> None:
    machine = pxpl5.Machine()
    with pytest.raises(pxpl5.SettingError, match=r"there is no parameter `ring.wrd_ns`; did you mean `ring.word_ns`\?"):
        machine["ring.wrd_ns"] = 40
    with pytest.raises(ValueError, match="small-hmd"):
        pxpl5.Machine("small-hm")
    assert machine == pxpl5.Machine()


def test_a_value_that_no_source_allows_is_a_warning() -> None:
    machine = pxpl5.Machine("small-hmd", {"gp.triangle_ns": 100_000})
    assert any(warning.startswith("gp.triangle_ns = 100000 ns is outside its range") for warning in machine.warnings)


def test_a_machine_shows_itself() -> None:
    machine = pxpl5.Machine()
    assert "ring.word_ns" in machine._repr_html_() and "13 GPs" in repr(machine)
    table = machine.table()
    assert len(table) == len(machine) and table.names[:2] == ["path", "value"]
    assert "least value that the sources allow" in table.definitions["low"]
