"""What the logger repeats between two measured moments is no fault of these (store/tidy/flags/measured_alone.py)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from store_fakes import START_NS, write_campaign, write_log

from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """
schema: thermodata/campaign/1
id: sampled
machine: {id: m}
sources: {daq: {reader: npz, files: "raw/{test}.npz"}}
channels:
  dZ: {source: daq, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}
  meas: {source: daq, signal: meas, quantity: state}
tests:
  - {id: a, kind: other, measuring: MEASURING}
"""
EVERY = 30  # rows: a row each 10 s, a reading each 5 min
SAMPLED = 48 * EVERY
N = 2 * SAMPLED
MEASURED: Bool1D = (np.arange(N) % EVERY == 0) | (np.arange(N) >= SAMPLED)
MASKED = '"meas > 0.5"'


def readings() -> Float1D:
    """A drift of 40 um with noise, read every 5 min and repeated for 4 h, then read each time."""
    rows = np.arange(N)
    read = np.where(rows < SAMPLED, rows - rows % EVERY, rows)
    x = 40 * (1 - np.exp(-rows / 900)) + np.random.default_rng(0).normal(0, 0.3, N)
    return np.asarray(np.round(x, 3)[read])


def ingested(store: Store, folder: Path, dz: Float1D, measuring: str = MASKED) -> tuple[Bool1D, list[tuple[str, str]]]:
    """(where dZ counts, shape (n,); its events)."""
    path = write_campaign(folder, CAMPAIGN.replace("MEASURING", measuring), logs=False)
    t = START_NS + np.arange(N, dtype=np.int64) * 10 * 10**9
    write_log(path.parent / "raw/a.npz", {"main": {"t_ns": t, "dZ": dz, "meas": MEASURED.astype(np.float64)}})
    ingest(store, path)
    with store.reader() as con:
        flags = [f for (f,) in con.execute("select flag from sample where channel = 'dZ' order by t").fetchall()]
        events = con.execute("select flag, detail from quality where channel = 'dZ' order by flag, from_s").fetchall()
    faults = int(Flag.HELD | Flag.STUCK | Flag.SATURATED | Flag.NOT_MEASURING)
    return (np.array(flags) & faults) == 0, events


# the mask goes by rows, or by stretches that are found first
@pytest.mark.parametrize("measuring", [MASKED, "{when: meas > 0.5, for: 1 s}"])
def test_each_measured_sample_is_a_reading_of_its_own(store: Store, tmp_path: Path, measuring: str) -> None:
    counts, events = ingested(store, tmp_path / "lab", readings(), measuring)
    assert (counts == MEASURED).all()
    assert events == [("held", "only while not measuring")]


def test_what_repeats_among_the_measured_samples_is_held(store: Store, tmp_path: Path) -> None:
    """A logger that hangs for an hour of the part that is sampled, and for half an hour of the other one."""
    dz = readings()
    hangs = np.zeros(N, dtype=np.bool_)
    hangs[10 * EVERY : 22 * EVERY] = hangs[2000:2180] = True
    dz[10 * EVERY : 22 * EVERY], dz[2000:2180] = dz[10 * EVERY], dz[2000]
    counts, events = ingested(store, tmp_path / "lab", dz)
    assert (counts == (MEASURED & ~hangs)).all()
    assert any(detail != "only while not measuring" for _, detail in events)


def test_without_a_mask_what_the_logger_repeats_is_held(store: Store, tmp_path: Path) -> None:
    counts, _ = ingested(store, tmp_path / "lab", readings(), '"meas > -1"')
    assert not counts[: SAMPLED - EVERY].any()
    assert counts[SAMPLED:].all()


def test_an_extreme_that_the_logger_repeats_is_no_end_of_a_range(store: Store, tmp_path: Path) -> None:
    dz = readings()
    dz[20 * EVERY : 21 * EVERY] = -12.5  # one reading, far out
    counts, _ = ingested(store, tmp_path / "lab", dz)
    assert counts[20 * EVERY]
    assert (counts == MEASURED).all()


def test_a_probe_that_stands_still_between_a_few_moments_is_held(store: Store, tmp_path: Path) -> None:
    """Five moments are few to tell by themselves; what lies between them stands as still. Three are alike by chance."""
    for moments, held in ((5, True), (3, False)):
        dz = readings()
        dz[10 * EVERY : (10 + moments) * EVERY] = dz[10 * EVERY]
        counts, _ = ingested(store, tmp_path / f"lab{moments}", dz)
        assert counts[10 * EVERY : (10 + moments) * EVERY].any() is np.bool_(not held)


@pytest.mark.parametrize(("struck", "found"), [(0.0, []), (2000.0, [1640])])
def test_a_short_measurement_is_no_spike_of_the_probe_in_the_air(
    store: Store, tmp_path: Path, struck: float, found: list[int]
) -> None:
    """Three samples are measured twice in an hour, the probe is far away between them; then all are, one is struck."""
    rows = np.arange(N)
    measured = (rows % 360 < 3) | (rows >= 400)
    dz = 40 * (1 - np.exp(-rows / 900)) + np.random.default_rng(0).normal(0, 0.1, N)
    dz[~measured] = 900.0 + np.random.default_rng(1).normal(0, 0.01, int((~measured).sum()))
    dz[1640] += struck
    path = write_campaign(tmp_path / "lab", CAMPAIGN.replace("MEASURING", MASKED), logs=False)
    t = START_NS + rows.astype(np.int64) * 10 * 10**9
    write_log(path.parent / "raw/a.npz", {"main": {"t_ns": t, "dZ": dz, "meas": measured.astype(np.float64)}})
    ingest(store, path)
    with store.reader() as con:
        flags = [f for (f,) in con.execute("select flag from sample where channel = 'dZ' order by t").fetchall()]
        told = con.execute("select from_s, to_s, n from quality where channel = 'dZ' and flag = 'spike'").fetchall()
    spikes = (np.array(flags) & int(Flag.SPIKE)) != 0
    assert np.flatnonzero(measured & spikes).tolist() == found
    # what is told is what is flagged, and nothing that was taken back
    assert sum(n for _, _, n in told) == spikes.sum()
    assert all(spikes[round(a / 10)] and spikes[round(b / 10)] for a, b, _ in told)


def test_what_stands_at_one_value_is_none_whether_the_measured_samples_tell_it_as_stuck_or_as_an_end(
    store: Store, tmp_path: Path
) -> None:
    """A machine moves between its measurements, and the probe stands at its end meanwhile, for most of the test: it is
    stuck. For an hour a motion that no log has goes on, and `measuring` lets it through: there alone it is an end."""
    rows = np.arange(N)
    away = (rows % 60 < 52) & (rows >= 120) & (rows < 2400)
    passes = (rows >= 900) & (rows < 1500)
    dz = np.round(20 * (1 - np.exp(-rows / 900)) + np.random.default_rng(0).normal(0, 0.24, N), 3)
    dz[away] = -223.198
    meas = (~away | passes).astype(np.float64)
    path = write_campaign(tmp_path / "lab", CAMPAIGN.replace("MEASURING", MASKED), logs=False)
    t = START_NS + rows.astype(np.int64) * 10 * 10**9
    write_log(path.parent / "raw/a.npz", {"main": {"t_ns": t, "dZ": dz, "meas": meas}})
    ingest(store, path)
    with store.reader() as con:
        rows_of = con.execute("select flag, valid(flag) from sample where channel = 'dZ' order by t").fetchall()
    flags, valid = np.array(rows_of).T
    assert ((flags[away & passes] & int(Flag.STUCK | Flag.SATURATED)) != 0).all()
    assert (valid.astype(bool) == ~away).all()


def test_a_probe_that_is_not_in_reach_yet_when_measuring_begins_stays_saturated(store: Store, tmp_path: Path) -> None:
    """Five of a day's readings of 520 um counted, each the first of a measurement that the position had begun."""
    rows = np.arange(N)
    rng = np.random.default_rng(1)
    x = 40 * (1 - np.exp(-rows / 900)) + rng.normal(0, 0.3, N)
    phase = rows % EVERY
    x[(phase > 17) | ((phase == 0) & (rows // EVERY % 30 == 0))] = 520.0
    path = write_campaign(tmp_path / "lab", CAMPAIGN.replace("MEASURING", MASKED), logs=False)
    t = START_NS + rows.astype(np.int64) * 10 * 10**9
    meas = (phase <= 17).astype(np.float64)
    write_log(path.parent / "raw/a.npz", {"main": {"t_ns": t, "dZ": np.round(x, 3), "meas": meas}})
    ingest(store, path)
    with store.reader() as con:
        (most, count) = con.execute("select max(value), count(*) from displacement where valid(flag)").fetchone()
    assert most < 50
    assert count == int(((phase <= 17) & (x < 500)).sum())
