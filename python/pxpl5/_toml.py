"""Values in the format of experiment files (TOML)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from os import PathLike, fspath


def toml_of(value: object) -> str:
    """Returns a value in the format of experiment files."""
    if isinstance(value, bool) or isinstance(value, int):
        return json.dumps(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, PathLike):
        return json.dumps(fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {toml_of(entry)}" for key, entry in value.items()) + " }"
    if hasattr(value, "tolist"):
        return toml_of(value.tolist())
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_of(entry) for entry in value) + "]"
    if hasattr(value, "item"):
        return toml_of(value.item())
    raise TypeError(f"expected text, a number, a truth value or a list of these, found {type(value).__name__}")
