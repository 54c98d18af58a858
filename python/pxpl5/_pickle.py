"""Functions with which the module pickle restores objects of the native module."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._errors import SettingError

if TYPE_CHECKING:
    from ._rows import Cell

#: Name, description, type and values of a column.
Column = tuple[str, str, str, list[object]]


def scene(text: bytes, warnings: list[str]) -> _native.Scene:
    """Returns the scene that a JSON text describes."""
    return _native.scene_of_json(text, warnings)


def recording(text: bytes, columns: Mapping[str, str], end: str | None, about: str) -> _native.Motion:
    """Returns the motion of a recording's text."""
    return _native.motion_of_text(text, columns, end, about)


def named_motion(name: str) -> _native.Motion:
    """Returns the motion with a name."""
    return _native.Motion(name)


def motion(arguments: Sequence[object]) -> _native.Motion:
    """Returns the motion whose arguments a file has: those of :func:`recording`, with the text as a string, or a name.

    Raises :class:`SettingError` for other arguments.
    """
    match arguments:
        case [str(name)]:
            return named_motion(name)
        case [str(text), dict(columns), None | str() as end, str(about)]:
            return recording(text.encode("latin-1"), columns, end, about)
    raise SettingError(f"a motion: expected a name or a recording, found {repr(arguments)[:40]}")


def callable_motion(pose: Callable[[float], Sequence[float]], name: str) -> _native.Motion:
    """Returns the motion of a Python function."""
    return _native.Motion.from_callable(pose, name=name)


def picture(pixels: NDArray[np.uint8], texts: list[tuple[str, str]]) -> _native.Picture:
    """Returns the picture with these pixels and texts."""
    return _native.picture_of_parts(pixels, texts)


def table(columns: list[Column]) -> _native.Table[dict[str, Cell]]:
    """Returns the table with these columns."""
    return _native.table_of_columns(columns)
