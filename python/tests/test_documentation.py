"""Tests that every public name has documentation."""

import inspect
from collections.abc import Iterator

import pxpl5
from pxpl5 import _native


def public() -> Iterator[tuple[str, object]]:
    for name in pxpl5.__all__:
        thing = getattr(pxpl5, name)
        yield name, thing
        if inspect.isclass(thing):
            own = [entry for entry in vars(thing) if not entry.startswith("_")]
            yield from ((f"{name}.{entry}", inspect.getattr_static(thing, entry)) for entry in own)


def test_every_public_name_has_a_docstring_that_says_something() -> None:
    fields = {name for thing in vars(pxpl5).values() for name in getattr(thing, "__dataclass_fields__", {})}
    bad = []
    for name, thing in public():
        if name.rpartition(".")[2] in fields or isinstance(thing, (int, str, float, type(None))):
            continue
        text = inspect.getdoc(thing) or ""
        if len(text.split()) <= 3:
            bad.append(name)
    assert bad == []


def test_everything_native_has_a_docstring() -> None:
    bad = []
    for name in _native.__all__:
        thing = getattr(_native, name)
        entries = {name: thing}
        if inspect.isclass(thing):
            entries |= {f"{name}.{entry}": value for entry, value in vars(thing).items() if not entry.startswith("__")}
        bad += [entry for entry, value in entries.items() if len((inspect.getdoc(value) or "").split()) <= 2]
    assert bad == []


def test_fields_of_records_are_described() -> None:
    """Each field follows a comment that begins with `#:`, which documentation tools read."""
    for name in pxpl5.__all__:
        thing = getattr(pxpl5, name)
        for field in getattr(thing, "__dataclass_fields__", {}):
            lines = inspect.getsource(thing).splitlines()
            at = next(i for i, line in enumerate(lines) if line.strip().startswith(f"{field}:"))
            assert lines[at - 1].strip().startswith("#:"), f"{name}.{field}"
