"""Executes the notebooks at a small size and writes their pictures to target/notebooks.

``python python/notebooks/execute.py [NAME ...]``; without names, all notebooks. The exit code is 1 if a cell fails or warns, or if a
notebook draws no picture.
"""

from __future__ import annotations

import base64
import os
import re
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient

HERE = Path(__file__).resolve().parent
OUT = HERE.parents[1] / "target/notebooks"


def kept(notebook: nbformat.NotebookNode, name: str) -> int:
    """Writes the pictures of a notebook to files. Returns the number of pictures."""
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


def warnings_of(notebook: nbformat.NotebookNode) -> str:
    """Returns the output of a notebook's cells on standard error, without progress bars."""
    streams = [output for cell in notebook.cells for output in cell.get("outputs", []) if output.output_type == "stream"]
    lines = [line for stream in streams if stream.name == "stderr" for line in re.split(r"[\r\n]", stream.text)]
    # A bar of tqdm has its time in brackets: `12 fields [00:01, 11.8 fields/s]`.
    return "\n".join(line for line in lines if line.strip() and not re.search(r"\[\d+:\d\d", line))


def execute(path: Path) -> None:
    """Executes a notebook. Raises exceptions of cells. Ends the program if a cell warns or imports a private name."""
    notebook = nbformat.read(path, as_version=4)
    if any("pxpl5._" in cell.source for cell in notebook.cells):
        raise SystemExit(f"{path.name} imports a private module")
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    if warnings_of(notebook):
        raise SystemExit(f"{path.name} warns: {warnings_of(notebook)}")
    nbformat.write(notebook, OUT / path.name)
    pictures = kept(notebook, path.stem)
    if pictures == 0:
        raise SystemExit(f"{path.name} draws nothing")
    print(f"{path.name}: {pictures} pictures in {OUT}")


def main() -> None:
    """Executes the notebooks that are named on the command line, or all."""
    os.environ["PXPL5_SMALL"] = "1"
    OUT.mkdir(parents=True, exist_ok=True)
    names = sys.argv[1:] or sorted(path.name for path in HERE.glob("*.ipynb"))
    for name in names:
        execute(HERE / name)


if __name__ == "__main__":
    main()
