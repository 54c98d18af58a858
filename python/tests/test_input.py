"""Tests of user input: arrays of any kind, wrong names and wrong numbers."""

import numpy as np
import pytest

import pxpl5

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


@pytest.mark.parametrize("kind", [list, tuple, np.float32, np.int16, np.float16])
def test_anything_that_numpy_takes_makes_the_same_scene(kind: type) -> None:
    expected = pxpl5.Scene.from_arrays(np.array(CORNERS, dtype=float), np.array(FACES), fit=False)
    vertices = kind(CORNERS) if kind in (list, tuple) else np.array(CORNERS, dtype=kind)
    triangles = kind(FACES) if kind in (list, tuple) else np.array(FACES, dtype=kind)
    found = pxpl5.Scene.from_arrays(vertices, triangles, fit=False)
    assert np.array_equal(found.vertices, expected.vertices) and np.array_equal(found.triangles, FACES)


def test_the_arrays_of_a_scene_make_it_again() -> None:
    mig = pxpl5.Scene.builtin("mig")
    again = pxpl5.Scene.from_arrays(mig.vertices, mig.triangles, normals=mig.normals, colours=mig.colours, fit=False)
    assert np.array_equal(again.vertices, mig.vertices) and np.array_equal(again.triangles, mig.triangles)
    assert np.array_equal(again.colours, mig.colours)


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"triangles": [[0, 1, 1.5]]}, "triangles: expected whole numbers, found numbers with a fraction"),
        ({"triangles": [[0, 1, float("nan")]]}, "triangles: expected whole numbers"),
        ({"triangles": "abc"}, "triangles: expected an array of numbers, found elements of type <U3"),
        ({"triangles": [[0, 1], [0]]}, "triangles: expected an array of numbers, found list"),
        ({"vertices": [1, 2, 3]}, r"vertices: expected shape \(n, 3\), found \(3,\)"),
        ({"vertices": [None, None]}, "vertices: expected an array of numbers, found elements of type object"),
        ({"colours": [[0, 0, 256]] * 4}, "colours, row 0: expected 0 to 255, found 256"),
        ({"colours": [[0, 0, 0]]}, "colours: expected 4"),
        ({"spheres": [[0, 0, 0]]}, r"spheres: expected shape \(n, 4\), found \(1, 3\)"),
    ],
)
def test_wrong_arrays_are_refused_in_words(keywords: dict[str, object], words: str) -> None:
    given = {"vertices": CORNERS, "triangles": FACES, **keywords}
    with pytest.raises(pxpl5.SettingError, match=words):
        pxpl5.Scene.from_arrays(**given)  # type: ignore[arg-type]


def test_motions_and_pictures_take_lists() -> None:
    motion = pxpl5.Motion.from_arrays([0, 1, 2], [[0, 0, 0]] * 3, [[1, 0, 0, 0]] * 3, end="hold")
    assert motion.poses([0, 0.5]).shape == (2, 7)
    with pytest.raises(pxpl5.SettingError, match="times_s: expected 0 to .* seconds, found -1"):
        motion.poses([-1])
    picture = pxpl5.Picture([[[1, 2, 3], [4, 5, 255]]])
    assert picture.array.tolist() == [[[1, 2, 3], [4, 5, 255]]]
    with pytest.raises(pxpl5.SettingError, match="with integers from 0 to 255, found"):
        pxpl5.Picture([[[1, 2, 256]]])


