"""A probe at the end of its range with its converter's noise, for a part of two tests or again and again in one:
flagged at ingest."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from store_fakes import START_NS, write_campaign, write_log

from thermodata.plugin import Float1D
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """
schema: thermodata/campaign/1
id: ends
machine: {id: m}
sources: {daq: {reader: npz, files: "raw/{test}.npz"}}
channels:
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
tests:
  - {id: a, kind: other}
  - {id: b, kind: other}
"""
T = np.arange(0.0, 3 * 3600, 5.0)


def warms(seed: int, most: float, end: float) -> Float1D:
    """Growth [um] until 2 h, then cooling; cut off below `end`, behind which a converter adds its noise."""
    up = 1 - np.exp(-np.minimum(T, 7200) / 2000)
    growth = -most * up * np.exp(-np.maximum(T - 7200, 0) / 2000)
    return np.asarray(np.round(np.maximum(growth, end) + np.random.default_rng(seed).normal(0, 0.2, len(T)), 3))


@pytest.mark.parametrize(("ends", "flagged"), [((-80.0, -80.0), True), ((-80.0, -76.0), False)])
def test_two_tests_that_stand_on_one_extreme_in_noise(
    store: Store, tmp_path: Path, ends: tuple[float, float], flagged: bool
) -> None:
    path = write_campaign(tmp_path / "lab", CAMPAIGN, logs=False)
    t_ns = START_NS + (T * 1e9).astype(np.int64)
    for k, (test, end) in enumerate(zip("ab", ends, strict=True)):
        log = {"t_ns": t_ns + k * 86_400 * 10**9, "dZ": warms(k, 110.0 + 10 * k, end)}
        write_log(path.parent / f"raw/{test}.npz", {"main": log})
    ingest(store, path)
    with store.reader() as con:
        rows = con.execute("select test, t_s, value, flag from sample where channel = 'dZ' order by test, t").fetchall()
        details = [d for (d,) in con.execute("select detail from quality where flag = 'saturated'").fetchall()]
    saturated = np.array([(f & int(Flag.SATURATED)) != 0 for *_, f in rows])
    at_end = np.array([x < -78.0 for _, _, x, _ in rows])
    assert not flagged or saturated[at_end].mean() > 0.99
    assert saturated.any() is np.bool_(flagged)
    assert not saturated[~at_end].any()
    assert any("again and again" in d for d in details) is flagged


@pytest.mark.parametrize(("noise", "flagged"), [(0.04, True), (0.2, False)])
def test_one_test_whose_probe_is_out_of_reach_between_measurements(
    store: Store, tmp_path: Path, noise: float, flagged: bool
) -> None:
    """noise: of the converter [um], beside 0.2 um of the probe."""
    path = write_campaign(tmp_path / "lab", CAMPAIGN, logs=False)
    t_ns = START_NS + (T * 1e9).astype(np.int64)
    here = np.arange(len(T)) % 120 < 24
    beyond = 250.0 + np.random.default_rng(9).normal(0, noise, len(T))
    cycles = np.round(np.where(here, warms(3, 30.0, -80.0), beyond), 3)
    for k, (test, x) in enumerate(zip("ab", (cycles, warms(4, 40.0, -80.0)), strict=True)):
        write_log(path.parent / f"raw/{test}.npz", {"main": {"t_ns": t_ns + k * 86_400 * 10**9, "dZ": x}})
    ingest(store, path)
    with store.reader() as con:
        rows = con.execute("select test, flag from sample where channel = 'dZ' order by test, t").fetchall()
    saturated = [[(f & int(Flag.SATURATED)) != 0 for t, f in rows if t == test] for test in "ab"]
    assert saturated[0] == (~here if flagged else np.zeros(len(T), dtype=bool)).tolist()
    assert not any(saturated[1])
