"""A clock that was off in one test is put right there: `tests[].clocks`."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.load import parse_campaign
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.trace.lineage import trace
from thermodata.view import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_daq.csv", clock: {offset: 0 s}}
  plc: {reader: table, files: "{test}_plc.csv"}
channels:
  T_b: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
tests:
  - {id: a, kind: spindle, role: calibration}
  - {id: b, kind: spindle, role: calibration CLOCKS}
"""
MENDED = CAMPAIGN.replace(" CLOCKS", ", clocks: {plc: -40 min}")


@pytest.fixture
def lab(tmp_path: Path, installed_readers: None) -> Path:
    """The speed is 4000 rpm from the first hour on; in test b the control's clock is 40 min late."""

    def stamp(minute: int) -> str:
        return f"2026-05-11T{6 + minute // 60:02d}:{minute % 60:02d}:00Z"

    for test, late in (("a", 0), ("b", 40)):
        daq = "".join(f"{stamp(m)};{20 + 0.01 * m}\n" for m in range(180))
        plc = "".join(f"{stamp(m + late)};{4000 if m >= 60 else 0}\n" for m in range(180))
        (tmp_path / f"{test}_daq.csv").write_text("timestamp;T\n" + daq)
        (tmp_path / f"{test}_plc.csv").write_text("timestamp;n [rpm]\n" + plc)
    return tmp_path


def begins(store: Store) -> dict[str, float]:
    """Test -> minute at which the spindle begins."""
    data = load_dataset(store, "lab", 60.0)
    return {t.test: float(t.t_s[t.values["n"] > 3000][0]) / 60 for t in data.tests}


def test_the_clock_of_one_test_is_put_right_and_no_other(lab: Path) -> None:
    path, store = lab / "campaign.yaml", Store(lab / "s.store", create=True)
    path.write_text(CAMPAIGN.replace(" CLOCKS", ""))
    ingest(store, path)
    assert begins(store) == {"a": 60.0, "b": 100.0}
    path.write_text(MENDED)
    ingest(store, path)
    assert begins(store) == {"a": 60.0, "b": 60.0}
    data = load_dataset(store, "lab", 60.0)
    declared = {t.test: {c.source for c in t.channels.values() if c.clock_declared} for t in data.tests}
    assert declared == {"a": {"daq"}, "b": {"daq", "plc"}}
    assert not data.channels["n"].clock_declared
    assert data.channels["T_b"].clock_declared
    assert trace(store, "lab", "b", "n", 3660.0)["sample"]["raw"]["row"] == 61


def test_a_clock_of_no_source_is_refused() -> None:
    with pytest.raises(SpecError, match="source"):
        parse_campaign(MENDED.replace("{plc:", "{pls:"))
