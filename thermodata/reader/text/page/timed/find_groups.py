"""Which columns of a table share one time: as declared, or as found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from thermodata.errors import UsageError
from thermodata.reader.text.cells.cell import is_empty
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.table_time import TableTime, time_of
from thermodata.reader.text.clocks.time_columns import column
from thermodata.reader.text.clocks.time_groups import Span, spans
from thermodata.reader.text.page.timed.group import STREAM, Group
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.time_units import EPOCHS, SECONDS


def find_groups(
    said: Mapping[str, Any] | Sequence[Mapping[str, Any]], seen: FirstRows
) -> tuple[list[Group], list[str]]:
    """(groups of columns with one time each, notes). said: `table: {time: ...}`, one declaration or a list.
    Errors: as `time_of`, and UsageError for a list that contradicts itself."""
    width = len(seen.names)
    if not isinstance(said, Mapping):
        if len(said) > 1:
            return _declared_groups(said, seen)
        said = said[0] if said else {}
    if said.get("period") is not None:
        return [_group_at_period(said["period"], width, seen.where)], []
    notes: list[str] = []
    found: list[Span] = []
    if said.get("column") is None:
        found, notes = spans(seen)
    if not found:
        time = time_of(said, seen)
        rest = tuple(i for i in range(width) if i not in time.columns)
        return [_group(STREAM, time, rest)], [*time.notes, *notes]
    groups = []
    for span in found:
        there = seen.with_rows([r for r in seen.rows if any(not is_empty(r[i]) for i in span.times)])
        found_there = time_of(said, there.of(span.columns), tuple(span.columns.index(i) for i in span.times))
        time = replace(found_there, columns=tuple(span.columns[i] for i in found_there.columns))
        rest = tuple(i for i in span.columns if i not in time.columns)
        groups.append(_group(seen.names[time.columns[0]], time, rest))
        notes += time.notes
    which = "that share its name" if found[0].named else "behind it"
    streams = ", ".join(g.stream for g in groups)
    return groups, [f"{len(groups)} time columns, each with the columns {which}: streams {streams}", *notes]


def _declared_groups(said: Sequence[Mapping[str, Any]], seen: FirstRows) -> tuple[list[Group], list[str]]:
    """Groups of a declared list of times: each with its `signals`, or with the columns behind it up to the next."""
    width, notes = len(seen.names), list[str]()
    found: list[tuple[TableTime, tuple[int, ...] | None]] = []  # a time, and its declared signals
    for one in said:
        if one.get("column") is None:
            raise UsageError(
                "a time of several without its column",
                where=seen.where,
                expected="table: {time: [{column: ...}, {column: ...}]}",
                hint="name the column of each time",
            )
        wanted = one["column"]
        columns = [
            column(w, seen.names, seen.where) for w in (wanted if isinstance(wanted, list | tuple) else [wanted])
        ]
        time = time_of(one, seen.with_rows([r for r in seen.rows if not is_empty(r[columns[0]])]))
        signals = one.get("signals")
        found.append((time, None if signals is None else tuple(column(w, seen.names, seen.where) for w in signals)))
        notes += time.notes
    times = [i for time, _ in found for i in time.columns]
    counts = [i for _, own in found for i in own or ()]
    taken = set(counts)
    twice = sorted({i for i in times if times.count(i) > 1 or i in taken})
    twice += sorted({i for i in counts if counts.count(i) > 1})
    if twice:
        raise UsageError(
            f"column '{seen.names[twice[0]]}' is declared twice",
            where=seen.where,
            expected="each column once, as a time or as a signal of one",
            hint="leave it out of one of the two",
        )
    groups, left = [], set(range(width)) - set(times) - taken
    for time, own in found:
        if own is None:
            end = min((i for i in times if i > max(time.columns)), default=width)
            own = tuple(i for i in range(max(time.columns) + 1, end) if i not in taken)
        left -= set(own)
        groups.append(_group(seen.names[time.columns[0]], time, own))
    if left:
        first = groups[0]
        groups[0] = replace(first, columns=tuple(sorted((*first.columns, *left))))
        notes.append(
            f"columns of no declared time are read with '{first.stream}': "
            + ", ".join(seen.names[i] for i in sorted(left))
        )
    return groups, notes


def _group(stream: str, time: TableTime, columns: tuple[int, ...]) -> Group:
    """columns: those that have this time."""
    unit = time.unit
    seconds, epoch = (None, None) if unit is None else (SECONDS.get(unit), unit if unit in EPOCHS else None)
    return Group(stream, time.columns, seconds, time.form, epoch, columns)


def _group_at_period(period: Any, width: int, where: str) -> Group:
    """All columns, in rows that follow each other at a declared period [s]."""
    return Group(STREAM, (), period_s(period, where), None, None, tuple(range(width)), True)


def period_s(period: Any, where: str) -> float:
    """A declared `time.period` [s]; FormatError where it is not answered yet."""
    if period == UNKNOWN:
        raise unanswered("time.period", "the time from row to row: 10 s, 1 min", where)
    if isinstance(period, str):
        from thermodata.schema.units.value import value_in

        period = value_in(period, "s")
    return float(period)
