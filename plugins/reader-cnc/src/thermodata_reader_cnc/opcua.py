"""Long tables of an OPC UA (or SIMATIC) logger: a row a value, with time, tag, value and status under many names.

A value holds until the next one: the source's time stands still while it does not change. A bad status flags it.
Where the table is sorted by tag, each tag is a stream of its own, for there is no common order of time.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text import clean
from thermodata.reader.zone import NAT
from thermodata.schema.flag import Flag
from thermodata_reader_cnc import events, when
from thermodata_reader_cnc.chunks import ODD, chunks, sample
from thermodata_reader_cnc.events import GONE, Event, HeldTable
from thermodata_reader_cnc.layout import fields
from thermodata_reader_cnc.losses import NAMED
from thermodata_reader_cnc.status import BAD, is_good, zero_is_good
from thermodata_reader_cnc.timecolumns import absolute
from thermodata_reader_cnc.when import TimeFormat

_LOOK = 4 << 20
_MOST_LINES = 64  # of one quoted value
_TIMES = (
    "sourcetimestamp",
    "sourcetime",
    "datetime",
    "timestamp",
    "timestring",
    "servertimestamp",
    "servertime",
    "time",
    "receivedat",
)
_TAGS = ("tagname", "varname", "nodeid", "node", "displayname", "browsename", "tag", "itemid", "name")
_VALUES = ("tagval", "tagvalue", "varvalue", "value")
_STATUS = ("statusname", "statustext", "tagquality", "quality", "statuscode", "status", "validity")
_COMMA = re.compile(r"^[+-]?\d+,\d+(?:[eE][+-]?\d+)?$")


@dataclass(frozen=True, slots=True)
class Layout:
    """Columns of the parts. times: the first that a row has is its time. tag, status: None where there is none."""

    delimiter: str
    row: int
    width: int
    times: tuple[int, ...]
    tag: int | None
    value: int
    status: int | None
    form: TimeFormat
    zero_good: bool


def find(lines: Sequence[str], where: str) -> Layout | None:
    """The layout by a header row among the first ten lines, or None. FormatError: no order of day and month."""
    for row, line in enumerate(lines[:10]):
        for delimiter in (",", ";", "\t"):
            names = [re.sub(r"[\s_.#()-]", "", clean(c)).casefold() for c in line.split(delimiter)]
            times = tuple(names.index(n) for n in _TIMES if n in names)
            tag = next((names.index(n) for n in _TAGS if n in names), None)
            value = next((names.index(n) for n in _VALUES if n in names), None)
            status = next((names.index(n) for n in _STATUS if n in names), None)
            if value is None or not times or (tag is None and ("sourcetimestamp" not in names or status is None)):
                continue
            body = [fields(text, delimiter, True) for text in lines[row + 1 : row + 2000]]
            body = [cells for cells in body if len(cells) == len(names)]
            stamps = [[_time(cells, times)] for cells in body if _time(cells, times)]
            found = absolute(stamps, [], where) if stamps else None
            if found is None or found[0][1].role != "datetime":
                continue
            zero = status is None or zero_is_good((cells[status] for cells in body), names[status])
            return Layout(delimiter, row, len(names), times, tag, value, status, found[0][1], zero)
    return None


def _time(cells: Sequence[str], times: Sequence[int]) -> str:
    return next((text for k in times if (text := clean(cells[k]))), "")


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    try:
        layout = find(lines, "")
    except FormatError:
        return None
    if layout is None:
        return None
    return "OPC UA: a long table of time, tag and value"


def _records(lines: Iterable[str]) -> Iterator[tuple[str, int]]:
    """(record, lines): a quoted value may hold line ends; a quote that is never closed ends with its line."""
    waiting: list[str] = []
    for line in lines:
        waiting.append(line)
        if sum(text.count('"') for text in waiting) % 2 == 0:
            yield "\n".join(waiting), len(waiting)
            waiting = []
        elif len(waiting) > _MOST_LINES:
            yield waiting[0], 1
            waiting = list(waiting[1:])
            while waiting and waiting[0].count('"') % 2 == 0:
                yield waiting.pop(0), 1
    for text in waiting:
        yield text, 1


def _events(layout: Layout, lines: Iterable[str], first: int, name: str) -> Iterator[Event | Loss]:
    number = first
    for text, count in _records(lines):
        at, number = f"{name} line {number + 1}", number + count
        if number - count <= layout.row or not text.strip():
            continue
        if "\0" in text:
            yield Loss(at, reason=f"{text.count(chr(0))} NUL bytes")
            text = text.replace("\0", "")
        cells = fields(text, layout.delimiter, True)
        time = _time(cells, layout.times) if len(cells) == layout.width else ""
        if not time or when.parse_one(time, layout.form) == NAT:
            yield Loss(at, reason=f"expected {layout.width} cells with a time, got '{text[:80]}'")
            continue
        flag = 0 if clean(cells[layout.times[0]]) else int(Flag.CLOCK_SUSPECT)
        if layout.status is not None and not is_good(clean(cells[layout.status]), layout.zero_good):
            flag |= BAD
        value = clean(cells[layout.value])
        if (layout.delimiter != "," and _COMMA.match(value)) or (
            layout.delimiter == "," and '"' in text and _COMMA.match(value)
        ):
            value = value.replace(",", ".")
        tag = "Value" if layout.tag is None else clean(cells[layout.tag])
        if not tag:
            yield Loss(at, reason=f"a value without a tag: '{text[:80]}'")
            continue
        yield Event(time, tag, value or GONE, at, flag)


@dataclass(frozen=True, slots=True)
class _Look:
    layout: Layout
    plan: events.Plan
    encoding: str
    by_tag: bool
    whole: bool
    notes: tuple[str, ...]


def _look(path: Path, source: Source) -> _Look:
    first = sample(path, source.encoding, _LOOK)
    layout = find(first.head, path.name)
    if layout is None:
        raise FormatError(
            "no long table",
            where=path.name,
            expected="columns of time, tag and value",
            got=first.head[0][:80] if first.head else "nothing",
        )
    lines = first.head[:-1] if first.whole and not first.ends_with_newline else first.head
    head = [e for e in _events(layout, lines, 0, path.name) if isinstance(e, Event)]
    rest = [e for e in _events(layout, first.rest, layout.row + 1, path.name) if isinstance(e, Event)]
    plan = events.plan([*head, *rest], form=layout.form)
    if not plan.items:
        raise FormatError("no rows", where=path.name, expected="rows of time, tag and value", got="none")
    changes = sum(a.key != b.key for a, b in pairwise(head))
    back = sum(a.key != b.key and b.time < a.time for a, b in pairwise(head))
    by_tag = 0 < changes < 0.1 * len(head) and 2 * back > changes
    notes = [first.note] if first.note else []
    notes += ["sorted by tag: each tag is a stream"] if by_tag else []
    return _Look(
        layout, replace(plan, apart=plan.apart or by_tag), first.encoding, by_tag, first.ends_with_newline, tuple(notes)
    )


def describe(path: Path, source: Source) -> Recording:
    """Tags and the first time of a log, by samples of it."""
    look = _look(path, source)
    return events.recording(look.plan, source, complete=None if look.whole else False, notes=look.notes)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values, and lines that do not read."""
    look, counts = _look(path, source), dict[str, int]()

    def limited(key: str, loss: Loss) -> Iterator[Loss]:
        key = key if key in counts or len(counts) < 1000 else ""
        counts[key] = counts.get(key, 0) + 1
        if counts[key] <= (1 if key else NAMED):
            yield loss

    def complain(event: Event, reason: str) -> Iterator[Loss]:
        return limited(event.key, Loss(event.at, reason=f"'{event.key}': {reason}"))

    table = HeldTable(look.plan, source, complain, ordered=look.by_tag)
    for event in _all(path, look):
        if isinstance(event, Loss):
            yield from limited("", event)
        else:
            yield from table.add(event)
    yield from table.flush()
    for key, count in counts.items():
        if count > (1 if key else NAMED):
            yield Loss(
                path.name,
                reason=f"{count - (1 if key else NAMED)} more "
                + (f"values of '{key}' that do not read" if key else "lines that do not read"),
            )


def _all(path: Path, look: _Look) -> Iterator[Event | Loss]:
    for chunk in chunks(path, look.encoding):
        for number in chunk.odd:
            yield Loss(f"{path.name} line {number + 1}", reason=ODD)
        lines = chunk.data.decode("utf-8", "replace").replace("\r\n", "\n").split("\n")
        tail = lines.pop()
        yield from _events(look.layout, lines, chunk.line, path.name)
        if tail.strip("\0 \r"):
            yield Loss(f"{path.name} last line", reason=f"it has no line end and may be cut: '{tail[:60]}'")
