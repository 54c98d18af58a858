"""Tests of figures, limits and comparisons."""

import json
from pathlib import Path

import pytest

import pxpl5


def test_one_latency_figure_is_met() -> None:
    """Figure 9: Slats shows every picture after one field; figure 10: 20 field regions in 11 region times."""
    table = pxpl5.figures(["9", "10"], progress=False)
    row = table.row(0)
    assert (row["id"], row["published"], row["unit"], row["provenance"]) == ("9", 1.0, "fields", "derived")
    assert row["simulated"] == pytest.approx(1.0) and row["misses"] is False
    assert table.row(1)["published"] == 11 and table.row(1)["misses"] is False
    assert {"4b", "19", "R7"} <= set(pxpl5.figure_ids())
    with pytest.raises(pxpl5.SettingError, match="there is no figure `99`; did you mean `9`"):
        pxpl5.figures(["99"])


def test_slats_draws_the_published_110_triangles_with_whole_copies() -> None:
    """The papers' time of a triangle is fitted to figure 12. The analytic level finds the same limit."""
    keys = {"machine": "slats", "copy": "whole", "machine__times": "papers"}
    limit = pxpl5.limit("slats", **keys)
    assert limit.triangles == 110 and limit.first_miss == 111
    assert limit.goal == "no_missed_retrace"
    analytic = pxpl5.limit("slats", level="analytic", **keys)
    assert analytic.triangles == 110


def test_an_unknown_key_of_a_limit_is_refused_with_the_nearest() -> None:
    with pytest.raises(pxpl5.SettingError, match="there is no key `machine.n_gp`; did you mean `machine.n_gps`"):
        pxpl5.limit_over("machine.n_gp", "slats", "mig")


def test_a_model_is_thinned_out_to_its_limit() -> None:
    limit = pxpl5.limit("slats", "mig", machine="slats", level="analytic")
    assert 50 < limit.triangles < 417 and limit.scene == "mig"


@pytest.mark.slow
def test_a_comparison_has_a_row_for_every_pipeline() -> None:
    progress: list[tuple[int, int]] = []
    comparison = pxpl5.compare("full-screen:2", head=pxpl5.Head("pan:200", predict="none"), fields=40, seeds=2,
                               progress=lambda *now: progress.append(now))
    rows = comparison.table.rows()
    names = {row["pipeline"] for row in rows}
    assert {"slats", "rendering-control"} <= names and len(rows) >= 6
    by_name = {row["pipeline"]: row for row in rows}
    assert by_name["slats"]["latency_ms.mean"] < by_name["rendering-control"]["latency_ms.mean"]
    assert progress[-1][0] == progress[-1][1] and "slats" in comparison._repr_html_()


SHORT = {"scene": "full-screen:2", "fields": 24, "seeds": 2, "only": ["slats", "jitp-field", "ideal"], "progress": False}


def short(**keywords: object) -> pxpl5.Comparison:
    return pxpl5.compare(**{**SHORT, **keywords})  # type: ignore[arg-type]


def without_host(comparison: pxpl5.Comparison) -> dict[str, object]:
    """Returns the comparison without the times on the host."""
    return {**comparison.data, "pipelines": [{**row, "host_seconds": 0} for row in comparison.data["pipelines"]]}


def test_an_interrupted_comparison_goes_on_to_the_same_rows(tmp_path: Path) -> None:
    out = tmp_path / "out"
    whole = short(out=out)
    assert json.loads((out / "comparison.json").read_text()) == whole.data
    assert without_host(short()) == without_host(whole), "a folder changes no number"
    # The file after a kill has one complete row and half of a second row.
    rows = out / "rows" / "rows.jsonl"
    lines = rows.read_text().splitlines(keepends=True)
    assert len(lines) == 4
    rows.write_text(lines[0] + lines[1] + lines[2][:100])
    with pytest.raises(pxpl5.SweepError, match="1 of 3 rows of an interrupted comparison are here"):
        short(out=out)
    progress: list[tuple[int, int]] = []
    resumed = short(out=out, resume=True, progress=lambda *now: progress.append(now))
    assert without_host(resumed) == without_host(whole) and progress[-1] == (4, 4), "two rows of two seeds"
    assert rows.read_text().splitlines(keepends=True)[1] == lines[1]
    with pytest.raises(pxpl5.SweepError, match="rows are of another comparison: fields was 24, expected 30"):
        short(out=out, resume=True, fields=30)
    with pytest.raises(pxpl5.SweepError, match="confidence was 0.95, expected 0.9"):
        short(out=out, resume=True, confidence=0.9)
    rows.write_text(lines[0] + "{}\n")
    with pytest.raises(pxpl5.SweepError, match="line 2: expected a row of a comparison"):
        short(out=out, resume=True)
    (tmp_path / "file").write_text("")
    with pytest.raises(pxpl5.SweepError, match="file"):
        short(out=tmp_path / "file")


def test_seeds_are_added_until_the_interval_is_narrow() -> None:
    """The ideal picture is exact, so its interval has the width 0. No other interval becomes as narrow as a thousandth of a pixel."""
    found = short(until_precision="0.001px", max_seeds=4, fields=40)
    assert (found.data["until_precision"], found.data["max_seeds"], found.data["seeds"]) == ("0.001px", 4, [1, 2])
    assert {row["pipeline"]: (row["seeds"], row["is_precise"]) for row in found.data["pipelines"]}["slats"] == (4, False)
    # The interval of a logarithm over two seeds can be hundreds of times as wide as the mean.
    wide = short(until_precision="1000000%", fields=40)
    assert {(row["seeds"], row["is_precise"]) for row in wide.data["pipelines"]} == {(2, True)}
    assert wide.data["max_seeds"] == 50


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"until_precision": "5"}, "until_precision: expected a width above 0 of the interval, .*found `5`"),
        ({"until_precision": "10%", "head": "pan:200"}, "this motion is the same for all seeds"),
        ({"until_precision": "10%", "max_seeds": 1}, "max_seeds: expected a whole number of 2 or more, found 1"),
        ({"max_seeds": 9}, "max_seeds: expected until_precision beside it"),
        ({"resume": True}, "resume: expected the folder out beside it"),
        ({"confidence": 95}, "confidence: expected a number between 0 and 1, found 95"),
        ({"only": ["slat"]}, "did you mean `slats`"),
    ],
)
def test_wrong_comparisons_are_refused(keywords: dict[str, object], words: str) -> None:
    with pytest.raises(pxpl5.SettingError, match=words):
        short(**keywords)


def test_what_there_is_to_choose_from_is_listed() -> None:
    assert "mig" in pxpl5.builtin_scenes() and "small-hmd" in pxpl5.presets() and "hires" in pxpl5.displays()
    names = [row["name"] for row in pxpl5.pipelines().rows()]
    assert "slats" in names and "rendering-control" in names
    assert "fields" in pxpl5.keys() and "latency_ms.mean" in pxpl5.quantities()
