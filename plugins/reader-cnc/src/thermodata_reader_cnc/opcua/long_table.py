"""Long tables of an OPC UA (or SIMATIC) logger or of a historian (InfluxDB, PI): a row a value, with time, tag, value
and status under many names.

A value holds until the next one: the source's time stands still while it does not change. A bad status flags it. Tables
of InfluxDB with other columns follow each other (`sections`). Where the table is sorted by tag, each tag is a stream of
its own, for there is no common order of time.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.number import to_float
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.cells.values.status import BAD, declared_zero, is_good
from thermodata.reader.text.file.lines import ODD, chunks, from_line, sample, split_last_line
from thermodata.reader.text.file.locate import line_of, lines_of
from thermodata.reader.text.file.losses import NAMED
from thermodata.reader.text.rows.footer import footer_notes, is_footer
from thermodata.reader.text.rows.typed import parse
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT
from thermodata.schema.flag import Flag
from thermodata_reader_cnc import events
from thermodata_reader_cnc.events import GONE, Event, HeldTable
from thermodata_reader_cnc.opcua.find_layout import find_layout
from thermodata_reader_cnc.opcua.long_layout import Layout
from thermodata_reader_cnc.opcua.row_units import in_unit_of, units_of
from thermodata_reader_cnc.opcua.sections import Sections, find_sections

EXAMPLE = b"DateTime,TagName,TagVal,TagQuality\n2024-01-01 00:00:00,T1,20.5,192\n2024-01-01 00:00:01,T2,20.5,192\n"
_LOOK = 4 << 20
_PART = 1 << 20  # bytes, and lines, whose cells are held as text at once
_LINES = 20_000
_LAST_LINES = 20  # in which a footer is looked for
_MOST_HELD = 1 << 16  # bytes of a value in quotes that goes over two parts


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    try:
        layout = find_layout(lines, "")
    except FormatError:
        return None
    if layout is None:
        return None
    return "OPC UA: a long table of time, tag and value"


def _events(
    layout: Layout, data: bytes, line: int, name: str, units: Mapping[str, str]
) -> Generator[Event | Loss, None, bool]:
    """What whole lines in UTF-8 report, in order; whether the table ends in them. line: the number of the first,
    0-based in the file; units: of tags, in which their values are given."""
    rows, part = parse(data, line, layout.grid), f"{name} line"
    status_name = layout.status_name
    columns = {k: rows.columns[k].values.tolist() for k in layout.wanted}
    stamps = [columns[k] for k in layout.times]
    times = [next((text for text in each if text), "") for each in zip(*stamps, strict=True)]
    ns = timestamp.parse(times, layout.form)
    undated = rows.line[ns == NAT].tolist()
    texts = {each.line: each.text for each in rows.bad}
    if undated:
        lines = data.split(b"\n")
        texts.update({k: lines[k - line].decode("utf-8", "replace").rstrip("\r") for k in undated})
    losses, end = _not_rows(layout, texts, rows.nul, name)
    of_row = (rows.line.tolist(), times, (ns != NAT).tolist(), stamps[0], layout.faulty(columns, rows.n))
    parts = [_parts(each, columns, rows.n) for each in (layout, *layout.more)]
    for number, time, good, stamp, faulty, *told in zip(*of_row, *parts, strict=True):
        while losses and losses[0][0] <= number:
            yield losses.pop(0)[1]
        if end is not None and number >= end:
            break
        for tag, value, status, unit in told if good else ():
            if not tag:
                if value or not layout.more:
                    yield Loss(f"{part} {number + 1}", reason=f"a value without a tag: '{value or ''}'")
                continue
            flag = (0 if stamp else int(Flag.CLOCK_SUSPECT)) | (BAD if faulty else 0)
            if status is not None and not is_good(status, bool(layout.zero_good), status_name):
                flag |= BAD
            if value and value.count(",") == 1 and "." not in value and to_float(value, ",") is not None:
                value = value.replace(",", ".")  # a value with a decimal comma is quoted, or stands between other marks
            value, wrong = in_unit_of(tag, value or "", (unit or "").strip(), units)
            if wrong is not None:
                yield Loss(f"{part} {number + 1}", reason=f"'{tag}': a value {wrong}: '{value[:40]}'")
                continue
            yield Event(time, tag, value or GONE, number + 1, part, flag)
    yield from (loss for _, loss in losses)
    return end is not None


def _parts(layout: Layout, columns: dict[int, list[str | None]], n: int) -> Iterator[tuple[str | None, ...]]:
    """(tag, value, status, unit) of each of n rows."""
    statuses = [None] * n if layout.status is None else columns[layout.status]
    written = [""] * n if layout.unit is None else columns[layout.unit]
    return zip(layout.named(columns, n), layout.valued(columns), statuses, written, strict=True)


def _not_rows(
    layout: Layout, texts: Mapping[int, str], nul: Sequence[tuple[int, int]], name: str
) -> tuple[list[tuple[int, Loss]], int | None]:
    """((line, loss) of what is no row, in order; the line at which columns are named anew). texts: line -> what stands
    in it; nul: (line, how many NUL bytes); name: of the file."""
    end = min((k for k, text in texts.items() if layout.is_other_header(text)), default=None)
    found = [(k, 0, f"{count} NUL bytes") for k, count in nul]
    found += [
        (k, 1, f"expected {layout.width} cells with a time, got '{text[:80]}'")
        for k, text in texts.items()
        if not (layout.is_header(text) or is_footer([clean(c) for c in fields(text, layout.delimiter)])) and k != end
    ]
    if end is not None:
        found = [each for each in found if each[0] < end]
        found.append((end, 1, f"a table with other columns begins, and the reading ends: '{texts[end][:80]}'"))
    return [(k, Loss(f"{name} line {k + 1}", reason=reason)) for k, _, reason in sorted(found)], end


@dataclass(frozen=True, slots=True)
class _Look:
    layout: Layout
    plan: events.Plan
    encoding: str
    by_tag: bool
    whole: bool
    notes: tuple[str, ...]
    units: Mapping[str, str]
    sections: Sections


def _look_at(path: Path, source: Source) -> _Look:
    first = sample(path, source.encoding, _LOOK)
    said = (source.table or {}).get("time")
    declared = said.get("format") if isinstance(said, Mapping) else None
    layout = find_layout(first.head, path.name, declared, first.rest)
    if layout is None:
        raise FormatError(
            "no long table",
            where=path.name,
            expected="columns of time, tag and value",
            got=first.head[0][:80] if first.head else "nothing",
            hint="'thermodata sniff FILE' says which reader takes it",
        )
    if layout.status is not None:
        name = clean(fields(layout.header, layout.delimiter)[layout.status])
        layout = replace(layout, zero_good=declared_zero(source.table, layout.zero_good, name, path.name))
    lines = first.head[:-1] if first.whole and not first.ends_with_newline else first.head
    sections = find_sections(path, first.encoding, layout, declared)
    layout = sections.all[0].layout if sections.all else layout
    units, converted = units_of(layout, (*lines[layout.row + 1 :], *first.rest), path.name)
    head = _sampled_events(sections, layout, lines[layout.row + 1 :], layout.row + 1, path.name, units)
    rest = [] if sections.all else _sampled_events(sections, layout, first.rest, 0, path.name, units)
    for section in {s.layout.header: s for s in sections.all}.values():
        rest += _sampled_events(Sections(), section.layout, sections.seen[section.layout.header], 0, path.name, units)
    plan = events.plan([*head, *rest], form=layout.form)
    if not plan.items:
        raise FormatError(
            "no rows",
            where=path.name,
            expected="rows of time, tag and value",
            got="none",
            hint="ask the historian for a stretch in which the tags were logged",
        )
    ordered = rest if sections.all else head
    changes = sum(a.key != b.key for a, b in pairwise(ordered))
    back = sum(a.key != b.key and b.time < a.time for a, b in pairwise(ordered))
    by_tag = 0 < changes < 0.1 * len(ordered) and 2 * back > changes
    notes = [*([first.note] if first.note else []), *converted]
    notes += ["sorted by tag: each tag is a stream"] if by_tag else []
    ends = (first.rest or first.head)[-_LAST_LINES:]
    notes += footer_notes([clean(c) for c in fields(line, layout.delimiter)] for line in ends)
    named = [clean(c) for c in fields(layout.header, layout.delimiter)]
    notes += [
        f"'{named[k]}' tells the faults of its row: rows on which it is not 0 do not count" for k in layout.faults
    ]
    if layout.unread:
        notes.append(f"not read, beside the value: {', '.join(repr(name) for name in layout.unread)}")
    return _Look(
        layout,
        replace(plan, apart=plan.apart or by_tag, beats=events.beats_of(head, plan.form)),
        first.encoding,
        by_tag,
        first.ends_with_newline,
        tuple(notes),
        units,
        sections,
    )


def _sampled_events(
    sections: Sections, first: Layout, lines: Sequence[str], line: int, name: str, units: Mapping[str, str]
) -> list[Event]:
    """What sampled lines report, of which the first is number `line` of the file."""
    return [
        event
        for k in range(0, len(lines), _LINES)
        for layout, data, number in sections.parts(("\n".join(lines[k : k + _LINES]) + "\n").encode(), line + k, first)
        for event in _events(layout, data, number, name, units)
        if isinstance(event, Event)
    ]


def describe(path: Path, source: Source) -> Recording:
    """Tags and the first time of a log, by samples of it."""
    look = _look_at(path, source)
    zoned, said = look.layout.said.source(source, look.plan.first, look.plan.form)
    notes = (*look.notes, *said)
    found = events.recording(look.plan, zoned, complete=None if look.whole else False, notes=notes)
    return replace(found, signals=tuple(replace(s, unit=look.units.get(s.name, s.unit)) for s in found.signals))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values, and lines that do not read."""
    look, counts = _look_at(path, source), dict[str, int]()

    def limited(key: str, loss: Loss) -> Iterator[Loss]:
        key = key if key in counts or len(counts) < 1000 else ""
        counts[key] = counts.get(key, 0) + 1
        if counts[key] <= (1 if key else NAMED):
            yield loss

    def complain(event: Event, reason: str) -> Iterator[Loss]:
        return limited(event.key, Loss(event.where, reason=f"'{event.key}': {reason}"))

    zoned, _ = look.layout.said.source(source, look.plan.first, look.plan.form)
    table = HeldTable(look.plan, zoned, complain, ordered=look.by_tag, keep_all=True)
    for event in _events_of_file(path, look):
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


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The lines of a row."""
    # where each tag is a stream, lines of others stand between
    told = line_of if _look_at(path, source).plan.apart else lines_of
    return told(blocks(path, source), stream, row)


def _events_of_file(path: Path, look: _Look) -> Iterator[Event | Loss]:
    held = b""  # a value in quotes whose end is in the next part
    for chunk in from_line(chunks(path, look.encoding, _PART), look.layout.row + 1):
        for number in chunk.odd:
            yield Loss(f"{path.name} line {number + 1}", reason=ODD)
        data, tail = split_last_line(held + chunk.data)
        line = chunk.line - held.count(b"\n")
        held = b""
        if not chunk.last and data.count(b'"') % 2:
            cut = data.rfind(b"\n", 0, data.rfind(b'"')) + 1
            data, held = (data[:cut], data[cut:]) if len(data) - cut < _MOST_HELD else (data, b"")
        for layout, part, number in look.sections.parts(data, line, look.layout):
            if (yield from _events(layout, part, number, path.name, look.units)):
                return
        text = tail.decode("utf-8", "replace")
        if text.strip("\0 \r"):
            yield Loss(f"{path.name} last line", reason=f"it has no line end and may be cut: '{text[:60]}'")
