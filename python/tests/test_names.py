"""Tests of the names that the library generates as types for type checkers.

``PXPL5_UPDATE_NAMES=1 pytest python/tests/test_names.py`` writes the names again.
"""

import os
from pathlib import Path
from typing import get_args

import pxpl5
from pxpl5 import _names

LISTS = {
    "QuantityName": ("Quantities of an outcome.", lambda: list(pxpl5.quantities())),
    "PipelineName": ("Pipelines.", lambda: [row["name"] for row in pxpl5.pipelines()]),
    "MachineName": ("Machines that are built in.", lambda: list(pxpl5.presets())),
    "LevelName": ("Levels of modelling.", lambda: ["transaction", "cycle", "analytic"]),
    "PixelsName": ("Choices of computed pixels.", lambda: ["off", "lazy", "all"]),
}


def text() -> str:
    """Returns the expected text of the module."""
    head = '"""' + str(_names.__doc__) + '"""\n\nfrom typing import Literal\n\n'
    parts = []
    for name, (about, values) in LISTS.items():
        parts.append(f"#: {about}\n{name} = Literal[\n" + "".join(f'    "{value}",\n' for value in values()) + "]\n")
    return head + "\n".join(parts)


def test_names_are_those_of_the_library() -> None:
    place = Path(str(_names.__file__))
    if "PXPL5_UPDATE_NAMES" in os.environ:
        place.write_text(text(), encoding="utf-8")
    assert place.read_text(encoding="utf-8") == text()
    for name, (_, values) in LISTS.items():
        assert list(get_args(getattr(_names, name))) == values() or "PXPL5_UPDATE_NAMES" in os.environ
