"""Ctrl-C within a computation of a library, pressed on a process of its own: workers of tests take it for theirs."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

QUERY = "select count(*) from range(10000000) a, range(10000000) b"  # hours
SHORT = "select count(*) from range(100000) a, range(400000) b"  # seconds: where DuckDB's end is waited for
OPENING = """
import sys
from thermodata.cli import main
from thermodata.errors import StoreError
from thermodata.store import Store
from thermodata.store.base import connection


def opened(*_):
    con = connection.memory({folder!r})
    print("opening", flush=True)
    try:
        con.execute({query!r})
    except Exception as error:
        raise StoreError("the catalogue is damaged") from error


Store._copy_into = opened
sys.exit(main(["--store", {store!r}, "tests"]))
"""


def pressed(command: list[str], after: str = "") -> tuple[int, str]:
    """(exit code, last line of what is said) of a process that is interrupted in its query. after: what it prints
    before that."""

    def heeding() -> None:
        """What the background of a shell starts ignores it."""
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=heeding)
    if after:
        assert running.stdout is not None
        assert running.stdout.readline().strip() == after
    time.sleep(0.5 if after else 3.0)
    running.send_signal(signal.SIGINT)
    try:
        _, said = running.communicate(timeout=60)
    finally:
        running.kill()
    return running.returncode, said.strip().splitlines()[-1]


def test_a_query_is_interrupted(campaign: Path) -> None:
    command = [sys.executable, "-m", "thermodata", "--store", str(campaign / "thermodata.store"), "sql", QUERY]
    assert pressed(command) == (1, "error: interrupted")


def test_an_interrupted_opening_is_no_damage(campaign: Path) -> None:
    code = OPENING.format(folder=campaign, query=SHORT, store=str(campaign / "thermodata.store"))
    code = code.replace("PosixPath", "__import__('pathlib').PosixPath")
    assert pressed([sys.executable, "-c", code], "opening") == (1, "error: interrupted")
