"""Items of an event log (SHDR, MTConnect, OPC UA) as signals, and their reports as rows that hold.

That an item keeps its value until the next report is what these formats say; UNAVAILABLE ends it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.events import HeldRows, Value
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import when
from thermodata_reader_cnc.localclock import LocalClock
from thermodata_reader_cnc.when import TimeFormat

STREAM = "nc"
GONE = "UNAVAILABLE"
_NUMBER = re.compile(r"^\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*$")
_MOST_VALUES = 1_000_000  # of a block: rows times signals
_MOST_TOGETHER = 1_000  # signals that share their rows; with more, each item is a stream
_MOST_WORDS = 16  # numbers in one text that are signals of their own
_ZONE = re.compile(r":\d{2}(?:[.,]\d+)?\s?[+-]\d{2}:?\d{2}\s*$")
ISO = when.DATETIME["ymd"]


@dataclass(frozen=True, slots=True)
class Event:
    """One report: an item's value at a time, as they stand in the file. at: where it stands, for messages.
    flag: what the log itself says of the value."""

    time: str
    key: str
    value: str
    at: str
    flag: int = 0


@dataclass(slots=True)
class Item:
    """What is known of an item: how often it was seen, as a number, and as how many numbers in one text."""

    seen: int = 0
    numbers: int = 0
    parts: set[int] = field(default_factory=set)

    def add(self, value: str) -> None:
        if value == GONE or not value.strip():
            return
        self.seen += 1
        words = value.split(None, _MOST_WORDS + 1)
        if all(_NUMBER.match(w) for w in words):
            self.parts.add(len(words))
            self.numbers += 1


@dataclass(frozen=True, slots=True)
class Target:
    """A signal that an item feeds. part: which number of its text, None for all of it."""

    name: str
    dtype: str
    part: int | None = None


def targets(key: str, item: Item, measured: bool = False) -> list[Target]:
    """A number is one signal, several numbers in one text (a position) one each, all else is text."""
    if item.seen and item.numbers >= 0.9 * item.seen:
        count = max(item.parts)
        if count == 1:
            return [Target(key, "float64")]
        if item.parts == {count} and count <= _MOST_WORDS:
            return [Target(f"{key}[{k}]", "float64", k) for k in range(count)]
    return [Target(key, "float64" if measured and not item.seen else "str")]


@dataclass(frozen=True, slots=True)
class Plan:
    """items: key -> its signals. first: the first time stamp that reads. apart: each item is a stream, for there
    are too many to share rows, or no order that they share. form: how the time stamps are written."""

    items: dict[str, list[Target]]
    first: str | None
    apart: bool = False
    form: TimeFormat = ISO

    def stream(self, key: str) -> str:
        return key if self.apart else STREAM


def plan(
    events: Iterable[Event | Loss], measured: Callable[[str], bool] = lambda key: False, form: TimeFormat = ISO
) -> Plan:
    """The signals of sampled events. measured: which items are numbers though none was seen."""
    items: dict[str, Item] = {}
    first = None
    for event in events:
        if isinstance(event, Loss):
            continue
        if first is None and when.parse_one(event.time, form) != NAT:
            first = event.time
        items.setdefault(event.key, Item()).add(event.value)
    taken: set[str] = set()
    found: dict[str, list[Target]] = {}
    for key, item in items.items():
        each = targets(key, item, measured(key))
        if taken.intersection(t.name for t in each):  # 'a' of two numbers beside an item called 'a[0]'
            each = [Target(_free(key, taken), "str")]
        taken.update(t.name for t in each)
        found[key] = each
    return Plan(found, first, sum(map(len, found.values())) > _MOST_TOGETHER, form)


def _free(key: str, taken: set[str]) -> str:
    name, number = key, 1
    while name in taken:
        number += 1
        name = f"{key}#{number}"
    return name


def to_utc(times: list[str], clock: LocalClock, form: TimeFormat = ISO) -> Int1D:
    """UTC nanoseconds of time stamps; NAT where one is none. Without an offset they are in the source's zone."""
    ns = when.parse(times, form)
    if clock.timezone is None or form.role == "offset":
        return ns
    local = np.array([not _has_zone(t) for t in times], bool) & (ns != NAT)
    if local.any():
        ns[local] = clock.utc(ns[local])
    return ns


