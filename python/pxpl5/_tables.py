"""Rows as tables."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

from . import _native
from ._native import Table


def _cleaned(value: object) -> object:
    """What is no number becomes null: JSON has no name for it."""
    if isinstance(value, float):
        return value if isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: _cleaned(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_cleaned(entry) for entry in value]
    return value


def table_of(rows: Sequence[Mapping[str, Any]], definitions: Mapping[str, str] | None = None) -> Table:
    """A table of dictionaries: nested names with points, lists as JSON; a column has a type where all its values have it."""
    return _native.table_of_rows(json.dumps([_cleaned(row) for row in rows]), dict(definitions or {}))
