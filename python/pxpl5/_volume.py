"""Slices of a scene for a spinning volumetric display (SpatialGL, Perspecta)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING

from . import _native
from ._checks import named
from ._native import Scene, Table, Volume
from ._progress import Progress, reporting
from ._tables import table_of

if TYPE_CHECKING:
    from ._rows import VolumeFigureRow


def _scene(scene: str | PathLike[str] | Scene) -> Scene:
    """Returns the scene with a name or from a model file. A :class:`Scene` is returned unchanged."""
    if isinstance(scene, Scene):
        return scene
    name = fspath(scene)
    is_file = "/" in name or name.lower().endswith((".ply", ".obj", ".stl", ".gltf", ".glb", ".pdb", ".ent"))
    return Scene.load(name) if is_file else Scene.builtin(name)


def draw_volume(
    scene: str | PathLike[str] | Scene, settings: Mapping[str, object] | None = None, **keys: object
) -> Volume:
    """Draws a scene as a volume. ``settings`` has values by path (:func:`volume_keys`); other settings are those of the paper.

    Each path can also be a keyword argument, with ``__`` instead of a point: ``display__width=64``.

    Raises :class:`SettingError` with the path, the expected value and the found value.
    """
    given = {path.replace("__", "."): value for path, value in keys.items()} | dict(settings or {})
    assignments = [f"{path}={_text(value)}" for path, value in given.items()]
    return Volume.draw(_scene(scene), assignments)


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def volume_keys() -> list[str]:
    """Returns the paths of all settings of a volume."""
    return _native.volume_keys()


@named
def volume_figures(scenes: Sequence[str | Scene] = ("mig", "head", "molecules"), *, progress: Progress = None) -> Table[VolumeFigureRow]:
    """Returns a row for each figure of the SpatialGL paper, with published value, simulated value and provenance.

    Raises :class:`SettingError` for a scene that cannot be drawn.
    """
    with reporting(progress, "scenes") as reporter:
        found = _native.volume_figures([_scene(scene) for scene in scenes], reporter)
    return table_of(found["figures"])
