"""Runs a piece of Python in a process of its own and measures it: wall time, peak memory, and what it answers."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
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


def run(words: Sequence[object], cwd: Path | None = None, ok: Sequence[int] = (0,)) -> Run:
    """One process. CalledProcessError with its stderr where it ends with another code than those of `ok`."""
    with tempfile.TemporaryFile("w+") as said:  # a file: a pipe could fill while the other is read
        begin = time.perf_counter()
        child = subprocess.Popen([str(w) for w in words], cwd=cwd, stdout=subprocess.PIPE, stderr=said, text=True)
        assert child.stdout is not None
        out = child.stdout.read()
        _, status, usage = os.wait4(child.pid, 0)
        seconds = time.perf_counter() - begin
        child.returncode = os.waitstatus_to_exitcode(status)
        child.stdout.close()
        said.seek(0)
        err = said.read()
    if child.returncode not in ok:
        raise subprocess.CalledProcessError(child.returncode, list(map(str, words)), out, err)
    return Run(seconds, usage.ru_maxrss / 1024, out, usage.ru_utime + usage.ru_stime)


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
