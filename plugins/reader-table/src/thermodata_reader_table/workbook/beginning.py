"""The first rows of a large workbook, as a small workbook: for a look at it. A few megabytes may unpack to rows that
take minutes and gigabytes."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

from thermodata.archive.workbook import inflate
from thermodata.errors import FormatError

ROWS = 100_000  # of all sheets together
_LEAST_ROWS, _LEAST_BYTES = 500, 1 << 18  # of each
_FEWEST_ROWS = 20  # or no layout shows
_SHEET_BYTES = 32 << 20  # of all sheets together, unpacked
_OTHER_BYTES = 64 << 20  # of all other parts: texts and formats
_SHEETS = "xl/worksheets/"
_BESIDE = ("xl/media/", "xl/drawings/", "xl/embeddings/", "xl/charts/")  # no cell needs them
_ROW_END = re.compile(rb"</(\w+:)?row\s*>")


def beginning(path: Path, folder: Path) -> Path | None:
    """A workbook of the same name in `folder` with the first rows of each sheet; None where it would hold all of them,
    or where the workbook can't be taken apart: then whoever reads it says why."""
    target = folder / path.name
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
        sheets = [m for m in members if m.filename.startswith(_SHEETS)]
        others = [m for m in members if m not in sheets and not m.filename.startswith(_BESIDE)]
        rows = max(_LEAST_ROWS, ROWS // max(1, len(sheets)))
        size = max(_LEAST_BYTES, _SHEET_BYTES // max(1, len(sheets)))
        with path.open("rb") as file, zipfile.ZipFile(target, "w") as small:
            cut = False
            for member in sheets:
                text, whole = _first_rows(inflate(file, member, path), rows, size)
                cut = cut or not whole
                small.writestr(member.filename, text)
            if not cut:
                return None
            _copy(file, others, path, small)
    # NotImplementedError: zipfile's word for a compression that it lacks
    except (FormatError, zipfile.BadZipFile, OSError, ValueError, NotImplementedError):
        return None
    return target


def _copy(file: BinaryIO, members: Sequence[zipfile.ZipInfo], path: Path, target: zipfile.ZipFile) -> None:
    """Parts of the workbook `path` as they are; ValueError where they unpack to more than is taken."""
    left = _OTHER_BYTES
    for member in members:
        with target.open(member.filename, "w") as out:
            for part in inflate(file, member, path):
                left -= len(part)
                if left < 0:
                    raise ValueError("texts and formats of an absurd length")
                out.write(part)


def _first_rows(parts: Iterator[bytes], rows: int, size: int) -> tuple[bytes, bool]:
    """(a sheet that ends behind so many rows, or behind the last one within so many bytes; whether that is all)."""
    text = bytearray()
    for part in parts:
        text += part
        ends = list(_ROW_END.finditer(text)) if len(text) > size or text.count(b"row") > rows else []
        if len(ends) > rows or (len(ends) >= _FEWEST_ROWS and len(text) > size):
            end = ends[min(rows, len(ends)) - 1]
            space = end[1] or b""
            return bytes(text[: end.end()]) + b"</%ssheetData></%sworksheet>" % (space, space), False
        if len(text) > 4 * size:
            raise ValueError("rows of an absurd length")
    return bytes(text), True
