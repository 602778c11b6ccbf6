"""SHDR logs of an MTConnect adapter: a line a report, written when a value changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text.cells.time_forms.time_pattern import OFFSET_MS, OFFSET_S
from thermodata.reader.text.file.lines import ODD, chunks, sample
from thermodata.reader.text.file.locate import line_of, lines_of
from thermodata_reader_cnc import events
from thermodata_reader_cnc.events import Event, HeldTable
from thermodata_reader_cnc.mtconnect import time_series
from thermodata_reader_cnc.mtconnect.shdr_lines import Lines, is_time, looks_like_items
from thermodata_reader_cnc.mtconnect.shdr_parts import ALIKE, names_columns, numbered_form, time_form, units_behind

EXAMPLE = b"2009-06-15T00:00:00.000000|power|ON\n2009-06-15T00:00:00.010000|Xabs|1.5\n"
NO_UNITS = (
    "the lines say no units, and are not in MTConnect's own yet: nativeUnits in the agent's Devices.xml says what the "
    "adapter sends"
)
_NAMED = 20
_LOOK = 8 << 20  # an item may be reported for the first time late in a log


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text as SHDR, or None."""
    full = [line for line in lines if line.strip() and not line.startswith("*")][:200]
    if not full or full[0].count("|") < 2:
        return None
    parts = [line.split("|") for line in full]
    dated = [p for p in parts if len(p) >= 3 and is_time(p[0])]
    if dated and len(dated) >= 0.3 * len(full) and (is_time(parts[0][0]) or not parts[0][0].strip()):
        return "SHDR: lines of time|item|value"
    items = [p for p in parts if looks_like_items(p)]
    form = numbered_form([p[0] for p in items]) if len(items) >= ALIKE * len(full) else None
    if form is None or names_columns(parts[0]):
        return None
    return "SHDR: lines of offset|item|value" if form == OFFSET_MS else f"lines of {form.text}|item|value"


class _Look:
    """The items of a sampled log, its time series and how its times are written."""

    def __init__(self, path: Path, source: Source) -> None:
        first = sample(path, source.encoding, _LOOK)
        self.encoding, self.note, self.whole = first.encoding, first.note, first.ends_with_newline
        self.series: set[str] = set()
        cut = first.whole and not first.ends_with_newline
        head = first.head[:-1] if cut else first.head
        parts = [line.split("|") for line in head if "|" in line]
        self.form = time_form([p[0] for p in parts], source.table, path.name)
        self.relative = self.form in (OFFSET_MS, OFFSET_S)
        self.units = units_behind(parts)
        self.plan = events.plan(self._events(path.name, head, first.rest), form=self.form)
        self.head = first.head

    def lines(self, name: str) -> Lines:
        """What reads the lines of this log."""
        return Lines(name, self.form, self.units)

    def _events(self, name: str, head: Iterable[str], rest: Iterable[str]) -> Iterator[Event | Loss]:
        for lines, pieces in ((head, False), (rest, True)):
            reader = self.lines(name)
            reader.time = "x" if pieces else ""
            for number, line in enumerate(lines):
                if pieces and "|" not in line[:40]:
                    continue
                for event in reader.events(line, number):
                    if isinstance(event, time_series.Report):
                        self.series.add(event.key)
                    else:
                        yield event


