from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from thermodata.calibration.quality.event import QualityEvent
from thermodata.store.tidy.flags.measured.not_measuring import ONLY, Activity, join_while_not_measuring
from thermodata.store.tidy.flags.measured.standing import join_while_standing


def activity(*phases: tuple[int, int], n: int = 1000, piece: int = 37) -> Activity:
    mask = np.zeros(n, dtype=bool)
    for a, b in phases:
        mask[a:b] = True
    made = Activity()
    for i in range(0, n, piece):
        made.add(np.arange(i, min(i + piece, n), dtype=np.int64), mask[i : i + piece])
    return made


def event(flag: str, a: int, b: int, channel: str | None = "dZ") -> QualityEvent:
    return QualityEvent(channel, flag, a, b, b - a + 1)


def test_events_between_measuring_phases_become_one_that_says_so() -> None:
    times = {"dZ": activity((100, 200), (500, 600))}
    events = [
        event("saturated", 0, 50),
        event("saturated", 90, 100),
        event("saturated", 210, 499),
        event("gap", 210, 220),
        event("saturated", 0, 50, "dX"),
    ]
    assert join_while_not_measuring(events, times) == [
        QualityEvent("dX", "saturated", 0, 50, 51),
        QualityEvent("dZ", "saturated", 0, 499, 341, "only while not measuring"),
        event("saturated", 90, 100),
        event("gap", 210, 220),
    ]


def test_spikes_that_no_sample_is_flagged_for_are_told_of_no_test_that_says_when_it_measures() -> None:
    told = QualityEvent("dZ", "spike", 0, 700, 103, "not flagged: 6.3 % of the samples stand out for 1 to 3 samples")
    times, none = {"dZ": activity((100, 200), (500, 600))}, {("dZ", "spike"): Activity()}
    assert join_while_not_measuring([told], times, none) == []
    assert join_while_not_measuring([told], {}, {}) == [told]


def test_the_pieces_in_which_the_mask_comes_do_not_matter() -> None:
    rng = np.random.default_rng(0)
    phases = [(int(a), int(a) + 7) for a in np.sort(rng.choice(990, 40, replace=False))]
    at = np.arange(1000)
    for piece in (1, 10, 999, 1000):
        made = activity(*phases, piece=piece)
        assert (made.during(at, at) == activity(*phases, piece=1000).during(at, at)).all()
        assert (made.during(at, at) == [any(a <= t < b for a, b in phases) for t in at]).all()
    assert not activity().during(np.array([0]), np.array([999])).any()


def test_what_was_held_only_while_not_measuring_stays_so_though_the_spindle_stands() -> None:
    """Its detail is what says that nothing of the channel is lost by it."""
    bound = {
        "dZ": SimpleNamespace(channel=SimpleNamespace(quantity="displacement")),
        "n": SimpleNamespace(channel=SimpleNamespace(quantity="rotational_speed")),
    }
    series: Any = SimpleNamespace(
        plan=SimpleNamespace(bound=bound), sampled=lambda name, t_ns: (np.zeros(len(t_ns)), None)
    )
    between = QualityEvent("dZ", "held", 0, 499, 341, ONLY)
    assert join_while_standing([between], series) == [between]
    (other,) = join_while_standing([QualityEvent("dZ", "held", 0, 499, 500, "exactly 3.2 um")], series)
    assert other.detail == "while the spindle stands: exactly 3.2 um"
