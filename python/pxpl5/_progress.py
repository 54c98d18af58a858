"""Display of progress: a bar of tqdm, a call of a function, or nothing."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol

#: Values of ``progress=``: None for a bar in notebooks and terminals, True for a bar, False for no bar, or a callable. The callable
#: gets two numbers: finished steps and all steps.
Progress = bool | None | Callable[[int, int], object]


def _wants_bar(progress: bool | None) -> bool:
    """Returns true if a bar shall be shown. With None, notebooks and terminals get a bar."""
    if progress is not None:
        return progress
    return "ipykernel" in sys.modules or sys.stderr.isatty()


class _Bar(Protocol):
    """The part of a bar of tqdm that is used here."""

    total: float | None
    n: float

    def update(self, n: float, /) -> object: ...

    def __enter__(self) -> object: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> object: ...


def _bar(unit: str) -> _Bar | None:
    """Returns a bar of tqdm, or None if tqdm is not installed."""
    # In a notebook without ipywidgets, tqdm would warn that it shows a bar of text.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return None
        bar: _Bar = tqdm(total=0, unit=f" {unit}", leave=False)
        return bar


@contextmanager
def reporting(progress: Progress, unit: str) -> Iterator[Callable[[int, int], object] | None]:
    """Yields a function that shows progress during some work, or None if no progress is shown."""
    if callable(progress):
        yield progress
        return
    bar = _bar(unit) if _wants_bar(progress) else None
    if bar is None:
        yield None
        return

    def tell(done: int, of: int) -> None:
        bar.total = of
        bar.update(done - bar.n)

    with bar:
        yield tell
