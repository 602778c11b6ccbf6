"""Quality flags of a test's channels, and when it measures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.calibration.measuring import measuring_mask, measuring_names
from thermodata.errors import ThermodataError
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.flag import Flag
from thermodata.schema.quantity import canonical
from thermodata.store.keys import MEASURED
from thermodata.store.plan import Bound
from thermodata.store.series import Member, TestSeries

# more events of one kind than this say nothing that their number doesn't
MOST_EVENTS = 200


@dataclass(frozen=True, slots=True)
class Event:
    """A stretch of flagged samples; times in seconds from the test's start. channel: None for the whole stream."""

    channel: str | None
    flag: str
    from_s: float
    to_s: float
    n: int
    detail: str | None = None


class Quality:
    """Flags the columns of one stream of a test."""

    def __init__(self, series: TestSeries, member: Member) -> None:
        self.series, self.member = series, member
        self.problems: list[str] = []
        self._when: tuple[Int1D, Bool1D | None] | None = None

    def column(self, bound: Bound, t_ns: Int1D, values: Array, flags: Array) -> tuple[Array, list[Event]]:
        """(flags, events) of a calibrated column; flags of its calibration and of the reader are kept."""
        try:
            from thermodata.calibration.quality import ColumnInput, flag_stream
        except ImportError:
            events = []
        else:
            found, events = flag_stream(t_ns, {bound.name: ColumnInput(values=values, flags=flags, channel=bound.channel)})
            flags = found[bound.name]
        if bound.channel.quantity in MEASURED and self.series.plan.test.measuring is not None:
            mask = self.measuring(bound, t_ns, values, flags)
            if mask is not None:
                flags = flags | np.where(mask, np.uint16(0), np.uint16(Flag.NOT_MEASURING))
        return flags, [self._event(e) for e in events[:MOST_EVENTS]]

    def measuring(self, bound: Bound, t_ns: Int1D, values: Array, flags: Array) -> Bool1D | None:
        """Where the test measures with this channel, shape (n,); None where that can't be told."""
        test = self.series.plan.test
        try:
            operands: dict[str, Array] = {}
            for name in measuring_names(test.measuring):
                if name in self.series.plan.bound:
                    operands[name] = self.series.sampled(name, t_ns)[0]
            units = {n: canonical(self.series.plan.bound[n].channel.quantity) for n in operands}
            return measuring_mask(t_ns, test.measuring, {**operands}, units, {bound.name: flags})
        except ThermodataError as error:
            self.problems.append(f"test '{test.id}', measuring: " + "; ".join(str(error).splitlines()))
            return None

    def stream(self, here: Sequence[Bound], t_ns: Int1D) -> list[Event]:
        """Events of the stream as a whole."""
        return []

    def _event(self, event: Any) -> Event:
        return event
