"""Reader of tables: delimited text, XLSX, Parquet, MAT and MDF, with a layout that is declared or found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType

from thermodata.errors import FormatError, ThermodataError
from thermodata.plugin import Block, Head, Loss, Recording, Source


class Reader:
    """One row a time, one column a signal; the layout is `sources.*.table` of the campaign file."""

    name = "table"
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
            workbook = b"xl/" in head.start or b"[Content_Types]" in head.start
            return "XLSX: a ZIP file that holds a workbook" if workbook else None
        if head.start[:8] in (b"MDF     ", b"UnFinMF "):
            return f"MDF: version {head.start[8:12].decode('ascii', 'replace').strip()} in its first bytes"
        if head.start[:10] == b"MATLAB 7.3" and mat_is_hdf5(head.start):
            return "MAT 7.3: HDF5 behind a header of MATLAB's"
        if head.start[126:128] in (b"IM", b"MI") and head.start[124:126] in (b"\x00\x01", b"\x01\x00"):
            return "MAT 5: version and byte order of MATLAB's header"
        return _sniff_text(head)

    def describe(self, path: Path, source: Source) -> Recording:
        recording: Recording = _format(path).describe(path, source)
        return recording

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        found: Iterator[Block | Loss] = _format(path).blocks(path, source)
        return found

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: line, row of a sheet, index of an array, record."""
        module = _format(path)
        where: str | None
        if hasattr(module, "locate"):
            where = module.locate(path, source, stream, row)
        else:
            from thermodata_reader_table.place import place

            where = place(module, path, source, stream, row)
        return where or f"row {row + 1}"

    place = locate


def mat_is_hdf5(start: bytes) -> bool:
    from thermodata_reader_table.mat.files import is_hdf5

    return is_hdf5(start)


# Text files that are tables at first sight, and have readers of their own
_OTHERS = ("LabVIEW Measurement", "/Nck/", "%[GLOBAL]", "ScopeName", "SampleTime", "<?xml", "* ", "TagName")


def _sniff_text(head: Head) -> str | None:
    from thermodata.reader.text import decode_head
    from thermodata_reader_table.delimited import head_rows
    from thermodata_reader_table.layout import find

    text = decode_head(head.start)
    if not text or any(word in text[:2000] for word in _OTHERS):
        return None
    found = head_rows(text.lstrip("\ufeff"), None)
    if found is None or found[0] == "|":
        return None
    delimiter, rows = found
    try:
        layout = find(rows, None, head.name)
    except ThermodataError:
        return None
    if _is_long(layout.names):
        return None  # a row a value: OPC UA logs, which have a reader of their own
    if layout.first == 0:
        return None  # without a header, nothing says what the columns are
    if layout.groups[0].seconds is None and delimiter in (";", "\t"):
        # local dates between ';' or tabs are how controls export; the cnc reader claims them. Named in the campaign
        # file, this reader takes such a table just as well.
        return None
    shown = {"\t": "tab"}.get(delimiter, f"'{delimiter}'")
    return f"table: cells separated by {shown}, time in column '{layout.names[layout.time[0]]}'"


_TAGS = {"_name", "node id", "nodeid", "tag", "tagname", "tag name", "item", "itemid", "display name", "displayname"}
_VALUES = {"_value", "value", "tagval", "tag value", "val"}


def _is_long(names: Sequence[str]) -> bool:
    """Whether each row names the one signal that it holds a value of."""
    low = {n.strip().lower() for n in names}
    return bool(low & _TAGS) and bool(low & _VALUES)


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
