"""What can go wrong, as exceptions with the words of the library: what, where, expected, found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._outcome import Outcome


class Pxpl5Error(Exception):
    """The base of everything that this package raises by itself."""


class SettingError(Pxpl5Error, ValueError):
    """A setting, name, file or array that no experiment can have; the text names it, what was expected and what was found."""


class AssemblyError(Pxpl5Error, ValueError):
    """Source text of which no i860 program can be made; the text has a line for each that is wrong."""


class SweepError(Pxpl5Error, OSError):
    """A folder of a sweep that cannot be used, is in use, or holds another sweep."""


class RunError(Pxpl5Error, RuntimeError):
    """A run that ended early, or a processor that trapped."""

    _native: Any = None
    #: Fields after which a picture behind the warm-up would have been shown, as far as a closed form can tell; else None.
    fields_needed: int | None = None

    @property
    def partial(self) -> Outcome | None:
        """Everything that was observed until then; None where nothing was."""
        from ._outcome import Outcome

        return None if self._native is None else Outcome(self._native)


class TooShortError(RunError):
    """A run in which nothing but pictures of the warm-up was shown; :attr:`fields_needed` says how long it must be."""
