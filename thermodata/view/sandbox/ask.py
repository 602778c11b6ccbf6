"""A query in a process of its own that is ended when it takes too long."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Literal

from thermodata.errors import ThermodataError, UsageError

Form = Literal["table", "csv", "parquet"]
_CHUNK = 1 << 16


@dataclass(frozen=True, slots=True)
class Limits:
    """seconds: from the question to the last row. rows: of the answer; what is left out is said."""

    seconds: float = 20.0
    memory_mb: int = 512
    rows: int = 1_000


@dataclass(frozen=True, slots=True)
class Table:
    """columns: (name, type of DuckDB's). rows: values of JSON, long texts cut. more: whether rows were left out.
    units: column -> unit, of those that are as the store has them."""

    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[Any, ...], ...]
    more: bool
    units: Mapping[str, str] = field(default_factory=dict)


def ask(store: Path | str, query: str, limits: Limits = Limits()) -> Table:
    """The rows of one SELECT over a store. UsageError where it is refused, fails, or goes beyond a limit."""
    with _child_answering(store, query, "table", limits) as (head, _):
        columns = tuple((str(name), str(kind)) for name, kind in head["columns"])
        return Table(columns, tuple(tuple(row) for row in head["rows"]), bool(head["more"]), head["units"])


def stream(store: Path | str, query: str, form: Form, limits: Limits = Limits()) -> Iterator[bytes]:
    """The same as CSV or Parquet, in pieces; errors come before the first piece. An answer that goes beyond a limit
    once it began ends with an error, and never looks whole."""
    with _child_answering(store, query, form, limits) as (_, body):
        yield b""  # begun: from here on there is an answer
        while piece := body.read(_CHUNK):
            yield piece


@contextmanager
def _child_answering(
    store: Path | str, query: str, form: Form, limits: Limits
) -> Iterator[tuple[dict[str, Any], IO[bytes]]]:
    request = {
        "store": str(Path(store).absolute()),
        "query": query,
        "form": form,
        "rows": limits.rows,
        "memory_mb": limits.memory_mb,
        "cpu_s": int(limits.seconds) + 2,
    }
    process = subprocess.Popen(
        # -P: a module that lies in the working folder, which may be one of somebody's data, is not imported
        [sys.executable, "-P", "-m", "thermodata.view.sandbox.child"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=_environment(),
    )
    late = threading.Event()

    def end() -> None:
        late.set()
        process.kill()

    watch = threading.Timer(limits.seconds, end)
    watch.start()
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(request).encode() + b"\n")
        process.stdin.close()
        yield _head(process, late, limits), process.stdout
        if process.wait() != 0 or late.is_set():
            raise _ended(process, late, limits)
    finally:
        watch.cancel()
        process.kill()
        process.wait()
        for pipe in (process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()


def _head(process: subprocess.Popen[bytes], late: threading.Event, limits: Limits) -> dict[str, Any]:
    assert process.stdout is not None
    line = process.stdout.readline()
    if not line.endswith(b"\n"):
        process.wait()
        raise _ended(process, late, limits)
    head: dict[str, Any] = json.loads(line)
    refused = head.get("refused")
    if refused is not None:
        code = refused.pop("exit_code")
        error = UsageError(**refused) if code == 2 else ThermodataError(**refused)
        raise error
    return head


def _ended(process: subprocess.Popen[bytes], late: threading.Event, limits: Limits) -> ThermodataError:
    if late.is_set() or process.returncode == -24:  # SIGXCPU
        return UsageError(
            "the query takes too long",
            expected=f"at most {limits.seconds:g} s",
            hint="ask for fewer tests or coarser bins, or in a terminal: thermodata sql",
        )
    said = process.stderr.read().decode(errors="replace").strip().splitlines() if process.stderr else []
    if any("MemoryError" in line or "bad_alloc" in line for line in said):
        return UsageError("the query needs too much memory", expected=f"at most {limits.memory_mb} MB")
    return ThermodataError(
        "the query's process ended", got=f"exit code {process.returncode}" + (f": {said[-1]}" if said else "")
    )


def _environment() -> dict[str, str]:
    """Where Python finds itself and this program; nothing else of the user's."""
    kept = {"PATH", "PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "SYSTEMROOT", "TMPDIR", "TEMP", "LANG", "LC_ALL", "TZ"}
    return {
        **{name: value for name, value in os.environ.items() if name in kept},
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
