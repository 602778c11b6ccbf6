"""A trace frame's signals as streams: servo signals held on the grid of their interval, others as they were written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Float1D, Int1D, Loss
from thermodata.reader.signals.events import fill_forward
from thermodata.reader.text.cells.values.column import values_of
from thermodata.reader.text.cells.values.number import to_float
from thermodata.schema.flag import Flag
from thermodata.schema.words.numbered import numbered
from thermodata_reader_cnc.sinumerik.trace_records import Frame

LOOK = 2000  # records by which an interval's unit is found
_NO_VALUE = 9.218868437227405e18  # the bits of a double's infinity and what is no number, as an integer
_SERVO = "255"
_ROWS = 1 << 20  # of a block
_JUMP = 1 << 21  # rows of a grid that one record may skip: 70 min at 2 ms
_MISSING = np.uint16(Flag.NOT_MEASURING)


@dataclass(slots=True)
class Group:
    """Signals of one kind and interval. names: attribute -> signal; step_s: the grid's step, None where none fits;
    next: rows of the grid so far; counts: values so far by attribute; held: the last value by attribute; last_at: the
    byte of the last record."""

    stream: str
    servo: bool
    names: dict[str, str]
    step_s: float | None = None
    origin: int | None = None
    next: int = 0
    counts: dict[str, int] = field(default_factory=dict)
    held: dict[str, float] = field(default_factory=dict)
    last_at: int = 0
    stepped_back: int = 0
    too_far: int = 0


def groups_of(frame: Frame, taken: Iterable[str]) -> list[Group]:
    """The groups of a frame's signals. taken: streams of other frames, whose names are not used again."""
    groups: dict[tuple[bool, str], Group] = {}
    seen: dict[str, int] = {}
    used = set(taken)
    intervals = {s.get("interval", "") for s in frame.signals.values()}
    for key, said in frame.signals.items():
        servo, interval = said.get("event") == _SERVO, said.get("interval", "")
        name = said.get("name") or said.get("description") or key
        seen[name] = seen.get(name, 0) + 1
        name += f"#{seen[name]}" if seen[name] > 1 else ""
        stream = ("servo" if servo else "ipo") + (f"@{interval}" if len(intervals) > 1 else "")
        if (servo, interval) not in groups:
            groups[servo, interval] = Group(numbered(stream, used.__contains__, " #"), servo, {})
            used.add(groups[servo, interval].stream)
        groups[servo, interval].names[key] = name
    for (servo, interval), group in groups.items():
        if servo:
            times = [
                t
                for t, cells in zip(frame.times[:LOOK], frame.cells, strict=False)
                if not group.names.keys().isdisjoint(cells)
            ]
            group.step_s = _step(interval, np.array(times), frame, group)
    return list(groups.values())


def _step(interval: str, times: Float1D, frame: Frame, group: Group) -> float | None:
    """The interval in seconds: the unit (s, ms, us) by which the group's records lie on a grid of it."""
    value = _finite_number(interval)
    gaps = np.diff(times)
    gaps, since = gaps[gaps > 0], times - times[:1]
    if value is None or not value > 0 or not gaps.size:
        return None
    for unit in (1.0, 1e-3, 1e-6):
        for step in _steps(value * unit, frame, group):
            steps, places = gaps / step, since / step
            if (
                np.abs(places - np.round(places)).max() < 0.05
                and steps.min() > 0.5
                and (unit == 1.0 or steps.min() < 16.5)
            ):
                return step
    return None


def _steps(step: float, frame: Frame, group: Group) -> Iterator[float]:
    """The step as announced; and as the frame's length and count say, for it may be rounded to whole microseconds."""
    yield step
    count = next(
        (int(c) for k in group.names if (c := frame.signals[k].get("datapointCount", "")).isdecimal() and len(c) < 12),
        0,
    )
    length = _finite_number(frame.header.get("stopInc", ""))
    if count > 1 and length and abs(length / (count - 1) / step - 1) < 0.02:
        yield length / (count - 1)


def _finite_number(text: str) -> float | None:
    value = to_float(text)
    return value if value is not None and np.isfinite(value) else None


def rows(
    group: Group, times: Float1D, at: Int1D, columns: dict[str, tuple[Int1D, Float1D]], start_ns: int
) -> Iterator[Block]:
    """The records of a frame as rows of one group. times: of the records, shape (n,) [s]; at: their bytes, shape (n,);
    columns: attribute -> (which records have it, their values)."""
    present = {key: columns.get(key, (np.empty(0, np.int64), np.empty(0))) for key in group.names}
    for key, (record, _) in present.items():
        group.counts[key] = group.counts.get(key, 0) + record.size
    which = np.unique(np.concatenate([record for record, _ in present.values()]))
    if not which.size:
        return
    if group.servo and group.step_s is not None:
        yield from _on_grid(group, times, at, which, present, start_ns)
        return
    t_ns = start_ns + np.round(times[which] * 1e9).astype(np.int64)
    values: dict[str, Array] = {}
    for key, name in group.names.items():
        record, known = present[key]
        column = np.full(which.size, np.nan)
        column[np.searchsorted(which, record)] = known
        if group.servo:
            column = _held_column(group, key, column, np.isin(which, record))
        values[name] = column
    yield _block(group.stream, t_ns, values, at[which])


