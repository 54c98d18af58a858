"""Tests of scenes: built in, from files, from arrays."""

from pathlib import Path

import numpy as np
import pytest

import pxpl5


def test_the_mig_has_the_published_417_triangles() -> None:
    scene = pxpl5.Scene.builtin("mig")
    assert scene.triangles.shape == (417, 3) and scene.triangles.dtype == np.uint32
    assert scene.vertices.dtype == np.float32 and scene.vertices.shape[1] == 3
    assert np.allclose(np.linalg.norm(scene.normals, axis=1), 1, atol=1e-3)


def test_arrays_come_back_as_they_were_given() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    triangles = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    colours = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]], dtype=np.uint8)
    scene = pxpl5.Scene.from_arrays(vertices, triangles, colours=colours, fit=False)
    assert np.array_equal(scene.vertices, vertices) and np.array_equal(scene.triangles, triangles)
    assert np.array_equal(scene.colours, colours)


def test_a_fitted_scene_has_the_size_of_imported_models() -> None:
    """The scene is centred and its farthest point is 0.148 m away, as for imported files."""
    vertices = np.array([[10, 0, 0], [30, 0, 0], [20, 10, 0]], dtype=float)
    scene = pxpl5.Scene.from_arrays(vertices, np.array([[0, 1, 2]]))
    box = (scene.vertices.min(axis=0) + scene.vertices.max(axis=0)) / 2
    assert np.allclose(box, 0, atol=1e-6)
    assert np.linalg.norm(scene.vertices, axis=1).max() == pytest.approx(0.148, rel=1e-5)


def test_a_scene_of_arrays_is_drawn_as_its_file(tmp_path: Path) -> None:
    """The same model through the OBJ importer and through NumPy gives the same pixels."""
    rows = ["v -1 -1 0", "v 1 -1 0", "v 1 1 0", "v -1 1 0.5", "f 1 2 3", "f 1 3 4"]
    (tmp_path / "model.obj").write_text("\n".join(rows) + "\n")
    read = pxpl5.Scene.load(tmp_path / "model.obj")
    made = pxpl5.Scene.from_arrays(read.vertices.astype(float), read.triangles.astype(np.int64), fit=False, colours=read.colours,
                                   normals=read.normals.astype(float))
    pictures = [pxpl5.Experiment("rendering-control", scene, fields=50).run().picture() for scene in (read, made)]
    assert pictures[0] is not None and pictures[1] is not None
    assert np.array_equal(pictures[0].array, pictures[1].array)


@pytest.mark.parametrize(
    ("vertices", "triangles", "words"),
    [
        (np.zeros((3, 2)), np.zeros((1, 3), dtype=np.int64), r"vertices: expected shape \(n, 3\), found \(3, 2\)"),
        (np.zeros((3, 3)), np.array([[0, 1, 3]]), "triangle 0: expected an index of one of 3 vertices, found 3"),
        (np.zeros((3, 3)), np.array([[0, 1, -1]]), "found -1"),
        (np.full((3, 3), np.nan), np.array([[0, 1, 2]]), "a finite position"),
    ],
)
def test_wrong_arrays_are_refused_with_what_was_expected(
    vertices: np.ndarray, triangles: np.ndarray, words: str
) -> None:
    with pytest.raises(pxpl5.SettingError, match=words):
        pxpl5.Scene.from_arrays(vertices, triangles)


def test_a_missing_file_is_refused_with_its_name() -> None:
    with pytest.raises(pxpl5.SettingError, match="nowhere.ply: expected a readable file"):
        pxpl5.Scene.load("nowhere.ply")


def test_spheres_are_drawn() -> None:
    none = np.zeros((0, 3))
    scene = pxpl5.Scene.from_arrays(none, none.astype(np.int64), spheres=np.array([[0, 0, 0, 1.0]]),
                                    sphere_colours=np.array([[255, 0, 0]], dtype=np.uint8))
    picture = pxpl5.Experiment("rendering-control", scene, fields=50).run().picture()
    assert picture is not None
    red = picture.array[..., 0] > picture.array[..., 2]
    assert 1_000 < red.sum() < 640 * 480 / 2
