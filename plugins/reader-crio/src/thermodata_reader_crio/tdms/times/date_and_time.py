"""A channel of dates and one of times of day, both as text, which together are the time of their group."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import BinaryIO

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.cell import TIME_WORD
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.times.in_memory import times_of_pairs
from thermodata.reader.text.times.time_formats import find_format
from thermodata_reader_crio.tdms.channels.channel import Channel
from thermodata_reader_crio.tdms.raw.values import read
from thermodata_reader_crio.tdms.times.time_channel import TimeChannel

_LOOKED_AT = 100  # rows


@dataclass(frozen=True, eq=False, slots=True)
class DateAndTime:
    """date, time: the channels. form: how both together are declared to read, None where they are not."""

    date: Channel
    time: Channel
    source: Source
    form: str | None

    @property
    def members(self) -> tuple[Channel, Channel]:
        """The one that stands for the time of its group, and the other."""
        return self.date, self.time

    def time_channel(self, file: BinaryIO) -> TimeChannel:
        """The times of all rows, as those of the channel of dates."""
        rows = min(self.date.length, self.time.length)
        days, clocks = (_texts(file, c, rows) for c in self.members)
        where = f"{self.date.signal.name}, {self.time.signal.name}"
        told = times_of_pairs(days, clocks, self.source.timezone, self.form, where)
        return TimeChannel(self.date, None, told, tuple(told.notes))


def date_and_time(members: Sequence[Channel], source: Source, file: BinaryIO) -> DateAndTime | None:
    """The channels of a group that are declared so, or that hold the one and the other where nothing else dates the
    group and a name says time; None where there are none."""
    said = one_time(source.table, "table")
    wanted, form = said.get("column"), said.get("format")
    texts = [c for c in members if c.signal.dtype == "str" and c.clock is None]
    if isinstance(wanted, list | tuple):
        found = [next((c for c in texts if name in (c.short, c.signal.name)), None) for name in wanted]
        if len(found) == 2 and found[0] is not None and found[1] is not None:
            return DateAndTime(found[0], found[1], source, None if form is None else str(form))
        return None
    if wanted is not None or "time" in source.options or any(c.clock is not None or c.is_timestamp for c in members):
        return None
    roles = [(c, _role(c, file)) for c in texts]
    days, times = ([c for c, role in roles if role == wished] for wished in ("date", "time"))
    if len(days) != 1 or len(times) != 1 or days[0].length != times[0].length:
        return None
    if any(role == "datetime" and TIME_WORD.match(split_unit(c.short)[0]) for c, role in roles):
        return None
    if not any(TIME_WORD.match(split_unit(c.short)[0]) for c in (days[0], times[0])):
        return None
    return DateAndTime(days[0], times[0], source, None if form is None else str(form))


def _role(channel: Channel, file: BinaryIO) -> str | None:
    """'date', 'time' or 'datetime' of a channel whose first texts are dates, times of day or both; None of others."""
    cells = [c for c in _texts(file, channel, min(_LOOKED_AT, channel.length)) if c]
    if not cells:
        return None
    try:
        form = find_format(cells, channel.signal.name)
    except QuestionError:  # day and month, which are asked of both together
        return None if any(":" in c for c in cells) else "date"
    except FormatError:
        return None
    return "time" if form.of_day else form.role if form.role in ("date", "datetime") else None


def _texts(file: BinaryIO, channel: Channel, rows: int) -> list[str]:
    found = read(file, list(channel.columns), 0, rows)[0]
    return ["" if c is None else str(c).strip() for c in found]