def _on_grid(
    group: Group, times: Float1D, at: Int1D, which: Int1D, present: dict[str, tuple[Int1D, Float1D]], start_ns: int
) -> Iterator[Block]:
    """Servo signals on the grid of their interval, in bounded blocks."""
    assert group.step_s is not None
    grid = np.round(times / group.step_s).astype(np.int64)
    if group.origin is None:
        group.origin = int(grid[which[0]])
    grid -= group.origin
    far = _far(grid, which, group.next)
    group.too_far += int(far[which].sum())
    group.stepped_back += int((grid[which] < group.next).sum())
    if far[which].all():
        return
    last = int(grid[which][~far[which]].max()) + 1
    for first in range(group.next, last, _ROWS):
        stop = min(first + _ROWS, last)
        t_ns = start_ns + np.round((group.origin + np.arange(first, stop)) * group.step_s * 1e9).astype(np.int64)
        values: dict[str, Array] = {}
        for key, name in group.names.items():
            record, known = present[key]
            inside = (grid[record] >= first) & (grid[record] < stop) & ~far[record]
            column, written = np.full(stop - first, np.nan), np.zeros(stop - first, bool)
            column[grid[record[inside]] - first] = known[inside]
            written[grid[record[inside]] - first] = True
            values[name] = _held_column(group, key, column, written)
        near = which[(grid[which] >= first) & (grid[which] < stop) & ~far[which]]
        yield _block(group.stream, t_ns, values, _records_of(group, at[near], grid[near] - first, stop - first))
    group.next = max(group.next, last)


def _records_of(group: Group, at: Int1D, place: Int1D, n: int) -> Int1D:
    """The byte of each row's record: the last one that stands at it, or before it."""
    result: Int1D = np.full(n, -1)
    result[place] = at
    if n and result[0] < 0:
        result[0] = group.last_at
    result = fill_forward(result, result >= 0)
    group.last_at = int(result[-1])
    return result


def _far(grid: Int1D, which: Int1D, start: int) -> Bool1D:
    """The records that lie far behind all before them: a damaged time is no reason to hold values for days."""
    far = np.zeros(grid.size, bool)
    while True:
        left = which[~far[which]]
        reached = np.maximum.accumulate(np.concatenate(([start], grid[left])))
        jump = np.flatnonzero(np.diff(reached) > _JUMP)
        if not jump.size:
            return far
        far[left[grid[left] > reached[jump[0]] + _JUMP]] = True


def _held_column(group: Group, key: str, column: Float1D, written: Array) -> Float1D:
    if written.size and not written[0]:
        column[0], written = group.held.get(key, np.nan), written.copy()
        written[0] = True
    result: Float1D = fill_forward(column, written)
    group.held[key] = float(result[-1])
    return result


def _block(stream: str, t_ns: Int1D, values: dict[str, Array], at: Int1D) -> Block:
    flags = {name: np.isnan(column) * _MISSING for name, column in values.items() if np.isnan(column).any()}
    return Block(stream, t_ns, values, flags or None, at)


def columns_of(frame: Frame) -> dict[str, tuple[Int1D, Float1D]]:
    """The records' values by attribute: (which records have it, their values); what is no number is NaN."""
    written: dict[str, tuple[list[int], list[str]]] = {key: ([], []) for key in frame.signals}
    for row, cells in enumerate(frame.cells):
        for key, text in cells.items():
            if key in written:
                written[key][0].append(row)
                written[key][1].append(text)
    columns: dict[str, tuple[Int1D, Float1D]] = {}
    for key, (records, texts) in written.items():
        cells_read = values_of(texts, "float64")
        values = cells_read.values
        values[np.abs(values) >= _NO_VALUE] = np.nan
        if cells_read.odd:
            frame.first_odd = (
                frame.first_odd or f"'{cells_read.odd[0][1][:40]}' of '{frame.signals[key].get('name', key)}'"
            )
            frame.odd += len(cells_read.odd)
        columns[key] = np.array(records, np.int64), values
    return columns


def counted(where: str, frame: Frame, groups: list[Group]) -> Iterator[Loss]:
    """What of a frame is missing by its own `datapointCount`, and records that step back in time."""
    for group in groups:
        if group.too_far:
            yield Loss(
                f"{where} stream '{group.stream}'",
                reason=(
                    f"{group.too_far} records lie more than {_JUMP} intervals behind those before; they are not read"
                ),
            )
        if group.stepped_back:
            yield Loss(
                f"{where} stream '{group.stream}'",
                reason=(f"{group.stepped_back} records step back in time; they are not read"),
            )
        for key, name in group.names.items():
            said = frame.signals[key].get("datapointCount", "")
            holds = group.next if group.servo and group.step_s is not None else group.counts.get(key, 0)
            if (group.servo and group.step_s is None) or not said.isdecimal() or int(said[:15]) == holds:
                continue
            yield Loss(
                f"{where} signal '{name}'",
                fraction=max(0.0, 1 - holds / max(1, int(said[:15]))),
                reason=f"datapointCount is {said[:15]}, the {'grid' if group.servo else 'file'} holds {holds}",
            )
