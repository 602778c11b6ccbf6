"""OPC UA logs as long tables: a row a value, with time, tag, value and status under names that differ by logger.

A value holds until the next one: the source's time stands still while it does not change. A bad status ends it.
Where the table is sorted by tag, each tag is a stream of its own, for there is no common order of time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text import clean
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import events, when
from thermodata_reader_cnc.chunks import chunks, sample
from thermodata_reader_cnc.events import Event, HeldTable
from thermodata_reader_cnc.layout import fields
from thermodata_reader_cnc.losses import NAMED

_LOOK = 4 << 20
_NAMES = {
    "time": ("sourcetimestamp", "sourcetime", "datetime", "timestamp", "servertimestamp", "servertime", "time"),
    "tag": ("tagname", "nodeid", "node", "displayname", "browsename", "tag"),
    "value": ("tagval", "tagvalue", "value"),
    "status": ("tagquality", "quality", "statuscode", "status"),
}


@dataclass(frozen=True, slots=True)
class Layout:
    """Columns of the four parts; status None where there is none."""

    delimiter: str
    row: int
    width: int
    time: int
    tag: int
    value: int
    status: int | None


def find(lines: Sequence[str]) -> Layout | None:
    """The layout by a header row among the first ten lines, or None."""
    for row, line in enumerate(lines[:10]):
        for delimiter in (",", ";", "\t"):
            names = [re.sub(r"[\s_.-]", "", clean(c)).lower() for c in line.split(delimiter)]
            place = {part: next((names.index(n) for n in known if n in names), None) for part, known in _NAMES.items()}
            time, tag, value = place["time"], place["tag"], place["value"]
            if time is not None and tag is not None and value is not None:
                return Layout(delimiter, row, len(names), time, tag, value, place["status"])
    return None


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    layout = find(lines)
    if layout is None or len(lines) < layout.row + 2:
        return None
    cells = fields(lines[layout.row + 1], layout.delimiter, True)
    if layout.time >= len(cells) or when.parse_one(cells[layout.time], when.DATETIME["ymd"]) == NAT:
        return None
    return "OPC UA: a long table of time, tag and value"


def good(status: str) -> bool:
    """Whether a status keeps its value: Good and Uncertain in words, OPC's 192...255, or UA's codes below bad."""
    text = status.strip().lower()
    if not text or text.startswith(("good", "uncertain")):
        return True
    try:
        code = int(text, 0)
    except ValueError:
        return False
    return code == 0 or 64 <= code <= 255 or (code > 255 and code >> 30 < 2)


def _events(layout: Layout, lines: Sequence[str], first: int, name: str) -> Iterator[Event | Loss]:
    for number, line in enumerate(lines, first):
        if number <= layout.row or not line.strip():
            continue
        cells = fields(line, layout.delimiter, True)
        at = f"{name} line {number + 1}"
        if len(cells) != layout.width or when.parse_one(cells[layout.time], when.DATETIME["ymd"]) == NAT:
            yield Loss(at, reason=f"expected {layout.width} cells with a time, got '{line[:80]}'")
            continue
        value = clean(cells[layout.value])
        if layout.status is not None and not good(cells[layout.status]):
            value = "UNAVAILABLE"
        yield Event(clean(cells[layout.time]), clean(cells[layout.tag]), value.replace(",", ".") if re.fullmatch(
            r"[+-]?\d+,\d+", value) else value, at)


@dataclass(frozen=True, slots=True)
class _Look:
    layout: Layout
    plan: events.Plan
    first: str | None
    encoding: str
    by_tag: bool
    whole: bool


def _look(path: Path, source: Source) -> _Look:
    first = sample(path, source.encoding, _LOOK)
    layout = find(first.head)
    if layout is None:
        raise FormatError("no long table", where=path.name, expected="columns of time, tag and value",
                          got=first.head[0][:80] if first.head else "nothing")
    head = [e for e in _events(layout, first.head, 0, path.name) if isinstance(e, Event)]
    rest = [e for e in _events(layout, first.rest, layout.row + 1, path.name) if isinstance(e, Event)]
    found, start = events.plan([*head, *rest])
    if not found:
        raise FormatError("no rows", where=path.name, expected="rows of time, tag and value", got="none")
    changes = sum(a.key != b.key for a, b in pairwise(head))
    back = sum(a.key != b.key and b.time < a.time for a, b in pairwise(head))
    return _Look(layout, found, start, first.encoding, 0 < changes < 0.1 * len(head) and 2 * back > changes,
                 first.ends_with_newline)


def describe(path: Path, source: Source) -> Recording:
    """Tags and the first time of a log, by samples of it."""
    look = _look(path, source)
    said = events.recording(look.plan, look.first, source, complete=None if look.whole else False)
    if not look.by_tag:
        return said
    stream = {t.name: tag for tag, each in look.plan.items() for t in each}
    return Recording(tuple(Signal(s.name, stream[s.name], s.unit, s.dtype) for s in said.signals), said.clock,
                     said.start_ns, said.complete, ("sorted by tag: each tag is a stream",))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values, and lines that do not read."""
    look, counts = _look(path, source), dict[str, int]()

    def limited(key: str, loss: Loss) -> Iterator[Loss]:
        counts[key] = counts.get(key, 0) + 1
        if counts[key] <= (1 if key else NAMED):
            yield loss

    complain: Callable[[Event, str], Iterator[Loss]] = \
        lambda event, reason: limited(event.key, Loss(event.at, reason=f"'{event.key}': {reason}"))  # noqa: E731
    tables = {tag: HeldTable({tag: t}, source, complain, tag) for tag, t in look.plan.items()} if look.by_tag else {}
    common = HeldTable(look.plan, source, complain)
    for chunk in chunks(path, look.encoding):
        lines = chunk.data.decode("utf-8", "replace").replace("\r\n", "\n").split("\n")
        tail = lines.pop()
        for event in _events(look.layout, lines, chunk.line, path.name):
            if isinstance(event, Loss):
                yield from limited("", event)
            else:
                yield from tables.get(event.key, common).add(event)
        if chunk.last and tail.strip():
            yield Loss(f"{path.name} last line", reason=f"it has no line end and may be cut: '{tail[:60]}'")
    for table in (*tables.values(), common):
        yield from table.flush()
    if counts.get("", 0) > NAMED:
        yield Loss(path.name, reason=f"{counts[''] - NAMED} more lines that do not read")
