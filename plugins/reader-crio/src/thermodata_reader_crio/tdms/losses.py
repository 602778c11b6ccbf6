"""What damage took from a TDMS file, as far as the file still says: bytes, per cent, time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from thermodata.plugin import Loss
from thermodata_reader_crio.tdms.file import File
from thermodata_reader_crio.tdms.segments.index import Hole
from thermodata_reader_crio.tdms.streams import Stream


def losses(file: File, path: Path, last_ns: int | None) -> Iterator[Loss]:
    """Holes in the middle, channels of which a part was left out, and what the end of the file took with it.
    last_ns: the last time that was delivered."""
    index = file.index
    for hole in index.holes:
        from_ns, to_ns = _times_around(file, hole)
        gone = hole.end - hole.start
        length = "" if hole.chunks is None else "; as long as the segments before it, so times go on behind it"
        if hole.chunks is None:
            length = "; how many values is not known: times behind it are in doubt, unless the file dates them anew"
        yield Loss(
            f"{path.name} byte {hole.start}",
            from_ns,
            to_ns,
            gone / index.size,
            f"{hole.reason}; {gone} bytes are skipped{length}",
        )
    for sentence in file.partly:
        yield Loss(path.name, reason=sentence)
    if index.damage is not None:
        yield _end(file, path, last_ns)


def _times_around(file: File, hole: Hole) -> tuple[int | None, int | None]:
    """The last time before a hole, and the first behind it where that is known."""
    before: list[int] = []
    behind: list[int] = []
    for stream in file.streams:
        row = _row(stream, hole)
        if stream.clock is None or not 0 < row < stream.rows:
            continue
        before.append(int(stream.clock.times(row - 1, row)[0]))
        if stream.clock.suspects(row, row + 1) is None:
            behind.append(int(stream.clock.times(row, row + 1)[0]))
    from_ns, to_ns = max(before, default=None), min(behind, default=None)
    if from_ns is not None and to_ns is not None and to_ns < from_ns:
        to_ns = None
    return from_ns, to_ns


def _row(stream: Stream, hole: Hole) -> int:
    return stream.channels[0].columns[0].row_at(hole.piece)


def _end(file: File, path: Path, last_ns: int | None) -> Loss:
    index = file.index
    missing = (index.expected_end or index.size) - index.good_end
    planned = [
        int(s.clock.times(s.planned - 1, s.planned)[0])
        for s in file.streams
        if s.clock is not None and s.planned > s.rows
    ]
    to_ns = max(planned, default=None)
    if to_ns is not None and last_ns is not None and to_ns < last_ns:
        to_ns = None
    fraction = missing / (index.good_end + missing) if missing else None
    return Loss(f"{path.name} byte {index.good_end}", last_ns, to_ns, fraction, (index.damage or "").split(": ", 1)[-1])
