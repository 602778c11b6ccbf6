"""Every rule that refuses a clock, just inside and just outside its limit: a wrong clock is worse than none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from thermodata.calibration.clock import estimate, events, refine
from thermodata.errors import CalibrationError
from thermodata.plugin import Float1D

S = 1_000_000_000


def refused(what: str, call: Callable[[], object], refuses: bool) -> None:
    if refuses:
        with pytest.raises(CalibrationError, match=what):
            call()
    else:
        call()


@pytest.mark.parametrize(("correlation", "refuses"), [(0.80, False), (0.799, True)])
def test_logs_must_look_alike(correlation: float, refuses: bool) -> None:
    refused("look alike", lambda: estimate.refuse_logs_that_do_not_look_alike(correlation), refuses)


@pytest.mark.parametrize(("stretches", "refuses"), [(1, False), (0, True)])
def test_both_logs_must_see_an_event(stretches: int, refuses: bool) -> None:
    refused("no event that both", lambda: estimate.refuse_logs_without_a_common_event(stretches), refuses)


@pytest.mark.parametrize(("events", "refuses"), [(2, False), (1, True), (0, True)])
def test_one_event_is_not_enough(events: int, refuses: bool) -> None:
    refused("one event is not enough", lambda: estimate.refuse_a_single_event(events), refuses)


@pytest.mark.parametrize(("n", "refuses"), [(10, False), (9, True)])
def test_a_log_has_ten_samples(n: int, refuses: bool) -> None:
    """That are finite and later than the one before."""
    t = np.arange(20, dtype=np.int64) * S
    values = np.where(np.arange(20) < n, np.arange(20) % 3, np.nan)
    refused("hardly any", lambda: estimate._prepared(t, values, "here"), refuses)
    again = np.minimum(t, (n - 1) * S)
    refused("hardly any", lambda: estimate._prepared(again, np.arange(20) % 3, "here"), refuses)


@pytest.mark.parametrize(("change", "refuses"), [(4e-9, False), (1e-9, True)])
def test_a_log_must_change(change: float, refuses: bool) -> None:
    """A change of alternating samples is a deviation of half of it, of 1: limit 2e-9."""
    values = 1.0 + change * (np.arange(20) % 2)
    refused("never changes", lambda: estimate._prepared(np.arange(20) * S, values, "here"), refuses)


def peaks(rival: float, at: int = 80) -> Float1D:
    """A best peak of 0.9 and another of `rival` times that height, with a valley between."""
    r = np.zeros(101)
    r[18:23] = [0.3, 0.6, 0.9, 0.6, 0.3]
    r[at] = 0.9 * rival
    return r


@pytest.mark.parametrize(("rival", "refuses"), [(0.969, False), (0.971, True)])
def test_one_offset_must_stand_out(rival: float, refuses: bool) -> None:
    r = peaks(rival)
    refused("equally well", lambda: estimate._refuse_rivals(r, 20, 1.0), refuses)


def test_a_peaks_own_flank_is_no_rival() -> None:
    r = np.clip(0.9 - 0.01 * np.abs(np.arange(101) - 20.0), 0, None)
    estimate._refuse_rivals(r, 20, 1.0)


@pytest.mark.parametrize(("height", "refuses"), [(0.80, True), (0.79, False)])
def test_rivals_are_asked_for_only_where_the_logs_look_alike(height: float, refuses: bool) -> None:
    r = peaks(1.0) * height / 0.9
    refused("equally well", lambda: estimate._refuse_rivals(r, 20, 1.0), refuses)


@pytest.mark.parametrize(("share", "seen"), [(0.27, True), (0.23, False)])
def test_logs_must_overlap_by_a_quarter_of_the_shorter(share: float, seen: bool) -> None:
    rng = np.random.default_rng(0)
    common = round(share * 400)
    whole = rng.normal(size=1000)
    here, there = whole[:400], whole[400 - common :]
    lag, correlation = estimate._coarse((here, np.ones(400)), (there, np.ones(len(there))), 1.0)
    assert (correlation > 0.99 and lag == common - 400) is seen


@pytest.mark.parametrize(("change", "seen"), [(0.25, True), (0.2, False)])
def test_an_overlap_without_change_is_no_evidence(change: float, seen: bool) -> None:
    """The variance of both within the overlap is at least 0.05 of theirs: 0.0625 and 0.04."""
    quiet = change * np.random.default_rng(0).permutation(np.tile([1.0, -1.0], 200))
    lag, correlation = estimate._coarse((quiet, np.ones(400)), (quiet, np.ones(400)), 1.0)
    assert (correlation > 0.99 and lag == 0.0) is seen


@pytest.mark.parametrize(
    ("moved", "correlation", "told"),
    [(0.0, 0.70, True), (0.0, 0.699, False), (2.94, 0.9, True), (2.95, 0.9, False), (-2.95, 0.9, False)],
)
def test_a_stretch_tells_its_lag(moved: float, correlation: float, told: bool) -> None:
    """A correlation of 0.7, and not at the end of the reach (98 % of 3 s)."""
    assert refine.is_told(moved, 3.0, correlation) is told


@pytest.mark.parametrize(("n", "told"), [(6, True), (5, False)])
def test_a_stretch_has_six_samples(n: int, told: bool) -> None:
    t = np.arange(100.0)
    b = np.cumsum(np.random.default_rng(0).normal(size=100))
    found = refine.refine(t[40 : 40 + n], b[40 : 40 + n], t, b, 0.0, 1.0)
    assert (found is not None) is told


def drift(ppm: float, scatter_s: float = 0.0, events: int = 8) -> float:
    """The drift [ppm] that events over a day tell, sampled each second, with a scatter that turns."""
    at = np.linspace(0.0, 86_400.0, events)
    lags = 5.0 + ppm * 1e-6 * at + scatter_s * (np.arange(events) % 2 - 0.5)
    return estimate._line(at, lags, np.ones(events), 1.0)[2]


@pytest.mark.parametrize(("ppm", "events", "told"), [(80.0, 4, True), (80.0, 3, False)])
def test_a_drift_needs_four_events(ppm: float, events: int, told: bool) -> None:
    assert drift(ppm, events=events) == pytest.approx(ppm if told else 0.0)


def test_a_drift_must_stand_out_of_its_scatter() -> None:
    """Four times its error: at 0.6 s of scatter about 15 ppm."""
    assert drift(40.0, 0.6) == pytest.approx(40.0, rel=0.2)
    assert drift(12.0, 0.6) == 0.0


def test_a_drift_must_move_the_clock_by_half_of_what_a_sample_is_worth() -> None:
    """A sample of 1 s is known to 0.29 s; half of that in a day is 1.7 ppm."""
    floor_ppm = 0.5 / np.sqrt(12) / 86_400 * 1e6
    assert drift(1.05 * floor_ppm, events=4000) == pytest.approx(1.05 * floor_ppm)
    assert drift(0.95 * floor_ppm, events=4000) == 0.0


# ---- events that a person typed


def typed(*offsets: float, apart_s: float) -> estimate.ClockEstimate:
    here = np.arange(len(offsets)) * apart_s
    there = here + np.asarray(offsets)
    return events.offset_from_events(np.rint(here * S).astype(np.int64), np.rint(there * S).astype(np.int64))


@pytest.mark.parametrize(("apart_s", "tells"), [(3600.0, True), (3599.0, False)])
def test_a_drift_is_told_over_an_hour(apart_s: float, tells: bool) -> None:
    assert (typed(0.0, 1.0, apart_s=apart_s).drift_ppm != 0.0) is tells


@pytest.mark.parametrize(("ppm", "refuses"), [(499.0, False), (501.0, True), (-499.0, False), (-501.0, True)])
def test_a_clock_drifts_by_500_ppm_at_most(ppm: float, refuses: bool) -> None:
    refused("contradict", lambda: typed(0.0, ppm * 1e-6 * 20_000, apart_s=20_000), refuses)


@pytest.mark.parametrize(("off", "refuses"), [(59.9, False), (60.1, True)])
def test_close_events_agree_within_half_a_minute_of_their_mean(off: float, refuses: bool) -> None:
    refused("contradict", lambda: typed(0.0, off, apart_s=60.0), refuses)


@pytest.mark.parametrize(("off", "refuses"), [(44.9, False), (45.1, True)])
def test_far_events_agree_within_half_a_minute_of_their_line(off: float, refuses: bool) -> None:
    """The middle one of three lies two thirds of its offset from the line."""
    refused("contradict", lambda: typed(0.0, off, 0.0, apart_s=100_000.0), refuses)