def test_a_misspelled_attribute_names_the_nearest() -> None:
    machine = pxpl5.Machine()
    with pytest.raises(pxpl5.UnknownNameError, match="Machine has no attribute n_gpus; did you mean n_gps"):
        machine.n_gpus = 3  # type: ignore[attr-defined]
    assert machine.n_gps == 13
    experiment = pxpl5.Experiment("slats", "mig", triangles=60, fields=30)
    with pytest.raises(AttributeError, match="Experiment has no attribute field; did you mean fields"):
        experiment.field = 3  # type: ignore[attr-defined]
    with pytest.raises(AttributeError):
        experiment.fields = 3  # type: ignore[misc]
    for thing in (pxpl5.Scene.builtin("full-screen:1"), pxpl5.Motion("still"), pxpl5.Head("still")):
        with pytest.raises(AttributeError):
            thing.colour = 3  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: pxpl5.Head("pan:100", traker="ideal"), "Head: there is no keyword traker; did you mean tracker?"),
        (lambda: pxpl5.SweepSpace({}, sedes=2), "SweepSpace: there is no keyword sedes; did you mean seeds?"),
        (lambda: pxpl5.Range(1, 2, stepp=1), "Range: there is no keyword stepp; did you mean step?"),
        (lambda: pxpl5.Machine(prest="slats"), "Machine: there is no keyword prest; did you mean preset?"),
        (lambda: pxpl5.Experiment.from_text("", setings={}), "there is no keyword setings; did you mean settings?"),
        (lambda: pxpl5.Experiment("slats", "mig").run(thread=1), "Experiment.run: there is no keyword thread; did you mean threads?"),
        (lambda: pxpl5.figures("9", levl="cycle"), "figures: there is no keyword levl; did you mean level?"),
        (lambda: pxpl5.draw_volume("mig", display__wdth=64), "did you mean `display.width`"),
        (lambda: pxpl5.limit("slats", traker="ideal"), "there is no key `traker`"),
    ],
)
def test_a_wrong_keyword_is_refused_with_the_nearest(call, words: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(pxpl5.SettingError) as raised:
        call()
    assert words in str(raised.value)


def test_a_timeline_outside_of_the_run_is_refused(slats: pxpl5.Outcome) -> None:
    fields, last = slats.report["fields"], max(slats.pictures["picture"])
    assert slats.timeline(first_field=fields - 1, picture=int(last)).svg.startswith("<svg")
    with pytest.raises(pxpl5.SettingError, match=f"first_field: expected 0 to {fields - 1}, found {fields}"):
        slats.timeline(first_field=fields)
    with pytest.raises(pxpl5.SettingError, match=rf"picture: expected \d+ to {last}, found {last + 1}"):
        slats.timeline(picture=int(last) + 1)


def test_a_parameter_that_is_no_number_is_refused_in_words() -> None:
    machine = pxpl5.Machine()
    for wrong in ("fast", None, [1]):
        with pytest.raises(pxpl5.SettingError, match="gp.triangle_ns: expected a number, found") as raised:
            machine["gp.triangle_ns"] = wrong  # type: ignore[assignment]
        assert "enum" not in str(raised.value) and "extract" not in str(raised.value)
    with pytest.raises(pxpl5.SettingError, match="n_gps"):
        machine.n_gps = -1


def test_a_text_is_one_name_and_not_a_list_of_letters() -> None:
    experiment = pxpl5.Experiment("slats", "mig", triangles=60, fields=30, measure="latency_ms.mean")
    assert list(experiment.measure()) == ["latency_ms.mean"]
    assert len(pxpl5.figures("9", progress=False)) == 1
    with pytest.raises(pxpl5.SettingError, match="measure: expected names, found 3"):
        pxpl5.Experiment("slats", "mig", measure=["latency_ms.mean", 3])  # type: ignore[list-item]


@pytest.mark.parametrize(
    "wrong",
    [
        lambda outcome: outcome.seen(-1),
        lambda outcome: outcome.timeline(picture=-1),
        lambda outcome: outcome.timeline(fields=0),
        lambda outcome: outcome.pixel_memory(-1),
        lambda outcome: outcome.pixel_memory("first"),
        lambda outcome: pxpl5.limit("slats", fields=-1),
        lambda outcome: pxpl5.compare("mig", seeds=0),
        lambda outcome: pxpl5.compare("mig", seeds=[-1]),
        lambda outcome: pxpl5.Experiment("slats", "mig", fields=30).run(threads=-1),
        lambda outcome: pxpl5.SweepSpace({"pipeline": "slats", "scene": "mig"}, seeds=-1),
    ],
)
def test_a_negative_number_is_refused_with_its_name(slats: pxpl5.Outcome, wrong) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(pxpl5.SettingError, match=r"^\w+: expected a whole number"):
        wrong(slats)


def test_negative_fields_are_refused_in_the_words_of_the_library() -> None:
    with pytest.raises(pxpl5.SettingError, match="fields"):
        pxpl5.Experiment("slats", "mig", fields=-1)


def test_tables_are_made_of_rows_and_go_elsewhere(tmp_path: object) -> None:
    table = pxpl5.Table.from_rows([{"a": 1, "b": {"c": np.float64(2.5)}}, {"a": None, "b": {"c": float("nan")}}], {"a": "a number"})
    assert [dict(row) for row in table] == [{"a": 1, "b.c": 2.5}, {"a": None, "b.c": None}]
    assert "a" in table and "d" not in table and table.definitions["a"] == "a number"
    with pytest.raises(pxpl5.SettingError, match="row 1: expected a dictionary, found int"):
        pxpl5.Table.from_rows([{"a": 1}, 3])  # type: ignore[list-item]
    with pytest.raises(pxpl5.SettingError, match="rows: expected numbers, texts"):
        pxpl5.Table.from_rows([{"a": object()}])


def test_tables_become_frames_and_files(tmp_path) -> None:  # type: ignore[no-untyped-def]
    parquet = pytest.importorskip("pyarrow.parquet")
    pytest.importorskip("pandas")
    pytest.importorskip("polars")
    table = pxpl5.Table.from_rows([{"n": 1, "x": 0.5, "name": "a"}, {"n": 2, "x": None, "name": "b"}], {"n": "a number"})
    assert table.to_pandas()["n"].tolist() == [1, 2]
    assert table.to_polars()["x"].to_list() == [0.5, None]
    table.to_parquet(tmp_path / "table.parquet")
    read = parquet.read_table(tmp_path / "table.parquet")
    assert read.to_pylist() == table.rows() and read.schema.field("n").metadata[b"about"] == b"a number"


def test_notebooks_show_scenes_motions_and_experiments() -> None:
    assert "417" in pxpl5.Scene.builtin("mig")._repr_html_()
    html = pxpl5.Motion("pan:90")._repr_html_()
    # 90 degrees a second: half a turn after 2 s.
    assert "pan:90" in html and "180.0 degrees in 10.0 s" in html and "<polyline" in html
    html = pxpl5.Experiment("slats", "mig", triangles=60)._repr_html_()
    assert "triangles = 60" in html and "slats" in html
