from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thermodata.calibration.clock.events import offset_from_events
from thermodata.errors import CalibrationError
from thermodata.plugin import Int1D

T0 = 1_770_000_000_000_000_000
S = 1_000_000_000


def at(*seconds: float) -> Int1D:
    return np.array([T0 + round(s * S) for s in seconds], np.int64)


def test_one_event_gives_an_offset_and_no_drift() -> None:
    got = offset_from_events(at(100), at(7303.5))
    assert (got.offset_ns, got.drift_ppm, got.stretches) == (round(7203.5 * S), 0.0, 1)
    assert got.uncertainty_ns == S


def test_close_events_are_averaged_and_far_ones_give_a_drift() -> None:
    close = offset_from_events(at(0, 600), at(10, 612))
    assert close.drift_ppm == 0.0
    assert close.offset_ns == 11 * S
    assert close.uncertainty_ns >= S
    far = offset_from_events(at(86_400, 0), at(86_418.64, 10))
    assert far.drift_ppm == pytest.approx(100.0)
    assert far.apply(at(0, 43_200)).tolist() == at(10, 43_214.32).tolist()


@pytest.mark.parametrize(
    ("here", "there"), [((0, 7200), (0, 7300)), ((0, 60), (0, 200)), ((0, 40_000, 80_000), (5, 40_105, 80_005))]
)
def test_events_that_contradict_each_other_are_refused(here: tuple[float, ...], there: tuple[float, ...]) -> None:
    with pytest.raises(CalibrationError, match="contradict"):
        offset_from_events(at(*here), at(*there))


def test_no_events_are_refused() -> None:
    with pytest.raises(CalibrationError, match="no events"):
        offset_from_events(at(), at())


@given(st.lists(st.floats(0, 500_000), min_size=1, max_size=8, unique=True), st.floats(-1e7, 1e7), st.floats(-80, 80))
def test_the_line_behind_the_events_is_found(seconds: list[float], offset: float, ppm: float) -> None:
    here = np.array(seconds)
    there = here + offset + ppm * 1e-6 * here
    got = offset_from_events(at(*here), at(*there))
    drift = 0.0 if np.ptp(here) < 3600 else ppm
    assert np.abs(got.apply(at(*here)) - at(*there)).max() < (0.3 if drift == 0.0 else 1e-3) * S
