"""Items of an event log (SHDR, MTConnect, OPC UA) as signals, and their reports as rows that hold.

That an item keeps its value until the next report is what these formats say; UNAVAILABLE ends it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from thermodata.plugin import Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.signals.beat import Beat, beat_of
from thermodata.reader.signals.events import HeldRows, Value
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.values.number import is_empty, is_overload, to_bool, to_float
from thermodata.reader.text.times.local_clock import LocalClock
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT
from thermodata.schema.flag import Flag
from thermodata.schema.words.numbered import numbered

STREAM = "nc"
GONE = "UNAVAILABLE"
_MOST_VALUES = 1_000_000  # of a block: rows times signals
_MOST_TOGETHER = 1_000  # signals that share their rows; with more, each item is a stream
_MOST_WORDS = 16  # numbers in one text that are signals of their own
ISO = time_pattern.DATETIME["ymd"]


class Event(NamedTuple):
    """One report: an item's value at a time, as they stand in the file. at: its line (from 1) or its sequence number;
    part: what of the file that counts in, for messages ("log.txt line"); flag: what the log itself says of the value.
    """

    time: str
    key: str
    value: str
    at: int
    part: str
    flag: int = 0

    @property
    def where(self) -> str:
        return f"{self.part} {self.at}"


def _number(word: str) -> float | None:
    """The number in a word; None where it is none: a truth value is a state here."""
    value = to_float(word)
    return None if value in (0.0, 1.0) and to_bool(word) is not None else value


@dataclass(slots=True)
class Item:
    """What is known of an item: how often it had a value, a number, and of how many numbers in one text."""

    values: int = 0
    numbers: int = 0
    parts: set[int] = field(default_factory=set)

    def add(self, value: str) -> None:
        if is_empty(value):
            return
        self.values += 1
        words = value.split(None, _MOST_WORDS + 1)
        if all(_number(word) is not None or is_overload(word) for word in words):
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
    if item.values and item.numbers >= 0.9 * item.values:
        count = max(item.parts)
        if count == 1:
            return [Target(key, "float64")]
        if item.parts == {count} and count <= _MOST_WORDS:
            return [Target(f"{key}[{k}]", "float64", k) for k in range(count)]
    return [Target(key, "float64" if measured and not item.values else "str")]


@dataclass(frozen=True, slots=True)
class Plan:
    """items: key -> its signals. first: the first time stamp that reads. apart: each item is a stream, for there
    are too many to share rows, or no order that they share. form: how the time stamps are written."""

    items: dict[str, list[Target]]
    first: str | None
    apart: bool = False
    form: TimeFormat = ISO
    beats: Mapping[str, Beat] = field(default_factory=dict)

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
        if first is None and timestamp.parse_one(event.time, form) != NAT:
            first = event.time
        items.setdefault(event.key, Item()).add(event.value)
    taken: set[str] = set()
    fed: dict[str, list[Target]] = {}
    for key, item in items.items():
        signals = targets(key, item, measured(key))
        if taken.intersection(t.name for t in signals):  # 'a' of two numbers beside an item called 'a[0]'
            signals = [Target(numbered(key, taken.__contains__), "str")]
        taken.update(t.name for t in signals)
        fed[key] = signals
    return Plan(fed, first, sum(map(len, fed.values())) > _MOST_TOGETHER, form)


def beats_of(events: Iterable[Event | Loss], form: TimeFormat = ISO) -> dict[str, Beat]:
    """The beats of items, by key, of logs that say nothing of when they write. events: those at the head of one, as
    they follow each other."""
    found: dict[str, tuple[list[str], list[str]]] = {}
    for event in events:
        if isinstance(event, Event):
            times, values = found.setdefault(event.key, ([], []))
            times.append(event.time)
            values.append(event.value)
    beats = dict[str, Beat]()
    for key, (times, values) in found.items():
        t_ns = timestamp.parse(times, form)
        numbers = np.array([np.nan if (v := to_float(text)) is None else v for text in values])
        beat = beat_of(t_ns, values, numbers) if (t_ns != NAT).all() else None
        beats |= {} if beat is None else {key: beat}
    return beats


def to_utc(times: list[str], clock: LocalClock, form: TimeFormat = ISO) -> Int1D:
    """UTC nanoseconds of time stamps; NAT where one is none. Without an offset they are in the source's zone."""
    ns = timestamp.parse(times, form)
    if clock.timezone is None or form.role == "offset":
        return ns
    local = timestamp.parse(times, time_pattern.with_zone(form, zoned=False)) != NAT
    if local.any():
        ns[local] = clock.utc(ns[local])
    return ns


