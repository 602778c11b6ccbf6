"""When a log ends whose clock was set back, once what follows is joined (told/clocks/ends.py)."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

pytestmark = pytest.mark.usefixtures("installed_readers")

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
sources:
  nc: {reader: table, files: "nc_{test}.csv", timezone: UTC%s}
  daq: {reader: table, files: "daq_{test}.csv", timezone: UTC}
channels:
  T_m: {source: nc, signal: T_m, quantity: temperature, unit: degC}
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
tests:
  - {id: a, kind: mixed, role: none}
"""


def written(path: Path, name: str, minutes: int, back_at: int | None = None) -> None:
    rows = [datetime(2026, 10, 5, 7) + timedelta(minutes=i) for i in range(minutes)]
    if back_at is not None:
        rows[back_at:] = [t - timedelta(hours=1) for t in rows[back_at:]]
    path.write_text(f"time;{name}\n" + "".join(f"{t:%Y-%m-%d %H:%M:%S};{20 + i / 10}\n" for i, t in enumerate(rows)))


@pytest.mark.parametrize(
    ("minutes", "back_at", "resets", "told"),
    [
        (300, 140, True, ""),
        (300, 140, False, "h in a"),  # what follows is refused
        (200, 140, True, "1.67 h"),  # it does end early
        (200, None, True, "1.67 h"),
        (300, None, True, ""),
    ],
)
def test_what_is_joined_behind_a_step_back_counts_for_the_end_of_its_log(
    tmp_path: Path, minutes: int, back_at: int | None, resets: bool, told: str
) -> None:
    written(tmp_path / "nc_a.csv", "T_m", minutes, back_at)
    written(tmp_path / "daq_a.csv", "dZ", 300)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN % (", clock: {resets: allow}" if resets else ""))
    notes = ingest(Store(tmp_path / "s.store", create=True), tmp_path / "campaign.yaml").notes
    early = [n for n in notes if "ends long before 'daq'" in n]
    assert [told in n for n in early] == ([True] if told else [])
