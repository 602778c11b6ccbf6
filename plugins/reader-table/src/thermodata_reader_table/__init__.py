"""Reader of tables: delimited text, XLSX, Parquet, MAT and MDF, with a layout that is declared or found."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from thermodata.archive.packed_by import packed
from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Source


class Reader:
    """One row a time, one column a signal; the layout is `sources.*.table` of the campaign file."""

    name = "table"
    gives_way = True  # a table at first sight may have a reader of its own
    formats = (
        "delimited text (CSV)",
        "XLSX",
        "Parquet",
        "MAT 5 and 7.3",
        "MDF 2 to 4 (with the extra mdf)",
    )

    def sniff(self, head: Head) -> str | None:
        if head.start[:4] == b"PAR1":
            return "Parquet: the file starts with 'PAR1'"
        if head.start[:4] == b"PK\x03\x04":
            office = b"[Content_Types]" in head.start and b"word/" not in head.start and b"ppt/" not in head.start
            workbook = packed(head.start) is None and (b"xl/" in head.start or office)
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

    def beginning(self, path: Path, source: Source) -> Reader | None:
        """A reader of the first rows of a workbook that holds more than a look needs; None for all other files."""
        if not _is_zip(path):
            return None
        import tempfile

        from thermodata_reader_table.workbook.beginning import beginning

        folder = tempfile.TemporaryDirectory(prefix="thermodata-")
        small = beginning(path, Path(folder.name))
        return None if small is None else _Beginning(path, small, folder)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: line, row of a sheet, index of an array, record."""
        where: str | None = _format(path).locate(path, source, stream, row)
        return where or f"row {row + 1}"

    place = locate


class _Beginning(Reader):
    """Reads a file in place of another, whose beginning it is. folder: where it stands, gone when nobody needs it."""

    def __init__(self, whole: Path, small: Path, folder: object) -> None:
        self._whole, self._small, self._folder = whole, small, folder

    def describe(self, path: Path, source: Source) -> Recording:
        return super().describe(self._beginning_of(path), source)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return super().blocks(self._beginning_of(path), source)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        return super().locate(self._beginning_of(path), source, stream, row)

    def _beginning_of(self, path: Path) -> Path:
        return self._small if path == self._whole else path


def _is_zip(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(4) == b"PK\x03\x04"


def mat_is_hdf5(start: bytes) -> bool:
    from thermodata_reader_table.mat.files import is_hdf5

    return is_hdf5(start)


def _format(path: Path) -> ModuleType:
    with path.open("rb") as file:
        start = file.read(1024)
    if not start:
        raise FormatError(
            "an empty file",
            where=path.name,
            expected="a table",
            hint="take it out of the campaign file, or copy it anew from where it was recorded",
        )
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
