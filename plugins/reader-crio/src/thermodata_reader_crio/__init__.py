"""Reader of what LabVIEW and a cRIO write: TDMS (with DAQmx), and the text files LVM."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.text import decode_head

LVM_START = "LabVIEW Measurement"


class Reader:
    """TDMS and LVM, told apart by their first bytes. A `.tdms_index` beside a file is never read: it may be stale."""

    name = "crio"

    def sniff(self, head: Head) -> str | None:
        if head.start[:4] == b"TDSm":
            return "TDMS: the file starts with the lead-in 'TDSm'"
        if head.start[:200].lstrip(b"\xef\xbb\xbf\xff\xfe").startswith((b"LabVIEW", b"L\0a\0b\0V\0I\0E\0W")):
            text = decode_head(head.start[:200])
            if text is not None and text.lstrip("\ufeff").startswith(LVM_START):
                return f"LVM: the file starts with '{LVM_START}'"
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        recording: Recording = _format(path).describe(path, source)
        return recording

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        found: Iterator[Block | Loss] = _format(path).blocks(path, source)
        return found


def _format(path: Path) -> ModuleType:
    """One of two modules with the same two functions."""
    with path.open("rb") as file:
        start = file.read(4)
    if start.lstrip(b"\xef\xbb\xbf\xff\xfe")[:1] == b"L":
        from thermodata_reader_crio import lvm

        return lvm
    from thermodata_reader_crio import tdms

    return tdms
