"""Where a row of a Sinumerik trace stands: the record at its time; of a held row, the last one before it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermodata.plugin import Source
from thermodata_reader_cnc.place import find
from thermodata_reader_cnc.traceparse import Frame, TraceParser
from thermodata_reader_cnc.tracexml import _FEED, _Frames, blocks


class _Numbered(TraceParser):
    """Knows the number and the byte of each record with a time since they were taken."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.records = 0
        self.where: dict[int, list[tuple[int, int]]] = {}

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self.records += tag == "rec"
        before = sum(len(f.times) for f in self.frames[-1:])
        super()._start(tag, attributes)
        if tag == "rec" and len(self.frames[-1].times) > before:
            self.where.setdefault(self.frames[-1].number, []).append((self.records, self.parser.CurrentByteIndex))


def place(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`record 812, byte 123456`, as the XML counts its <rec> elements; None where there is no such row."""
    wanted = find(blocks, path, source, stream, row)
    if wanted is None:
        return None
    parser, frames = _Numbered(path.name), _Frames(path, source)
    best: tuple[int, int, int] | None = None
    with path.open("rb") as file:
        while True:
            data = file.read(_FEED)
            wrong = parser.feed(data, not data)
            found, parser.frames = parser.frames, parser.frames[-1:]
            for frame in found:
                if (
                    frame is not frames.frame
                    and frame.signals
                    and (frame.started or frame.done or frame is not found[-1])
                ):
                    list(frames.begin(frame))  # what it says is lost is of no interest here
                if frame is frames.frame:
                    best = _nearest(frame, frames, parser.where.pop(frame.number, []), stream, wanted[0], best)
            if wrong is not None or not data:
                break
    if best is None:
        return None
    time, record, byte = best
    return f"record {record}, byte {byte}" + (" (held since then)" if time < wanted[0] else "")


def _nearest(
    frame: Frame,
    frames: _Frames,
    where: list[tuple[int, int]],
    stream: str,
    t_ns: int,
    best: tuple[int, int, int] | None,
) -> tuple[int, int, int] | None:
    """(time, record, byte) of the last record of a stream at or before a time, of these records and the best so far.
    Takes the records."""
    group = next((g for g in frames.groups if g.stream == stream), None)
    times, cells, frame.times, frame.cells = frame.times, frame.cells, [], []
    for time, attributes, (record, byte) in zip(times, cells, where, strict=True):
        if group is None or group.names.keys().isdisjoint(attributes):
            continue
        seconds: Any = time if group.step_s is None else round(time / group.step_s) * group.step_s
        at = frames.start + round(seconds * 1e9)
        if at <= t_ns and (best is None or at >= best[0]):
            best = at, record, byte
    return best
