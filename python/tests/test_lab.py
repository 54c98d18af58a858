"""Figures, limits, comparison."""

import pytest

import pxpl5


def test_one_latency_figure_is_met() -> None:
    """Figure 9: Slats shows every picture after one field; figure 10: 20 field regions in 11 region times."""
    table = pxpl5.figures(["9", "10"], progress=False)
    row = table.row(0)
    assert (row["id"], row["published"], row["unit"], row["provenance"]) == ("9", 1.0, "fields", "free")
    assert row["simulated"] == pytest.approx(1.0) and row["misses"] is False
    assert table.row(1)["published"] == 11 and table.row(1)["misses"] is False
    assert len(pxpl5.figure_ids()) == 26
    with pytest.raises(pxpl5.SettingError, match="there is no figure 99; expected one of 1, 2"):
        pxpl5.figures(["99"])


def test_slats_draws_the_published_110_triangles_with_whole_copies() -> None:
    """Figure 12, to which the time of a triangle is fitted; the analytic level finds the same."""
    limit = pxpl5.limit("slats", machine="slats", copy="whole")
    assert limit.triangles == 110 and limit.first_miss == 111
    assert limit.goal == "no_missed_retrace"
    analytic = pxpl5.limit("slats", machine="slats", copy="whole", level="analytic")
    assert analytic.triangles == 110


def test_a_model_is_thinned_out_to_its_limit() -> None:
    limit = pxpl5.limit("slats", "mig", machine="slats", level="analytic")
    assert 50 < limit.triangles < 417 and limit.scene == "mig"


@pytest.mark.slow
def test_a_comparison_has_a_row_for_every_pipeline() -> None:
    told: list[tuple[int, int]] = []
    comparison = pxpl5.compare("full-screen:2", head=pxpl5.Head("pan:200", predict="none"), fields=40, seeds=2,
                               progress=lambda *now: told.append(now))
    rows = comparison.table.rows()
    names = {row["pipeline"] for row in rows}
    assert {"slats", "rendering-control"} <= names and len(rows) >= 6
    by_name = {row["pipeline"]: row for row in rows}
    assert by_name["slats"]["latency_ms.mean"] < by_name["rendering-control"]["latency_ms.mean"]
    assert told[-1][0] == told[-1][1] and "slats" in comparison._repr_html_()


def test_what_there_is_to_choose_from_is_listed() -> None:
    assert "mig" in pxpl5.builtin_scenes() and "small-hmd" in pxpl5.presets() and "hires" in pxpl5.displays()
    names = [row["name"] for row in pxpl5.pipelines().rows()]
    assert "slats" in names and "rendering-control" in names
    assert "fields" in pxpl5.keys() and "latency_ms.mean" in pxpl5.quantities()
