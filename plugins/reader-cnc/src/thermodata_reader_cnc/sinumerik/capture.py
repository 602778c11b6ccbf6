"""Recordings of SINUMERIK Edge (Analyze MyWorkpiece /Capture4Analysis) in JSON: rows of the control's cycle (HFData),
each with the number of its cycle, and values of the control that are written on change (LFData).

The header names the columns (SignalListHFData) and says when which cycle was (Initial; else the first HFTimestamp does)
and how long one is (CycleTimeMs).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Recording, Signal, Source
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.times.local_clock import LocalClock
from thermodata.reader.times.zone import NAT, NO_ZONE
from thermodata_reader_cnc import events
from thermodata_reader_cnc.events import GONE, Event, HeldTable
from thermodata_reader_cnc.sinumerik.capture_parts import Document

EXAMPLE = (
    b'{"Header":{"Initial":{"Time":"2026-03-02T08:00:00.000Z","HFProbeCounter":100},"CycleTimeMs":2,"SignalListHFData":['
    b'{"Name":"CYCLE","Type":"INTEGER","Axis":"Cycle","Address":"CYCLE"},'
    b'{"Name":"CURRENT","Type":"DOUBLE","Axis":"X","Address":"CURRENT|1"}]},'
    b'"Payload":[{"HFData":[[100,1.5],[101,1.5],[102,1.75]]}]}\n'
)
HF = "hf"
_MARK = re.compile(r'\s*\{(?=.{0,60000}?"(?:SignalListHFData|HFProbeCounter)")', re.DOTALL)
_CYCLE = "CYCLE"
_LOOK = 64 << 20  # bytes in which values on change are met
_BLOCK = 1_000_000  # values
_MOST_NAMED = 20
_LONGEST_MS = 1e6  # of a cycle
_MOST_SIGNALS = 2000
_LATEST_NS = 1e18  # behind the first cycle
_NOT_READ = frozenset({"HFTimestamp", "HFBlockEvent", "HFCallEvent"})  # of the payload, with no loss


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of text, or None."""
    if not lines or not lines[0].lstrip().startswith("{"):
        return None
    return "SINUMERIK Edge: JSON with SignalListHFData" if _MARK.match("\n".join(lines)) else None


@dataclass(frozen=True, slots=True)
class _Columns:
    """names: of a row's cells, None of the counter; counter: which cell counts the cycles; said: name -> what the
    header says of it; start_ns: when cycle `first` was; step_ns: how long one is; zoned: whether the start says where
    it stands from UTC."""

    names: tuple[str | None, ...]
    counter: int
    said: Mapping[str, Mapping[str, str]]
    first: int
    start_ns: int
    step_ns: float
    zoned: bool


def _columns(header: Mapping[str, Any], stamp: Any, source: Source, where: str) -> _Columns:
    """stamp: the first HFTimestamp."""
    names, counter, said = _names_of_cells(header, where)
    initial = header.get("Initial") if isinstance(header.get("Initial"), dict) else stamp
    start, first = (initial.get("Time"), initial.get("HFProbeCounter")) if isinstance(initial, dict) else (None, None)
    cycle = _number(header.get("CycleTimeMs"))
    text = "" if start is None else str(start)[:64]
    ns = int(events.to_utc([text], LocalClock(source.timezone))[0]) if text else NAT
    number = _number(first)
    if ns == NAT or number is None or cycle is None or not 0 < cycle < _LONGEST_MS:
        raise FormatError(
            "nothing says when a cycle was",
            where=where,
            expected="CycleTimeMs, and Time and HFProbeCounter of Initial, in the header",
            got=f"Initial: {str(initial)[:80]}, CycleTimeMs: {str(header.get('CycleTimeMs'))[:20]}",
            hint="export the recording anew, or as CSV with a time",
        )
    zoned = time_pattern.is_zoned(text, events.ISO)
    return _Columns(tuple(names), counter, said, int(number), ns, cycle * 1e6, zoned)


def _names_of_cells(header: Mapping[str, Any], where: str) -> tuple[list[str | None], int, dict[str, dict[str, str]]]:
    """(the names of a row's cells, which of them counts the cycles, what the header says of each). A name that comes
    again is told apart by its axis, else by its address. Where none is the counter, that stands before the others."""
    told = header.get("SignalListHFData")
    listed = [s for s in told if isinstance(s, dict)] if isinstance(told, list) else []
    if len(listed) > _MOST_SIGNALS:
        raise FormatError(
            "too many signals",
            where=where,
            expected=f"{_MOST_SIGNALS} at most",
            got=f"{len(listed)}",
            hint="record fewer at once",
        )
    calls = [str(s.get("Name") or s.get("Address") or f"column {k + 1}")[:200] for k, s in enumerate(listed)]
    every = list[str]()
    for each, call in zip(listed, calls, strict=True):
        axis = str(each.get("Axis") or "")[:200]
        every.append(call if calls.count(call) == 1 else f"{call}/{axis}" if axis else _address(each, call))
    twice = {n for n in every if every.count(n) > 1}
    every = [_address(each, n) if n in twice else n for each, n in zip(listed, every, strict=True)]
    counter = calls.index(_CYCLE) if _CYCLE in calls else 0
    names = [None if k == counter else n for k, n in enumerate(every)] if _CYCLE in calls else [None, *every]
    if len(set(every)) < len(every):
        raise FormatError(
            "signals of one name and address",
            where=where,
            expected="each once",
            got=", ".join(every[:9]),
            hint="record each once",
        )
    said = {
        n: {key: str(each[key])[:200] for key in ("Axis", "Address", "Type") if each.get(key)}
        for each, n in zip(listed, every, strict=True)
    }
    return names, counter, said


