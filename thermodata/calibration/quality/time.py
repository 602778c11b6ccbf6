"""What is wrong with a stream's time: gaps, standing and backward time, changes of rate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Bool1D, Float1D, Int1D
from thermodata.schema.flag import Flag

_CHUNK = 64
_GAP = 2.75  # of the period; between one sample lost and two
_RATE = 1.5
_MOST_EVENTS = 50
TimeEvent = tuple[str, int, int, int, str]  # flag, from_ns, to_ns, n, detail


@dataclass(frozen=True, slots=True)
class TimeFlags:
    """flags: shape (n,), uint16, for every column. period_ns: the typical one (0: under two samples)."""

    flags: Array
    events: list[TimeEvent]
    period_ns: float


def time_flags(t_ns: Int1D, *, on_change: bool = False) -> TimeFlags:
    """Flags of the times, shape (n,). on_change: a row is written where something changes: pauses and rates say
    nothing.

    DUPLICATE_TIME and CLOCK_SUSPECT: a sample no later than one before it (its time was covered already), or a
    lone sample with a time far ahead. GAP: the first sample after a pause. RATE_CHANGE: the first at a new rate.
    """
    n = len(t_ns)
    flags = np.zeros(n, np.uint16)
    events: list[TimeEvent] = []
    if n < 2:
        return TimeFlags(flags, events, 0.0)
    bad = _out_of_order(t_ns, flags, events)
    rows = np.flatnonzero(~bad) if bad.any() else None
    t = t_ns if rows is None else t_ns[rows]
    dt = np.diff(t)
    if not len(dt):
        return TimeFlags(flags, events, 0.0)
    period = float(np.median(dt))
    if on_change:
        return TimeFlags(flags, events, period)
    local = _rates(t, dt, rows, flags, events)
    threshold = _GAP * local
    high = float(np.quantile(dt, 0.95))
    if high > 1.5 * period:  # written on change: only a long silence is a gap
        threshold = np.maximum(threshold, 10.0 * high)
    after = np.flatnonzero(dt > threshold) + 1
    flags[after if rows is None else rows[after]] |= np.uint16(Flag.GAP)
    for i in after[:_MOST_EVENTS].tolist():
        events.append(
            (
                "gap",
                int(t[i - 1]),
                int(t[i]),
                0,
                f"{(t[i] - t[i - 1]) / 1e9:.6g} s without a sample, usual {float(local[i - 1]) / 1e9:.4g} s",
            )
        )
    if len(after) > _MOST_EVENTS:
        rest = after[_MOST_EVENTS:]
        events.append(("gap", int(t[rest[0] - 1]), int(t[rest[-1]]), 0, f"{len(rest)} further gaps"))
    return TimeFlags(flags, events, period)


def _out_of_order(t: Int1D, flags: Array, events: list[TimeEvent]) -> Bool1D:
    bad: Bool1D = np.zeros(len(t), dtype=bool)
    step = np.diff(t)
    if bool((step > 0).all()):
        return bad
    # one sample ahead of its time would make all that follow look late: it is the odd one out
    usual = float(np.median(step[step > 0])) if (step > 0).any() else 0.0
    ahead = np.flatnonzero((step[1:] < 0) & (t[2:] > t[:-2]) & (step[:-1] > _GAP * usual)) + 1
    bad[ahead] = True
    flags[ahead] |= np.uint16(Flag.CLOCK_SUSPECT | Flag.DUPLICATE_TIME)
    kept = np.where(bad, np.iinfo(np.int64).min, t)
    newest = np.maximum.accumulate(kept)
    late = np.concatenate([[False], t[1:] <= newest[:-1]]) & ~bad
    same = np.concatenate([[False], t[1:] == newest[:-1]]) & late
    flags[late] |= np.uint16(Flag.DUPLICATE_TIME)
    flags[late & ~same] |= np.uint16(Flag.CLOCK_SUSPECT)
    for i in ahead[:_MOST_EVENTS].tolist():
        events.append(
            (
                "clock_suspect",
                int(t[i - 1]),
                int(t[i + 1]),
                1,
                f"one sample {(t[i] - t[i - 1]) / 1e9:.6g} s ahead of its neighbours",
            )
        )
    edges = np.flatnonzero(np.diff(np.concatenate([[0], late.view(np.int8), [0]])))
    for a, b in list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))[:_MOST_EVENTS]:
        back = (newest[a - 1] - t[a]) / 1e9
        events.append(
            (
                "duplicate_time" if back == 0 else "clock_suspect",
                int(t[a:b].min()),
                int(newest[a - 1]),
                b - a,
                "the time stands still" if back == 0 else f"the time goes back by {back:.6g} s",
            )
        )
    bad |= late
    return bad


def _rates(t: Int1D, dt: Int1D, rows: Int1D | None, flags: Array, events: list[TimeEvent]) -> Float1D:
    """The period [ns] around each step, shape (len(dt),); flags lasting changes of it."""
    chunks = len(dt) // _CHUNK
    if chunks < 4:
        return np.full(len(dt), float(np.median(dt)))
    medians = np.median(dt[: chunks * _CHUNK].reshape(chunks, _CHUNK), axis=1)
    steady = np.median(np.stack([medians[:-2], medians[1:-1], medians[2:]]), axis=0)
    steady = np.concatenate([steady[:1], steady, steady[-1:]])  # one odd chunk is no new rate
    low, high = float(steady.min()), float(steady.max())
    local = np.repeat(steady, _CHUNK)
    local = np.concatenate([local, np.full(len(dt) - len(local), steady[-1])])
    if low <= 0 or high / low < _RATE:
        return local
    ratio = steady[1:] / steady[:-1]
    changes = np.flatnonzero((ratio > _RATE) | (ratio < 1 / _RATE)) + 1
    if len(changes) > 0.1 * chunks:  # no rate at all: written on change
        return np.full(len(dt), float(np.median(dt)))
    for c in changes.tolist():
        before, after = float(steady[c - 1]), float(steady[c])
        a, b = max(0, (c - 1) * _CHUNK), min(len(dt), (c + 1) * _CHUNK)
        old = np.abs(dt[a:b] - before) < np.abs(dt[a:b] - after)
        first = a + (int(np.flatnonzero(old)[-1]) + 1 if old.any() else 0)
        first = min(first, len(dt) - 1)
        local[min(first, c * _CHUNK) : max(first, c * _CHUNK)] = after if first < c * _CHUNK else before
        row = first + 1
        flags[row if rows is None else rows[row]] |= np.uint16(Flag.RATE_CHANGE)
        events.append(
            ("rate_change", int(t[row]), int(t[row]), 1, f"from {before / 1e9:.4g} s to {after / 1e9:.4g} s a sample")
        )
    return local
