"""A probes' log of many tests that a control's files cut, and that does not reach their ends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """
schema: thermodata/campaign/1
id: c
sources:
  daq: {reader: table, files: daq.csv, timezone: UTC}
  cnc: {reader: table, files: "{test}.csv", timezone: ZONE}
channels:
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
  n: {source: cnc, signal: n, quantity: rotational_speed, unit: rpm, at: spindle}
tests: [{id: a, kind: spindle}, {id: b, kind: spindle}]
"""


def written(path: Path, head: str, begin_min: int, count: int) -> None:
    t = np.datetime64("2026-03-02T08:00:00") + (begin_min + np.arange(count)) * np.timedelta64(1, "m")
    path.write_text(f"time,{head}\n" + "".join(f"{a},{k % 7 + k / 50:.2f}\n" for k, a in enumerate(t)))


@pytest.mark.parametrize(
    ("zone", "longer_min", "said"),
    [
        ("UTC", 0, []),
        ("UTC", -4, []),
        ("UTC", -20, ["test 'b': 'daq', which 'cnc' cuts, ends 20 min before 'cnc'"]),
        ("Etc/GMT+1", 0, ["test 'b': 'daq', which 'cnc' cuts, ends 1 h before 'cnc'"]),  # 1 h behind UTC
        ("Etc/GMT-1", 0, ["test 'a': 'daq', which 'cnc' cuts, begins 1 h after 'cnc'"]),
    ],
)
def test_what_a_wrong_clock_cuts_off_is_told_with_its_cause(
    tmp_path: Path, installed_readers: None, zone: str, longer_min: int, said: list[str]
) -> None:
    written(tmp_path / "daq.csv", "dZ [um]", 0, 420 + longer_min)
    written(tmp_path / "a.csv", "n [rpm]", 0, 180)
    written(tmp_path / "b.csv", "n [rpm]", 240, 180)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN.replace("ZONE", zone))
    summary = ingest(Store(tmp_path / "store", create=True), tmp_path / "campaign.yaml")
    told = [note for note in summary.notes if "cuts, " in note]
    assert len(told) == len(said)
    for note, words in zip(told, said, strict=True):
        assert words in note
        assert "the clock or timezone of one of them is wrong, and the cut with it" in note
