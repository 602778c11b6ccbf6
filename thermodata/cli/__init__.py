"""The command line: `thermodata [--store DIR] COMMAND ... [--json]`. Only this floor talks to a terminal."""

from __future__ import annotations

import gc
import signal
from collections.abc import Sequence

from thermodata.errors import INTERRUPTED

_NEW_OBJECTS = 50_000  # that may hold others, before one looks for rings among them


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; the console script of the distribution."""
    # what a command makes, it mostly keeps to its end: looking for rings in it every 700 objects took a fifth of an
    # ingest
    gc.set_threshold(_NEW_OBJECTS, 20, 50)
    try:
        from thermodata.cli.app import run

        code = run(argv)
    except KeyboardInterrupt:  # before there is anything that could say it better
        import sys

        sys.stderr.write("error: interrupted\n")
        code = INTERRUPTED
    if code == INTERRUPTED:
        # CPython takes one that came through the execution of a text, as data classes are made by, for one that nobody
        # caught, and would end by the signal; the next text makes it forget that
        exec("")
    if argv is None:
        # the answer is given: an interpreter that ends gives Ctrl-C back to the system, which would kill it for nothing
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    return code


__all__ = ["main"]
