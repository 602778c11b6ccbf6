"""How many readings stand at the end of a range, where the logger repeats each of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from thermodata.calibration.quality.ends.range import ends_of_ranges
from thermodata.calibration.quality.ends.still import Reading
from thermodata.store.tidy.flags.beside.readings import reading_with
from thermodata.store.tidy.values.chunk import Column

LIMIT = 30.125


def _read(seed: int, at_limit: int, repeated: int) -> Reading:
    """3,000 readings of a noisy probe, some of which stand at one limit, each logged several times."""
    rng = np.random.default_rng(seed)
    x = np.minimum(np.round(rng.normal(0.0, 2.0, 3000), 3), LIMIT - 0.5)
    x[1000 : 1000 + at_limit] = LIMIT
    logged = np.repeat(x, repeated)
    nobody: Any = None
    return reading_with(None, Column(nobody, logged, np.zeros(len(logged), np.uint16)), np.arange(len(logged)) * 1.0)


@pytest.mark.parametrize("repeated", [1, 12, 30])
@pytest.mark.parametrize(("at_limit", "is_end"), [(1, False), (9, False), (10, True), (400, True)])
def test_a_reading_at_an_end_is_one_however_often_it_is_logged(repeated: int, at_limit: int, is_end: bool) -> None:
    readings = {(f"day{k}", "dZ"): _read(k, at_limit, repeated) for k in (1, 2)}
    assert {r.high_n for r in readings.values()} == {at_limit}
    assert bool(ends_of_ranges(readings)) is is_end
