"""A calibrated sample names the rows of its jump test too (store/trace/jump_rows.py)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from thermodata.cli.look.tracing_text import trace_text
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.trace.lineage import trace

pytestmark = pytest.mark.usefixtures("installed_readers")

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  log: {reader: table, files: "{test}.csv"}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: jump_z}
  lift: {derive: "dZ + 0 um", quantity: displacement, axis: Z, at: tcp}
  T_hall: {source: log, signal: T, quantity: temperature, unit: degC, at: hall}
calibrations:
  jump_z: {kind: jump, axis: Z, source: log, file: jump.csv, signal: dZ, moves: [100 um, -50 um], dwell: 10 s}
tests:
  - {id: day, kind: etve, role: calibration}
"""
LEAD = 5  # rows without a reading; the times of plateaus count behind them


def _volts(rng: np.random.Generator) -> list[float]:
    """10 s a dwell at 5 Hz behind the lead: 5 V, and 0.01 V/um; one spike in the first dwell."""
    levels = np.repeat([5.0, 6.0, 5.5], 50) + rng.normal(0, 1e-3, 150)
    levels[25] = 9.0
    return [float("nan")] * LEAD + levels.tolist()


@pytest.fixture
def store(tmp_path: Path) -> Store:
    volts = _volts(np.random.default_rng(1))
    rows = (f"{0.2 * i:.1f},{'' if v != v else f'{v:.6f}'},21" for i, v in enumerate(volts))
    (tmp_path / "jump.csv").write_text("t [s],dZ,T\n" + "\n".join(rows) + "\n")
    (tmp_path / "day.csv").write_text("t [s],dZ,T\n" + "".join(f"{i},{5 + i / 1000},21\n" for i in range(60)))
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    return store


@pytest.mark.parametrize("channel", ["dZ", "lift"])
def test_the_rows_of_each_plateau_are_named(store: Store, tmp_path: Path, channel: str) -> None:
    found = trace(store, "lab", "day", channel, 30.0)
    [step] = (found if channel == "dZ" else found["operands"][0])["calibrations"]
    written = np.genfromtxt(tmp_path / "jump.csv", delimiter=",", skip_header=1)[:, 1]
    assert [at["commanded_um"] for at in step["rows"]] == [0.0, 100.0, 50.0]
    for at in step["rows"]:
        own = written[at["first_row"] : at["last_row"] + 1]
        own = own[own < 8.0]
        assert (at["source_path"], at["used"]) == ("jump.csv", own.size)
        assert at["mean"] == pytest.approx(own.mean(), abs=1e-9)
    assert step["rows"][0]["last_row"] - step["rows"][0]["first_row"] == step["rows"][0]["used"], "but for the spike"
    first = step["rows"][0]
    rows = f"rows {first['first_row'] + 1} to {first['last_row'] + 1} of jump.csv"
    assert re.search(rf"^jump_z +{rows}, .* at 0 um$", trace_text(found), re.MULTILINE)


def test_what_no_jump_test_made_has_no_rows_of_one(store: Store) -> None:
    assert trace(store, "lab", "day", "T_hall", 30.0)["calibrations"] == []
    assert trace(store, "lab", "day", "dZ")["calibrations"][0]["rows"] is None, "of no sample"
