"""The command line: `thermodata [--store DIR] COMMAND ... [--json]`. Only this floor talks to a terminal."""

from __future__ import annotations

from collections.abc import Sequence


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; the console script of the distribution."""
    try:
        from thermodata.cli.app import run

        return run(argv)
    except KeyboardInterrupt:  # before there is anything that could say it better
        import sys

        sys.stderr.write("error: interrupted\n")
        return 1


__all__ = ["main"]
