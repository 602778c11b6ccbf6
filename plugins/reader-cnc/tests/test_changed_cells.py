"""A log that writes the changed cells alone, from its file to the bins: the speed stands until it is written again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """\
schema: thermodata/campaign/1
id: shop
machine: {id: x}
sources:
  nc: {reader: cnc, files: "{test}.csv"}
channels:
  n: {source: nc, signal: n, quantity: rotational_speed, unit: rpm, at: spindle}
  T_b: {source: nc, signal: T_b, quantity: temperature, unit: degC, at: spindle.bearing}
tests:
  - {id: one, kind: spindle, role: calibration}
"""


@pytest.mark.parametrize(("stands", "known"), [(None, True), ("none", False)])
def test_the_speed_of_a_log_of_changes_stands_in_every_bin(tmp_path: Path, stands: str | None, known: bool) -> None:
    rng = np.random.default_rng(2)
    speed, last = np.where((np.arange(720) >= 60) & (np.arange(720) < 600), 4000, 0), ("", "")
    lines = ["time;T_b [degC];n [rpm]"]
    for k, temperature in enumerate(20 + np.arange(720) / 100 + rng.normal(0, 0.1, 720)):
        cells = f"{temperature:.1f}", str(speed[k])
        if cells != last:
            changed = (c if c != b else "" for c, b in zip(cells, last, strict=True))
            lines.append(f"2026-05-04T{8 + k // 360:02}:{k // 6 % 60:02}:{k % 6 * 10:02}Z;" + ";".join(changed))
        last = cells
    (tmp_path / "one.csv").write_text("\n".join([*lines, ""]))
    declared = "" if stands is None else f", table: {{stands: {stands}}}"
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN.replace('"{test}.csv"', '"{test}.csv"' + declared))
    made = Store(tmp_path / "store", create=True)
    ingest(made, tmp_path / "campaign.yaml")
    with made.reader() as con:
        bins = con.execute("select n from binned('shop', 'one', '60 s') order by t_s").fetchnumpy()["n"]
        flagged = {flag for (flag,) in con.execute("select flag from quality_event").fetchall()}
    binned = np.ma.filled(bins.astype(float), np.nan)
    assert np.array_equal(binned[:119], speed[::6][:119]) is known
    assert ("out_of_range" in flagged) is not known
