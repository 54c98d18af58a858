"""Runs that several tests share."""

from pathlib import Path

import pytest

import pxpl5

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def slats() -> pxpl5.Outcome:
    """100 triangles of the Mig under Slats."""
    return pxpl5.Experiment("slats", "mig", triangles=100, fields=60).run(progress=False)


@pytest.fixture(scope="session")
def mig() -> pxpl5.Outcome:
    """The Mig under Rendering Control."""
    return pxpl5.Experiment("rendering-control", "mig", fields=60).run(progress=False)


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder of the repository."""
    return ROOT
