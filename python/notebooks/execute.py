"""Executes the notebooks at a small size and keeps what they draw under target/notebooks, to be looked at.

``python python/notebooks/execute.py [NAME ...]``; without names all. It ends with 1 when a cell fails or a notebook draws nothing.
"""

from __future__ import annotations

import base64
import os
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient

HERE = Path(__file__).resolve().parent
OUT = HERE.parents[1] / "target/notebooks"


def kept(notebook: nbformat.NotebookNode, name: str) -> int:
    """Writes the pictures of a notebook as files; so many there are."""
    count = 0
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                count += 1
                (OUT / f"{name}-{count}.png").write_bytes(base64.b64decode(data["image/png"]))
            elif "image/svg+xml" in data:
                count += 1
                (OUT / f"{name}-{count}.svg").write_text(data["image/svg+xml"])
    return count


def execute(path: Path) -> None:
    """Executes a notebook; raises what a cell raises."""
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    nbformat.write(notebook, OUT / path.name)
    pictures = kept(notebook, path.stem)
    if pictures == 0:
        raise SystemExit(f"{path.name} draws nothing")
    print(f"{path.name}: {pictures} pictures in {OUT}")


def main() -> None:
    """Executes those that are named, or all."""
    os.environ["PXPL5_SMALL"] = "1"
    OUT.mkdir(parents=True, exist_ok=True)
    names = sys.argv[1:] or sorted(path.name for path in HERE.glob("*.ipynb"))
    for name in names:
        execute(HERE / name)


if __name__ == "__main__":
    main()
