"""Runs a piece of Python in a process of its own and measures it: wall time, peak memory, and what it answers."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

PROGRAM = str(Path(sys.executable).with_name("thermodata"))


@dataclass(frozen=True)
class Run:
    """seconds: wall time with the start of the interpreter. peak_mib: largest resident memory of the process.
    cpu_seconds: processor time of all its threads, its own and the system's for it."""

    seconds: float
    peak_mib: float
    out: str
    cpu_seconds: float = 0.0

    @property
    def answer(self) -> Any:
        return json.loads(self.out)


# what a process takes at most is counted from the size of the one that began it: so a small one begins it
_WATCH = """
import json, os, subprocess, sys, time
begin = time.perf_counter()
child = subprocess.Popen(sys.argv[2:])
_, status, usage = os.wait4(child.pid, 0)
with open(sys.argv[1], "w") as said:
    json.dump([time.perf_counter() - begin, status, usage.ru_maxrss, usage.ru_utime + usage.ru_stime], said)
"""


def run(words: Sequence[object], cwd: Path | None = None, ok: Sequence[int] = (0,)) -> Run:
    """One process. CalledProcessError with its stderr where it ends with another code than those of `ok`."""
    told = [str(w) for w in words]
    with tempfile.TemporaryDirectory() as folder:
        used = Path(folder, "used")
        watch = [sys.executable, "-I", "-S", "-c", _WATCH, str(used), *told]
        done = subprocess.run(watch, cwd=cwd, capture_output=True, text=True, check=False)
        if not used.exists():
            raise subprocess.CalledProcessError(done.returncode, told, done.stdout, done.stderr)
        seconds, status, peak_kib, cpu_seconds = json.loads(used.read_text())
    code = os.waitstatus_to_exitcode(status)
    if code not in ok:
        raise subprocess.CalledProcessError(code, told, done.stdout, done.stderr)
    return Run(seconds, peak_kib / 1024, done.stdout, cpu_seconds)


def python(script: Path, *words: object) -> Run:
    """This script again, with other words."""
    return run([sys.executable, script, *words])


def middle(runs: Sequence[Run]) -> Run:
    """Medians of the times and of memory; the last answer."""
    return Run(
        median(r.seconds for r in runs),
        median(r.peak_mib for r in runs),
        runs[-1].out,
        median(r.cpu_seconds for r in runs),
    )


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(c) for c in line) + " |" for line in lines)


def machine() -> str:
    """What it ran on, and how busy that was."""
    import duckdb

    return (
        f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, Python {sys.version.split()[0]}, "
        f"DuckDB {duckdb.__version__}"
    )
