"""The formats of this reader: a new one is a module with the functions of `Format`, and its line in `FORMATS`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Protocol

from thermodata.plugin import HEAD_BYTES, Block, Head, Loss, Recording, Source
from thermodata.reader.text.file.encoding import decode_head
from thermodata_reader_crio import labview_text, lvm, tdms


class Format(Protocol):
    """What a format's module holds. EXAMPLE: the first bytes of a file of it, for other readers to leave alone."""

    @property
    def EXAMPLE(self) -> bytes: ...

    def claims(self, head: Head) -> str | None:
        """The reason for claiming a file, or None."""

    def describe(self, path: Path, source: Source) -> Recording:
        """What the file holds."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        """Its data."""

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str | None:
        """Where a row (counted from 0) of a stream stands; None where there is no such row."""


# asked in this order
FORMATS: Mapping[str, Format] = {"TDMS": tdms, "LVM": lvm, "LabVIEW text": labview_text}


def claims(head: Head) -> str | None:
    """The reason of the first format that claims a file."""
    return next((reason for form in FORMATS.values() if (reason := form.claims(head))), None)


def format_of(path: Path) -> Format:
    """The format that claims a file; where none does (a campaign names the reader), rows of numbers if it is text, and
    a damaged TDMS file if it is not."""
    with path.open("rb") as file:
        head = Head(path.name, path.stat().st_size, file.read(HEAD_BYTES))
    for form in (tdms, lvm):
        if form.claims(head):
            return form
    return labview_text if head.start.strip() and decode_head(head.start[:4096]) is not None else tdms
