"""Plain text that LabVIEW writes ("Write To Spreadsheet File", "Write Delimited Spreadsheet", logs of a cRIO): rows of
numbers between tabs, with or without names, and a time in seconds since 1904, in seconds from a start, or none.

Text with dates and times of day belongs to the readers of controls and tables; see `layout` for what is claimed.
"""

from __future__ import annotations

from pathlib import Path

from thermodata.plugin import Source
from thermodata.reader.text.file.locate import line_of
from thermodata_reader_crio.labview_text.layout import claims
from thermodata_reader_crio.labview_text.reading import blocks, describe

EXAMPLE = (
    b"Time\tT1 [degC]\n3855000000.00\t20.500\n3855000000.25\t20.625\n3855000000.50\t20.750\n3855000000.75\t20.875\n"
)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row (counted from 0) of a stream; None where there is no such row."""
    return line_of(blocks(path, source), stream, row)


__all__ = ["EXAMPLE", "blocks", "claims", "describe", "locate"]
