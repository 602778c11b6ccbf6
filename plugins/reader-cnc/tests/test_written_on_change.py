"""What a log writes on change stands until the next row: in the grids, in what models are fitted to, in the flags."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.flags import flag_stream
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.load import load_dataset

CAMPAIGN = """\
schema: thermodata/campaign/1
id: shop
machine: {id: x}
sources:
  daq: {reader: table, files: "raw/{test}.csv"}
  nc: {reader: cnc, files: "raw/{test}.txt"}
channels:
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
  n: {source: nc, signal: Sspeed, quantity: rotational_speed, unit: rpm, at: spindle}
  T_b: {source: nc, signal: Btemp, quantity: temperature, unit: degC, at: spindle.bearing}
tests:
  - {id: one, kind: spindle, role: calibration}
"""
SAID = """\
2026-05-04T08:00:00Z|Sspeed|0|Btemp|21.5
2026-05-04T08:20:00Z|Sspeed|12000
2026-05-04T09:20:30Z|Sspeed|UNAVAILABLE
2026-05-04T09:40:00Z|Sspeed|8000
2026-05-04T09:50:15Z|Sspeed|4000
2026-05-04T09:52:00Z|Sspeed|0
2026-05-04T09:52:10Z|Sspeed|6000
2026-05-04T09:52:50Z|Sspeed|0
2026-05-04T09:59:50Z|avail|AVAILABLE
"""


@pytest.fixture
def store(tmp_path: Path) -> Store:
    (tmp_path / "raw").mkdir()
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    (tmp_path / "raw" / "one.txt").write_text(SAID)
    rows = [f"2026-05-04T{8 + s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}Z,{s % 7 / 10}" for s in range(0, 7200, 10)]
    (tmp_path / "raw" / "one.csv").write_text("\n".join(["time,dZ [um]", *rows, ""]))
    made = Store(tmp_path / "store", create=True)
    ingest(made, tmp_path / "campaign.yaml")
    return made


MINUTES = np.arange(120)
# of each minute the mean over the time in which it had a value
SPEED = np.select([MINUTES < 20, MINUTES < 81, MINUTES < 100, MINUTES < 110], [0.0, 12000.0, np.nan, 8000.0], 0.0)
SPEED[110:113] = 5000.0, 4000.0, 4000.0


def test_a_grid_holds_it_and_ends_where_the_log_says_that_there_is_none(store: Store) -> None:
    with store.reader() as con:
        for grid in ("binned", "aligned"):
            rows = con.execute(f"select n, T_b from {grid}('shop', 'one', '60 s') order by t_s").fetchnumpy()
            speed = np.ma.filled(rows["n"].astype(float), np.nan)
            at = SPEED.copy()
            if grid == "aligned":  # the last row at or before each point
                at[110:113] = 8000.0, 4000.0, 0.0
            np.testing.assert_allclose(speed, at, err_msg=grid)
            assert (rows["T_b"] == 21.5).all()


def test_models_are_fitted_to_what_it_held(store: Store) -> None:
    (test,) = load_dataset(store, "shop", 60.0).tests
    np.testing.assert_allclose(test.values["n"], SPEED)
    np.testing.assert_array_equal(test.valid["n"], np.isfinite(SPEED))
    assert (test.values["T_b"] == 21.5).all()


def test_what_moves_within_a_bin_counts_by_its_time(store: Store) -> None:
    """Whatever the step: a coarse bin has the mean of the fine ones."""
    fine, coarse = (load_dataset(store, "shop", step).tests[0] for step in (10.0, 60.0))
    whole = fine.values["n"].reshape(-1, 6).mean(axis=1)
    told = np.isfinite(whole)
    np.testing.assert_allclose(whole[told], coarse.values["n"][told])


def test_a_displacement_is_never_made_up(store: Store, tmp_path: Path) -> None:
    text = (tmp_path / "campaign.yaml").read_text()
    text = text.replace("rotational_speed, unit: rpm, at: spindle", "displacement, unit: um, axis: X, at: tcp")
    (tmp_path / "campaign.yaml").write_text(text)
    ingest(store, tmp_path / "campaign.yaml")
    (test,) = load_dataset(store, "shop", 60.0).tests
    assert test.valid["n"].sum() < 10, "bins with rows only"


def test_no_row_is_no_gap_and_what_stands_still_is_sound(store: Store) -> None:
    with store.reader() as con:
        said = {flag for (flag,) in con.execute("select flag from quality_event").fetchall()}
    assert said <= {"not_measuring", "out_of_range"}, "of the speed that was unavailable"
    rng = np.random.default_rng(0)
    t_ns = np.cumsum(np.where(np.arange(2000) % 700 == 300, 900, 1)).astype(np.int64) * 10**9
    noisy = rng.normal(20, 1, 2000)
    noisy[500:900] = noisy[500]
    inputs = {
        held: {n: ColumnInput(x, "temperature", held=held) for n, x in (("a", noisy), ("b", rng.normal(20, 1, 2000)))}
        for held in (False, True)
    }
    flags = {held: flag_stream(t_ns, inputs[held])[0]["a"] for held in (False, True)}
    assert (flags[False] & (Flag.HELD | Flag.STUCK))[501:899].all()
    assert (flags[False] & Flag.GAP).any()
    assert not (flags[True] & (Flag.HELD | Flag.STUCK | Flag.GAP | Flag.RATE_CHANGE)).any()
