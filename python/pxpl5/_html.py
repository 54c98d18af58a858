"""What notebooks show, as HTML without scripts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape


def number(value: object) -> str:
    """A value for people: four significant digits of a real number, nothing of what is missing."""
    if value is None:
        return ""
    if isinstance(value, float):
        return "" if value != value else f"{value:.4g}"
    return str(value)


def table(head: Sequence[str], rows: Iterable[Sequence[object]], caption: str = "") -> str:
    """A table with a head; everything in it is escaped."""
    cells = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(number(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    title = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{title}<thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def picture(png: bytes, title: str) -> str:
    """A picture within the page."""
    from base64 import b64encode

    return f'<img alt="{escape(title)}" title="{escape(title)}" src="data:image/png;base64,{b64encode(png).decode()}">'
