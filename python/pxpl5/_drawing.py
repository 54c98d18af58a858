"""Drawings in the format SVG."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from . import _native
from ._checks import Strict, names


class Drawing(Strict):
    """A drawing in the format SVG. Notebooks show the drawing."""

    _fields = ("svg",)

    def __init__(self, svg: str) -> None:
        #: The text of the SVG document.
        self.svg = svg

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the drawing to a file. Raises OSError if the file cannot be written."""
        Path(path).write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        """Returns the SVG element without the XML header, as notebooks need it."""
        return self.svg[self.svg.index("<svg") :]

    def __repr__(self) -> str:
        return f"<pxpl5.Drawing of {len(self.svg)} bytes>"


def plotted(file: str, text: str, x: str, y: str, width_mm: float, options: Mapping[str, object]) -> Drawing:
    """Returns the plot that the command ``pxpl5 plot`` makes of results, given as the text of their file.

    Raises :class:`SettingError` with the message of the command.
    """
    with TemporaryDirectory(prefix="pxpl5-") as folder:
        (Path(folder) / file).write_text(text, encoding="utf-8")
        out = Path(folder) / "plot" / "figure.svg"
        arguments = [folder, "--x", x, "--y", y, "--width", str(width_mm), "--out", str(out)]
        for name, value in options.items():
            arguments += _option(name, value)
        _native.plot(arguments)
        return Drawing(out.read_text(encoding="utf-8"))


def _option(name: str, value: object) -> list[str]:
    """Returns an option of the command; an empty value gives no option."""
    option = f"--{name.replace('_', '-')}"
    if not value:
        return []
    if isinstance(value, Mapping):
        return [part for column, wanted in value.items() for part in (option, f"{column}={wanted}")]
    if isinstance(value, str):
        return [option, value]
    return [option, ",".join(names(name, value))]  # type: ignore[arg-type]
