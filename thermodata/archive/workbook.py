"""What a workbook unpacks to, before anything reads it: a small file may ask for all memory. And what its cells hold
that a reader gives as nothing: errors, formulas without values."""

from __future__ import annotations

import re
import struct
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError

MAX_UNPACKED = 1 << 30
MAX_CELLS = 60_000_000
MAX_ROWS = 4 * 1_048_576  # of all sheets together: more are read in minutes and gigabytes
_SPARSE = 3_000_000  # cells of a sheet that may be almost empty
_RIGHT, _BOTTOM = 16_384, 1_048_576  # columns and rows that a sheet can have
# as loosely as any reader of XML takes it: what a cell says of its place is what is allocated
_CELL = re.compile(rb"""<(?:\w+:)?c\s[^>]*?\br\s*=\s*["']\s*([A-Za-z]*)(\d*)""")
_ANY_CELL = re.compile(rb"<(?:\w+:)?c[\s>/]")
_ROW = re.compile(rb"""<(?:\w+:)?row\s[^>]*?\br\s*=\s*["']\s*(\d+)""")


# what calamine gives as an empty cell, or does not tell
_ODD = {
    "with an error such as #N/A": re.compile(rb'<(?:\w+:)?c [^>]*?t="e"'),
    "with a formula without its value (open the workbook once in a spreadsheet and save it)": re.compile(
        rb"(?:</(?:\w+:)?f>|<(?:\w+:)?f [^>]*/>)\s*(?:<(?:\w+:)?v\s*/>|<(?:\w+:)?v>\s*</(?:\w+:)?v>)?\s*</(?:\w+:)?c>"
    ),
    "hidden": re.compile(rb'<(?:\w+:)?row [^>]*?hidden="(?:1|true)"'),
}


def check_size(path: Path) -> None:
    """FormatError for a workbook that is no ZIP, or whose parts unpack to more than 1 GiB (whatever their headers
    say), or whose sheets have more than MAX_ROWS rows, or whose cells span an absurd area: a reader of
    it would take all memory."""
    odd_cells(path)


def odd_cells(path: Path) -> dict[str, int]:
    """How many cells and rows of all sheets are of each kind of _ODD. FormatError as of `check_size`."""
    members = _members(path)
    odd, unpacked = Counter(dict.fromkeys(_ODD, 0)), 0
    with path.open("rb") as file:
        _check_rows(file, members, path)
        for member in members:
            where = f"{path.name} {member.filename}"
            sheet = _Sheet() if _is_sheet(member) else None
            for part in inflate(file, member, path):
                unpacked += len(part)
                if unpacked > MAX_UNPACKED:
                    raise FormatError(
                        "workbook unpacks to more than 1 GiB",
                        where=where,
                        expected="a log of reasonable size",
                        got=f"{path.stat().st_size} bytes packed",
                        hint="export it as CSV or Parquet",
                    )
                if sheet is not None:
                    sheet.add(part)
            if sheet is not None:
                sheet.check(where)
                odd.update(sheet.odd)
    return dict(odd)


def _is_sheet(member: zipfile.ZipInfo) -> bool:
    return member.filename.startswith("xl/worksheets/")


def _members(path: Path) -> list[zipfile.ZipInfo]:
    """The parts of a workbook. FormatError for what is none."""
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError) as error:
        raise FormatError(
            "not a readable workbook",
            where=path.name,
            expected="an XLSX (ZIP) file",
            got=str(error),
            hint="save it as .xlsx in a spreadsheet program, or export its sheets as CSV",
        ) from None
    if not any(m.filename.lstrip("/").startswith(("xl/", "[Content_Types]")) for m in members):
        names = [m.filename for m in members[:3]] + ["..."] * (len(members) > 3)
        raise FormatError(
            "not a readable workbook",
            where=path.name,
            expected="an XLSX file",
            got=f"a ZIP archive of {', '.join(names)}",
            hint="unpack it, and name the files in it",
        )
    return members


def _check_rows(file: Any, members: list[zipfile.ZipInfo], path: Path) -> None:
    """FormatError where there are too many rows. Counts no more than these, before anything is looked at closely."""
    rows = unpacked = 0
    for member in members:
        rest = b""
        for part in inflate(file, member, path) if _is_sheet(member) else ():
            text = rest + part
            rows += text.count(b"<row") + text.count(b":row") // 2  # a row with a prefix: begun and ended
            rest = part[-3:]
            unpacked += len(part)
            if rows > MAX_ROWS:
                raise FormatError(
                    "workbook of too many rows",
                    where=f"{path.name} {member.filename}",
                    expected=f"at most {MAX_ROWS} rows in all sheets together",
                    got=f"{path.stat().st_size} bytes that unpack to more",
                    hint="export it as CSV or Parquet",
                )
            if unpacked > MAX_UNPACKED:
                return  # told where all parts are added up


