"""Logs of changes (SHDR, MTConnect streams) as one stream: a row a time stamp, each item held until it changes.

That an item keeps its value until the next report is what these formats say; UNAVAILABLE ends it (NaN).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.plugin import Array, Block, Int1D, Loss, Recording, Signal, Source
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import when
from thermodata_reader_cnc.localclock import LocalClock

STREAM = "nc"
_GONE = "UNAVAILABLE"
_NUMBER = re.compile(r"^\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*$")
_MOST_VALUES = 1_000_000        # of a block: rows times signals


@dataclass(frozen=True, slots=True)
class Event:
    """One report: an item's value at a time, as they stand in the file. at: where it stands, for messages."""

    time: str
    key: str
    value: str
    at: str


@dataclass(slots=True)
class Item:
    """What is known of an item: how often it was seen, as a number, and as how many numbers in one text."""

    seen: int = 0
    numbers: int = 0
    parts: set[int] = field(default_factory=set)
    properties: dict[str, str] = field(default_factory=dict)

    def add(self, value: str) -> None:
        if value == _GONE or not value.strip():
            return
        self.seen += 1
        words = value.split()
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
        if item.parts == {count} and count <= 16:
            return [Target(f"{key}[{k}]", "float64", k) for k in range(count)]
    return [Target(key, "float64" if measured and not item.seen else "str")]


Plan = dict[str, list[Target]]


def plan(events: Iterable[Event | Loss],
         measured: Callable[[str], bool] = lambda key: False) -> tuple[Plan, str | None]:
    """The signals of sampled events, and the first time. measured: which items are numbers though none was seen."""
    items: dict[str, Item] = {}
    first = None
    for event in events:
        if isinstance(event, Loss):
            continue
        if first is None and when.parse_one(event.time, when.DATETIME["ymd"]) != NAT:
            first = event.time
        items.setdefault(event.key, Item()).add(event.value)
    return {key: targets(key, item, measured(key)) for key, item in items.items()}, first


def to_utc(times: list[str], clock: LocalClock) -> Int1D:
    """UTC nanoseconds of time stamps; NAT where one is none. Without an offset they are in the source's zone."""
    ns = when.parse(times, when.DATETIME["ymd"])
    if clock.timezone is None:
        return ns
    local = np.array([not _has_zone(t) for t in times], bool) & (ns != NAT)
    if local.any():
        ns[local] = clock.utc(ns[local])
    return ns


def _has_zone(text: str) -> bool:
    return text.endswith("Z") or (re.search(r"[+-]\d{2}:?\d{2}$", text) is not None and "T" in text)


def recording(found: Plan, first: str | None, source: Source, properties: dict[str, dict[str, str]] | None = None,
              complete: bool | None = None, notes: Iterable[str] = ()) -> Recording:
    """The description of a log of changes."""
    signals = tuple(Signal(t.name, STREAM, None, t.dtype, None, (properties or {}).get(key, {}))
                    for key, each in found.items() for t in each)
    start = int(to_utc([first], LocalClock(source.timezone))[0]) if first is not None else 0
    return Recording(signals, "absolute", start, complete, tuple(notes))


class HeldTable:
    """Collects events into blocks of rows. Events that share a time stamp and stand together share a row."""

    def __init__(self, found: Plan, source: Source, complain: Callable[[Event, str], Iterator[Loss]],
                 stream: str = STREAM) -> None:
        self.plan, self.complain, self.stream = found, complain, stream
        self.clock = LocalClock(source.timezone)
        self._columns = {t.name: t for each in found.values() for t in each}
        self._state: dict[str, Any] = {n: None if t.dtype == "str" else np.nan for n, t in self._columns.items()}
        self._most = max(500, _MOST_VALUES // max(1, len(self._columns)))
        self._times: list[str] = []
        self._changes: dict[str, tuple[list[int], list[Any]]] = {n: ([], []) for n in self._columns}

    def add(self, event: Event) -> Iterator[Block | Loss]:
        """Takes an event; yields a block when enough rows have come together."""
        found = self.plan.get(event.key)
        if found is None:
            yield from self.complain(event, "an item that the first look at the file did not meet; it is not read")
            return
        if not self._times or self._times[-1] != event.time:
            if len(self._times) >= self._most:
                yield from self.flush()
            self._times.append(event.time)
        words = event.value.split()
        for target in found:
            value, good = _value(target, event.value, words)
            if not good:
                yield from self.complain(event, f"expected a number, got '{event.value[:40]}'")
            rows, values = self._changes[target.name]
            rows.append(len(self._times) - 1)
            values.append(value)

    @property
    def last_time(self) -> str | None:
        """The time stamp of the row that still grows."""
        return self._times[-1] if self._times else None

    def drop_last(self) -> None:
        """Forgets the row that still grows."""
        if not self._times:
            return
        self._times.pop()
        for rows, values in self._changes.values():
            while rows and rows[-1] == len(self._times):
                rows.pop()
                values.pop()

    def flush(self) -> Iterator[Block | Loss]:
        """The rows so far as a block."""
        if not self._times:
            return
        t_ns, n = to_utc(self._times, self.clock), len(self._times)
        good = t_ns != NAT
        values: dict[str, Array] = {}
        for name, target in self._columns.items():
            rows, changed = self._changes[name]
            kind = object if target.dtype == "str" else np.float64
            known = np.empty(len(changed) + 1, kind)
            known[0], known[1:] = self._state[name], changed
            which = np.zeros(n, np.int64)
            which[rows] = np.arange(1, len(changed) + 1)
            values[name] = known[np.maximum.accumulate(which)][good]
            self._state[name] = known[-1]
            self._changes[name] = ([], [])
        if not good.all():
            row = int(np.flatnonzero(~good)[0])
            yield Loss("time stamps", reason=f"{int((~good).sum())} do not read, first '{self._times[row][:40]}'")
        self._times = []
        if good.any():
            yield Block(self.stream, t_ns[good], values)


def _value(target: Target, text: str, words: list[str]) -> tuple[Any, bool]:
    """(value, whether it is one of the target's kind)."""
    gone = text == _GONE or not text.strip()
    if target.dtype == "str":
        return (None if gone else text), True
    if gone:
        return np.nan, True
    place = 0 if target.part is None else target.part
    if place < len(words) and _NUMBER.match(words[place]) and (target.part is not None or len(words) == 1):
        return float(words[place]), True
    return np.nan, False
