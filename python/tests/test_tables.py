"""Tests of tables and of the Arrow PyCapsule interface."""

import numpy as np
import pytest

import pxpl5

pyarrow = pytest.importorskip("pyarrow")


def test_pyarrow_takes_a_table_as_it_is(mig: pxpl5.Outcome) -> None:
    table = pyarrow.table(mig.pictures)
    assert table.schema.field("shown_at_ps").type == pyarrow.int64()
    assert table.schema.field("shown_at_ps").metadata[b"about"].startswith(b"the retrace from which on it is shown")
    assert table.num_rows == len(mig.pictures) > 4
    shown = np.array(table["shown_at_ps"]) - np.array(table["transform_at_ps"])
    complete = table["complete"].to_numpy() == 1
    assert np.array_equal(shown[complete], table["latency_ps"].drop_null().to_numpy())


def test_latencies_of_the_table_are_those_of_the_report(mig: pxpl5.Outcome) -> None:
    """Compares with an independent mean over the steady, complete pictures."""
    pictures = mig.pictures
    kept = (pictures["steady"] == 1) & (pictures["complete"] == 1)
    assert pictures["latency_ps"][kept].mean() / 1e9 == pytest.approx(mig.latency_ms.mean, rel=1e-12)
    assert kept.sum() == mig.latency_ms.n


def test_pandas_polars_and_duckdb_take_a_table_as_it_is(mig: pxpl5.Outcome) -> None:
    duckdb = pytest.importorskip("duckdb")
    polars = pytest.importorskip("polars")
    pandas = pytest.importorskip("pandas")
    pictures = mig.pictures
    assert polars.DataFrame(pictures)["picture"].to_list() == list(pictures["picture"])
    from_arrow = getattr(pandas.DataFrame, "from_arrow", None)
    frame = from_arrow(pictures) if from_arrow else pyarrow.table(pictures).to_pandas()
    assert frame["shown_at_ps"].tolist() == list(pictures["shown_at_ps"])
    rows = duckdb.sql("select count(*), sum(complete) from pictures").fetchall()[0]
    assert rows == (len(pictures), int(pictures["complete"].sum()))


def test_the_first_rows_are_a_table(mig: pxpl5.Outcome) -> None:
    pictures = mig.pictures
    head = pictures.head(3)
    assert head.rows() == list(pictures)[:3] == [row for row in head]
    assert len(pictures.head()) == 5 and pictures.head(10**6).rows() == pictures.rows()
    assert head.definitions == pictures.definitions
    with pytest.raises(pxpl5.SettingError, match="expected a whole number of 0 or more, found -1"):
        pictures.head(-1)


def test_a_slice_of_a_table_is_that_of_its_list_of_rows(mig: pxpl5.Outcome) -> None:
    pictures = mig.pictures
    rows = pictures.rows()
    for part in (slice(2, 5), slice(-3, None), slice(None, 2), slice(None), slice(7, 3), slice(10**6, None)):
        assert pictures[part].rows() == rows[part]
    assert pictures[1:3].definitions == pictures.definitions and pyarrow.table(pictures[1:3]).num_rows == 2
    assert list(pictures[2:5]["picture"]) == list(pictures["picture"][2:5])
    with pytest.raises(pxpl5.SettingError, match="a slice of a table: expected the step 1, found 2"):
        pictures[::2]


def test_what_is_missing_is_null_and_nan(mig: pxpl5.Outcome) -> None:
    """During the warm-up a picture has no parts of its latency."""
    pictures = mig.pictures
    assert pictures.row(0)["render_ps"] is None and np.isnan(pictures["render_ps"][0])
    assert pictures["picture"].dtype == np.int64
    assert pyarrow.table(pictures)["render_ps"].null_count >= 4


def test_a_stage_ends_after_its_begin(mig: pxpl5.Outcome) -> None:
    stages = mig.stages
    ended = ~np.isnan(stages["end_ps"].astype(float))
    assert (stages["end_ps"][ended] >= stages["begin_ps"][ended]).all()
    assert {"transform", "render", "copy"} <= set(stages["stage"])


def test_events_are_in_the_order_of_time_and_name_their_boards(mig: pxpl5.Outcome) -> None:
    events = mig.events
    assert (np.diff(events["time_ps"]) >= 0).all()
    assert {"GP 0", "renderer 0", "display 0"} <= set(events["board"])
    begun = [row for row in events if row["event"].lower().startswith("begin of transform")]
    assert begun and all(row["picture"] is not None for row in begun)


def test_unknown_columns_and_rows_are_refused(mig: pxpl5.Outcome) -> None:
    with pytest.raises(KeyError, match="there is no column `colour`; expected picture, steady"):
        mig.pictures["colour"]
    with pytest.raises(IndexError, match="expected a row below"):
        mig.pictures.row(10_000)


def test_a_notebook_sees_the_first_rows_escaped() -> None:
    from pxpl5._tables import table_of

    table = table_of([{"name": "<b>", "value": 1.5, "nested": {"list": [1]}}] * 50, {"name": "a & b"})
    html = table._repr_html_()
    assert "&lt;b&gt;" in html and "a &amp; b" in html and "and 10 more rows" in html
    assert table.names == ["name", "value", "nested.list"] and table.row(0)["nested.list"] == "[1]"
