"""Progress of what takes long: a bar of tqdm, a callable, or nothing."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol

#: What ``progress=`` takes: None for a bar where one makes sense, True or False for a bar or none, or a callable that is told
#: (done, of all).
Progress = bool | None | Callable[[int, int], object]


def _wants_bar(progress: bool | None) -> bool:
    """Where nothing is said, a bar is for people: notebooks and terminals."""
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
    """A bar of tqdm, in notebooks too; None without tqdm."""
    # Without ipywidgets tqdm warns in every notebook that it shows a bar of text.
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
    """What is told of progress, for as long as some work takes."""
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
