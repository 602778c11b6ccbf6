"""The ends of a log that is written on change are its times (clocks/ends_of_logs.py)."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

from thermodata.diagnosis.clocks.ends_of_logs import ends_of_logs
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_daq.csv"}
  plc: {reader: table, files: "{test}_plc.csv"}
channels:
  dZ: {source: daq, signal: "dZ [um]", quantity: displacement, unit: um, axis: Z, at: tcp}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle, held: true}
tests:
"""
SPEEDS = (0, 6000, 3000, 9000, 0, 4500)


def _write(path: Path, start: datetime, head: str, rows: dict[int, float]) -> None:
    lines = [f"{(start + timedelta(minutes=m)).isoformat().replace('+00:00', 'Z')};{v:g}" for m, v in rows.items()]
    path.write_text("\n".join([head, *lines]) + "\n")


def _store(tmp_path: Path, late_min: int) -> Store:
    """Five days of 5 h; the speed is written when it changes, every few minutes and then for hours not."""
    names = [f"d{day}" for day in range(5)]
    for day, name in enumerate(names):
        start = datetime(2026, 5, 11 + day, 6, tzinfo=UTC)
        _write(tmp_path / f"{name}_daq.csv", start, "timestamp;dZ [um]", {m: m / 60 for m in range(301)})
        turns = [0, *(10 * (day + 1) * i for i in range(1, 5)), 300]
        _write(
            tmp_path / f"{name}_plc.csv",
            start + timedelta(minutes=late_min if day == 2 else 0),
            "timestamp;n [rpm]",
            dict(zip(turns, SPEEDS, strict=True)),
        )
    tests = "".join(f"  - {{id: {name}, kind: spindle, role: calibration}}\n" for name in names)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN + tests)
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    return store


def test_a_clock_that_is_off_in_one_test_is_told_of_a_log_on_change(tmp_path: Path) -> None:
    """By rows times their median step its days last 50 to 250 minutes, and end with nothing."""
    store = _store(tmp_path, 40)
    ends = ends_of_logs(store, cast("Any", SimpleNamespace(data=load_dataset(store, "lab", 60.0))))
    [odd] = ends.odd
    assert (odd.test, odd.late, odd.early, odd.shift_s) == ("d2", "plc", "daq", 2400.0)
    both = frozenset({"daq", "plc"})
    assert ends.together == {("lab", name): both for name in ("d0", "d1", "d3", "d4")}


def test_logs_on_change_that_end_with_the_others_agree(tmp_path: Path) -> None:
    store = _store(tmp_path, 0)
    ends = ends_of_logs(store, cast("Any", SimpleNamespace(data=load_dataset(store, "lab", 60.0))))
    assert not ends.odd
    assert ends.together == {("lab", f"d{day}"): frozenset({"daq", "plc"}) for day in range(5)}
