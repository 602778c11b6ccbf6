"""A table as far as it was sampled, and the cells of each column there, in the rows that have a time for it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.page.timed.group import Group
from thermodata.reader.text.tables.table import TimedGroup
from thermodata.reader.text.times.several_cells.date_parts import column_times, row_time
from thermodata.reader.text.times.several_cells.days import filled
from thermodata.reader.times.zone import NAT

_FEW_ROWS = 400  # whose times are read one by one, for Arrow takes longer to load


def still_going(rows: Iterable[list[str]], group: Group, layout: Layout) -> list[list[str]]:
    """The rows in which a group has a time. Groups have lengths of their own: beside those that go on, one that has
    ended is empty, which says nothing of how its times are written."""
    if len(layout.groups) < 2:
        return list(rows)
    return [r for r in rows if any(clean(r[i]) for i in group.time if i < len(r))]


@dataclass(frozen=True, slots=True)
class Sampled:
    """A table as far as it was sampled. said: what is declared of it; groups: its columns, each with the times of its
    rows; body: rows with a cell for each column; where: the file, as errors name it."""

    said: Mapping[str, Any]
    layout: Layout
    groups: tuple[TimedGroup, ...]
    body: Sequence[list[str]]
    where: str

    def cells(self) -> dict[str, list[str]]:
        """The cells of each column by its name, in the rows that have a time for it."""
        found: dict[int, list[str]] = {}
        for timed in self.groups:
            dated = _rows_with_times(still_going(self.body, timed.group, self.layout), timed)
            found |= {i: [r[i] for r in dated] for i in (*timed.group.time, *timed.group.columns)}
        return {name: found[i] for i, name in enumerate(self.layout.names)}


def _rows_with_times(body: Sequence[list[str]], timed: TimedGroup) -> list[list[str]]:
    """The rows whose times can be read."""
    if not timed.formats:
        return list(body)
    if timed.once:
        date = timed.group.time[0]
        days = filled([r[date] for r in body])
        body = [[*r[:date], day, *r[date + 1 :]] for r, day in zip(body, days, strict=True)]
    if len(body) < _FEW_ROWS:
        return [r for r in body if row_time([r[i] for i in timed.group.time], timed.formats) != NAT]
    read = column_times([[r[i] for r in body] for i in timed.group.time], timed.formats) != NAT
    return [r for r, good in zip(body, read.tolist(), strict=True) if good]
