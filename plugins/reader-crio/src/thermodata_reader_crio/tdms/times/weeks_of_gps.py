"""A channel of weeks of GPS and one of the times in them, which together are the time of their group."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from thermodata.plugin import Source
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.clocks.time_questions import question_of_weeks
from thermodata.reader.text.times.in_memory import Stamps
from thermodata.reader.text.times.several_cells.gps_weeks import find_weeks, may_be_of_weeks, reads_weeks, utc_of_weeks
from thermodata_reader_crio.tdms.channels.channel import Channel
from thermodata_reader_crio.tdms.raw.values import read
from thermodata_reader_crio.tdms.times.time_channel import TimeChannel

_LOOKED_AT = 100  # rows


@dataclass(frozen=True, eq=False, slots=True)
class WeeksOfGps:
    """form: how both read, 'gps_week gps_s'."""

    week: Channel
    in_week: Channel
    form: str

    @property
    def members(self) -> tuple[Channel, Channel]:
        """The one that stands for the time of its group, and the other."""
        return self.week, self.in_week

    def time_channel(self, file: BinaryIO) -> TimeChannel:
        """The times of all rows, as those of the channel of weeks."""
        rows = min(self.week.length, self.in_week.length)
        weeks, in_weeks = (read(file, list(c.columns), 0, rows)[0] for c in (self.week, self.in_week))
        return TimeChannel(self.week, None, Stamps(utc_of_weeks(weeks, in_weeks, self.form), True, ()))


def weeks_of_gps(members: Sequence[Channel], source: Source, file: BinaryIO) -> WeeksOfGps | None:
    """The channels of a group that are declared so; None where there are none. QuestionError where two look so, and
    nothing else dates the group."""
    said = one_time(source.table, "table")
    wanted, form = said.get("column"), said.get("format")
    if isinstance(wanted, list | tuple) and reads_weeks(str(form or "").split()) is not None:
        found = [next((c for c in members if name in (c.short, c.signal.name)), None) for name in wanted]
        if len(found) == 2 and found[0] is not None and found[1] is not None:
            return WeeksOfGps(found[0], found[1], str(form))
        return None
    if wanted is not None or "time" in source.options or any(c.clock is not None or c.is_timestamp for c in members):
        return None
    likely = [c for c in members if c.signal.dtype not in ("str", "bool") and may_be_of_weeks(_name_with_unit(c))]
    rows = min([_LOOKED_AT, *(c.length for c in likely)])
    if len(likely) < 2 or not rows:
        return None
    cells = [read(file, list(c.columns), 0, rows)[0].tolist() for c in likely]
    data = [list(row) for row in zip(*cells, strict=True)]
    pair = find_weeks([_name_with_unit(c) for c in likely], data)
    if pair is None:
        return None
    (week, in_week), form = pair
    names = likely[week].short, likely[in_week].short
    row = next((r for r in data if np.isfinite([r[week], r[in_week]]).all()), data[0])
    where = f"{likely[week].signal.name}, {likely[in_week].signal.name}"
    raise question_of_weeks(names, names, f"{row[week]:.15g} {row[in_week]:.15g}", form, where)


def _name_with_unit(channel: Channel) -> str:
    unit = channel.signal.unit
    return f"{channel.short} [{unit}]" if unit else channel.short
