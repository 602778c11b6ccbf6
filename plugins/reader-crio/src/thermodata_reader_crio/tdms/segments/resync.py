"""After damage: the next lead-in of a TDMS file that parses, leads on, and means the same without what was lost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO, NamedTuple

from thermodata_reader_crio.tdms.segments.chunk_layout import DamageError
from thermodata_reader_crio.tdms.segments.index import Index
from thermodata_reader_crio.tdms.segments.lead_in import META, NEW_LIST, VERSIONS, LeadIn, read_lead_in, read_metadata
from thermodata_reader_crio.tdms.segments.metadata import SAME, Object, parse

_TAG = b"TDSm"
_WINDOW = 1 << 20
_KNOWN_FLAGS = 0xEE
_MOST_TRIES = 10_000
_MOST_PARSED = 512 * 1024 * 1024  # bytes of metadata: a hostile file may nest lead-ins in each other


class GoodSegment(NamedTuple):
    """The last good segment: its lead-in, and the pieces that it added."""

    lead: LeadIn
    end: int
    first_piece: int
    layout: int
    chunks: int
    tail: int


@dataclass(frozen=True, slots=True)
class ResumePoint:
    """Where reading goes on. alone: the segment names all that it needs; passed: good segments before it that could
    not be used, for they reuse a list of objects that was lost; missing: (layout, chunks) between, if known."""

    lead: LeadIn
    objects: list[Object] | None
    alone: bool
    passed: int
    missing: tuple[int, int | None]


def find(file: BinaryIO, index: Index, last: GoodSegment | None, searched: int, start: int) -> ResumePoint | None:
    """The next usable segment from byte `searched` on, where a segment was expected at `start`. last: the good one
    before it."""
    for passed, (lead, objects) in enumerate(_possible_lead_ins(file, searched, index.size)):
        alone = bool(lead.toc & META and lead.toc & NEW_LIST) and all(
            o.held is None or o.held != SAME for o in objects or ()
        )
        missing = _missing_chunks(file, index, last, start, lead)
        follows = lead.start <= start and _ends_with_whole_chunks(index, last, lead.start)
        if alone or follows or (missing[1] is not None and _twin(index, last, lead)):
            return ResumePoint(lead, objects, alone, passed, missing)
    return None


def _possible_lead_ins(file: BinaryIO, at: int, size: int) -> Iterator[tuple[LeadIn, list[Object] | None]]:
    """Lead-ins whose metadata parse, and which lead to another one or to the end of the file."""
    tries = parsed = 0
    while tries < _MOST_TRIES and parsed < _MOST_PARSED:
        at = _next_tag(file, at, size)
        if at < 0:
            return
        tries += 1
        found = None
        try:
            lead = read_lead_in(file, at, size)
            if _leads_on(file, lead, size):
                parsed += lead.meta_bytes
                objects = parse(read_metadata(file, lead), lead.order)[0] if lead.toc & META else None
                found = lead, objects
        except DamageError:
            pass  # a tag by chance, or of another damaged segment: search on
        if found is None:
            at += len(_TAG)
        else:
            tries = 0
            yield found
            at = size if lead.end is None else lead.end


def _next_tag(file: BinaryIO, at: int, size: int) -> int:
    while at < size:
        file.seek(at)
        window = file.read(_WINDOW)
        place = window.find(_TAG)
        if place >= 0:
            return at + place
        at += max(1, len(window) - len(_TAG) + 1)
    return -1


def _leads_on(file: BinaryIO, lead: LeadIn, size: int) -> bool:
    if lead.toc & ~_KNOWN_FLAGS or lead.version not in VERSIONS or (lead.meta_bytes and not lead.toc & META):
        return False
    if lead.end is None or lead.end >= size:
        return bool(lead.toc & META)
    file.seek(lead.end)
    return file.read(len(_TAG)) == _TAG


def _ends_with_whole_chunks(index: Index, last: GoodSegment | None, end: int) -> bool:
    """Whether the last good segment ends there with whole chunks, so that nothing is lost between."""
    if last is None or last.layout < 0 or end <= last.lead.data:
        return False
    chunk = index.layouts[last.layout].chunk_bytes
    return bool(chunk) and (end - last.lead.data) % chunk == 0


def _missing_chunks(
    file: BinaryIO, index: Index, last: GoodSegment | None, start: int, lead: LeadIn
) -> tuple[int, int | None]:
    """(layout, chunks) of the segments between `start` and a lead-in: known where they are as long as one or more
    of the segments before them, or where a lead-in is left that says how long its data are."""
    if last is None or last.layout < 0 or not last.chunks or lead.start <= start:
        return -1, None
    gone = lead.start - start
    length = last.end - last.lead.start
    if gone % length == 0:
        return last.layout, gone // length * last.chunks
    try:
        damaged = read_lead_in(file, start, index.size)
    except DamageError:
        return -1, None
    chunk = index.layouts[last.layout].chunk_bytes
    data_bytes = 0 if damaged.end != lead.start else damaged.end - damaged.data
    return (last.layout, data_bytes // chunk) if data_bytes and data_bytes % chunk == 0 else (-1, None)


def _twin(index: Index, last: GoodSegment | None, lead: LeadIn) -> bool:
    """Whether a segment looks like the last good one, so that it may be read with the same list of objects."""
    if last is None or last.layout < 0 or lead.toc != last.lead.toc or lead.meta_bytes != last.lead.meta_bytes:
        return False
    end = index.size if lead.end is None else lead.end
    return (end - lead.data) % index.layouts[last.layout].chunk_bytes == 0
