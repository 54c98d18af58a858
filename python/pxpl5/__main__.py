"""Runs the command ``pxpl5``: ``python -m pxpl5``."""

from ._command import main

main()
