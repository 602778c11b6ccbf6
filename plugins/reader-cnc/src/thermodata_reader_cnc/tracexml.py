"""Sinumerik Trace as XML, streamed: servo signals are written when they change, interpolator signals always.

Servo signals (event 255) are held on their interval's grid, which is what "written on change" says, and counted against
`datapointCount`; interpolator signals keep their own rows. `unitsType` is a class and no unit; `dropOuts` is a loss.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Recording, Signal, Source
from thermodata.reader.zone import NAT
from thermodata_reader_cnc import when
from thermodata_reader_cnc.localclock import LocalClock

_FEED = 1 << 20
_LOOK = 2000
_NO_VALUE = 9.218868437227405e18        # the bits of a NaN, written as an integer
_ROOT = re.compile(r"<(traceSession|traceDataRoot|traceData)[\s>]")


def claims(text: str) -> str | None:
    """The reason for claiming a text, or None."""
    found = _ROOT.search(text[:8192])
    return None if found is None else f"Sinumerik Trace: an element <{found[1]}>"


@dataclass(slots=True)
class Frame:
    """A frame's header, its signals by id, and the records since they were taken: (time [s], id, value)."""

    header: dict[str, str] = field(default_factory=dict)
    signals: dict[str, dict[str, str]] = field(default_factory=dict)
    times: list[float] = field(default_factory=list)
    cells: list[dict[str, str]] = field(default_factory=list)
    done: bool = False


class _Parser:
    def __init__(self, name: str) -> None:
        self.name, self.frames, self.bad = name, list[Frame](), 0
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.EntityDeclHandler = self._entity

    def feed(self, data: bytes, final: bool) -> str | None:
        """What is wrong with the XML, or None."""
        try:
            self.parser.Parse(data, final)
        except expat.ExpatError as error:
            return str(error)
        return None

    def _entity(self, *_: Any) -> None:
        raise FormatError("the XML declares entities", where=self.name, expected="a trace without them")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag == "rec":
            if not self.frames:
                self.frames.append(Frame())
            try:
                self.frames[-1].times.append(float(attributes.pop("time")))
                self.frames[-1].cells.append(attributes)
            except (KeyError, ValueError):
                self.bad += 1
        elif tag == "frameHeader":
            self.frames.append(Frame(dict(attributes)))
        elif tag == "dataSignal":
            if not self.frames or self.frames[-1].times:
                self.frames.append(Frame())
            key = attributes.get("id", str(len(self.frames[-1].signals) + 1))
            self.frames[-1].signals[key if key.startswith("f") else f"f{key}"] = dict(attributes)

    def _end(self, tag: str) -> None:
        if tag == "dataFrame" and self.frames:
            self.frames[-1].done = True


@dataclass(slots=True)
class Group:
    """Signals of one kind and interval. ids -> names; interval_s: the grid's step, None where none fits."""

    stream: str
    servo: bool
    names: dict[str, str]
    interval_s: float | None
    state: dict[str, float]
    next: int = 0


def _groups(frame: Frame) -> list[Group]:
    groups: dict[tuple[bool, str], Group] = {}
    taken: dict[str, int] = {}
    intervals = {s.get("interval", "") for s in frame.signals.values()}
    for key, said in frame.signals.items():
        servo, interval = said.get("event") == "255", said.get("interval", "")
        name = said.get("name") or said.get("description") or key
        taken[name] = taken.get(name, 0) + 1
        name += f"#{taken[name]}" if taken[name] > 1 else ""
        stream = ("servo" if servo else "ipo") + (f"@{interval}" if len(intervals) > 1 else "")
        group = groups.setdefault((servo, interval), Group(stream, servo, {}, _step(interval, frame.times), {}))
        group.names[key] = name
        group.state[key] = np.nan
    return list(groups.values())


def _step(interval: str, times: list[float]) -> float | None:
    """The interval in seconds: the unit (s, ms, us) by which the sampled times lie on a grid of it."""
    try:
        value = float(interval)
    except ValueError:
        return None
    gaps = np.diff(np.array(times[:_LOOK]))
    gaps = gaps[gaps > 0]
    for unit in (1.0, 1e-3, 1e-6):
        steps = gaps / (value * unit) if value > 0 else np.empty(0)
        if steps.size and np.abs(steps - np.round(steps)).max() < 0.05 and steps.min() > 0.5:
            return value * unit
    return None


def _look(path: Path) -> Frame:
    """The first frame with signals, and its first records."""
    parser = _Parser(path.name)
    with path.open("rb") as file:
        while data := file.read(64 * 1024):
            wrong = parser.feed(data, False)
            frame = next((f for f in parser.frames if f.signals), None)
            if frame is not None and (len(frame.times) >= _LOOK or wrong or frame.done):
                return frame
            if wrong:
                raise FormatError("no XML", where=path.name, expected="a Sinumerik trace", got=wrong)
    frame = next((f for f in parser.frames if f.signals), None)
    if frame is None:
        raise FormatError("no signals", where=path.name, expected="<dataSignal> elements", got="none")
    return frame


def _start_ns(header: dict[str, str], source: Source) -> int | None:
    """UTC of a frame's startTime; None where it is no date."""
    text = header.get("startTime", "")
    ns = next((n for form in when.DATETIME.values() if (n := when.parse_one(text, form)) != NAT), None)
    if ns is None:
        return None
    zoned = text.endswith("Z") or re.search(r"T.*[+-]\d\d:?\d\d$", text) is not None
    return ns if zoned else int(LocalClock(source.timezone).utc(np.array([ns]))[0])


