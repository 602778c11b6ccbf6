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


@pytest.mark.parametrize(("flickers", "stuck"), [((), True), ((211,), True), ((95, 211, 298), False)])
def test_a_coarse_sensor_that_shows_the_next_tread_now_and_then_is_alive(
    tmp_path: Path, installed_readers: None, flickers: tuple[int, ...], stuck: bool
) -> None:
    i = np.arange(400)
    for k, test in enumerate("abc"):
        tank = np.round(20.5 + (6.0 * (1 - np.exp(-i / 90)) if test != "c" else 0.0 * i), 1)
        tank[list(flickers) if test == "c" else []] += 0.1
        others = [np.round(20 + n * (1 - np.exp(-i / 80)) + 0.01 * (i % 3), 2) for n in (4, 5, 6, 7)]
        times = np.datetime64(f"2026-03-0{k + 2}T08:00:00") + i * np.timedelta64(60, "s")
        rows = [f"{t}," + ",".join(f"{v:.2f}" for v in row) for t, *row in zip(times, tank, *others, strict=True)]
        (tmp_path / f"{test}.csv").write_text("time,T0,T1,T2,T3,T4\n" + "\n".join(rows) + "\n")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    with store.reader() as con:
        told = con.execute("select distinct test, channel from quality where flag = 'stuck'").fetchall()
    assert told == ([("c", "T0")] if stuck else [])
