"""A candidate's courses (report/charts/courses.py): no line where nothing counts."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.report.charts.courses import pauses


@pytest.mark.parametrize(
    ("steps", "behind"),
    [
        ([60] * 20, []),
        ([60] * 10 + [7 * 3600] + [60] * 10, [11]),
        ([300] * 10 + [60] * 20, []),
        ([300] * 10 + [7 * 3600] + [60] * 20, [11]),
        ([60] * 20 + [150] + [60] * 5, []),
        ([7 * 3600], []),
        ([], []),
    ],
)
def test_a_line_is_broken_over_hours_without_a_sample_but_not_where_samples_are_seldom(
    steps: list[float], behind: list[int]
) -> None:
    assert pauses(np.concatenate([[0.0], np.cumsum(steps)])).tolist() == behind
