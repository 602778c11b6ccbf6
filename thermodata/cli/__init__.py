"""The command line: `thermodata [--store DIR] COMMAND ... [--json]`. Only this floor talks to a terminal."""

from __future__ import annotations

from collections.abc import Sequence


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; the console script of the distribution."""
    from thermodata.cli.app import run

    return run(argv)


__all__ = ["main"]
