"""The harness itself: readers broken on purpose must be caught, and a good one must not."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

RUN = Path(__file__).with_name("run.py")
TWIN = """
import ctypes, os, time
import numpy as np
from tests.fuzz.formats.foo import *

def damaged(path):
    return len(path.read_bytes()) % 7 == 3 and path.read_bytes() != seeds()[0].data

class Twin(Foo):
    def parse(self, path):
        words, rows, whole = super().parse(path)
        if damaged(path):
            {does}
        return words, rows, whole

READER = Twin
"""
TWINS = {
    "raises": ("[][1]", "plugin bug", "IndexError: list index out of range"),
    "crashes": ("ctypes.string_at(0)", "the worker died, code -11", ""),
    "hangs": ("\n            while True: pass", "more than 0.2 s of processor time", ""),
    "waits": ("time.sleep(3600)", "no end after 2.4 s", ""),
    "eats memory": ("np.ones(2**30)", "MemoryError", ""),
    "leaves a file": ("path.with_suffix('.idx').write_bytes(b'')", "left beside the file: ['a.idx']", ""),
    "drops a row": ("rows, whole = rows[1:], True", "silently missing: 'T': 1 of 40 rows are missing", ""),
    "shifts values": (
        "rows = list(zip([t for t, _ in rows], [v for _, v in rows[1:] + rows[:1]])); whole = True",
        "silently wrong: 'T': 40 of 40 rows are not the seed's",
        "",
    ),
}


def run(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, str(RUN), *map(str, words)], capture_output=True, text=True, check=False)


def test_a_good_reader_passes() -> None:
    done = run("--format", "foo", "--count", 200)
    assert done.returncode == 0, done.stdout + done.stderr
    last = done.stdout.splitlines()[-1].split()
    assert last[0] == "all"
    assert last[-1] == "200"
    assert min(int(n) for n in (last[1], last[3], last[4])) > 5  # same, changed, reported


@pytest.mark.parametrize("name", TWINS)
def test_a_broken_reader_is_caught_and_the_run_goes_on(name: str, tmp_path: Path) -> None:
    does, why, more = TWINS[name]
    module = tmp_path / "twin.py"
    module.write_text(TWIN.format(does=does))
    count = 20
    done = run("--format", module, "--count", count, "--limit", 0.2, "--out", tmp_path / "out")
    assert done.returncode == 1, done.stdout + done.stderr
    assert why in done.stdout
    assert more in done.stdout
    assert done.stdout.split("\nall ")[1].split("\n")[0].split()[-1] == str(count)
    reports = list((tmp_path / "out").glob("*.txt"))
    assert reports
    number = reports[0].name.split("-")[1]
    assert f"--replay {number}" in reports[0].read_text()
    if name == "raises":
        again = run("--format", module, "--replay", number)
        assert again.returncode == 1
        assert "IndexError" in again.stdout


def test_a_worker_that_somebody_stopped_is_not_to_blame(tmp_path: Path) -> None:
    """A busy machine, or one on which something else is measured."""
    module = tmp_path / "twin.py"
    stops = (
        "__import__('subprocess').Popen(['sh', '-c', f'sleep 4; kill -CONT {os.getpid()}']); os.kill(os.getpid(), 19)"
    )
    module.write_text(TWIN.format(does=stops))
    done = run("--format", module, "--count", 8, "--limit", 0.2, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_seed_that_is_no_whole_file_is_refused(tmp_path: Path) -> None:
    module = tmp_path / "twin.py"
    module.write_text(
        "from tests.fuzz.formats.foo import *\ndef seeds():\n    return [Seed('a.foo', b'FOO1 T degC 3\\n0 1;\\n')]\n"
    )
    done = run("--format", module, "--count", 3)
    assert done.returncode == 1
    assert "no whole file" in done.stderr
