"""The zero of a response."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.zero import zero_mask, zero_value
from thermodata.errors import UsageError


def test_counts_from_the_first_valid_sample() -> None:
    t = np.arange(0.0, 4000.0, 10.0)
    values = np.where(t < 1200, 99.0, t)
    valid = t >= 1200
    assert zero_value(t, values, valid, over_s=20.0) == pytest.approx(1210.0)
    assert zero_mask(t, valid, 0.0).sum() == 1


def test_invalid_and_missing_samples_do_not_count() -> None:
    t = np.arange(5.0)
    assert zero_value(t, np.array([np.nan, 1.0, 50.0, 3.0, 9.0]), np.array([1, 1, 0, 1, 1], bool), 2.0) == 2.0


def test_no_valid_sample_is_told() -> None:
    with pytest.raises(UsageError, match="no valid sample"):
        zero_value(np.arange(3.0), np.zeros(3), np.zeros(3, bool))
