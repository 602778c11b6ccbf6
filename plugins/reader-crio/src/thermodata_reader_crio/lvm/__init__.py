"""LVM, the text file of LabVIEW ("LabVIEW Measurement"): a file header, then packets of a heading and rows.

Format: National Instruments, "Specification for the LabVIEW Measurement File". Version 0.92 has no
Decimal_Separator, and writes a comma in its times beside points in its data. The last column is free text ("LOST
COMMUNICATION").
"""

from __future__ import annotations

from pathlib import Path

from thermodata.plugin import Head, Source
from thermodata.reader.text.file.encoding import decode_head
from thermodata.reader.text.file.locate import line_of
from thermodata_reader_crio.lvm.reading import blocks
from thermodata_reader_crio.lvm.recording import describe

START = "LabVIEW Measurement"
EXAMPLE = (
    b"LabVIEW Measurement\t\r\nWriter_Version\t2\r\nSeparator\tTab\r\nDecimal_Separator\t.\r\nX_Columns\tOne\r\n"
    b"Date\t2026/03/01\r\nTime\t08:00:00.0\r\n***End_of_Header***\t\r\n\t\r\nChannels\t1\t\r\nSamples\t2\t\r\n"
    b"Y_Unit_Label\tdegC\t\r\nDelta_X\t0.5\t\r\n***End_of_Header***\t\t\r\nX_Value\tT1\tComment\r\n"
    b"0.0\t20.5\t\r\n0.5\t20.6\t\r\n"
)


def claims(head: Head) -> str | None:
    """The reason for claiming a file: its first words."""
    start = head.start[:200]
    if not start.lstrip(b"\xef\xbb\xbf\xff\xfe").startswith((b"LabVIEW", b"L\0a\0b\0V\0I\0E\0W")):
        return None
    text = decode_head(start)
    if text is None or not text.lstrip("\ufeff").startswith(START):
        return None
    return f"LVM: the file starts with '{START}'"


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row (counted from 0) of a stream; None where there is no such row."""
    return line_of(blocks(path, source), stream, row)


__all__ = ["EXAMPLE", "blocks", "claims", "describe", "locate"]
