"""What goes both ways within a bin: its mean is nothing, and what it rubs is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view import load_dataset

pytestmark = pytest.mark.usefixtures("installed_readers")

CAMPAIGN = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  plc: {reader: table, files: "{test}_plc.csv"}
  log: {reader: table, files: "{test}_log.csv"}
channels:
  v: {source: plc, signal: "v [m/min]", quantity: feed, unit: m/min, at: axis.x}
  M: {source: plc, signal: "M [N m]", quantity: torque, unit: N m, at: axis.x.motor}
  P: {source: plc, signal: "P [kW]", quantity: power, unit: kW, at: axis.x.motor}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
  x: {source: plc, signal: "x [um]", quantity: displacement, unit: um, axis: X, at: spindle}
  v_log: {source: log, signal: "v [m/min]", quantity: feed, unit: m/min, at: axis.y}
tests:
  - {id: day, kind: linear_axis, role: calibration}
"""
MINUTE = 60


def _told(tmp_path: Path) -> dict[str, np.ndarray]:
    """Ten minutes at 1 s: the axis goes to and fro by strokes of 7 s, the spindle turns backwards, the axis of the
    other log goes by strokes of 20 s and writes when it turns."""
    s = np.arange(10 * MINUTE)
    way = np.where(s // 7 % 2, -1.0, 1.0)
    columns = (8 * way, 3 * way, 0.4 * way, np.full(s.size, -3000.0), 5 * way)
    times = np.datetime_as_string(np.datetime64("2026-05-11T06:00:00") + s)
    rows = (f"{t}Z;" + ";".join(f"{c[i]:g}" for c in columns) for i, t in enumerate(times))
    head = "timestamp;v [m/min];M [N m];P [kW];n [rpm];x [um]\n"
    (tmp_path / "day_plc.csv").write_text(head + "\n".join(rows) + "\n")
    turns = [0, 20, 40, 61, 79, 102, 120, 150, 163, 190, 400, 599]
    written = (f"{times[k]}Z;{v:g}" for k, v in zip(turns, [6, -6] * 4 + [6, -2, -2, -2], strict=True))
    (tmp_path / "day_log.csv").write_text("timestamp;v [m/min]\n" + "\n".join(written) + "\n")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    (test,) = load_dataset(store, "lab", 60.0).tests
    names = ("v", "M", "P", "n", "x", "v_log")
    with store.reader() as con:
        binned = con.execute("select * from binned('lab', 'day', step := '60 s')").fetchnumpy()
    for name in names:
        np.testing.assert_allclose(np.ma.filled(binned[name].astype(float), np.nan), test.values[name], rtol=1e-6)
    return {name: test.values[name] for name in names}


def test_a_feed_that_goes_to_and_fro_has_its_size_in_a_bin(tmp_path: Path) -> None:
    told = _told(tmp_path)
    np.testing.assert_allclose(told["v"], 8.0)
    np.testing.assert_allclose(told["M"], 3.0)
    # a drive feeds power back, and a displacement is where the tool is
    assert np.abs(told["P"]).max() < 0.1
    assert np.abs(told["x"]).max() < 1.0


def test_what_goes_one_way_has_its_sign(tmp_path: Path) -> None:
    told = _told(tmp_path)
    np.testing.assert_allclose(told["n"], -3000.0)
    np.testing.assert_allclose(told["v_log"][:3], 6.0)  # it turned in each of these minutes
    np.testing.assert_allclose(told["v_log"][4:], -2.0)


SLOW = """\
schema: thermodata/campaign/1
id: lab
machine: {id: m1}
sources:
  plc: {reader: table, files: "{test}_plc.csv"}
channels:
  v: {source: plc, signal: "v [m/min]", quantity: feed, unit: m/min, at: axis.x}
  n: {source: plc, signal: "n [rpm]", quantity: rotational_speed, unit: rpm, at: spindle}
  P: {source: plc, signal: "P [kW]", quantity: power, unit: kW, at: axis.x.motor}
tests:
  - {id: day, kind: linear_axis, role: calibration}
"""


def test_between_two_signs_of_a_slow_log_stands_the_size(tmp_path: Path) -> None:
    """Every 10 s, one way after the other, on a grid of 5 s: a line through nought halved the mean size."""
    rows = []
    for i, second in enumerate(range(0, 600, 10)):
        way = -1 if i % 2 else 1
        v, n = 8 * way, (0, 1000, 2000, 3000)[min(i, 3)]
        rows.append(f"2026-05-11T06:{second // 60:02d}:{second % 60:02d}Z;{v if i != 30 else -4};{n};{0.4 * way}")
    (tmp_path / "day_plc.csv").write_text("timestamp;v [m/min];n [rpm];P [kW]\n" + "\n".join(rows) + "\n")
    (tmp_path / "campaign.yaml").write_text(SLOW)
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    (test,) = load_dataset(store, "lab", 5.0).tests
    with store.reader() as con:
        binned = con.execute("select * from binned('lab', 'day', step := '5 s')").fetchnumpy()
    for name in ("v", "n", "P"):
        told = np.ma.filled(binned[name].astype(float), np.nan)
        np.testing.assert_allclose(told[: test.t_s.size], test.values[name][: told.size], rtol=1e-6, atol=1e-9)
    v = test.values["v"]
    np.testing.assert_allclose(np.abs(v[:58]), 8.0)  # 4.0 in the mean by lines through nought
    np.testing.assert_allclose(v[[58, 59, 60, 61, 62]], [-8.0, -6.0, -4.0, -6.0, -8.0])  # of one sign: a line
    np.testing.assert_allclose(test.values["n"][:7], [0, 500, 1000, 1500, 2000, 2500, 3000])
    np.testing.assert_allclose(test.values["P"][1:57:2], 0.0, atol=1e-9)  # what a drive feeds back is no heat
