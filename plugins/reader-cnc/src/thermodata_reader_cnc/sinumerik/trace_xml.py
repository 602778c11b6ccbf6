"""Sinumerik Trace as XML, streamed: servo signals are written when they change, interpolator signals always.

Servo signals (event 255) are held on their interval's grid, which is what "written on change" says, and counted against
`datapointCount`; all others keep their own rows. `unitsType` is a class and no unit. Where the control reports
drop-outs the rows of the frame are flagged, for it does not say where they are.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Signal, Source
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.file.locate import row_at
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT, local_to_utc_ns
from thermodata.schema.flag import Flag
from thermodata_reader_cnc.sinumerik import trace_records
from thermodata_reader_cnc.sinumerik.trace_grid import LOOK, Group, columns_of, counted, groups_of, rows
from thermodata_reader_cnc.sinumerik.trace_records import Frame, TraceParser, record_number

EXAMPLE = b'<?xml version="1.0" encoding="UTF-8"?>\n<traceSession version="1.0">\n<frameHeader startTime="0"/>\n'
_ROOT = re.compile(r"<(traceSession|traceDataRoot|traceData)[\s>]")
_CLOSED = re.compile(rb"</(traceSession|traceDataRoot|traceData)\s*>\s*(<!--[^>]*-->\s*)?$")
_PROPERTIES = 300  # characters of a property
_SUSPECT = np.uint16(Flag.CLOCK_SUSPECT)
_CLOCK = "times are by the control's own clock (startTime), which may be far off"


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming lines of XML, or None."""
    root = _ROOT.search("\n".join(lines)[:8192])
    return None if root is None else f"Sinumerik Trace: an element <{root[1]}>"


def _frames_by_kind(path: Path) -> list[Frame]:
    """The first frame with signals and its first records; where several are announced, one of each set of signals."""
    parser = TraceParser(path.name)
    by_kind: dict[tuple[tuple[str, ...], ...], Frame] = {}
    several = False
    with path.open("rb") as file:
        while data := file.read(trace_records.FEED if several else 64 * 1024):
            wrong = parser.feed(data, False)
            several = several or (parser.announced or 0) > 1
            for frame in parser.frames:
                kind = _kind(frame)
                known = frame.started or frame.done  # else more signals may follow
                if known and frame.signals and (kind not in by_kind or by_kind[kind] is frame):
                    by_kind[kind] = frame
                    if len(frame.times) < LOOK and not frame.done and not wrong:
                        continue
                if (several and frame is not by_kind.get(kind)) or len(frame.times) >= 4 * LOOK:
                    frame.times, frame.cells, frame.at = frame.times[:LOOK], frame.cells[:LOOK], []
            if several:
                parser.frames = parser.frames[-1:]
            first = next(iter(by_kind.values()), None)
            if first is not None and not several and (len(first.times) >= LOOK or first.done):
                return [first]
            if wrong:
                if first is None:
                    raise FormatError(
                        "no XML",
                        where=path.name,
                        expected="a Sinumerik trace",
                        got=wrong,
                        hint="save the trace again; 'thermodata sniff FILE' says what this file is",
                    )
                break
    if not by_kind:
        raise FormatError(
            "no signals",
            where=path.name,
            expected="<dataSignal> elements",
            got="none",
            hint="save the trace again, with its signals chosen",
        )
    return list(by_kind.values())


def _kind(frame: Frame) -> tuple[tuple[str, ...], ...]:
    """What tells frames of one layout from others."""
    return tuple(
        (key, *(said.get(k, "") for k in ("name", "event", "interval", "description")))
        for key, said in frame.signals.items()
    )


def _layouts(frames: list[Frame]) -> dict[tuple[tuple[str, ...], ...], list[Group]]:
    layouts: dict[tuple[tuple[str, ...], ...], list[Group]] = {}
    taken: list[str] = []
    for frame in frames:
        layouts[_kind(frame)] = groups_of(frame, taken)
        taken += [group.stream for group in layouts[_kind(frame)]]
    return layouts


@dataclass(frozen=True, slots=True)
class _Start:
    """UTC of a frame's startTime; notes: on a local time, of a zone that nobody says."""

    ns: int
    notes: tuple[str, ...] = ()


def _start(header: dict[str, str], source: Source) -> _Start | None:
    """None where it is no date."""
    text = header.get("startTime", "")
    for form in time_pattern.DATETIME.values():
        ns = timestamp.parse_one(text, form)
        if ns != NAT:
            if time_pattern.is_zoned(text, form):
                return _Start(ns)
            utc, notes = local_to_utc_ns(np.array([ns], np.int64).view("datetime64[ns]"), source.timezone)
            return _Start(int(utc[0]), tuple(notes) if source.timezone is None else ())
    return None


