"""Ctrl-C within a computation of a library, pressed on a process of its own: workers of tests take it for theirs."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from thermodata.store import Store
from thermodata.store.keep.check import check_store

from .conftest import write_campaign

INTERRUPTED = (130, "error: interrupted")

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


SWALLOWED = """
import contextlib, os, signal, sys
from thermodata.cli import main
from thermodata.store.ingest.reading.campaign_files import CampaignFiles

survey = CampaignFiles.survey


def swallowing(files):
    with contextlib.suppress(BaseException):  # as pyarrow does, where it looks whether there is pandas
        os.kill(os.getpid(), signal.SIGINT)
    print("surveyed", flush=True)
    survey(files)


CampaignFiles.survey = swallowing
sys.exit(main(["--store", {store!r}, "ingest", {campaign!r}]))
"""


def heeding() -> None:
    """What the background of a shell starts ignores Ctrl-C, and so would what it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def processes(group: int) -> int:
    """How many live in a group of processes."""
    found = 0
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(ProcessLookupError):
            found += os.getpgid(int(entry.name)) == group
    return found


def pressed(command: list[str], after: str = "", wait_s: float = 3.0, workers: int = 0) -> tuple[int, str]:
    """(exit code, last line of what is said) of a process that is interrupted at work, with all that it has started, as
    a terminal does it. after: what it prints before that; wait_s: else how long that takes, from when its workers
    live."""
    running = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heeding,
        start_new_session=True,
    )
    if after:
        assert running.stdout is not None
        assert running.stdout.readline().strip() == after
    while processes(running.pid) <= workers:
        assert running.poll() is None, running.communicate()
        time.sleep(0.1)
    try:
        running.wait(0.5 if after else wait_s)  # what is done earlier is not waited for
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGINT)
    try:
        _, said = running.communicate(timeout=60)
    finally:
        running.kill()
    assert "Traceback" not in said
    return running.returncode, "".join(said.strip().splitlines()[-1:])


ENDING = """
import atexit, os, signal, sys
from thermodata.cli import main


atexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))
sys.argv = ["thermodata", "plugins"]
sys.exit(main())
"""


def test_what_is_done_is_not_killed_as_it_ends() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", ENDING], capture_output=True, text=True, timeout=120, check=False, preexec_fn=heeding
    )
    assert (ended.returncode, ended.stderr) == (0, "")


def test_a_query_is_interrupted(campaign: Path) -> None:
    command = [sys.executable, "-m", "thermodata", "--store", str(campaign / "thermodata.store"), "sql", QUERY]
    assert pressed(command) == INTERRUPTED


def test_an_interrupted_opening_is_no_damage(campaign: Path) -> None:
    code = OPENING.format(folder=campaign, query=SHORT, store=str(campaign / "thermodata.store"))
    code = code.replace("PosixPath", "__import__('pathlib').PosixPath")
    assert pressed([sys.executable, "-c", code], "opening") == INTERRUPTED


def test_an_interrupt_that_a_library_swallows_ends_an_ingest_all_the_same(tmp_path: Path) -> None:
    path, store = write_campaign(tmp_path / "lab"), tmp_path / "store"
    code = SWALLOWED.format(store=str(store), campaign=str(path))
    command = [sys.executable, "-c", code]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, preexec_fn=heeding)
    assert (ended.returncode, ended.stdout.strip()) == (130, "surveyed")
    assert ended.stderr.strip() == "error: interrupted"
    assert check_store(Store(store)).damaged == []


@pytest.mark.parametrize("command", ["ingest", "diagnose"])
def test_what_is_interrupted_leaves_a_sound_store_and_is_done_again(
    campaign: Path, tmp_path: Path, command: str
) -> None:
    """Wherever in it Ctrl-C comes; where it comes late the work may be done."""
    shutil.copytree(campaign, tmp_path / "lab")
    place = tmp_path / "lab" / ("new" if command == "ingest" else "thermodata.store")
    target = str(tmp_path / "lab" / "campaign.yaml") if command == "ingest" else "baseline"
    words = [sys.executable, "-m", "thermodata", "--store", str(place), command, target]
    for wait_s in (1.0, 2.0, 4.0):
        if command == "ingest":
            shutil.rmtree(place, ignore_errors=True)
        code, last = pressed(words, wait_s=wait_s)
        assert (code, last) == INTERRUPTED or code == 0
        if Store.is_at(place):
            assert check_store(Store(place)).damaged == []
    assert subprocess.run(words, capture_output=True, timeout=300, check=False).returncode == 0
    assert check_store(Store(place)).damaged == []


def test_an_interrupted_benchmark_ends_its_processes_too(tmp_path: Path) -> None:
    words = ["benchmark-diagnosis", "--machine", "lathe", "--seeds", "4", "--jobs", "2", "--no-rivals"]
    command = [sys.executable, "-m", "thermodata", *words, "--out", str(tmp_path / "kept.jsonl")]
    began = time.monotonic()
    assert pressed(command, wait_s=2.0, workers=2) == INTERRUPTED
    assert time.monotonic() - began < 60  # the machines that are left would take minutes
