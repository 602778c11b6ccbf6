"""Several processes in one store at once; `together.py` beside this measures how long they wait."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def test_writers_and_readers_in_processes_of_their_own_all_succeed() -> None:
    done = subprocess.run(
        [
            sys.executable,
            str(Path(__file__).parent / "together.py"),
            "--ingests",
            "2",
            "--readers",
            "2",
            "--tests",
            "2",
            "--pause",
            "0.05",  # or readers take a busy machine from the writers that they wait for
        ],
        capture_output=True,
        text=True,
        timeout=1500,
        check=False,
    )
    # the exit code tells the waits too, which belong to the machine
    assert "failed: 0 of 4" in done.stdout, done.stdout + done.stderr
