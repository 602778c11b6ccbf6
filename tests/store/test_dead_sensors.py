"""A temperature that stands through a test: one that is dead, and one of coarse steps in a calm place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CHANNELS = "".join(
    f"  T{k}: {{source: log, signal: T{k}, quantity: temperature, unit: degC, at: {at}}}\n"
    for k, at in enumerate(("coolant.tank", "bed", "column.front", "ram", "table"))
)
CAMPAIGN = f"""
schema: thermodata/campaign/1
id: c
sources: {{log: {{reader: table, files: "{{test}}.csv", timezone: UTC}}}}
channels:
{CHANNELS}tests: [{{id: a, kind: etve}}, {{id: b, kind: etve}}, {{id: c, kind: etve}}]
"""


OFTEN = (35, 95, 96, 145, 211, 298, 352)


@pytest.mark.parametrize(
    ("others", "stuck"),
    [
        ({}, True),
        ({211: 0.1}, True),
        ({211: 0.1, 212: 0.1, 213: 0.1, 214: 0.1, 215: 0.1}, True),  # once
        ({95: -20.5, 298: -20.5}, True),
        (dict.fromkeys(OFTEN, -20.5), True),  # it drops out
        (dict.fromkeys((101, 103, 105, 107, 109, 111), 0.1), True),  # not all over the test
        ({row: 0.1 if k % 2 else -0.1 for k, row in enumerate(OFTEN)}, False),
    ],
)
def test_a_coarse_sensor_that_shows_the_next_tread_now_and_then_is_alive(
    tmp_path: Path, installed_readers: None, others: dict[int, float], stuck: bool
) -> None:
    i = np.arange(400)
    for k, test in enumerate("abc"):
        tank = np.round(20.5 + (6.0 * (1 - np.exp(-i / 90)) if test != "c" else 0.0 * i), 1)
        for row, apart in others.items() if test == "c" else ():
            tank[row] += apart
        machine = [np.round(20 + n * (1 - np.exp(-i / 80)) + 0.01 * (i % 3), 2) for n in (4, 5, 6, 7)]
        times = np.datetime64(f"2026-03-0{k + 2}T08:00:00") + i * np.timedelta64(60, "s")
        rows = [f"{t}," + ",".join(f"{v:.2f}" for v in row) for t, *row in zip(times, tank, *machine, strict=True)]
        (tmp_path / f"{test}.csv").write_text("time,T0,T1,T2,T3,T4\n" + "\n".join(rows) + "\n")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    with store.reader() as con:
        told = con.execute("select distinct test, channel from quality where flag = 'stuck'").fetchall()
    assert told == ([("c", "T0")] if stuck else [])
