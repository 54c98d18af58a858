"""Tests that the examples run, and that the guide shows the examples unchanged.

``PXPL5_UPDATE_GUIDE=1 pytest python/tests/test_examples.py`` writes the examples into the guide.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = ["my_model", "my_pipeline", "i860_loop", "my_sweep", "my_recording"]


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs(root: Path, tmp_path: Path, name: str) -> None:
    run = [sys.executable, str(root / "examples" / f"{name}.py")]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()


def shown(page: str, root: Path) -> str:
    """Returns the page with every example replaced by the content of its file."""

    def example(match: re.Match[str]) -> str:
        text = (root / "examples" / f"{match[1]}.py").read_text()
        return f"<!-- examples/{match[1]}.py -->\n```python\n{text}```\n"

    return re.sub(r"<!-- examples/(\w+)\.py -->\n```python\n.*?```\n", example, page, flags=re.DOTALL)


def test_the_guide_shows_every_example_as_it_is(root: Path) -> None:
    guide = root / "docs/guide/python.md"
    page = guide.read_text()
    if "PXPL5_UPDATE_GUIDE" in os.environ:
        guide.write_text(shown(page, root))
        return
    assert page == shown(page, root)
    assert all(f"examples/{name}.py" in page for name in EXAMPLES), "each is shown or linked"
