"""A window that cuts off a start in which the machine was driven: its parts are warm where the test begins."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.store.tidy.plan.plan import SCHEDULE, Bound
from thermodata.store.tidy.rows.on_change import SET
from thermodata.store.tidy.values.series import Member, TestSeries

_DRIVES = ("rotational_speed", "feed", "flow")  # a load or a power reads something at rest
_TURNS = 0.02  # of the most that it does
_LEAST_S = 60.0  # a jog warms nothing
_MOST_ROWS = 1_000_000  # before the window, that are looked at


def driven_before(series: TestSeries, member: Member, here: Sequence[Bound], start: int, stop: int) -> tuple[str, ...]:
    """What is said of a test that begins at row `start` of a stream and leaves out what was logged before: nothing
    where the campaign file says how its lags begin, or where the machine stood. here: channels of the stream."""
    test = series.plan.test
    said = "history" in test.model_fields_set or test.start_state != "balance"
    if test.window is None or said or member[0] == SCHEDULE or not 0 < start < stop:
        return ()
    drives = [b for b in here if b.channel.quantity in _DRIVES and b.channel.quantity in SET]
    first = max(0, start - _MOST_ROWS)
    t_s = series.t_s(series.timeline(member).times(first, start + 1))
    moved: list[tuple[float, str]] = []
    for bound in drives:
        x = np.abs(series.values(bound, first, min(stop, start + _MOST_ROWS))[0])
        if x.dtype.kind != "f" or not np.isfinite(x).any():
            continue
        runs = x[: start - first] > _TURNS * float(np.nanmax(x))
        seconds = float(np.diff(t_s)[: len(runs)][runs].sum())
        if seconds >= _LEAST_S:
            moved.append((seconds, bound.name))
    if not moved:
        return ()
    names = ", ".join(name for _, name in sorted(moved, reverse=True))
    return (
        f"the window cuts off a start in which {names} ran, and lags begin at rest behind it; history: recording in "
        "the test lets them run from the recording's start, history: test says that they do begin at rest",
    )