def _address(signal: Mapping[str, Any], name: str) -> str:
    return str(signal.get("Address") or name)[:200]


def _number(value: Any) -> float | None:
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return number if np.isfinite(number) and abs(number) < 2**53 else None


def _events(message: Mapping[str, Any], name: str) -> Iterator[Event]:
    """The values on change of a message."""
    for each in message.get("LFData") or () if isinstance(message.get("LFData"), list) else ():
        if isinstance(each, dict) and each.get("address") and each.get("timestamp"):
            value = each.get("value")
            text = GONE if value is None or isinstance(value, (dict, list)) else str(value).strip() or GONE
            yield Event(str(each["timestamp"])[:64], str(each["address"])[:300], text, 0, name)


@dataclass(frozen=True, slots=True)
class _Look:
    columns: _Columns
    plan: events.Plan


def _look_at(path: Path, source: Source) -> _Look:
    with closing(Document(path)) as document:
        stamps: list[Any] = []
        plan = events.plan(_sampled_events(document, path.name, stamps))
        columns = _columns(document.header, stamps[0] if stamps else None, source, path.name)
    return _Look(columns, plan)


def _sampled_events(document: Document, name: str, stamps: list[Any]) -> Iterator[Event]:
    """Values on change of the first part of a file; stamps gets the first HFTimestamp."""
    for message in document.messages():
        if isinstance(message, dict):
            if "HFTimestamp" in message and not stamps:
                stamps.append(message["HFTimestamp"])
            yield from _events(message, name)
        if document.read > _LOOK:
            return


def describe(path: Path, source: Source) -> Recording:
    """Columns of the rows, values on change that the first part of the file holds, and the time of the first cycle."""
    look = _look_at(path, source)
    slow = events.recording(look.plan, source)
    names = [n for n in look.columns.names if n is not None]
    fast = tuple(Signal(n, HF, None, "float64", None, dict(look.columns.said.get(n, {}))) for n in names)
    step_s = look.columns.step_ns / 1e9
    notes = [*slow.notes, f"times of {HF} count cycles of {step_s:g} s from the header's Initial"]
    if source.timezone is None and not look.columns.zoned:
        notes.append(f"{NO_ZONE}: times are taken as UTC")
    signals = (*fast, *slow.signals)
    return replace(slow, signals=signals, start_ns=look.columns.start_ns, notes=tuple(dict.fromkeys(notes)))


class _Rows:
    """Rows of the control's cycle as blocks."""

    def __init__(self, columns: _Columns, name: str) -> None:
        self._columns, self._name = columns, name
        self._held: list[list[Any]] = []
        self._most = max(1, _BLOCK // max(1, len(columns.names)))
        self.odd = 0

    def add(self, rows: Any) -> Iterator[Block]:
        for row in rows if isinstance(rows, list) else ():
            if isinstance(row, list) and len(row) == len(self._columns.names):
                self._held.append(row)
            else:
                self.odd += 1
        if len(self._held) >= self._most:
            yield from self.flush()

    def flush(self) -> Iterator[Block]:
        held, self._held = self._held, []
        counts = [_number(row[self._columns.counter]) for row in held]
        first, step = self._columns.first, self._columns.step_ns
        good = [k for k, n in enumerate(counts) if n is not None and abs(n - first) * step < _LATEST_NS]
        self.odd += len(held) - len(good)
        if not good:
            return
        cycles: Array = np.array([counts[k] for k in good], np.float64) - first
        t_ns = self._columns.start_ns + np.rint(cycles * step).astype(np.int64)
        values = {n: _floats([held[k][i] for k in good]) for i, n in enumerate(self._columns.names) if n is not None}
        yield Block(HF, t_ns, values)


def _floats(cells: list[Any]) -> Array:
    try:
        return np.array(cells, np.float64)
    except (TypeError, ValueError, OverflowError):
        return np.array([np.nan if (x := _number(c)) is None else x for c in cells], np.float64)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Rows of the cycle, rows of values that hold, and what does not read."""
    look, counts = _look_at(path, source), dict[str, int]()

    def complain(event: Event, reason: str) -> Iterator[Loss]:
        counts[event.key] = counts.get(event.key, 0) + 1
        if counts[event.key] == 1 and len(counts) <= _MOST_NAMED:
            yield Loss(f"{path.name} LFData", reason=f"'{event.key}': {reason}")

    fast, slow = _Rows(look.columns, path.name), HeldTable(look.plan, source, complain, ordered=False)
    unread = dict[str, None]()
    with closing(Document(path)) as document:
        for message in document.messages():
            if isinstance(message, Loss):
                yield message
                continue
            if "HFData" in message:
                yield from fast.add(message["HFData"])
            for event in _events(message, path.name):
                yield from slow.add(event)
            unread.update(dict.fromkeys(message.keys() - _NOT_READ - {"HFData", "LFData"}))
            unread = dict.fromkeys(list(unread)[:_MOST_NAMED])
    yield from fast.flush()
    yield from slow.flush()
    if fast.odd:
        reason = f"{fast.odd} rows of HFData without a cell for each signal, or without a cycle"
        yield Loss(path.name, reason=reason)
    if unread:
        yield Loss(path.name, reason=f"messages that are not read: {', '.join(k[:40] for k in unread)}")


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The cycle of a row; None of values on change."""
    if stream != HF:
        return None
    seen = 0
    columns = _look_at(path, source).columns
    for block in blocks(path, source):
        if isinstance(block, Block) and block.stream == HF:
            if row < seen + block.t_ns.size:
                cycle = columns.first + round((int(block.t_ns[row - seen]) - columns.start_ns) / columns.step_ns)
                return f"cycle {cycle}"
            seen += block.t_ns.size
    return None