def describe(path: Path, source: Source) -> Recording:
    """Signals and start of a trace, by its head."""
    frames = _frames_by_kind(path)
    start = _start(frames[0].header, source)
    signals, notes = [], []
    for frame, groups in zip(frames, _layouts(frames).values(), strict=True):
        for group in groups:
            for key, name in group.names.items():
                said = {k: v[:_PROPERTIES] for k, v in frame.signals[key].items() if k != "name" and v}
                signals.append(Signal(name, group.stream, None, "float64", None, said))
            if group.servo and group.step_s is None:
                interval = frame.signals[next(iter(group.names))].get("interval", "")[:40]
                notes.append(
                    f"stream '{group.stream}': the records lie on no grid of interval '{interval}'; their own "
                    "times are kept"
                )
    told = frames[0].header.get("startTime", "")[:80]
    notes += [f"startTime '{told}' is no date: times are relative"] if start is None else [_CLOCK, *start.notes]
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 4096))
        complete = _CLOSED.search(file.read()) is not None
    if start is None:
        return Recording(tuple(signals), "relative", None, complete, tuple(notes))
    return Recording(tuple(signals), "absolute", start.ns, complete, tuple(notes))


class _Frames:
    """The rows of frame after frame."""

    def __init__(self, path: Path, source: Source) -> None:
        self.name, self.source = path.name, source
        frames = _frames_by_kind(path)
        self.layouts = _layouts(frames)
        self.relative = _start(frames[0].header, source) is None
        self.frame: Frame | None = None
        self.groups: list[Group] = []
        self.start, self.drops = 0, False

    def begin(self, frame: Frame) -> Iterator[Loss]:
        """The end of the frame before, and what is wrong with this one's header."""
        yield from self.end()
        where = f"{self.name} frame {frame.number}"
        self.frame, self.drops = frame, False
        known = self.layouts.get(_kind(frame))
        self.groups = [Group(g.stream, g.servo, g.names, g.step_s) for g in known or ()]
        start = None if self.relative else _start(frame.header, self.source)
        if known is None:
            yield Loss(where, reason="a frame with other signals than those that the first look met; it is not read")
        elif start is None and not self.relative:
            self.groups = []
            yield Loss(where, reason=f"startTime '{frame.header.get('startTime', '')[:80]}' is no date; it is not read")
        self.start = 0 if start is None else start.ns
        count = frame.header.get("dropOuts", "0").strip()
        if count not in ("", "0", "false", "False"):
            self.drops = True
            yield Loss(
                f"{where} frameHeader",
                reason=f"the control reports drop-outs: {count[:40]}; the frame's rows are flagged",
            )

    def end(self) -> Iterator[Loss]:
        """What the frame lacks."""
        if self.frame is None:
            return
        where = f"{self.name} frame {self.frame.number}"
        yield from counted(where, self.frame, self.groups)
        if self.frame.bad:
            yield Loss(where, reason=f"{self.frame.bad} records without a time")
        if self.frame.odd:
            yield Loss(where, reason=f"{self.frame.odd} values are no numbers, first {self.frame.first_odd}")

    def records(self, frame: Frame) -> Iterator[Block]:
        """The rows of the records since they were taken."""
        if not frame.times:
            return
        times, at, columns = np.array(frame.times), np.array(frame.at, np.int64), columns_of(frame)
        frame.times, frame.cells, frame.at = [], [], []
        for group in self.groups:
            for block in rows(group, times, at, columns, self.start):
                yield _suspect(block) if self.drops else block


def _suspect(block: Block) -> Block:
    flags = {
        name: (block.flags or {}).get(name, np.uint16(0)) | np.full(block.t_ns.size, _SUSPECT) for name in block.values
    }
    return replace(block, flags=flags)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The records of every frame, and what is missing of them."""
    parser, size = TraceParser(path.name), max(1, path.stat().st_size)
    frames = _Frames(path, source)
    with path.open("rb") as file:
        while True:
            data = file.read(trace_records.FEED)
            wrong = parser.feed(data, not data)
            found, parser.frames = parser.frames, parser.frames[-1:]
            for frame in found:
                # a frame's signals are known when its first record came, or its end
                known = frame.started or frame.done or frame is not found[-1]
                if frame is not frames.frame and frame.signals and known:
                    yield from frames.begin(frame)
                if frame is frames.frame:
                    yield from frames.records(frame)
            if wrong is not None or not data:
                break
    yield from frames.end()
    if wrong is not None:
        yield Loss(
            f"{path.name} byte {parser.at_byte}",
            fraction=max(0.0, 1 - parser.at_byte / size),
            reason=f"the XML ends or is damaged: {wrong}",
        )
    elif parser.announced is not None and parser.announced != parser.count:
        yield Loss(path.name, reason=f"{parser.announced} frames are announced, {parser.count} are there")


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`record 812, byte 123456`, as the XML counts its <rec> elements; of a row that is held, the record that it is
    held since."""
    here = row_at(blocks(path, source), stream, row)
    if here is None:
        return None
    before = row_at(blocks(path, source), stream, row - 1) if row else None
    held = before is not None and before[0] == here[0]
    return f"record {record_number(path, here[0])}, byte {here[0]}" + (" (held since then)" if held else "")