class _Sheet:
    """How far the cells of a sheet reach, by what they and their rows say, and how many are odd."""

    def __init__(self) -> None:
        self.right = self.bottom = self.rows = self.count = self.unplaced = 0
        self.odd: Counter[str] = Counter()
        self._rest = b""  # the end of the part before, in which a cell may begin

    def add(self, part: bytes) -> None:
        text = self._rest + part
        for kind, pattern in _ODD.items():
            self.odd[kind] += len(pattern.findall(text)) - len(pattern.findall(self._rest))
        self._rest = part[-200:]
        cells = _CELL.findall(text)
        self.count += len(cells)
        self.unplaced += max(0, len(_ANY_CELL.findall(text)) - len(cells))
        letters = {c[:9] for c, _ in cells}
        self.right = max([self.right, *map(_column, letters)])
        self.bottom = max([self.bottom, *(int(r[:12]) for r in {r for _, r in cells} if r)])
        self.rows = max([self.rows, *(int(r[:12]) for r in set(_ROW.findall(text)))])

    def check(self, where: str) -> None:
        bottom = max(self.bottom, self.rows) if self.unplaced else self.bottom
        right = max(self.right, 1)
        if right > _RIGHT or bottom > _BOTTOM:
            raise FormatError(
                "a cell outside of any sheet",
                where=where,
                got=f"row {bottom}, column {right}",
                expected=f"at most {_BOTTOM} rows and {_RIGHT} columns",
                hint="save it anew as .xlsx in a spreadsheet program",
            )
        if right * bottom > MAX_CELLS or right * bottom > max(_SPARSE, 20 * (self.count + self.unplaced)):
            raise FormatError(
                "sheet spans an absurd area",
                where=where,
                expected=f"at most {MAX_CELLS} cells, most of them filled",
                got=f"{bottom} rows x {right} columns with {self.count + self.unplaced} cells",
                hint="delete the stray cells far off, or export it as CSV or Parquet",
            )


def inflate(file: Any, member: zipfile.ZipInfo, path: Path) -> Iterator[bytes]:
    """A part of a workbook, unpacked in pieces of at most 1 MiB. FormatError where it is damaged."""
    if member.header_offset < 0:  # what stands before the archive moves all of its places
        raise FormatError(
            "damaged workbook",
            where=f"{path.name} {member.filename}",
            expected="a ZIP entry",
            hint="save it anew as .xlsx in a spreadsheet program",
        )
    file.seek(member.header_offset)
    header = file.read(30)
    if len(header) < 30 or header[:4] != b"PK\x03\x04":
        raise FormatError(
            "damaged workbook",
            where=f"{path.name} byte {member.header_offset}",
            expected="a ZIP entry",
            got=header[:4].hex(" "),
            hint="save it anew as .xlsx in a spreadsheet program",
        )
    name, extra = struct.unpack("<HH", header[26:30])
    file.seek(name + extra, 1)
    left = member.compress_size
    if member.compress_type == zipfile.ZIP_STORED:
        while left > 0 and (raw := file.read(min(left, 65536))):
            left -= len(raw)
            yield raw
        return
    if member.compress_type != zipfile.ZIP_DEFLATED:
        raise FormatError(
            "workbook packed in an unusual way",
            where=f"{path.name} {member.filename}",
            hint="save it anew as .xlsx in a spreadsheet program",
        )
    unpack = zlib.decompressobj(-15)
    try:
        while left > 0 and (raw := file.read(min(left, 65536))):
            left -= len(raw)
            while raw:
                yield unpack.decompress(raw, 1 << 20)
                raw = unpack.unconsumed_tail
    except zlib.error as error:
        raise FormatError(
            "damaged workbook",
            where=f"{path.name} {member.filename}",
            got=str(error),
            hint="save it anew as .xlsx in a spreadsheet program",
        ) from None


def _column(letters: bytes) -> int:
    n = 0
    for letter in letters.upper():
        n = n * 26 + letter - 64
    return n
