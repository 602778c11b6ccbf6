"""Parts of a recording that tell times of day without a date: the pause between them is theirs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  daq: {reader: table, files: "{test}_*.txt"}
channels:
  T_b: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}
tests:
  - {id: night, kind: spindle, role: calibration}
"""


pytestmark = pytest.mark.usefixtures("installed_readers")


def part(path: Path, begin_min: int, minutes: int, first: float) -> None:
    rows = (
        f"{(m // 60) % 24:02d}:{m % 60:02d}:00\t{first + m - begin_min}" for m in range(begin_min, begin_min + minutes)
    )
    path.write_text("Uhrzeit\tT\n" + "\n".join(rows) + "\n")


@pytest.mark.parametrize(
    ("second_min", "pause_min"),
    [
        (22 * 60 + 40, 10),  # 21:30 to 22:29, and on at 22:40
        (40, 130),  # after midnight
        (21 * 60 + 29, 23 * 60 - 1),  # earlier in the day: the next one
        (22 * 60 + 25, 0),  # a clock that was set between them: end to end, as the rows follow each other
    ],
)
def test_a_pause_between_two_parts_is_kept(tmp_path: Path, second_min: int, pause_min: int) -> None:
    part(tmp_path / "night_001.txt", 21 * 60 + 30, 60, 20.0)
    part(tmp_path / "night_002.txt", second_min, 30, 79.5)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    (test,) = load_dataset(store, "lab", 60.0).tests
    (at,) = np.flatnonzero(test.values["T_b"] == 79.5)
    assert test.t_s[at] / 60 == 60 + pause_min


def test_parts_that_stand_newest_first_keep_it_too(tmp_path: Path) -> None:
    for name, begin in (("001", 21 * 60 + 30), ("002", 22 * 60 + 40)):
        part(tmp_path / f"night_{name}.txt", begin, 60 if name == "001" else 30, 20.0 if name == "001" else 79.5)
        head, *rows = (tmp_path / f"night_{name}.txt").read_text().splitlines()
        (tmp_path / f"night_{name}.txt").write_text("\n".join([head, *rows[::-1]]) + "\n")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    (test,) = load_dataset(store, "lab", 60.0).tests
    (at,) = np.flatnonzero(test.values["T_b"] == 79.5)
    assert (test.t_s[0], test.t_s[at] / 60) == (0.0, 70)
