"""Output for notebooks, as HTML without scripts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ._native import Motion


def number(value: object) -> str:
    """Returns a value as text: four significant digits of a real number, and an empty text for a missing value."""
    if value is None:
        return ""
    if isinstance(value, float):
        return "" if value != value else f"{value:.4g}"
    return str(value)


def table(head: Sequence[str], rows: Iterable[Sequence[object]], caption: str = "") -> str:
    """Returns a table with a head. All texts are escaped."""
    cells = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(number(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    title = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{title}<thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def picture(png: bytes, title: str) -> str:
    """Returns a picture whose data are part of the page."""
    from base64 import b64encode

    return f'<img alt="{escape(title)}" title="{escape(title)}" src="data:image/png;base64,{b64encode(png).decode()}">'


def warning(text: str) -> str:
    """Returns a warning as a paragraph."""
    return f"<p><strong>Warning:</strong> {escape(text)}</p>"


def lines(rows: Iterable[str], caption: str) -> str:
    """Returns lines of text under a caption."""
    return f"<p>{escape(caption)}</p><pre>{escape(chr(10).join(rows))}</pre>"


#: Seconds of a motion that a notebook shows, and number of samples in this time.
MOTION_S = 10.0
MOTION_SAMPLES = 201

#: Width and height of the drawing of a motion, in pixels.
MOTION_SIZE = (560, 120)


def motion(moving: Motion, about: str) -> str:
    """Returns origin and end of a motion, and a plot of the angle in degrees between the head and its start."""
    ends_s = moving.ends_s
    seconds = min(MOTION_S, ends_s) if ends_s is not None else MOTION_S
    times = np.linspace(0, seconds, MOTION_SAMPLES)
    turns = moving.poses(times)[:, 3:]
    # The angles of the rotations from the first orientation to the other orientations.
    degrees = 2 * np.degrees(np.arccos(np.clip(np.abs(turns @ turns[0]), 0, 1)))
    width, height = MOTION_SIZE
    greatest = max(float(degrees.max()), 1e-9)
    across = times / seconds * width if seconds > 0 else times
    points = " ".join(f"{x:.1f},{height - y:.1f}" for x, y in zip(across, degrees / greatest * (height - 4), strict=True))
    end = "none" if ends_s is None else f"{ends_s:.3f} s"
    rows = [["motion", about], ["end", end], ["greatest turn from the start", f"{degrees.max():.1f} degrees in {seconds:.1f} s"]]
    drawing = f'<polyline fill="none" stroke="#1f77b4" points="{points}"/>'
    return table(["", ""], rows) + f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}">{drawing}</svg>'
