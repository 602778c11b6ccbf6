"""What is told of a channel is what its samples say (store/tidy/flags/trimmed.py)."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.quality.event import QualityEvent
from thermodata.schema.flag import Flag
from thermodata.store.tidy.flags.measured.trimmed import Trimmed

SPIKE, HELD = np.uint16(Flag.SPIKE), np.uint16(Flag.HELD)


def trimmed(given: dict[int, np.uint16], lost: dict[int, np.uint16], piece: int) -> Trimmed:
    """Of 100 rows, a nanosecond each."""
    before = np.zeros(100, np.uint16)
    for row, flag in given.items():
        before[row] |= flag
    after = before.copy()
    for row, flag in lost.items():
        after[row] &= ~flag
    made = Trimmed()
    for a in range(0, 100, piece):
        t = np.arange(a, min(a + piece, 100), dtype=np.int64)
        made.add("dZ", t, before[t], after[t])
    return made


@pytest.mark.parametrize("piece", [1, 7, 100])
def test_an_event_is_what_is_left_of_it(piece: int) -> None:
    held = dict.fromkeys(range(20, 40), HELD)
    made = trimmed({10: SPIKE, 50: SPIKE, **held}, {10: SPIKE, 20: HELD, 21: HELD, 30: HELD, 39: HELD}, piece)
    events = [
        QualityEvent("dZ", "spike", 10, 10, 1),
        QualityEvent("dZ", "held", 20, 39, 20, "exactly 3 um"),
        QualityEvent("dZ", "spike", 50, 50, 1),
        QualityEvent("dX", "spike", 10, 10, 1),
        QualityEvent(None, "gap", 0, 99, 1),
    ]
    assert made.events(events) == [QualityEvent("dZ", "held", 22, 38, 16, "exactly 3 um"), *events[2:]]


def test_events_of_which_nothing_was_taken_stay_as_they_are() -> None:
    made = trimmed({10: SPIKE}, {}, 100)
    # of a flag that comes from elsewhere, or is told wider than it is set
    events = [QualityEvent("dZ", "spike", 5, 15, 3), QualityEvent("dZ", "offset", 0, 99, 100)]
    assert made.events(events) == events
