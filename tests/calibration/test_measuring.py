"""When a test measures."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.measuring import measuring_mask, measuring_names, stretches
from thermodata.errors import UsageError
from thermodata.schema.files.campaign import Measuring
from thermodata.schema.flag import Flag

T = np.arange(100, dtype=np.int64) * 1_000_000_000
FEED = np.where((np.arange(100) // 20) % 2 == 0, 0.0, 10.0)  # stands for 20 s, moves for 20 s
VALUES = {"feed_Z": FEED, "pos_Z": np.full(100, 210.0)}
UNITS = {"feed_Z": "m/min", "pos_Z": "mm"}


def long_form(**spec: object) -> Measuring:
    return Measuring.model_validate(spec)


def test_nothing_declared_measures_always() -> None:
    assert measuring_mask(T, None, {}).all()
    assert measuring_names(None) == frozenset()


def test_an_expression() -> None:
    text = "feed_Z == 0 and abs(pos_Z - 210) < 0.05"
    np.testing.assert_array_equal(measuring_mask(T, text, VALUES, UNITS), FEED == 0)
    assert measuring_names(text) == {"feed_Z", "pos_Z"}


def test_settle_drops_the_start_of_every_stretch() -> None:
    mask = measuring_mask(T, long_form(when="feed_Z == 0", settle="5 s"), VALUES, UNITS)
    assert mask.sum() == 3 * 15
    assert not mask[:5].any()
    assert mask[5:20].all()


def test_for_drops_stretches_that_are_too_short() -> None:
    short = {**VALUES, "feed_Z": np.where(np.arange(100) == 30, 0.0, FEED)}
    assert measuring_mask(T, long_form(when="feed_Z == 0"), short, UNITS)[30]
    held = measuring_mask(T, long_form(when="feed_Z == 0", **{"for": "20 s"}), short, UNITS)
    assert not held[30]
    assert held.sum() == 60
    assert not measuring_mask(T, long_form(when="feed_Z == 0", **{"for": "21 s"}), short, UNITS).any()


def test_a_pause_of_the_log_ends_a_stretch() -> None:
    t = T.copy()
    t[10:] += 3600 * 1_000_000_000
    first, last = stretches(t, FEED == 0)
    assert list(zip(first.tolist(), last.tolist(), strict=True)) == [(0, 10), (10, 20), (40, 60), (80, 100)]
    mask = measuring_mask(t, long_form(when="feed_Z == 0", settle="5 s"), VALUES, UNITS)
    assert not mask[10:15].any()


def test_ranges_take_units_and_missing_values_do_not_measure() -> None:
    values = {"dZ": np.array([0.0, 5.0, 50.0, np.nan])}
    spec = long_form(in_range={"dZ": ["-0.01 mm", "10 um"]})
    assert measuring_mask(T[:4], spec, values, {"dZ": "um"}).tolist() == [True, True, False, False]
    assert measuring_names(spec) == {"dZ"}


def test_in_range_reads_the_flags() -> None:
    flags = {"dZ": np.array([0, Flag.SATURATED, Flag.OUT_OF_RANGE, Flag.GAP], np.uint16)}
    for spec in ("in_range", long_form(in_range="in_range"), long_form(in_range="dZ")):
        assert measuring_mask(T[:4], spec, {}, {}, flags).tolist() == [True, False, False, True]


def test_a_channel_that_is_not_there_is_named() -> None:
    for spec in ("feed_X == 0", long_form(in_range={"feed_X": [0, 1]}), long_form(in_range="feed_X")):
        with pytest.raises(UsageError, match="feed_X"):
            measuring_mask(T, spec, VALUES, UNITS)


def test_of_no_rows_there_is_no_mask() -> None:
    assert len(measuring_mask(T[:0], "feed_Z == 0", {"feed_Z": np.empty(0)}, UNITS)) == 0
