"""Quality flags of a test's channels, and when it measures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thermodata.calibration.measuring import measuring_mask, measuring_names
from thermodata.errors import ThermodataError
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.flag import Flag
from thermodata.schema.quantity import canonical
from thermodata.store.keys import MEASURED
from thermodata.store.plan import SCHEDULE
from thermodata.store.series import Member, TestSeries

if TYPE_CHECKING:
    from thermodata.store.tidy import Column


@dataclass(frozen=True, slots=True)
class Event:
    """A stretch of flagged samples; times in seconds from the test's start. channel: None for the whole stream."""

    channel: str | None
    flag: str
    from_s: float
    to_s: float
    n: int
    detail: str | None = None


def flagged(series: TestSeries, member: Member, t_ns: Int1D, made: Mapping[str, Column],
            problems: list[str]) -> list[Event]:
    """Adds flags to the columns of one stream and returns the events; flags that are there are kept.

    problems: gets the reason where `measuring` can't be evaluated.
    """
    from thermodata.calibration.quality import ColumnInput, flag_stream

    if member[0] == SCHEDULE or not made:
        return []
    found, events = flag_stream(t_ns, {
        n: ColumnInput(values=c.values, quantity=c.bound.channel.quantity, flags=c.flags) for n, c in made.items()})
    zero = series.span.zero_ns
    listed = [Event(e.channel, e.flag, (e.from_ns - zero) / 1e9, (e.to_ns - zero) / 1e9, e.n, e.detail or None)
              for e in events]
    for name, column in made.items():
        column.flags = found[name]
        if column.bound.channel.quantity in MEASURED and series.plan.test.measuring is not None:
            mask = _measuring(series, name, column, t_ns, problems)
            if mask is not None:
                column.flags = column.flags | np.where(mask, np.uint16(0), np.uint16(Flag.NOT_MEASURING))
    return listed


def _measuring(series: TestSeries, name: str, column: Column, t_ns: Int1D, problems: list[str]) -> Bool1D | None:
    """Where the test measures with this channel, shape (n,); None where that can't be told."""
    test = series.plan.test
    try:
        operands: dict[str, Array] = {
            n: series.sampled(n, t_ns)[0] for n in measuring_names(test.measuring) if n in series.plan.bound}
        units = {n: canonical(series.plan.bound[n].channel.quantity) for n in operands}
        return measuring_mask(t_ns, test.measuring, operands, units, {name: column.flags})
    except ThermodataError as error:
        problems.append("measuring: " + "; ".join(str(error).splitlines()))
        return None
