"""A log without dates begins with what has dates as that is moved by its declared clock."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_daq.csv"OF_DAQ}
  plc: {reader: table, files: "{test}_plc.csv", clock: {offset: OFFSET}}
channels:
  T_b: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
tests:
  - {id: a, kind: spindle, role: calibration}
"""


@pytest.mark.parametrize("offset", ["0 s", "-40 min", "400 d"])
@pytest.mark.parametrize(("own", "later_min"), [("", 0), (", clock: {offset: 10 min}", 10)])
def test_an_offset_of_the_dated_log_moves_both(
    tmp_path: Path, installed_readers: None, offset: str, own: str, later_min: int
) -> None:
    """The speed and the temperature leap at once, an hour behind the begin of each log."""

    def stamp(minute: int) -> str:
        return f"2026-05-11T{6 + minute // 60:02d}:{minute % 60:02d}:00Z"

    daq = "".join(f"{60 * m};{30 if m >= 60 else 20}.{m % 7}\n" for m in range(180))
    (tmp_path / "a_daq.csv").write_text("time [s];T\n" + daq)
    plc = "".join(f"{stamp(m)};{4000 if m >= 60 else 0}\n" for m in range(180))
    (tmp_path / "a_plc.csv").write_text("timestamp;n [rpm]\n" + plc)
    path, store = tmp_path / "campaign.yaml", Store(tmp_path / "s.store", create=True)
    path.write_text(CAMPAIGN.replace("OFFSET", offset).replace("OF_DAQ", own))
    ingest(store, path)
    (test,) = load_dataset(store, "lab", 60.0).tests
    turns = float(test.t_s[test.values["n"] > 3000][0]) / 60
    warms = float(test.t_s[test.values["T_b"] > 29][0]) / 60
    assert warms - turns == later_min


@pytest.mark.parametrize(
    ("start", "zone", "told"),
    [("2026-05-11 08:00", "", True), ("2026-05-11 08:00", ", timezone: UTC", False), ("2026-05-11T08:00Z", "", False)],
)
def test_a_start_that_names_no_zone_is_told(
    tmp_path: Path, installed_readers: None, start: str, zone: str, told: bool
) -> None:
    daq = "".join(f"{60 * m};20.{m % 7}\n" for m in range(180))
    (tmp_path / "a_daq.csv").write_text("time [s];T\n" + daq)
    text = "\n".join(line for line in CAMPAIGN.splitlines() if "plc" not in line).replace("OF_DAQ", zone)
    path, store = tmp_path / "campaign.yaml", Store(tmp_path / "s.store", create=True)
    path.write_text(text.replace("{id: a,", f'{{id: a, start: "{start}",') + "\n")
    said = "a: its start names no zone, and no source declares one: taken as UTC; set timezone: of a source, or"
    assert any(n.startswith(said) for n in ingest(store, path).notes) == told
