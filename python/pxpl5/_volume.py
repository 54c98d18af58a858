"""Scenes as the slices of a spinning volumetric display (SpatialGL, Perspecta)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING

from . import _native
from ._native import Scene, Table, Volume
from ._progress import Progress, reporting
from ._tables import table_of

if TYPE_CHECKING:
    from ._rows import VolumeFigureRow


def _scene(scene: str | PathLike[str] | Scene) -> Scene:
    """A scene by its name, from its file, or as it is."""
    if isinstance(scene, Scene):
        return scene
    name = fspath(scene)
    is_file = "/" in name or name.lower().endswith((".ply", ".obj", ".stl", ".gltf", ".glb", ".pdb", ".ent"))
    return Scene.load(name) if is_file else Scene.builtin(name)


def draw_volume(
    scene: str | PathLike[str] | Scene, settings: Mapping[str, object] | None = None
) -> Volume:
    """Draws a scene as a volume; what ``settings`` do not say, by path of :func:`volume_keys`, is as in the paper.

    Raises :class:`SettingError` with the path, what was expected and what was found.
    """
    assignments = [f"{path}={_text(value)}" for path, value in (settings or {}).items()]
    return Volume.draw(_scene(scene), assignments)


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def volume_keys() -> list[str]:
    """Paths of everything that decides what a volume is."""
    return _native.volume_keys()


def volume_figures(scenes: Sequence[str | Scene] = ("mig", "head", "molecules"), *, progress: Progress = None) -> Table[VolumeFigureRow]:
    """The figures of the SpatialGL paper beside the model's: a row for each with expected and computed value and standing.

    Raises :class:`SettingError` for a scene that cannot be drawn.
    """
    with reporting(progress, "scenes") as told:
        found = _native.volume_figures([_scene(scene) for scene in scenes], told)
    return table_of(found["figures"])
