"""The walk over the segments of a TDMS file.

Layout of the format: National Instruments, "TDMS File Format Internal Structure". Each segment is a lead-in of
28 bytes, metadata (which objects, how many values a chunk, which properties) and raw data in chunks.
"""

from __future__ import annotations

from pathlib import Path

from thermodata.errors import FormatError
from thermodata_reader_crio.tdms.segments.chunk_layout import DamageError
from thermodata_reader_crio.tdms.segments.index import Hole, Index, Shape
from thermodata_reader_crio.tdms.segments.lead_in import (
    INTERLEAVED,
    META,
    RAW,
    VERSIONS,
    LeadIn,
    open_file,
    read_lead_in,
)
from thermodata_reader_crio.tdms.segments.object_lists import ObjectLists
from thermodata_reader_crio.tdms.segments.resync import GoodSegment, ResumePoint, find

_MOST_HOLES = 1000


class SegmentReader:
    """Reads segment after segment into an index."""

    def __init__(self, path: Path) -> None:
        self.file = open_file(path)
        self.index = Index(path.stat().st_size)
        self.lists = ObjectLists(self.index)
        self.last: GoodSegment | None = None
        self._shapes: dict[Shape, int] = {}

    def step(self, start: int) -> None:
        """Reads the segment at a position. DamageError: it can't be read, and nothing of it was taken."""
        self._take_segment(read_lead_in(self.file, start, self.index.size), None)

    def _take_segment(self, lead: LeadIn, found: ResumePoint | None) -> None:
        index = self.index
        end = index.size if lead.end is None else min(lead.end, index.size)
        cut = lead.end is None or lead.end > index.size
        plan = self.lists.plan(self.file, lead) if found is None else self.lists.plan_of(lead, found.objects)
        layout = self.lists.layout(plan, lead.toc) if end > lead.data or cut else -1
        chunk = index.layouts[layout].chunk_bytes if layout >= 0 else 0
        if end > lead.data and chunk == 0 and not cut:
            raise DamageError(f"{end - lead.data} bytes of raw data that no channel claims")
        self.lists.commit(plan)
        if self.last is not None and not lead.toc & META and (lead.toc ^ self.last.lead.toc) & INTERLEAVED:
            index.note(f"byte {lead.start}: data that go on interleaved where they were not, or the reverse")
        if lead.version not in VERSIONS:
            index.note(f"byte {lead.start}: TDMS version {lead.version}, known are 4712 and 4713")
        first = len(index.pieces)
        chunks, tail = divmod(end - lead.data, chunk) if chunk else (0, 0)
        self._pieces(lead, layout, chunks, tail, cut)
        if cut:
            index.expected_end = lead.end
            index.damage = f"byte {index.size}: the file ends inside raw data"
        index.good_end = end
        index.starts.append(lead.start)
        self.last = GoodSegment(lead, end, first, layout, chunks, tail)

    def _pieces(self, lead: LeadIn, layout: int, chunks: int, tail: int, cut: bool) -> None:
        if layout < 0:
            return
        index, chunk = self.index, self.index.layouts[layout].chunk_bytes
        if not lead.toc & RAW and (chunks or tail):
            index.note(
                f"byte {lead.start}: the lead-in says that no raw data follow; {chunks * chunk + tail} bytes of "
                "them do, and are taken"
            )
        at = lead.data + chunks * chunk
        if chunks:
            index.pieces.add(lead.data, chunks, self._shape(Shape(layout)))
        if tail or (cut and not chunks and chunk):
            index.pieces.add(at, 1, self._shape(Shape(layout, tail, cut)))
        if tail and not cut:
            index.note(
                f"byte {at}: a chunk of {tail} bytes instead of {chunk}: taken as all of its channels written "
                "shorter by the same share"
            )

    def _shape(self, shape: Shape) -> int:
        number = self._shapes.setdefault(shape, len(self.index.shapes))
        if number == len(self.index.shapes):
            self.index.shapes.append(shape)
        return number

    # ---- damage --------------------------------------------------------------------------------

    def go_on(self, reason: str, *, inside: bool) -> bool:
        """Goes on behind bytes that are no segment; False where nothing further can be read. inside: the length of
        the segment before is in doubt, so the next lead-in may lie inside of it."""
        index, last = self.index, self.last
        start = index.good_end
        inside = inside and last is not None
        search = last.lead.data if inside and last is not None else start
        failed = 0
        while len(index.holes) < _MOST_HOLES:
            found = find(self.file, index, self.last, search, start)
            if found is None:
                return False
            kept = index.pieces.copy(last.first_piece) if last is not None else []
            begin, why, missing = start, reason, found.missing
            if last is not None and inside and (found.lead.start < start or last.tail):
                begin = self._shorten(last, min(found.lead.start, start))
                why = "a segment's length is wrong"
                missing = (-1, None) if found.lead.start > start else (-1, 0)
            piece = len(index.pieces)
            if found.alone:
                self.lists.forget()
            try:
                self._take_segment(found.lead, found)
            except DamageError:
                if last is not None:
                    index.pieces.restore(last.first_piece, kept)
                search, failed = found.lead.start + 4, failed + 1 + found.passed
                self.lists.forget()  # what follows may be read only where it names all that it needs
                self.last = None
                continue
            if index.damage == reason:
                index.damage = index.expected_end = None
            if failed + found.passed:
                why += f"; {failed + found.passed} segments after it reuse a list of objects that was lost"
            if begin < found.lead.start:
                index.holes.append(Hole(begin, found.lead.start, piece, why, *missing))
            return True
        return False

    def _shorten(self, last: GoodSegment, end: int) -> int:
        """Cuts the last segment where the next one turned out to start; returns where its whole chunks end."""
        index = self.index
        index.pieces.drop_from(last.first_piece)
        chunk = index.layouts[last.layout].chunk_bytes if last.layout >= 0 else 0
        chunks = (end - last.lead.data) // chunk if chunk else 0
        if chunks:
            index.pieces.add(last.lead.data, chunks, self._shape(Shape(last.layout)))
        index.note(f"byte {last.lead.start}: the segment's length is wrong; it ends at byte {end} at the latest")
        return last.lead.data + chunks * chunk


def read_index(path: Path) -> Index:
    """The index of a file. FormatError where not even one segment can be read; damage further on is stepped over
    where that is safe, or ends the walk, with the good part kept."""
    state = SegmentReader(path)
    index = state.index
    with state.file:
        goes_on = True
        while goes_on and index.good_end < index.size:
            reason, inside = None, False
            try:
                state.step(index.good_end)
            except DamageError as error:
                reason, inside = str(error), "no lead-in" in str(error)
            if index.damage is not None:
                reason, inside = index.damage, True
            if reason is not None:
                goes_on = state.go_on(reason, inside=inside)
                if not goes_on and index.damage is None:
                    index.damage = f"byte {index.good_end}: {reason}"
                goes_on = goes_on and index.damage is None
    if not index.segments:
        raise FormatError(
            "not a readable TDMS file",
            where=f"{path.name} {index.damage or 'byte 0'}",
            expected="a lead-in, its metadata and raw data",
            got=f"a file of {index.size} bytes",
            hint="copy it anew from where it was recorded, byte by byte",
        )
    return index
