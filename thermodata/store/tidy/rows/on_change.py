"""Whether a log was written when something changed: its rows come at no rate, or are a few set values that somebody
wrote down beside a log that is much denser.

A speed that is 0 at 6:30 and 4000 at 9:00 did not rise for two hours and a half: between the rows of such a log each
value stands. What a sensor measures runs on meanwhile, and is left to the readers that know their format.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.reader.signals.set_values import are_set
from thermodata.schema.units.quantity import STATES
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.rows.timeline import Timeline

# what is commanded, and what follows a command at once
SET = frozenset({"rotational_speed", "feed", "power", "load", "current", "torque", "flow"})
LEAST_ROWS = 3
UNEVEN = 3.0  # between the longer and the shorter of the times between its rows (deciles)
MOST_ROWS = 100_000  # of which it is told

BY_HAND = SET | {"position"}  # of what somebody writes down the steps
STEPS = BY_HAND | STATES  # what goes in steps in a log written on change; what a sensor measures runs on
DENSER = 10.0  # the densest log beside it has so many rows where it has one
MOST_BY_HAND = 200  # rows
_BEFORE_NS = 10**9  # a change, which two clocks tell to a sample at best
_MINUTE_NS, _ASKED_NS, _LONG_NS = 60 * 10**9, 300 * 10**9, 1200 * 10**9
_STEPS = 0.5  # of its rows that change something, unless they lie far apart
# rows, and what they change of the largest, that are asked for where they are not round; more, at even times, are asked
# for where they are
_FEW_ROWS, _LARGE = 24, 0.3

Written = Literal["on change", "asked"]


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


def with_steps(t_ns: Int1D, values: Array) -> tuple[Int1D, Array]:
    """A log written on change with a row of the old value just before each of its rows, so that what reads straight
    between rows sees steps, and none of them as far off as its pauses are long.

    t_ns: ascending, shape (n,); values: shape (n,). Returns both of shape (m,), m >= n.
    """
    at = np.flatnonzero(np.diff(t_ns) > 2 * _BEFORE_NS) + 1
    return np.insert(t_ns, at, t_ns[at] - _BEFORE_NS), np.insert(values, at, values[at - 1])


def step_beside(streams: Mapping[tuple[str, str], Sequence[RawStream]], own: tuple[str, str]) -> int:
    """The time between rows of the densest of the other streams of a test that are longer [ns]; 0 where none is."""
    rows = sum(r.rows for r in streams.get(own, ()))
    others = [r.step_ns for key, raws in streams.items() if key != own for r in raws if r.rows > DENSER * rows]
    return min((s for s in others if s > 0), default=0)


def written_by_hand(quantity: str, t_ns: Int1D, values: Array, beside_ns: int) -> Written | None:
    """Whether a channel's rows are steps that somebody wrote down: each stands until the next one, is asked for where
    the values are none that anybody sets, and runs on (None) else.

    t_ns, values: shape (n,), as logged; beside_ns: of a row in the densest log beside it, 0 for none.
    """
    if quantity not in BY_HAND or not beside_ns or values.dtype.kind not in "iuf" or len(values) > MOST_BY_HAND:
        return None
    x = values.astype(np.float64)
    t, x = t_ns[np.isfinite(x)], x[np.isfinite(x)]
    if x.size < LEAST_ROWS:
        return None
    apart = float(np.median(np.diff(t)))
    if apart < max(_MINUTE_NS, DENSER * beside_ns):
        return None
    if np.count_nonzero(np.diff(x)) < (1 if apart >= _LONG_NS else _STEPS * (x.size - 1)):
        return None
    if are_set(np.abs(x)):
        return "asked" if x.size > _FEW_ROWS and _comes_evenly(t) else "on change"
    large = float(np.ptp(x)) >= _LARGE * float(np.abs(x).max())
    return "asked" if large and apart >= _ASKED_NS and x.size <= _FEW_ROWS else None


def _comes_evenly(t_ns: Int1D) -> bool:
    """Whether rows come as a clock calls them: hours of them nobody writes down so."""
    apart = np.diff(t_ns)
    return bool(apart.max() <= 1.01 * apart.min())


def asked(name: str, rows: int) -> str:
    """What is said of a channel whose few rows may stand until the next one."""
    return (
        f"{name}: its {rows} rows lie far apart beside a log that is much denser, and are drawn as ramps from one to "
        "the next; if each value stood until the next row: held: true in the channel, else held: false"
    )


def told(names: Sequence[str], *, by_hand: bool = False) -> tuple[str, ...]:
    """What is said of the channels that are held for that; nothing of none. by_hand: for their few set values."""
    what = (
        "are a few set values beside a log that is much denser, as somebody writes changes down"
        if by_hand
        else "come at no rate, as a log's that is written on change"
    )
    return (f"{', '.join(names)}: rows {what}: each value stands until the next row",) if names else ()
