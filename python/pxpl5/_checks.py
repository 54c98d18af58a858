"""Checks of arguments, with error messages that name the argument."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import wraps
from inspect import Parameter, signature
from operator import index
from types import FunctionType
from typing import ClassVar, TypeVar, cast

from ._errors import SettingError, UnknownNameError


def whole(name: str, value: object, low: int = 0) -> int:
    """Returns an argument as an integer; raises :class:`SettingError` for another type or a number below ``low``."""
    try:
        number = index(value)  # type: ignore[arg-type]
    except TypeError:
        raise SettingError(f"{name}: expected a whole number, found {value!r}") from None
    if isinstance(value, bool) or number < low:
        raise SettingError(f"{name}: expected a whole number of {low} or more, found {value!r}")
    return number


def optional(name: str, value: object, low: int = 0) -> int | None:
    """Returns an argument as an integer, or None; raises as :func:`whole`."""
    return None if value is None else whole(name, value, low)


def names(name: str, value: str | Iterable[str]) -> list[str]:
    """Returns an argument as a list of names. A single text is one name; raises :class:`SettingError` for other types."""
    all_names = [value] if isinstance(value, str) else list(value)
    for entry in all_names:
        if not isinstance(entry, str):
            raise SettingError(f"{name}: expected names, found {entry!r}")
    return all_names


def choice(name: str, value: object, expected: Iterable[str]) -> str:
    """Returns an argument if it is one of the expected names; otherwise raises :class:`SettingError` with all names."""
    names = list(expected)
    if isinstance(value, str) and value in names:
        return value
    raise SettingError(f"{name}: expected {' or '.join(names)}, found {value!r}")


F = TypeVar("F", bound=Callable[..., object])


def named(function: F) -> F:
    """Returns the function, or the class, with a :class:`SettingError` for an unknown keyword that states the nearest one."""
    if isinstance(function, type):
        setattr(function, "__init__", named(vars(function)["__init__"]))
        return function
    parameters = signature(function).parameters.values()
    if any(parameter.kind is Parameter.VAR_KEYWORD for parameter in parameters):
        return function
    known = [parameter.name for parameter in parameters if parameter.name not in ("self", "cls")]
    of = getattr(function, "__qualname__", "the function").removesuffix(".__init__")

    @wraps(function)
    def call(*arguments: object, **keywords: object) -> object:
        for name in keywords:
            if name not in known:
                nearest = get_close_matches(name, known, 1, 0.0)
                advice = f"; did you mean {nearest[0]}?" if nearest else ""
                raise SettingError(f"{of}: there is no keyword {name}{advice}")
        return function(*arguments, **keywords)

    return cast(F, call)


class Strict:
    """Base of classes that refuse new attributes and unknown keywords, so a misspelled name raises an exception."""

    #: Names of public attributes that objects have besides the properties of their class.
    _fields: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        for name, entry in list(vars(cls).items()):
            if name != "__init__" and name.startswith("_"):
                continue
            if isinstance(entry, FunctionType):
                setattr(cls, name, named(entry))
            elif isinstance(entry, (classmethod, staticmethod)):
                setattr(cls, name, type(entry)(named(entry.__func__)))

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_") and name not in self._fields and not hasattr(type(self), name):
            names = [entry for entry in (*dir(type(self)), *self._fields) if not entry.startswith("_")]
            nearest = get_close_matches(name, names, 1, 0.0)
            advice = f"; did you mean {nearest[0]}?" if nearest else ""
            raise UnknownNameError(f"{type(self).__name__} has no attribute {name}{advice}")
        object.__setattr__(self, name, value)
