"""When a test measures: the same whether its rows come in one piece or in many, and told by any channel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from store_fakes import daq, times, write_log

from thermodata.calibration.measuring import measuring_mask
from thermodata.plugin import Bool1D, Int1D
from thermodata.schema.files.campaign import Measuring
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.raw import writer
from thermodata.store.tidy.flags.in_windows import windows
from thermodata.store.tidy.flags.measured.measuring import find_stretches


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 50), st.floats(0, 5), st.floats(0, 8), st.booleans())
def test_stretches_of_pieces_are_those_of_the_whole(
    seed: int, rows: int, settle: float, for_: float, pause: bool
) -> None:
    rng = np.random.default_rng(seed)
    n = 120
    t: Int1D = times(n)
    if pause:
        t[n // 2 :] += 3600 * 1_000_000_000
    on = np.repeat(rng.random(n) < 0.5, rng.integers(1, 9, n))[:n].astype(float)
    spec = Measuring.model_validate({"when": "x == 1", "settle": f"{settle} s", "for": f"{for_} s"})
    whole = measuring_mask(t, spec, {"x": on}, {"x": "1"})

    def parts() -> Iterator[tuple[int, Int1D, Bool1D]]:
        for a in range(0, n, rows):
            yield a, t[a : a + rows], on[a : a + rows] == 1

    found = find_stretches(parts(), float(np.median(np.diff(t))), spec)
    made = np.concatenate([found.mask(a, t[a : a + rows]) for a in range(0, n, rows)])
    np.testing.assert_array_equal(made, whole)


def flags(store: Store, channel: str) -> np.ndarray:
    with store.reader() as con:
        rows = con.sql(f"select flag from signal('shop', 'one', '{channel}') order by t_s").fetchall()
    return np.array([r[0] for r in rows], np.int64)


def declare(campaign: Path, measuring: str) -> None:
    text = campaign.read_text().replace(
        "conditions: {speed: 9000 rpm}}", f"conditions: {{speed: 9000 rpm}}, measuring: {measuring}}}", 1
    )
    campaign.write_text(text)


@pytest.mark.parametrize(
    "measuring",
    ['"speed > 100 rpm"', '{when: "speed > 100 rpm", settle: 20 s, for: 30 s}', "{in_range: in_range, settle: 20 s}"],
)
def test_measuring_does_not_depend_on_the_pieces(
    store: Store, campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, measuring: str
) -> None:
    declare(campaign, measuring)
    n = 150
    write_log(
        campaign.parent / "raw/one.nc.npz",
        {"nc": {"t_ns": times(n, 7.0), "n": np.where(np.arange(n) % 20 < 9, 9000.0, 0.0), "msg": np.full(n, "RUN")}},
    )
    log = daq(1200)
    log["main"]["Z"][[200, 201, 700]] = np.nan
    write_log(campaign.parent / "raw/one_a.npz", log)
    whole = Store(tmp_path / "whole", create=True)
    ingest(whole, campaign)
    monkeypatch.setattr(windows, "WINDOW_VALUES", 1)
    monkeypatch.setattr(windows, "MARGIN_ROWS", 50)
    monkeypatch.setattr(writer, "GROUP_ROWS", 100)
    ingest(store, campaign)
    expected = flags(whole, "dZ")
    assert 0 < np.count_nonzero(expected & Flag.NOT_MEASURING) < len(expected)
    np.testing.assert_array_equal(flags(store, "dZ"), expected)


def test_a_channel_measures_where_another_is_in_its_range(store: Store, campaign: Path) -> None:
    log = daq(1200)
    log["main"]["T1"][300:400] = 95.0
    write_log(campaign.parent / "raw/one_a.npz", log)
    text = campaign.read_text().replace(
        "quantity: temperature, at: spindle}", "quantity: temperature, at: spindle, sensor: {range: [0 degC, 80 degC]}}"
    )
    campaign.write_text(text)
    declare(campaign, "{in_range: T_a}")
    ingest(store, campaign)
    found = flags(store, "dZ") & Flag.NOT_MEASURING != 0
    np.testing.assert_array_equal(found, (np.arange(1200) >= 300) & (np.arange(1200) < 400))


def test_a_test_without_the_channel_that_says_when_it_measures_counts_nowhere(store: Store, campaign: Path) -> None:
    declare(campaign, '"speed > 100 rpm"')
    text = campaign.read_text().replace("{id: one,", "{id: one, channels: {speed: {absent: true}},")
    campaign.write_text(text)
    summary = ingest(store, campaign)
    (told,) = [loss["reason"] for loss in summary.losses if "measuring" in loss["reason"]]
    assert "no channel 'speed'" in told.replace('"', "'") or "'speed'" in told
    assert "none of the test counts" in told
    assert (flags(store, "dZ") & Flag.NOT_MEASURING != 0).all()
    assert not (flags(store, "T_a") & Flag.NOT_MEASURING).any()


@pytest.mark.parametrize(("measuring", "never"), [('"speed > 100000 rpm"', True), ('"speed >= 0 rpm"', False)])
def test_a_measuring_that_never_holds_is_told_each_time(
    store: Store, campaign: Path, measuring: str, never: bool
) -> None:
    declare(campaign, measuring)
    for _ in range(2):
        told = [n for n in ingest(store, campaign).notes if "never holds" in n]
        assert [n.startswith("one, daq: measuring (speed > 100000 rpm) never holds: dZ") for n in told] == [
            True
        ] * never
