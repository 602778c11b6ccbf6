"""The clock of a control that nobody set is years off: the line that puts it right is told, and can be pasted."""

from __future__ import annotations

import re
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_daq.csv"}
  nc: {reader: table, files: "{test}_nc.csv"}
channels:
  dZ: {source: daq, signal: "dZ [um]", quantity: displacement, unit: um, axis: Z, at: tcp, relative_to: table}
  n: {source: nc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
tests:
  - {id: a, kind: spindle, role: calibration}
  - {id: b, kind: spindle, role: calibration}
"""


def log(path: Path, column: str, first: datetime) -> None:
    rows = [f"{first + timedelta(minutes=k):%Y-%m-%d %H:%M:%S},{(k * 7) % 90 + k / 10}" for k in range(121)]
    path.write_text("\n".join([f"time,{column}", *rows, ""]))


def asked_of(folder: Path) -> dict[str, list[str]]:
    """Source -> its questions, but for the zone."""
    return {s.name: [q for q in s.questions if "timezone" not in q] for s in draft_files(folder).draft.sources}


@pytest.fixture
def lab(tmp_path: Path, installed_readers: None) -> Path:
    """The control's clock stood 2557 days back, and its log begins 3 s later."""
    for test, day in (("a", 2), ("b", 3)):
        first = datetime(2026, 6, day, 8)
        log(tmp_path / f"{test}_daq.csv", "dZ [um]", first)
        log(tmp_path / f"{test}_nc.csv", "n [rpm]", first - timedelta(days=2557) + timedelta(seconds=3))
    return tmp_path


def test_a_clock_years_off_is_told_once_with_a_line_that_puts_it_right(lab: Path) -> None:
    (lab / "campaign.yaml").write_text(CAMPAIGN)
    notes = ingest(Store(lab / "store", create=True), lab / "campaign.yaml").notes
    [said] = [n for n in notes if "test 'a'" in n]
    assert "runs 61365 h 59 min 57 s earlier" in said
    assert not any("long before" in n for n in notes), "that is the clock's"
    line = re.search(r"clock: \{offset: [^}]*\}", said)
    assert line is not None
    assert line[0] == "clock: {offset: 61367 h 59 min 57 s}"
    (lab / "campaign.yaml").write_text(CAMPAIGN.replace('"{test}_nc.csv"', f'"{{test}}_nc.csv", {line[0]}'))
    notes = ingest(Store(lab / "store"), lab / "campaign.yaml").notes
    assert not any("runs" in n or "clock right" in n for n in notes)
    (lab / "campaign.yaml").write_text(CAMPAIGN.replace('"{test}_nc.csv"', '"{test}_nc.csv", clock: {offset: 61000 h}'))
    assert any(line[0] in n for n in ingest(Store(lab / "store"), lab / "campaign.yaml").notes)


def test_the_draft_asks_for_it_with_the_line(lab: Path) -> None:
    found = asked_of(lab)
    assert found["daq"] == []
    [asked] = found["nc"]
    assert asked.startswith("was its clock right? in a it begins 61367 h 59 min 57 s before 'daq'")
    assert "clock: {offset: 61367 h 59 min 57 s}" in asked


def test_each_test_has_its_own_line_where_the_clock_was_set_in_between(lab: Path) -> None:
    log(lab / "b_nc.csv", "n [rpm]", datetime(2019, 6, 2, 8))
    [asked] = asked_of(lab)["nc"]
    assert "clocks: {nc: 61367 h 59 min 57 s} in a, clocks: {nc: 61392 h} in b" in asked


def test_a_clock_that_is_a_day_off_at_most_is_asked_otherwise(lab: Path) -> None:
    log(lab / "b_nc.csv", "n [rpm]", datetime(2026, 6, 3, 20))
    assert asked_of(lab)["nc"] == []