def describe(path: Path, source: Source) -> Recording:
    """Items and the first time of a log, by samples of it."""
    look = _Look(path, source)
    if not look.plan.items and not look.series:
        raise FormatError(
            "no SHDR data",
            where=path.name,
            expected="lines of time|item|value",
            got=repr(look.head[0][:60]) if look.head else "nothing",
            hint="'thermodata sniff FILE' says which reader takes it",
        )
    of_adapter = look.form in (events.ISO, OFFSET_MS) and not look.units
    notes = [look.note, NO_UNITS if of_adapter else None, time_series.NOTE if look.series else None]
    if look.relative:
        notes.append(f"times are relative to the adapter's start, in {look.form.text}")
    sent = {key: {"protocol": "SHDR"} for key in look.plan.items if of_adapter}
    complete = None if look.whole else False
    held = events.recording(look.plan, source, sent, complete=complete, notes=filter(None, notes))
    measured = (replace(s, unit=look.units.get(s.name)) for s in held.signals)
    signals = (*measured, *(time_series.signal(key) for key in sorted(look.series)))
    return Recording(
        signals,
        "relative" if look.relative else "absolute",
        None if look.relative else held.start_ns,
        held.complete,
        held.notes,
    )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values, and lines that do not read."""
    look = _Look(path, source)
    losses = _FirstLosses()
    table = HeldTable(
        look.plan,
        source,
        lambda event, reason: losses.some(event.key, Loss(event.where, reason=f"'{event.key}': {reason}")),
    )
    reader, size = look.lines(path.name), max(1, path.stat().st_size)
    for number, line in _lines(path, look.encoding):
        if isinstance(number, str):
            yield from losses.some("", Loss(number, reason=ODD))
            continue
        if number < 0:
            time = line.split("|", 1)[0].partition("@")[0]
            if table.last_time is not None and (not time or table.last_time.startswith(time)):
                table.drop_last()  # more of this row stood in the lines that are gone
            yield from table.flush()
            yield Loss(
                f"{path.name} last line",
                fraction=min(1.0, len(line) / size),
                reason=f"it has no line end and may be cut: '{line[:60]}'",
            )
            continue
        for event in reader.events(line, number):
            if isinstance(event, Loss):
                yield from losses.some("", event)
            elif isinstance(event, Event):
                yield from table.add(event)
            elif event.key in look.series and not look.relative:
                read = time_series.rows(event, table.clock)
                yield from losses.some(event.key, read) if isinstance(read, Loss) else (read,)
            else:
                reason = "a time series that the first look did not meet, or without a date; not read"
                yield from losses.some(event.key, Loss(event.where, reason=f"'{event.key}': {reason}"))
    yield from table.flush()
    yield from reader.end()
    yield from losses.rest(path.name)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The lines of a row; of a time series, the report and the number of the sample."""
    plan = _Look(path, source).plan
    if stream.startswith(time_series.STREAM) and stream not in map(plan.stream, plan.items):
        report = time_series.sample_of(blocks(path, source), stream, row)
        return None if report is None else f"line {report[0]}, {report[1]}"
    # where each item is a stream, lines of others stand between
    return (line_of if plan.apart else lines_of)(blocks(path, source), stream, row)


def _lines(path: Path, encoding: str) -> Iterator[tuple[int | str, str]]:
    """(number, line); number -1 for a last line without a line end, and the place of a line of another encoding."""
    for chunk in chunks(path, encoding):
        yield from ((f"{path.name} line {odd + 1}", "") for odd in chunk.odd)
        text = chunk.data.decode("utf-8", "replace").replace("\r\n", "\n")
        lines = text.split("\n")
        tail = lines.pop()
        yield from enumerate(lines, chunk.line)
        if tail.strip("\0 \r"):
            yield -1, tail


class _FirstLosses:
    """The first losses of each kind by name, the rest as a number."""

    def __init__(self) -> None:
        self.count: dict[str, int] = {}

    def some(self, key: str, loss: Loss) -> Iterator[Loss]:
        if key not in self.count and len(self.count) > 50 * _NAMED:
            key = ""  # names of any number are no reason for any number of losses
        self.count[key] = self.count.get(key, 0) + 1
        most = 1 if "first look" in loss.reason else _NAMED
        if self.count[key] <= most:
            yield loss

    def rest(self, name: str) -> Iterable[Loss]:
        for key, count in self.count.items():
            if count > _NAMED:
                yield Loss(name, reason=f"{count - _NAMED} more" + (f" of '{key}'" if key else " lines"))
