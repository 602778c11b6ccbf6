"""The rate of a channel on the rows of its own stream: what its rows say of it, and how far they may be apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from thermodata.calibration.rate import NONE, lost_in_turns, rates, stood_in_pauses, stretches, usual_step_ns
from thermodata.errors import ThermodataError
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.flag import Flag
from thermodata.store.tidy.plan.plan import Bound
from thermodata.store.tidy.rows.on_change import MOST_ROWS
from thermodata.store.tidy.rows.timeline import Timeline

PERIODS = 3.5  # that two samples may be apart, as bins are filled over
TOLD = 0.05  # of the size of a rate
LEAST_LEG = 1.9  # stretches that an axis goes one way: of fewer none is without a turn, and nothing tells its speed
MOVES_NS = 10 * 10**9  # so far apart rows of a log written on change are no course of a movement


class Series(Protocol):
    """What a rate asks of the test that it belongs to: see `TestSeries`."""

    def timeline(self, member: tuple[str, str]) -> Timeline: ...

    def as_written(self, bound: Bound) -> Bound: ...

    def has_no_rate(self, member: tuple[str, str]) -> bool: ...

    def values(self, bound: Bound, start: int, stop: int) -> tuple[Array, Array]: ...


@dataclass(frozen=True, slots=True)
class Pace:
    """on_change: whether a value stands until the next row; longest_ns: between two samples that tell of a movement;
    lost, leg: see `lost_in_turns`."""

    on_change: bool
    longest_ns: int
    lost: float = 0.0
    leg: float = np.inf


def pace_of(series: Series, bound: Bound) -> Pace:
    """Of a logged channel, by what its campaign file and its log say of it, else by its first rows."""
    written = series.as_written(bound)
    if written.is_held or (not bound.is_said and series.has_no_rate((bound.source, bound.stream))):
        return Pace(True, MOVES_NS)
    line = series.timeline((bound.source, bound.stream))
    rows = min(line.rows, MOST_ROWS)
    try:
        t_ns, values = line.times(0, rows), series.values(bound, 0, rows)[0]
    except ThermodataError:  # which is told where the channel is made
        return Pace(False, 0)
    longest_ns = int(PERIODS * usual_step_ns(t_ns, values))
    if not bound.is_said and stood_in_pauses(t_ns, values, max(longest_ns, MOVES_NS)):
        return Pace(True, MOVES_NS)
    return Pace(False, longest_ns, *lost_in_turns(t_ns, values, longest_ns))


def rate_on_rows(series: Series, bound: Bound, pace: Pace, start: int, stop: int) -> tuple[Array, Array]:
    """(rates in the channel's canonical unit by the second, flags of both samples of each), rows start to stop of its
    stream; shape (stop - start,). Rows beside them are looked at, so that it makes no difference where a stream is
    cut."""
    if start >= stop:
        return np.empty(0), np.empty(0, np.uint16)
    low, t_ns, values, flags, sample, other = _stretches_near(series, bound, pace, start, stop)
    both = np.where(other == NONE, flags, flags | flags[sample] | flags[other])
    found = rates(t_ns, values, sample, other)
    return found[start - low : stop - low], both[start - low : stop - low]


def rows_of_rate(series: Series, bound: Bound, pace: Pace, row: int) -> list[int]:
    """The rows between which a rate was taken, in their order; the row itself where it has none, or where that can't be
    told."""
    try:
        low, *_, sample, other = _stretches_near(series, bound, pace, row, row + 1)
    except ThermodataError:  # a calibration that is not at hand
        return [row]
    here = row - low
    found = {row} if other[here] == NONE else {low + int(sample[here]), low + int(other[here])}
    return sorted(found)


def _stretches_near(
    series: Series, bound: Bound, pace: Pace, start: int, stop: int
) -> tuple[int, Int1D, Float1D, Array, Int1D, Int1D]:
    """(first row, times, values, flags, then as `stretches`) of rows start to stop and all that is near them."""
    line = series.timeline((bound.source, bound.stream))
    first, last = int(line.times(start, start + 1)[0]), int(line.times(stop - 1, stop)[0])
    low, high = line.find(first - pace.longest_ns), line.find(last + pace.longest_ns + 1)
    t_ns, (values, flags) = line.times(low, high), series.values(bound, low, high)
    # where the whole clock is doubtful, all rows are so alike
    clock = None if line.suspect else line.clock_flags(low, high)
    doubted = None if clock is None else (clock & np.uint16(Flag.CLOCK_SUSPECT)) != 0
    found = stretches(t_ns, values, longest_ns=pace.longest_ns, doubted=doubted, on_change=pace.on_change)
    return low, t_ns, values, flags, *found


def told_of_rates(names: Sequence[str]) -> tuple[str, ...]:
    """What is said of channels that take a rate of what was written on change; nothing of none."""
    return (
        (
            f"{', '.join(names)}: the rate of what was written on change: 0 where no row came for more than "
            f"{MOVES_NS / 1e9:g} s, for it stood there; if the log has gaps instead: held: false in the channel of "
            "the position",
        )
        if names
        else ()
    )


def told_of_turns(paces: Mapping[str, Pace]) -> tuple[str, ...]:
    """What is said of channels that take the rate of what turns so often that much of it is lost in this test, or may
    be; nothing of others. paces: of the position of each."""
    said = []
    for name, pace in paces.items():
        if pace.leg < LEAST_LEG:
            said.append(
                f"{name}: the axis goes one way for {pace.leg:.2g} samples before it turns: how fast it went between "
                "them nobody can tell; the size of its rate is too small by a share that differs from test to test, "
                "which no gain takes up; log the position faster"
            )
        elif pace.lost > TOLD:
            said.append(
                f"{name}: the axis turns between two of its samples, after {pace.leg:.2g} of them, which makes the "
                f"size of its rate in this test {100 * pace.lost:.0f} % too small, or less where it rests as it turns; "
                "in tests whose turns fall otherwise it is another share, which no gain takes up; log the position "
                "faster"
            )
    return tuple(said)