def recording(
    plan: Plan,
    source: Source,
    properties: dict[str, dict[str, str]] | None = None,
    complete: bool | None = None,
    notes: Iterable[str] = (),
) -> Recording:
    """The description of a log of changes."""
    signals = tuple(
        Signal(t.name, plan.stream(key), None, t.dtype, None, (properties or {}).get(key, {}), held=True)
        for key, fed in plan.items.items()
        for t in fed
    )
    start, all_notes = 0, list(notes)
    if plan.first is not None:
        start = int(to_utc([plan.first], LocalClock(source.timezone), plan.form)[0])
        if source.timezone is None and plan.form.role != "offset" and not time_pattern.is_zoned(plan.first, plan.form):
            all_notes.append("no time zone declared: times are taken as UTC")
    return Recording(signals, "absolute", start, complete, tuple(all_notes))


class HeldTable:
    """Collects events into blocks of rows. Events that share a time stamp and stand together share a row. keep_all:
    as `HeldRows` has it."""

    def __init__(
        self,
        plan: Plan,
        source: Source,
        complain: Callable[[Event, str], Iterator[Loss]],
        ordered: bool = True,
        keep_all: bool = False,
    ) -> None:
        self.plan, self.complain = plan, complain
        self.clock = LocalClock(source.timezone)
        self._rows: dict[str, HeldRows[str]] = {}
        groups: dict[str, dict[str, str]] = {}
        beats = {t.name: plan.beats[key] for key, fed in plan.items.items() if key in plan.beats for t in fed}
        for key, fed in plan.items.items():
            groups.setdefault(plan.stream(key), {}).update({t.name: t.dtype for t in fed})
        for stream, dtypes in groups.items():
            self._rows[stream] = HeldRows(dtypes, stream, ordered, keep_all, beats)
        widest = max(map(len, groups.values()), default=1)
        self._most = max(1, _MOST_VALUES // widest)
        self._waiting = 0

    def add(self, event: Event) -> Iterator[Block | Loss]:
        """Takes an event; yields blocks when enough rows have come together."""
        fed = self.plan.items.get(event.key)
        if fed is None:
            yield from self.complain(event, "an item that the first look at the file did not meet; it is not read")
            return
        rows = self._rows[self.plan.stream(event.key)]
        if rows.last != event.time and self._waiting >= self._most:
            yield from self.flush()
        before = len(rows)
        words = event.value.split(None, _MOST_WORDS + 1)
        for target in fed:
            value, flag, good = _value(target, event.value, words)
            if not good:
                yield from self.complain(event, f"expected a number, got '{event.value[:40]}'")
            rows.add(event.time, target.name, value, event.flag | flag, event.at)
        self._waiting += len(rows) - before

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


def _value(target: Target, text: str, words: list[str]) -> tuple[Value, int, bool]:
    """(value, a flag of its own, whether it is one of the target's kind)."""
    if target.dtype == "str":
        return (None if text == GONE or not text.strip() else text), 0, True
    place = 0 if target.part is None else target.part
    if place < len(words) and (target.part is not None or len(words) == 1):
        value = _number(words[place])
        if value is not None:
            return value, 0, True
        if is_overload(words[place]):
            return None, int(Flag.SATURATED), True
    return None, 0, is_empty(text)
