"""Progress: one line on a terminal, nothing in a pipe, nothing on stdout."""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import sys
import termios
import threading
from pathlib import Path

import pytest

from thermodata.store.base.counting import counted, watched
from thermodata.virtual import simulate

CAMPAIGN = """
schema: thermodata/campaign/1
id: shop
sources: {log: {reader: table, files: "raw/{test}_*.csv", timezone: UTC}}
channels: {T_a: {source: log, signal: T, quantity: temperature, unit: degC}}
tests: [{id: one, kind: other}]
"""
PROGRAM = [sys.executable, "-c", "from thermodata.cli import main; main()"]


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    (tmp_path / "raw").mkdir()
    for i in range(3):
        rows = "".join(f"2026-03-0{i + 1} 00:{s // 60:02d}:{s % 60:02d};{20 + s / 100}\n" for s in range(1200))
        (tmp_path / f"raw/one_{i}.csv").write_text("time;T\n" + rows)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    return tmp_path / "campaign.yaml"


def on_terminal(arguments: list[str], folder: Path) -> tuple[str, str]:
    """(stdout, what a terminal on stderr got)."""
    mine, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 160, 0, 0))
    seen = bytearray()

    def listen() -> None:
        while True:
            try:
                data = os.read(mine, 65536)
            except OSError:  # Linux says so when the other end is closed
                return
            if not data:
                return
            seen.extend(data)

    ear = threading.Thread(target=listen)
    ear.start()
    try:
        process = subprocess.Popen(
            [*PROGRAM, *arguments],
            stdout=subprocess.PIPE,
            stderr=its,
            cwd=folder,
            text=True,
            env={**os.environ, "TQDM_MININTERVAL": "0"},
        )
        os.close(its)
        out, _ = process.communicate(timeout=120)
    finally:
        ear.join(10)
        os.close(mine)
    return out, seen.decode()


def test_a_terminal_gets_one_line_that_is_rewritten(campaign: Path) -> None:
    out, seen = on_terminal(["ingest", str(campaign), "--json"], campaign.parent)
    assert json.loads(out)["files"] == 3
    assert "\n" not in seen.strip()
    assert seen.count("\r") > 3
    assert re.search(r"3/3 files, [\d.]+ MB/s, [\d.]+ Msamples/s", seen)
    assert re.search(r"\d\d:\d\d left", seen)
    assert seen.endswith("\r")  # and is gone in the end


def test_a_pipe_gets_nothing(campaign: Path) -> None:
    done = subprocess.run(
        [*PROGRAM, "ingest", str(campaign)],
        capture_output=True,
        text=True,
        cwd=campaign.parent,
        check=True,
        timeout=120,
    )
    assert re.fullmatch(r"next: [^\r\n]*\n", done.stderr), "what to type next is talk, and no progress"
    assert "%" not in done.stdout.split("took")[0].replace("[%]", "")


COUNTING = """
from thermodata.cli.terminal.progress import counting_line
from thermodata.store.base.counting import counted, watched
with counting_line() as tell, watched(tell):
    print(sum(counted([1, 2, 3], "candidates")))
"""


def test_work_that_is_counted_gets_a_line_too_and_a_pipe_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.modules[__name__], "PROGRAM", [sys.executable, "-c", COUNTING])
    out, seen = on_terminal([], tmp_path)
    assert out == "6\n"
    assert re.search(r"67 %\|.*2/3 candidates, +[\d.]+/s, \d\d:\d\d left", seen)
    assert "\n" not in seen.strip()
    done = subprocess.run(PROGRAM, capture_output=True, text=True, cwd=tmp_path, check=True, timeout=120)
    assert (done.stdout, done.stderr) == ("6\n", "")


def test_a_simulation_tells_how_far_it_is_while_somebody_watches(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    with watched(lambda *what: told.append(what)):
        simulate(tmp_path / "lab", tests=2, hours=2)
    assert len(told) > 2
    assert told == [("tests", done, len(told) - 1) for done in range(len(told))]
    assert list(counted("ab", "letters")) == ["a", "b"]
    assert told[-1][0] == "tests"  # nobody is told after the end
