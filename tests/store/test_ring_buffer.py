"""A circular archive: what it wrote last stands above what it wrote first."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say

pytestmark = pytest.mark.usefixtures("installed_readers")
CAMPAIGN = """schema: thermodata/campaign/1
id: ring
machine: {{id: M1}}
sources:
  log: {{reader: table, files: "{{test}}.csv", timezone: UTC{clock}}}
channels:
  T_bed: {{source: log, signal: T_bed, quantity: temperature, unit: degC, at: bed}}
tests:
  - {{id: a, kind: spindle, role: none}}
"""


def _log(
    folder: Path,
    seam: int,
    pause: int = 0,
    newest_first: bool = False,
    clock: str = "",
    count: int = 600,
    step: int = 10,
) -> None:
    rows = [
        f"2026-03-02 {8 + t // 3600:02d}:{t // 60 % 60:02d}:{t % 60:02d},{20 + t / 5000:.4f}"
        for t in (step * k + (pause if k >= seam else 0) for k in range(count))
    ]
    rows = rows[seam:] + rows[:seam]
    rows = rows[::-1] if newest_first else rows
    (folder / "a.csv").write_text("\n".join(["time,T_bed", *rows, ""]), encoding="utf-8")
    (folder / "campaign.yaml").write_text(CAMPAIGN.format(clock=clock), encoding="utf-8")


@pytest.mark.parametrize("newest_first", [False, True])
@pytest.mark.parametrize("clock", ["", ", clock: {resets: allow}"])
def test_a_ring_buffer_is_stored_in_the_order_of_its_times(
    tmp_path: Path, say: Say, newest_first: bool, clock: str
) -> None:
    _log(tmp_path, 380, newest_first=newest_first, clock=clock)
    said = say("ingest", tmp_path / "campaign.yaml")
    assert "a ring buffer: its oldest rows stand from row 221 on" in said.out
    asked = "select count(*), min(t_s), max(t_s), corr(t_s, value) > 0.9999 from sample"
    assert say("sql", asked, "--csv").out.splitlines()[1] == "600,0.0,5990.0,True"


@pytest.mark.parametrize("clock", ["", ", clock: {resets: allow}"])
def test_a_ring_buffer_of_less_than_two_minutes_is_no_clock_that_a_server_set(
    tmp_path: Path, say: Say, clock: str
) -> None:
    _log(tmp_path, 60, clock=clock, count=100, step=1)
    said = say("ingest", tmp_path / "campaign.yaml")
    assert "a ring buffer: its oldest rows stand from row 41 on" in said.out
    asked = "select count(*), min(t_s), max(t_s), corr(t_s, value) > 0.9999 from sample"
    assert say("sql", asked, "--csv").out.splitlines()[1] == "100,0.0,99.0,True"


def test_a_clock_that_was_set_back_a_minute_is_joined_still(tmp_path: Path, say: Say) -> None:
    """What follows runs into the times from before, as no buffer does."""
    times = [*range(60), *range(10, 70)]
    rows = [f"2026-03-02 08:{t // 60:02d}:{t % 60:02d},{20 + k / 500:.4f}" for k, t in enumerate(times)]
    (tmp_path / "a.csv").write_text("\n".join(["time,T_bed", *rows, ""]), encoding="utf-8")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN.format(clock=""), encoding="utf-8")
    assert "the clock was set back once" in say("ingest", tmp_path / "campaign.yaml").out
    assert say("sql", "select corr(t_s, value) > 0.9999 from sample", "--csv").out.splitlines()[1] == "True"


def test_what_is_older_behind_a_pause_is_not_said_to_be_joined_by_a_reset(tmp_path: Path, say: Say) -> None:
    _log(tmp_path, 380, pause=300)
    said = say("ingest", tmp_path / "campaign.yaml").out
    assert "what follows is older than all before it: a ring buffer with a pause? sort the file by its time" in said


def test_init_asks_nothing_of_a_ring_buffer(tmp_path: Path, say: Say) -> None:
    _log(tmp_path, 380)
    (tmp_path / "campaign.yaml").unlink()
    say("init", tmp_path)
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert "goes back" not in text
    assert "a ring buffer: its oldest rows stand from row 221 on" in text
    (tmp_path / "campaign.yaml").unlink()
    _log(tmp_path, 380, pause=300)
    (tmp_path / "campaign.yaml").unlink()
    say("init", tmp_path)
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert "what follows is older than all before it: a ring buffer with a pause?" in text
