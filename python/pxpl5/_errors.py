"""Exceptions of the package, with the messages of the library: what, where, expected, found."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import _native
    from ._outcome import Outcome


class Pxpl5Error(Exception):
    """Base class of all exceptions of this package."""


class SettingError(Pxpl5Error, ValueError):
    """A wrong setting, name, file or array. The message names the wrong input, the expected value and the found value."""


class UnknownNameError(SettingError, AttributeError):
    """An attribute that an object does not have. The message has the nearest name."""


class AssemblyError(Pxpl5Error, ValueError):
    """Source text that cannot be assembled to an i860 program. The message has a line for each error."""


class SweepError(Pxpl5Error, OSError):
    """A folder of a sweep or a comparison that cannot be used, is in use, or holds another sweep or comparison."""


class DiscardedError(Pxpl5Error, RuntimeError):
    """A table or drawing that needs records which the run has discarded, because it kept only statistics."""


class RunError(Pxpl5Error, RuntimeError):
    """A run that ended early, or a processor that trapped."""

    _native: _native.Outcome | None = None
    #: Number of fields that the run needs to show a picture after the warm-up, by a formula; None if unknown.
    fields_needed: int | None = None
    #: Outcome with all observations before the error; None without observations.
    partial: Outcome | None = None


class TooShortError(RunError):
    """A run in which only pictures of the warm-up were shown; :attr:`fields_needed` is the necessary length."""
