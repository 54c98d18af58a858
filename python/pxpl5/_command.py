"""The command ``pxpl5`` of the package."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> None:
    """Runs the command line of this process and exits with its code."""
    # The command runs outside of the interpreter, which would react to Ctrl-C only after the end of the command.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.command(["pxpl5", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
