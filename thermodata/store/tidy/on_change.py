"""Whether a log was written when something changed: its rows come at no rate.

A speed that is 0 at 6:30 and 4000 at 9:00 did not rise for two hours and a half: between the rows of such a log each
value stands. What a sensor measures runs on meanwhile, and is left to the readers that know their format.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.plugin import Int1D
from thermodata.store.tidy.timeline import Timeline

# what is commanded, and what follows a command at once
SET = frozenset({"rotational_speed", "feed", "power", "load", "current", "torque", "flow"})
LEAST_ROWS = 3
UNEVEN = 3.0  # between the longer and the shorter of the times between its rows (deciles)
MOST_ROWS = 100_000  # of which it is told


def has_no_rate(line: Timeline) -> bool:
    """Whether a stream was written when something changed."""
    return come_at_no_rate(line.times(0, min(line.rows, MOST_ROWS)))


def come_at_no_rate(t_ns: Int1D) -> bool:
    """Whether the times between rows differ by more than any clock does."""
    times = np.unique(t_ns)
    if len(times) < LEAST_ROWS:
        return False
    short, long = np.quantile(np.diff(times), (0.1, 0.9))
    return bool(long > UNEVEN * short)


def told(names: Sequence[str]) -> tuple[str, ...]:
    """What is said of the channels that are held for that; nothing of none."""
    what = "come at no rate, as a log's that is written on change: each value stands until the next row"
    return (f"{', '.join(names)}: rows {what}",) if names else ()