def _has_zone(text: str) -> bool:
    return text.rstrip().endswith(("Z", "UTC")) or _ZONE.search(text) is not None


def recording(
    found: Plan,
    source: Source,
    properties: dict[str, dict[str, str]] | None = None,
    complete: bool | None = None,
    notes: Iterable[str] = (),
) -> Recording:
    """The description of a log of changes."""
    signals = tuple(
        Signal(t.name, found.stream(key), None, t.dtype, None, (properties or {}).get(key, {}))
        for key, each in found.items.items()
        for t in each
    )
    start, said = 0, list(notes)
    if found.first is not None:
        start = int(to_utc([found.first], LocalClock(source.timezone), found.form)[0])
        if source.timezone is None and found.form.role != "offset" and not _has_zone(found.first):
            said.append("no time zone declared: times are taken as UTC")
    return Recording(signals, "absolute", start, complete, tuple(said))


class HeldTable:
    """Collects events into blocks of rows. Events that share a time stamp and stand together share a row."""

    def __init__(
        self, found: Plan, source: Source, complain: Callable[[Event, str], Iterator[Loss]], ordered: bool = True
    ) -> None:
        self.plan, self.complain = found, complain
        self.clock = LocalClock(source.timezone)
        self._rows: dict[str, HeldRows[str]] = {}
        groups: dict[str, dict[str, str]] = {}
        for key, each in found.items.items():
            groups.setdefault(found.stream(key), {}).update({t.name: t.dtype for t in each})
        for stream, dtypes in groups.items():
            self._rows[stream] = HeldRows(dtypes, stream, ordered)
        widest = max(map(len, groups.values()), default=1)
        self._most = max(1, _MOST_VALUES // widest)
        self._waiting = 0

    def add(self, event: Event) -> Iterator[Block | Loss]:
        """Takes an event; yields blocks when enough rows have come together."""
        found = self.plan.items.get(event.key)
        if found is None:
            yield from self.complain(event, "an item that the first look at the file did not meet; it is not read")
            return
        rows = self._rows[self.plan.stream(event.key)]
        if rows.last != event.time:
            if self._waiting >= self._most:
                yield from self.flush()
            self._waiting += 1
        words = event.value.split(None, _MOST_WORDS + 1)
        for target in found:
            value, good = _value(target, event.value, words)
            if not good:
                yield from self.complain(event, f"expected a number, got '{event.value[:40]}'")
            rows.add(event.time, target.name, value, event.flag)

    @property
    def last_time(self) -> str | None:
        """The time stamp of the row that still grows, where all share their rows."""
        return None if self.plan.apart or not self._rows else self._rows[STREAM].last

    def drop_last(self) -> None:
        """Forgets the row that still grows."""
        if not self.plan.apart:
            self._rows[STREAM].drop_last()

    def flush(self) -> Iterator[Block | Loss]:
        """The rows so far as blocks."""
        self._waiting = 0
        for rows in self._rows.values():
            if not len(rows):
                continue
            block, bad = rows.take(lambda stamps: to_utc(stamps, self.clock, self.plan.form))
            if bad:
                yield Loss("time stamps", reason=f"{len(bad)} do not read, first '{bad[0][:40]}'")
            if block is not None:
                yield block


def _value(target: Target, text: str, words: list[str]) -> tuple[Value, bool]:
    """(value, whether it is one of the target's kind)."""
    gone = text == GONE or not text.strip()
    if gone or target.dtype == "str":
        return (None if gone else text), True
    place = 0 if target.part is None else target.part
    if place < len(words) and _NUMBER.match(words[place]) and (target.part is not None or len(words) == 1):
        return float(words[place]), True
    return None, False
