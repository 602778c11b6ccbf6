"""Each fast path gives what the plain way gives, on whole and on damaged files, and is taken at all."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / "benchmarks" / "fast_paths.py"


@pytest.mark.parametrize("name", ["control csv", "lvm", "csv", "csv as text", "mcap json", "tdms"])
def test_it_reads_the_same_as_the_plain_way(name: str) -> None:
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "--check", "--only", name], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    equal, acted = done.stdout.splitlines()[2].split("|")[2:4]
    assert int(acted) > 0
    assert int(equal.split()[0]) == int(equal.split()[2]) >= 5


def test_every_fast_path_is_tried() -> None:
    listed = subprocess.run([sys.executable, str(SCRIPT), "--help"], capture_output=True, text=True, check=True).stdout
    assert "{control csv,lvm,csv,csv as text,mcap json,tdms}" in listed
