"""Reader of what LabVIEW and a cRIO write: TDMS (with DAQmx), LVM, and plain rows of numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata_reader_crio.formats import FORMATS, claims, format_of


class Reader:
    """TDMS, LVM and plain text, told apart by their first bytes. A `.tdms_index` beside a file is never read: it may
    be stale. heads: format -> the first bytes of such a file, which other readers leave alone."""

    name = "crio"
    formats = (
        "TDMS, with DAQmx and all NI scalings",
        "LVM",
        "plain LabVIEW text",
    )
    heads: Mapping[str, bytes] = {name: form.EXAMPLE for name, form in FORMATS.items()}

    def sniff(self, head: Head) -> str | None:
        return claims(head)

    def describe(self, path: Path, source: Source) -> Recording:
        return format_of(path).describe(path, source)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return format_of(path).blocks(path, source)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: segment and bytes of a TDMS file, the line of a text."""
        return format_of(path).locate(path, source, stream, row) or f"row {row + 1}"

    place = locate
