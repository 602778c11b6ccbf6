"""Reader of tables: delimited text, XLSX, Parquet, MAT and MDF, with a layout that is declared or found."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Source


class Reader:
    """One row a time, one column a signal; the layout is `sources.*.table` of the campaign file."""

    name = "table"
    gives_way = True  # a table at first sight may have a reader of its own

    def sniff(self, head: Head) -> str | None:
        if head.start[:4] == b"PAR1":
            return "Parquet: the file starts with 'PAR1'"
        if head.start[:4] == b"PK\x03\x04":
            workbook = b"xl/" in head.start or b"[Content_Types]" in head.start
            return "XLSX: a ZIP file that holds a workbook" if workbook else None
        if head.start[:8] in (b"MDF     ", b"UnFinMF "):
            return f"MDF: version {head.start[8:12].decode('ascii', 'replace').strip()} in its first bytes"
        if head.start[:10] == b"MATLAB 7.3" and mat_is_hdf5(head.start):
            return "MAT 7.3: HDF5 behind a header of MATLAB's"
        if head.start[126:128] in (b"IM", b"MI") and head.start[124:126] in (b"\x00\x01", b"\x01\x00"):
            return "MAT 5: version and byte order of MATLAB's header"
        from thermodata_reader_table import delimited

        return delimited.claims(head)

    def describe(self, path: Path, source: Source) -> Recording:
        recording: Recording = _format(path).describe(path, source)
        return recording

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        found: Iterator[Block | Loss] = _format(path).blocks(path, source)
        return found

    def place(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: line, row of a sheet, index of an array, record."""
        from thermodata_reader_table.place import place

        return place(_format(path), path, source, stream, row) or f"row {row + 1}"


def mat_is_hdf5(start: bytes) -> bool:
    from thermodata_reader_table.mat import is_hdf5

    return is_hdf5(start)


def _format(path: Path) -> ModuleType:
    with path.open("rb") as file:
        start = file.read(1024)
    if not start:
        raise FormatError("an empty file", where=path.name, expected="a table")
    if start[:4] == b"PAR1":
        from thermodata_reader_table import parquet

        return parquet
    if start[:4] == b"PK\x03\x04":
        from thermodata_reader_table import workbook

        return workbook
    if start[:8] in (b"MDF     ", b"UnFinMF "):
        from thermodata_reader_table import mdf

        return mdf
    if start[:6] == b"MATLAB" or start[126:128] in (b"IM", b"MI") or mat_is_hdf5(start):
        from thermodata_reader_table import mat

        return mat
    from thermodata_reader_table import delimited

    return delimited
