"""SHDR logs of an MTConnect adapter: `time|item|value|item|value...` a line, written when a value changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import events, when
from thermodata_reader_cnc.chunks import chunks, sample
from thermodata_reader_cnc.events import Event, HeldTable

_LEVELS = frozenset({"NORMAL", "WARNING", "FAULT", "UNAVAILABLE"})
_NAMED = 20
_LOOK = 8 << 20          # an item may be reported for the first time late in a log


def claims(lines: list[str]) -> str | None:
    """The reason for claiming lines of text as SHDR, or None."""
    full = [line for line in lines if line.strip() and not line.startswith("*")][:200]
    good = [line for line in full if line.count("|") >= 2
            and when.parse_one(line.split("|", 1)[0].partition("@")[0], when.DATETIME["ymd"]) != NAT]
    if full and full[0] in good and len(good) >= 0.3 * len(full):
        return "SHDR: lines of time|item|value"
    return None


class _Lines:
    """Lines to events. Commands (@...@), comments (*) and multi-line assets are no data."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.until: str | None = None

    def events(self, line: str, number: int) -> Iterator[Event | Loss]:
        if self.until is not None:
            if line.strip() == self.until:
                self.until = None
            return
        text = line.rstrip("\r")
        if not text.strip() or text.startswith("*"):
            return
        fields = text.split("|")
        at = f"{self.name} line {number + 1}"
        if len(fields) < 2 or fields[0][:1] not in "0123456789":
            yield Loss(at, reason=f"expected time|item|value, got '{text[:80]}'")
            return
        time = fields[0].partition("@")[0]
        if fields[1].startswith("@"):
            if fields[-1].startswith("--multiline--"):
                self.until = fields[-1]
            return
        if len(fields) in (6, 7) and fields[2].upper() in _LEVELS and not (fields[3] and fields[5]):
            yield Event(time, fields[1], fields[2].upper(), at)
            return
        if len(fields) % 2 == 0:
            if len(fields) == 4:                            # a message: item, native code, text
                yield Event(time, fields[1], fields[3], at)
                return
            yield Loss(at, reason=f"expected pairs of item and value, got '{text[:80]}'")
        for key, value in zip(fields[1::2], fields[2::2], strict=False):
            if key:
                yield Event(time, key, value, at)


def _sampled(path: Path, source: Source) -> Iterator[Event | Loss]:
    first = sample(path, source.encoding, _LOOK)
    reader = _Lines(path.name)
    for number, line in enumerate([*first.head, *first.rest]):
        if number == len(first.head):
            reader.until = None
        if number >= len(first.head) and "|" not in line[:40]:
            continue
        yield from reader.events(line, number)


def describe(path: Path, source: Source) -> Recording:
    """Items and the first time of a log, by samples of it."""
    first = sample(path, source.encoding)
    found, start = events.plan(_sampled(path, source))
    if not found:
        raise FormatError("no SHDR data", where=path.name, expected="lines of time|item|value",
                          got=repr(first.head[0][:60]) if first.head else "nothing")
    notes = [] if first.note is None else [first.note]
    return events.recording(found, start, source, complete=None if first.ends_with_newline else False, notes=notes)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of held values, and lines that do not read."""
    found, _ = events.plan(_sampled(path, source))
    losses = _Some()
    table = HeldTable(found, source, lambda event, reason: losses.some(event.key, Loss(event.at, reason=(
        f"'{event.key}': {reason}"))))
    reader = _Lines(path.name)
    for number, line in _lines(path, sample(path, source.encoding).encoding):
        if number < 0:
            time = line.split("|", 1)[0]
            if (table.last_time or "").startswith(time):
                table.drop_last()                           # more of this row stood in the lines that are gone
            yield from table.flush()
            yield Loss(f"{path.name} last line", fraction=min(1.0, len(line) / max(1, path.stat().st_size)),
                       reason=f"it has no line end and may be cut: '{line[:60]}'")
            continue
        for event in reader.events(line, number):
            if isinstance(event, Loss):
                yield from losses.some("", event)
            else:
                yield from table.add(event)
    yield from table.flush()
    yield from losses.rest(path.name)


def _lines(path: Path, encoding: str) -> Iterator[tuple[int, str]]:
    """(number, line); number -1 for a last line without a line end."""
    for chunk in chunks(path, encoding):
        text = chunk.data.decode("utf-8", "replace").replace("\r\n", "\n")
        lines = text.split("\n")
        tail = lines.pop()
        yield from enumerate(lines, chunk.line)
        if chunk.last and tail.strip("\0 \r"):
            yield -1, tail


class _Some:
    """The first losses of each kind by name, the rest as a number."""

    def __init__(self) -> None:
        self.count: dict[str, int] = {}

    def some(self, key: str, loss: Loss) -> Iterator[Loss]:
        self.count[key] = self.count.get(key, 0) + 1
        most = 1 if "first look" in loss.reason else _NAMED
        if self.count[key] <= most:
            yield loss

    def rest(self, name: str) -> Iterable[Loss]:
        for key, count in self.count.items():
            if count > _NAMED:
                yield Loss(name, reason=f"{count - _NAMED} more" + (f" of '{key}'" if key else " lines"))
