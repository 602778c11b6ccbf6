"""The lead-in of a TDMS segment: 28 bytes that say what follows, and where the next one starts."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from thermodata_reader_crio.tdms.segments.chunk_layout import DamageError

LEAD_IN = 28
META, NEW_LIST, RAW, INTERLEAVED, BIG_ENDIAN = 1 << 1, 1 << 2, 1 << 3, 1 << 5, 1 << 6
VERSIONS = (4712, 4713)
UNKNOWN_END = 0xFFFFFFFFFFFFFFFF
# metadata of 100,000 channels with 20 properties each stay below; more is a damaged length
MOST_METADATA = 256 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class LeadIn:
    """start: position in the file; data: where its raw data start; end: where the next segment starts, None where
    the writer died before it could say."""

    start: int
    toc: int
    version: int
    data: int
    end: int | None

    @property
    def order(self) -> str:
        """The order of the bytes as struct writes it: '<' or '>'."""
        return ">" if self.toc & BIG_ENDIAN else "<"

    @property
    def meta_bytes(self) -> int:
        """Bytes between the lead-in and the raw data."""
        return self.data - self.start - LEAD_IN


def open_file(path: Path) -> BinaryIO:
    """The file with a buffer for many small segments, or for the head of a large one."""
    return path.open("rb", buffering=64 * 1024)


def read_lead_in(file: BinaryIO, start: int, size: int) -> LeadIn:
    """The lead-in at a position; DamageError where there is none, or one that cannot be."""
    file.seek(start)
    raw = file.read(LEAD_IN)
    if len(raw) < LEAD_IN:
        raise DamageError(f"the file ends inside a lead-in, after {len(raw)} of {LEAD_IN} bytes")
    if raw[:4] != b"TDSm":
        raise DamageError(f"no lead-in: expected 'TDSm', got {raw[:4]!r}")
    toc = struct.unpack_from("<I", raw, 4)[0]
    version, to_next, to_raw = struct.unpack_from(">IQQ" if toc & BIG_ENDIAN else "<IQQ", raw, 8)
    data = start + LEAD_IN + to_raw
    end = None if to_next == UNKNOWN_END else start + LEAD_IN + to_next
    if end is not None and end < data:
        raise DamageError("a segment that ends before its data starts")
    if data > size:
        raise DamageError(f"the file ends inside metadata, {data - size} bytes short")
    return LeadIn(start, toc, version, data, end)


def read_metadata(file: BinaryIO, lead: LeadIn) -> bytes:
    """The bytes between lead-in and raw data: many only where the segment has metadata at all."""
    if lead.meta_bytes > MOST_METADATA:
        raise DamageError(f"metadata of {lead.meta_bytes} bytes")
    file.seek(lead.start + LEAD_IN)
    return file.read(lead.meta_bytes)