def describe(path: Path, source: Source) -> Recording:
    """Signals and start of a trace, by its head."""
    frame = _look(path)
    start = _start_ns(frame.header, source)
    signals = []
    for group in _groups(frame):
        for key, name in group.names.items():
            said = {k: v for k, v in frame.signals[key].items() if k != "name" and v}
            signals.append(Signal(name, group.stream, None, "float64", None, said))
    told = frame.header.get("startTime", "")
    notes = [] if start is not None else [f"startTime '{told}' is no date: times are relative"]
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 256))
        end = file.read().rstrip()
    complete = re.search(rb"</(traceSession|traceDataRoot|traceData)>$", end) is not None
    return Recording(tuple(signals), "relative" if start is None else "absolute", start or 0, complete, tuple(notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The records of every frame, and what is missing of them."""
    first = _look(path)
    known = {name for group in _groups(first) for name in group.names.values()}
    parser, size = _Parser(path.name), max(1, path.stat().st_size)
    groups: list[Group] = []
    current: Frame | None = None
    with path.open("rb") as file:
        while True:
            data = file.read(_FEED)
            wrong = parser.feed(data, not data)
            frames, parser.frames = parser.frames, parser.frames[-1:]
            for frame in frames:
                if frame.signals and frame is not current:
                    if current is not None:
                        yield from _counted(path.name, current, groups)
                    current, groups = frame, _groups(first if first.signals == frame.signals else frame)
                    yield from _dropouts(path.name, frame)
                    if {n for g in groups for n in g.names.values()} != known:
                        yield Loss(f"{path.name} frame", reason="a frame with other signals than the first is not read")
                        groups = []
                if frame.times:
                    for group in groups:
                        block = _rows(group, frame, _start_ns((current or frame).header, source) or 0)
                        if block is not None:
                            yield block
                    frame.times, frame.cells = [], []
            if wrong is not None:
                yield Loss(f"{path.name} byte {parser.parser.ErrorByteIndex}",
                           fraction=max(0.0, 1 - parser.parser.ErrorByteIndex / size) if data else None,
                           reason=f"the XML ends or is damaged: {wrong}")
                return
            if not data:
                break
    if current is not None:
        yield from _counted(path.name, current, groups)
    if parser.bad:
        yield Loss(path.name, reason=f"{parser.bad} records without a time")


def _dropouts(name: str, frame: Frame) -> Iterator[Loss]:
    count = frame.header.get("dropOuts", "0").strip()
    if count not in ("", "0", "false", "False"):
        yield Loss(f"{name} frameHeader", reason=f"the control reports drop-outs: {count}")


def _counted(name: str, frame: Frame, groups: list[Group]) -> Iterator[Loss]:
    for group in groups:
        for key, signal in group.names.items():
            said = frame.signals[key].get("datapointCount", "")
            if group.servo and group.interval_s is not None and said.isdigit() and abs(int(said) - group.next) > 1:
                yield Loss(f"{name} signal '{signal}'", fraction=max(0.0, 1 - group.next / max(1, int(said))),
                           reason=f"datapointCount is {said}, the grid holds {group.next}")


def _rows(group: Group, frame: Frame, start_ns: int) -> Block | None:
    """The records of a frame as rows of one group."""
    if group.servo:
        return _held(group, frame, start_ns)
    rows = [k for k, cells in enumerate(frame.cells) if not group.names.keys().isdisjoint(cells)]
    if not rows:
        return None
    t_ns = start_ns + np.round(np.array([frame.times[k] for k in rows]) * 1e9).astype(np.int64)
    values = {name: np.array([_value(frame.cells[k].get(key)) for k in rows]) for key, name in group.names.items()}
    return Block(group.stream, t_ns, values)


def _held(group: Group, frame: Frame, start_ns: int) -> Block | None:
    """Servo signals: on the grid of their interval, or at the records' times where none fits; held between."""
    times = np.array(frame.times)
    if group.interval_s is None:
        places, first, count = np.arange(times.size), 0, times.size
        t_ns = start_ns + np.round(times * 1e9).astype(np.int64)
    else:
        grid = np.round(times / group.interval_s).astype(np.int64)
        if group.next == 0:
            group.state["origin"] = float(grid[0])
        places = np.maximum.accumulate(grid - int(group.state["origin"])) - group.next
        first, count = group.next, max(0, int(places[-1]) + 1)
        steps = int(group.state["origin"]) + first + np.arange(count)
        t_ns = start_ns + np.round(steps * group.interval_s * 1e9).astype(np.int64)
    values: dict[str, Array] = {}
    for key, name in group.names.items():
        changed = [(int(p), _value(cells[key])) for p, cells in zip(places, frame.cells, strict=True) if key in cells]
        known = np.array([group.state[key], *(v for _, v in changed)])
        which = np.zeros(max(count, 1), np.int64)
        for number, (place, _) in enumerate(changed, 1):
            if place >= 0:
                which[place] = number
        values[name] = known[np.maximum.accumulate(which)][:count]
        group.state[key] = float(known[-1])
    group.next = first + count
    return Block(group.stream, t_ns, values) if count else None


def _value(text: str | None) -> float:
    try:
        value = float(text) if text is not None else np.nan
    except ValueError:
        return np.nan
    return np.nan if value >= _NO_VALUE else value
