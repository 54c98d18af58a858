"""Comparison of data with the types of dictionaries."""

from __future__ import annotations

from types import UnionType
from typing import Union, get_args, get_origin, get_type_hints, is_typeddict


def misfits(value: object, hint: object, place: str = "", *, exact: bool = False) -> list[str]:
    """Returns the places at which a value does not have its type, each with the expected type and the found value.

    Dictionaries may have further keys, unless ``exact`` is true.
    """
    if is_typeddict(hint):
        return _misfits_of_keys(value, hint, place, exact)
    if get_origin(hint) in (Union, UnionType):
        # The alternative that fits best explains the misfit.
        tried = [misfits(value, part, place, exact=exact) for part in get_args(hint)]
        return min(tried, key=len)
    kind = get_origin(hint) or (hint if isinstance(hint, type) else object)
    # Whole numbers are real numbers, and truth values are no numbers.
    kinds = (int, float) if kind is float else (kind,)
    if not isinstance(value, kinds) or (isinstance(value, bool) and kind in (int, float)):
        return [f"{place}: expected {kind.__name__}, found {repr(value)[:40]}"]
    parts: list[tuple[object, object, str]] = []
    if isinstance(value, list):
        parts = [(item, part, f"{place}[{n}]") for n, item in enumerate(value) for part in get_args(hint)]
    if isinstance(value, dict):
        parts = [(item, part, f"{place}.{entry[0]}") for entry in value.items() for item, part in zip(entry, get_args(hint))]
    return [misfit for item, part, inner in parts for misfit in misfits(item, part, inner, exact=exact)]


def _misfits_of_keys(value: object, hint: object, place: str, exact: bool) -> list[str]:
    if not isinstance(value, dict):
        return [f"{place}: expected an object, found {repr(value)[:40]}"]
    hints = get_type_hints(hint)
    required: frozenset[str] = getattr(hint, "__required_keys__")
    found = [f"{place}.{key}: expected a value, found none" for key in sorted(required - value.keys())]
    if exact:
        found += [f"{place}.{key}: expected no such key, found one" for key in sorted(value.keys() - hints.keys())]
    shared = [key for key in hints if key in value]
    return found + [misfit for key in shared for misfit in misfits(value[key], hints[key], f"{place}.{key}", exact=exact)]
