"""Reader of what LabVIEW and a cRIO write: TDMS (with DAQmx), LVM, and plain rows of numbers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.text import decode_head

LVM_START = "LabVIEW Measurement"


class Reader:
    """TDMS, LVM and plain text, told apart by their first bytes. A `.tdms_index` beside a file is never read: it may
    be stale."""

    name = "crio"
    formats = (
        "TDMS, with DAQmx and all NI scalings",
        "LVM",
        "plain LabVIEW text",
    )

    def sniff(self, head: Head) -> str | None:
        if head.start[:4] == b"TDSm":
            return "TDMS: the file starts with the lead-in 'TDSm'"
        if _is_lvm(head.start):
            return f"LVM: the file starts with '{LVM_START}'"
        from thermodata_reader_crio.ascii_layout import claim

        return claim(head)

    def describe(self, path: Path, source: Source) -> Recording:
        recording: Recording = _format(path).describe(path, source)
        return recording

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        found: Iterator[Block | Loss] = _format(path).blocks(path, source)
        return found

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: segment and bytes of a TDMS file, the line of a text."""
        module = _format(path)
        where: str | None
        if hasattr(module, "locate"):
            where = module.locate(path, source, stream, row)
        else:
            from thermodata_reader_crio import textparts

            where = textparts.place(module.blocks, path, source, stream, row)
        return where or f"row {row + 1}"

    place = locate


def _is_lvm(start: bytes) -> bool:
    if not start[:200].lstrip(b"\xef\xbb\xbf\xff\xfe").startswith((b"LabVIEW", b"L\0a\0b\0V\0I\0E\0W")):
        return False
    text = decode_head(start[:200])
    return text is not None and text.lstrip("\ufeff").startswith(LVM_START)


def _format(path: Path) -> ModuleType:
    """One of three modules with the same two functions; what is no text is taken for a damaged TDMS file."""
    with path.open("rb") as file:
        start = file.read(4096)
    if _is_lvm(start):
        from thermodata_reader_crio import lvm

        return lvm
    if start[:4] != b"TDSm" and decode_head(start) is not None and start.strip():
        from thermodata_reader_crio import labview_ascii

        return labview_ascii
    from thermodata_reader_crio import tdms

    return tdms
