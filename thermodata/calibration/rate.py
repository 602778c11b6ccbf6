"""The rate at which a logged value changes, between its own samples: the feed of an axis whose position was logged.

A sample has the rate of the stretch to the next one, for that is what the axis does from there on. Where nothing is
known of that stretch (a gap, the end of the log, a time that was made), it has that of the stretch before it; where
nothing is known of either, none.

A log that is written on change has no gaps: a value that nobody wrote another one behind stood. So its long stretches,
and what follows its last row, have the rate 0, and its short ones, in which the axis moved, what its rows say.
"""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D

NONE = -1  # no row
# pauses, and the share of them, that a log written on change goes on from; a step is small that is no more of the range
PAUSES, USUAL, SMALL = 4, 0.9, 0.1
STILL = 1e-3  # of its range, which it moves while it is held in place


def stretches(
    t_ns: Int1D, values: Float1D, *, longest_ns: int, doubted: Bool1D | None = None, on_change: bool = False
) -> tuple[Int1D, Int1D]:
    """(the row of each row's sample, the row of the other end of the stretch whose rate it has), both of shape (n,):
    one row where it stands, NONE where nothing is known.

    t_ns: non-decreasing, shape (n,), like all others. longest_ns: the longest stretch between two samples that tells of
    a movement. doubted: where a time is not what the log said. on_change: written when the value changed.
    What holds of a row depends on those within `longest_ns` of it alone, whatever else is there.
    """
    sample, other = np.full(len(t_ns), NONE), np.full(len(t_ns), NONE)
    there = np.flatnonzero(np.isfinite(values))
    # several rows at one time are one sample: the first of them, which the first at the next time follows
    times, first, again = np.unique(t_ns[there], return_index=True, return_inverse=True)
    rows = there[first]
    unknown = np.zeros(len(rows), dtype=bool) if doubted is None else doubted[rows]
    near = np.diff(times) <= longest_ns
    told = near & ~(unknown[1:] | unknown[:-1])
    ahead = np.append(np.where(told, rows[1:], NONE), NONE)[: len(rows)]
    behind = np.append(NONE, np.where(told, rows[:-1], NONE))[: len(rows)]
    stands = on_change & ~np.append(near, False)[: len(rows)]
    sample[there] = rows[again]
    other[there] = np.where(stands, rows, np.where(ahead == NONE, behind, ahead))[again]
    return sample, other


def rates(t_ns: Int1D, values: Float1D, sample: Int1D, other: Int1D) -> Float1D:
    """Rates in the values' unit by the second, shape (n,), of `stretches`; NaN where nothing is known."""
    found = np.where(other == NONE, np.nan, 0.0)
    moves = np.flatnonzero((other != NONE) & (other != sample))
    a, b = sample[moves], other[moves]
    found[moves] = (values[b] - values[a]) / ((t_ns[b] - t_ns[a]) / 1e9)
    return found


def stood_in_pauses(t_ns: Int1D, values: Float1D, longest_ns: int) -> bool:
    """Whether a log pauses where its value stands: behind nearly all of its pauses, and these are several, it goes on
    from where it was, by a step that is small beside its range. Shapes (n,), times non-decreasing."""
    there = np.flatnonzero(np.isfinite(values))
    times, first = np.unique(t_ns[there], return_index=True)
    steps, paused = np.abs(np.diff(values[there[first]])), np.diff(times) > longest_ns
    if np.count_nonzero(paused) < PAUSES or paused.all():
        return False
    step = float(np.quantile(steps[~paused], USUAL))
    goes_on = float(np.mean(steps[paused] <= step))
    return step <= SMALL * float(np.ptp(values[there])) and goes_on >= USUAL


def lost_in_turns(t_ns: Int1D, values: Float1D, longest_ns: int) -> tuple[float, float]:
    """(how much of the size of its rate is lost where it turns between two samples, as a share of all; over how many
    stretches it goes one way before it turns, inf where it never does). Shapes (n,), times non-decreasing.

    A stretch in which it turns lies between two that go opposite ways; what it is slower than these is lost, if the
    speed is even and it does not rest where it turns. So it is the most that can be lost. Ways of less than two
    stretches have none without a turn: then nothing tells it.
    """
    there = np.flatnonzero(np.isfinite(values))
    times, first = np.unique(t_ns[there], return_index=True)
    x = values[there[first]]
    apart = np.diff(times).astype(np.float64)
    steps = np.where(apart <= longest_ns, np.diff(x), 0.0)
    ways = np.sign(steps) * (np.abs(steps) > STILL * float(np.ptp(x))) if len(x) else steps
    if np.count_nonzero(ways) < 2:
        return 0.0, np.inf
    speeds = np.abs(steps * np.abs(ways)) / np.maximum(apart, 1.0)
    full = (speeds[:-2] + speeds[2:]) / 2
    between = ways[:-2] * ways[2:] < 0
    lost = np.where(between, np.maximum(full - speeds[1:-1], 0.0), 0.0) * apart[1:-1]
    # it turns within a stretch between two that go opposite ways, or at the sample where these meet
    goes = np.flatnonzero(ways)
    turned = ways[goes[1:]] * ways[goes[:-1]] < 0
    turns = int(np.count_nonzero(turned & (np.diff(goes) <= 2)))
    active = len(goes) + int(np.count_nonzero(between & (ways[1:-1] == 0)))
    moved = float(np.sum(speeds * apart)) + float(lost.sum())
    return float(lost.sum()) / moved, active / turns if turns else np.inf


def usual_step_ns(t_ns: Int1D, values: Float1D) -> int:
    """How far samples that have a value are usually apart [ns]; 0 of less than two. Shapes (n,), times
    non-decreasing."""
    steps = np.diff(np.unique(t_ns[np.isfinite(values)]))
    return int(np.median(steps)) if len(steps) else 0


__all__ = ["NONE", "lost_in_turns", "rates", "stood_in_pauses", "stretches", "usual_step_ns"]
