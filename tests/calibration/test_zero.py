"""The zero of a response."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.zero import zero_mask


def test_counts_from_the_first_valid_sample() -> None:
    t = np.arange(0.0, 4000.0, 10.0)
    valid = t >= 1200
    assert t[zero_mask(t, valid, over_s=20.0)].tolist() == [1200.0, 1210.0, 1220.0]
    assert zero_mask(t, valid, 0.0).sum() == 1


def test_invalid_samples_do_not_count() -> None:
    assert zero_mask(np.arange(5.0), np.array([0, 1, 0, 1, 1], bool), 2.0).tolist() == [False, True, False, True, False]


def test_without_a_valid_sample_there_is_no_zero() -> None:
    assert not zero_mask(np.arange(3.0), np.zeros(3, bool), 600.0).any()
