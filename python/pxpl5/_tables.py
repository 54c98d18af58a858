"""Conversion of rows to tables."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from . import _native
from ._errors import SettingError
from ._native import Table

if TYPE_CHECKING:
    from ._rows import Row


def _cleaned(value: object) -> object:
    """Returns a value for JSON. Infinite numbers and NaN become None, because JSON has no form for them."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if isfinite(value) else None
    if isinstance(value, np.ndarray):
        return _cleaned(value.tolist())
    if isinstance(value, Mapping):
        return {key: _cleaned(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_cleaned(entry) for entry in value]
    return value


def table_of(rows: Sequence[Mapping[str, object]], definitions: Mapping[str, str] | None = None) -> Table[Row]:
    """Returns a table of dictionaries. Nested names are joined with points, and lists become JSON.

    A column has the type of its values if all values have the same type.
    """
    for number, row in enumerate(rows):
        if not isinstance(row, Mapping):
            raise SettingError(f"row {number}: expected a dictionary, found {type(row).__name__}")
    try:
        text = json.dumps([_cleaned(row) for row in rows])
    except TypeError as error:
        raise SettingError(f"rows: expected numbers, texts, truth values, lists and dictionaries ({error})") from None
    table: Table[Row] = _native.table_of_rows(text, dict(definitions or {}))  # type: ignore[assignment]
    return table
