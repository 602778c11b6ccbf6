"""Reader of what LabVIEW and a cRIO write: TDMS (with DAQmx), LVM, and plain rows of numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.plugin import Block, Head, Loss, Recording, Source

if TYPE_CHECKING:
    from thermodata_reader_crio.formats import Format


class Reader:
    """TDMS, LVM and plain text, told apart by their first bytes. A `.tdms_index` beside a file is never read: it may
    be stale."""

    name = "crio"
    formats = (
        "TDMS, with DAQmx and all NI scalings",
        "LVM",
        "plain LabVIEW text",
    )

    @property
    def heads(self) -> Mapping[str, bytes]:
        """Format -> the first bytes of a file of it, which other readers leave alone."""
        from thermodata_reader_crio.formats import FORMATS

        return {name: form.EXAMPLE for name, form in FORMATS.items()}

    def sniff(self, head: Head) -> str | None:
        from thermodata_reader_crio.formats import claims

        return claims(head)

    def describe(self, path: Path, source: Source) -> Recording:
        return _format(path).describe(path, source)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return _format(path).blocks(path, source)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: segment and bytes of a TDMS file, the line of a text."""
        return _format(path).locate(path, source, stream, row) or f"row {row + 1}"

    place = locate


def _format(path: Path) -> Format:
    from thermodata_reader_crio.formats import format_of

    return format_of(path)
