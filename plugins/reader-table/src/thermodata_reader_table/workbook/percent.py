"""What a workbook says of its numbers elsewhere: which columns are shown in per cent (such a cell holds 0.25 and reads
"25 %"), and from which year days count. Cells come without their formats, so the sheets are asked."""

from __future__ import annotations

import re
import zipfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

_MOST = 16 << 20  # bytes of a part that is taken whole
_PERCENT = {9, 10}  # the built-in formats 0% and 0.00%
_FORMAT = re.compile(r"""<(?:\w+:)?numFmt\s[^>]*?>""")
_XFS = re.compile(r"<(?:\w+:)?cellXfs\b.*?</(?:\w+:)?cellXfs>", re.DOTALL)
_XF = re.compile(r"<(?:\w+:)?xf\b[^>]*?>")
_SHEET = re.compile(r"<(?:\w+:)?sheet\s[^>]*?>")
_PROPERTIES = re.compile(r"<(?:\w+:)?workbookPr\s[^>]*?>")
_RELATION = re.compile(r"<(?:\w+:)?Relationship\s[^>]*?>")
# a number: no type, or "n"; a formula may stand before its value
_CELL = re.compile(rb"<(?:\w+:)?c\s([^>]*?)>(?:<(?:\w+:)?f\b[^>]*?(?:/>|>[^<]*</(?:\w+:)?f>))?<(?:\w+:)?v>[^<]")


def _attribute(tag: str, name: str) -> str | None:
    found = re.search(rf"""[\s:]{name}\s*=\s*["']([^"']*)["']""", tag)
    return found[1] if found else None


def percent_columns(path: Path) -> dict[str, Counter[int]]:
    """Sheet -> column (from 0) -> how many of its numbers are shown in per cent; {} where none is."""
    with zipfile.ZipFile(path) as archive:
        styles = _percent_styles(_part(archive, "xl/styles.xml"))
        if not styles:
            return {}
        found = {sheet: Counter(_columns(archive, member, styles)) for sheet, member in _sheets(archive).items()}
        return {sheet: counts for sheet, counts in found.items() if counts}


def _columns(archive: zipfile.ZipFile, member: str, styles: set[str]) -> Iterator[int]:
    """The column of each number of a sheet that has one of these styles."""
    for rows in _rows(archive, member):
        for attributes in _CELL.findall(rows):
            tag = " " + attributes.decode("utf-8", "replace")
            place, style = _attribute(tag, "r"), _attribute(tag, "s")
            if place and style in styles and _attribute(tag, "t") in (None, "n"):
                yield _column(place)


def counts_from_1904(path: Path) -> bool:
    """Whether a workbook counts its days from 1904, as Excel did on a Macintosh."""
    with zipfile.ZipFile(path) as archive:
        tags = _PROPERTIES.findall(_part(archive, "xl/workbook.xml"))
    return any(_attribute(tag, "date1904") in ("1", "true", "on") for tag in tags)


def _part(archive: zipfile.ZipFile, name: str) -> str:
    try:
        with archive.open(name) as part:
            return part.read(_MOST).decode("utf-8", "replace")
    except (KeyError, zipfile.BadZipFile, OSError, NotImplementedError, RuntimeError):
        return ""


def _rows(archive: zipfile.ZipFile, name: str) -> Iterator[bytes]:
    """A sheet in parts that end with a row."""
    rest = b""
    try:
        with archive.open(name) as part:
            while piece := part.read(1 << 20):
                text = rest + piece
                cut = text.rfind(b"row>") + 4
                rest = text[cut:] if cut > 3 else text
                if cut > 3:
                    yield text[:cut]
    except (KeyError, zipfile.BadZipFile, OSError, NotImplementedError, RuntimeError):
        return


def _percent_styles(text: str) -> set[str]:
    """The numbers of the cell formats that show per cent."""
    percent = set(_PERCENT)
    for tag in _FORMAT.findall(text):
        number, code = _attribute(tag, "numFmtId"), _attribute(tag, "formatCode")
        if number and code and number.isdigit() and "%" in re.sub(r"&quot;.*?&quot;|\\\\.", "", code):
            percent.add(int(number))
    block = _XFS.search(text)
    formats = [_attribute(tag, "numFmtId") for tag in _XF.findall(block[0])] if block else []
    return {str(i) for i, number in enumerate(formats) if number and number.isdigit() and int(number) in percent}


def _sheets(archive: zipfile.ZipFile) -> dict[str, str]:
    """Sheet -> the part that holds it."""
    from html import unescape

    targets = {
        _attribute(tag, "Id"): _attribute(tag, "Target") or ""
        for tag in _RELATION.findall(_part(archive, "xl/_rels/workbook.xml.rels"))
    }
    found = {}
    for tag in _SHEET.findall(_part(archive, "xl/workbook.xml")):
        name, target = _attribute(tag, "name"), targets.get(_attribute(tag, "id"), "")
        if name and target:
            found[unescape(name)] = target.lstrip("/") if target.startswith("/") else f"xl/{target}"
    return found


def _column(place: str) -> int:
    n = 0
    for letter in place.rstrip("0123456789").upper():
        n = n * 26 + ord(letter) - 64
    return n - 1
