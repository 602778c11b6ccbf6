"""A log that is written when something changes: what is commanded stands between its rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.tidy.on_change import has_no_rate
from thermodata.store.tidy.timeline import given_timeline
from thermodata.view import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_daq.csv"}
  plc: {reader: table, files: "{test}_plc.csv"}
channels:
  T_b: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
tests:
  - {id: day, kind: spindle, role: calibration}
"""


def times(every_s: list[float]) -> object:
    return given_timeline((np.cumsum([0.0, *every_s]) * 1e9).astype(np.int64))


pytestmark = pytest.mark.usefixtures("installed_readers")


@pytest.mark.parametrize(
    ("every_s", "at_no_rate"),
    [
        ([1800.0, 9000.0], True),
        ([60.0, 1.0, 700.0, 3.0, 2000.0], True),
        ([60.0] * 50, False),
        ([60.0] * 40 + [7200.0] + [60.0] * 40, False),  # a pause is no change
        ([1.0, 1.1, 0.9, 2.0, 1.0, 1.0], False),
        ([3600.0], False),
    ],
)
def test_a_log_has_a_rate_or_none(every_s: list[float], at_no_rate: bool) -> None:
    assert has_no_rate(times(every_s)) is at_no_rate  # type: ignore[arg-type]


def test_a_speed_stands_between_the_rows_of_a_log_that_is_written_on_change(tmp_path: Path) -> None:
    minutes = range(240)
    rows = "".join(f"2026-05-11T{6 + m // 60:02d}:{m % 60:02d}:00Z;{20 + 0.01 * m}\n" for m in minutes)
    (tmp_path / "day_daq.csv").write_text("timestamp;T\n" + rows)
    (tmp_path / "day_plc.csv").write_text(
        "timestamp;n [rpm]\n2026-05-11T06:00:00Z;0\n2026-05-11T06:30:00Z;4000\n2026-05-11T09:00:00Z;0\n"
    )
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "s.store", create=True)
    summary = ingest(store, tmp_path / "campaign.yaml")
    assert [n for n in summary.notes if n.startswith("day, plc: n: rows come at no rate")]
    (test,) = load_dataset(store, "lab", 60.0).tests
    speed = test.values["n"]
    assert set(speed[:30]) == {0.0}
    assert set(speed[30:180]) == {4000.0}
