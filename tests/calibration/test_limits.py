"""Which way the limit of a check goes is said with it."""

from __future__ import annotations

import pytest

from thermodata.calibration.jump.evaluate import checks as jump_checks
from thermodata.calibration.jump.limits import with_limits
from thermodata.calibration.result import check


@pytest.mark.parametrize(
    ("name", "limit"),
    [
        ("noise_pct_of_move", "value <= threshold"),
        ("answers_most", "value < threshold"),
        ("dwell_s", "0.4 * threshold <= value <= 2.5 * threshold"),
        ("length_kept", "1 / threshold <= value <= threshold"),
    ],
)
def test_a_limit_says_when_the_check_passes(name: str, limit: str) -> None:
    [row] = with_limits([check(name, 19.5, 20.0, True, "")])
    assert row["limit"] == limit
    assert row["value"] == 19.5


@pytest.mark.parametrize(("value", "passed"), [(7.9, False), (8.1, True), (49.0, True), (51.0, False)])
def test_the_limit_of_the_dwell_is_the_one_that_is_asked(value: float, passed: bool) -> None:
    [row] = with_limits([check("dwell_s", value, 20.0, True, "")])
    assert eval(row["limit"], {"value": row["value"], "threshold": row["threshold"]}) is passed
    low, high = jump_checks.DWELL
    assert (low * 20.0 <= value <= high * 20.0) is passed


def test_a_check_without_a_threshold_has_no_limit() -> None:
    assert with_limits([check("sign_known", None, None, True, "")])[0]["limit"] is None
    assert with_limits(None) == []
