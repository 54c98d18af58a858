"""Tests of answers about a run: its limiting resource, the effect of more resources, differences, and runs that show nothing."""

import warnings

import pytest

import pxpl5


def leaves(value: object) -> list[object]:
    """Returns all values of nested dictionaries and lists."""
    if isinstance(value, dict):
        return [leaf for entry in value.values() for leaf in leaves(entry)]
    if isinstance(value, list):
        return [leaf for entry in value for leaf in leaves(entry)]
    return [value]


def test_a_run_that_shows_nothing_warns_and_has_no_nan() -> None:
    """The aircraft has 417 triangles, and the published limit of Slats is 140 (TR94)."""
    with pytest.warns(RuntimeWarning, match=r"TOO HEAVY: with 417 primitives .* about \d+ primitives would be in time"):
        outcome = pxpl5.Experiment("slats", "mig").run(progress=False)
    assert outcome.latency_ms.n == 0 and outcome.latency_ms.mean is None and outcome.latency_fields.sd is None
    assert not any(leaf != leaf for leaf in leaves(outcome.report))
    assert not any(value != value for value in outcome.quantities().values())
    html = outcome._repr_html_()
    # The data of the picture are random text, which can contain "nan".
    html = html.split("<img")[0]
    assert html.startswith("<p><strong>Warning:</strong> TOO HEAVY") and "nan" not in (html + repr(outcome)).lower()
    assert "latency" in html[: html.index("schema")]
    copy = outcome.advice
    assert copy is not None and "would be in time" in copy


@pytest.mark.parametrize("pipeline", ["jitp-field", "jitp-scanline-racing", "jitp-dual-view-racing"])
def test_just_in_time_pixels_of_the_aircraft_have_no_nan(pipeline: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        outcome = pxpl5.Experiment(pipeline, "mig", fields=40).run(progress=False)
    assert not any(leaf != leaf for leaf in leaves(outcome.report))
    assert "nan" not in (repr(outcome) + outcome.report._repr_html_()).lower()


def test_a_run_in_time_gives_no_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        outcome = pxpl5.Experiment("slats", "mig", triangles=60, fields=30).run(progress=False)
    assert outcome.advice is None


def test_discarded_records_are_refused_instead_of_truncated() -> None:
    experiment = pxpl5.Experiment("slats", "mig", triangles=20, fields=6_000, pixels="off")
    short = experiment.run(progress=False, keep="statistics")
    whole = experiment.run(progress=False)
    assert short.trace_hash == whole.trace_hash and short.has_discarded_records
    for read in (lambda: short.pictures, lambda: short.stages, short.timeline, short.page):
        with pytest.raises(pxpl5.DiscardedError, match='expected a run with keep="everything"'):
            read()
    assert len(whole.pictures) > 5_000 and not whole.has_discarded_records


def test_the_boards_of_a_run_and_its_path_name_the_ports(mig: pxpl5.Outcome) -> None:
    """COPY of the Mig uses both frame buffers in turn. The port of each is busy for 47 % of the time."""
    ports = [row for row in mig.boards if row["activity"] == "receiving"]
    assert [row["board"] for row in ports] == ["left frame buffer", "right frame buffer"]
    assert all(row["mean"] == pytest.approx(0.47, abs=0.01) for row in ports)
    path = mig.critical_path
    assert path is not None and path["parts"][0]["resource"] == "ports" and "COPY" in path["limited_by"]
    found = mig.utilisation
    assert found is not None and found["ring"]["capacity"] == 160e6
    assert mig.quantity("renderer_busy.max") == pytest.approx(found["renderers"]["executing"]["max"], rel=1e-9)


def test_more_of_a_resource_has_the_effect_of_an_experiment_with_more() -> None:
    table = pxpl5.Experiment("rendering-control", "mig", fields=60).what_if()
    rows = {row["key"]: row for row in table}
    ring = rows["machine.ring.word_ns"]
    # 50 ns / 1.1 = 45.5 ns, rounded up.
    assert (ring["from"], ring["to"]) == (50, 46)
    # Two experiments at the level of the row give the same results.
    found = []
    for word_ns in (50, 46):
        machine = pxpl5.Machine("small-hmd", {"ring.word_ns": word_ns})
        keywords = {"machine": machine, "fields": 60, "level": ring["level"], "measure": "latency_ms.mean"}
        found.append(pxpl5.Experiment("rendering-control", "mig", **keywords).measure()["latency_ms.mean"])  # type: ignore[arg-type]
    assert [ring["latency_ms.before"], ring["latency_ms.after"]] == found
    assert len(rows) == 6 and "10 % better" in table.definitions["to"]


def test_the_least_number_of_renderers_is_found() -> None:
    """Slats binds 20 regions, four to a renderer: five renderers are the fewest."""
    found = pxpl5.limit_over("machine.n_renderers", "slats", "typical:40", latency_fields=1.01, fields=30, high=8)
    assert (found.least, found.most, found.reached, found.low, found.high) == (5, None, True, 1, 8)
    assert found.tried[0] == (1.0, False) and found.goal == {"latency_fields": 1.01}
    with pytest.raises(pxpl5.SettingError, match="rate_hz: expected a number above 0, found -1"):
        pxpl5.limit_over("machine.n_gps", "slats", "mig", rate_hz=-1)
    with pytest.raises(pxpl5.SettingError, match="low and high: range: expected a least value below the greatest, found 5 to 5"):
        pxpl5.limit_over("machine.n_gps", "slats", "mig", low=5, high=5)
    with pytest.raises(pxpl5.SettingError, match="fields: expected a whole number of 10 or more, found -3"):
        pxpl5.limit_over("machine.n_gps", "slats", "mig", fields=-3)


def test_two_outcomes_are_compared_number_by_number(slats: pxpl5.Outcome, mig: pxpl5.Outcome) -> None:
    found = slats.diff(mig)
    settings = {row["key"]: row for row in found.settings}
    assert (settings["pipeline"]["a"], settings["pipeline"]["b"]) == ("slats", "rendering-control")
    results = {row["key"]: row for row in found.results}
    a, b = slats.latency_ms.mean, mig.latency_ms.mean
    assert a is not None and b is not None
    assert results["latency_ms.mean"]["percent"] == pytest.approx((b / a - 1) * 100)
    assert not found.same_trace and {row["surface"] for row in found.pictures} == {"left", "right"}
    assert "rendering-control" in found._repr_html_()
    with pytest.raises(pxpl5.SettingError, match="other: expected an Outcome, found str"):
        slats.diff("mig")  # type: ignore[arg-type]


@pytest.mark.slow
def test_the_rig_agrees_with_the_time_stamps() -> None:
    found = pxpl5.rig("slats", tracker="fastrak", passes=6)
    assert found["agrees"] and found["outside_ms"]["total"]["n"] == 6
    assert found["inside_ms"]["total"]["mean"] > 0
    with pytest.raises(pxpl5.SettingError, match="fields: expected no such setting"):
        pxpl5.rig("slats", fields=10)
    with pytest.raises(pxpl5.SettingError, match="passes: expected a whole number of 2 or more"):
        pxpl5.rig("slats", passes=1)


def test_the_recorded_levels_are_a_table() -> None:
    rows = pxpl5.levels().rows()
    assert {row["level"] for row in rows} == {"analytic", "transaction", "cycle"}
    cycle = [row for row in rows if row["level"] == "cycle"]
    assert len(cycle) == 1


def test_the_version_is_that_of_the_report(mig: pxpl5.Outcome) -> None:
    assert pxpl5.__version__ == mig.report["version"]
