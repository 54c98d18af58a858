"""A running experiment that advances on request."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import _native
from ._checks import Strict, whole
from ._native import Picture, Table
from ._tables import table_of
from ._types import BoardState, EventState

if TYPE_CHECKING:
    from ._experiment import Experiment
    from ._outcome import Outcome
    from ._rows import ChannelRow


class Stepper(Strict):
    """A run that advances by fields, lines or events, and whose state can be read between two steps.

    :meth:`Experiment.stepper` begins such a run. Steps and reading change no result: :meth:`finish` gives the same
    outcome as :meth:`Experiment.run`. Each step returns ``reached``, ``end``, ``breakpoint``, or ``failed`` with the
    reason. Times are picoseconds of simulated time.
    """

    def __init__(self, native: _native.Stepper, experiment: Experiment) -> None:
        self._native = native
        self._experiment = experiment

    def step_field(self) -> str:
        """Runs to the start of the next field."""
        return self._native.step_field()

    def step_line(self) -> str:
        """Runs to the instant at which the next line of the first surface begins to light."""
        return self._native.step_line()

    def step_event(self, board: str | None = None) -> str:
        """Handles one event. With ``board``, handles all events up to the next event of this board.

        Names of boards are ``host``, ``ring``, ``gp 3`` or ``renderer 0``. Raises :class:`SettingError` for an unknown board.
        """
        return self._native.step_event(board)

    def run_to_field(self, field: int) -> str:
        """Runs to the start of a field, counted from 0."""
        return self._native.run_to_field(whole("field", field))

    def run_to_ps(self, time_ps: int) -> str:
        """Runs to an instant in picoseconds."""
        return self._native.run_to_ps(whole("time_ps", time_ps))

    @property
    def field(self) -> int:
        """Number of the current field, counted from 0."""
        return self._native.field

    @property
    def now_ps(self) -> int:
        """Instant at which the last step ended, in picoseconds."""
        return self._native.now_ps

    @property
    def end_ps(self) -> int:
        """Instant at which the run ends, in picoseconds."""
        return self._native.end_ps

    @property
    def shown(self) -> int:
        """Number of complete pictures that were shown up to now and whose records are kept."""
        return self._native.shown

    @property
    def trace_hash(self) -> str:
        """Hash of the trace up to now, without the statistics that the hash of an outcome includes."""
        return self._native.trace_hash

    @property
    def last_event(self) -> EventState | None:
        """The last event with time, board and description; None if the last step did not end with an event."""
        return self._native.last_event()

    def board(self, name: str) -> BoardState | None:
        """Returns the state of a processor or renderer as a dictionary, or None for other boards and boards that do not exist.

        Raises :class:`SettingError` for an unknown kind of board.
        """
        return self._native.board(name)

    @property
    def channels(self) -> Table[ChannelRow]:
        """A row for each message that now occupies a channel of the ring."""
        return table_of(self._native.channels())

    def picture(self, surface: str = "left") -> Picture | None:
        """Returns the picture that the viewer of a surface sees now, or None without pixels.

        Lines above the beam are of the current field, and lines below the beam are of the previous field.

        Raises :class:`SettingError` with the surfaces of the display.
        """
        return self._native.picture(surface)

    def finish(self) -> Outcome:
        """Runs to the end and returns the outcome. The stepper cannot be used afterwards.

        Raises the exceptions of :meth:`Experiment.run`.
        """
        return self._experiment._finished(self._native.finish)

    def __repr__(self) -> str:
        return f"<pxpl5.Stepper of {self._experiment!r}>"
