"""A test as an Excel workbook: a sheet a stream, names in the first row and units in the second, numbers as numbers.

What Excel needs of Office Open XML (ECMA-376) for plain tables is little, so nothing has to be installed. Numbers
are no text here, hence no decimal comma or point to get wrong.
"""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from thermodata.errors import UsageError
from thermodata.export.content import Content, Stream
from thermodata.export.mat import flag_bits
from thermodata.schema.agreed.exported import TIME_UTC

MOST_ROWS, MOST_COLUMNS = 1_048_576, 16_384  # of a sheet
_NAME = 31  # characters of a sheet's name
_TIME_WIDE, _NARROWEST, _WIDEST = 24, 9, 44  # characters of a column: a time that has no room is shown as '####'
_HEADING = 2  # style of names and units
_HEAD = 2  # rows: names, units
_EPOCH_DAYS = 25_569  # from Excel's day 0, 1899-12-30, to 1970-01-01
_NO_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_REL = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_Column = tuple[str, str, Any]  # name, unit, values
_XML = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
_STYLES = (
    f'{_XML}<styleSheet xmlns="{_MAIN}"><numFmts count="1"><numFmt numFmtId="164" '
    'formatCode="yyyy\\-mm\\-dd\\ hh:mm:ss.000"/></numFmts>'
    '<fonts count="2"><font><sz val="11"/><name val="Calibri"/></font>'
    '<font><b/><sz val="11"/><name val="Calibri"/></font></fonts>'
    '<fills count="2"><fill><patternFill patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill>'
    '</fills><borders count="1"><border><left/><right/><top/><bottom/><diagonal/></border></borders>'
    '<cellStyleXfs count="1"><xf numFmtId="0" fontId="0" fillId="0" borderId="0"/></cellStyleXfs><cellXfs count="3">'
    '<xf numFmtId="0" fontId="0" fillId="0" borderId="0" xfId="0"/>'
    '<xf numFmtId="164" fontId="0" fillId="0" borderId="0" xfId="0" applyNumberFormat="1"/>'
    '<xf numFmtId="0" fontId="1" fillId="0" borderId="0" xfId="0" applyFont="1"/></cellXfs>'
    '<cellStyles count="1"><cellStyle name="Normal" xfId="0" builtinId="0"/></cellStyles></styleSheet>'
)


def write_xlsx(content: Content, path: Path) -> None:
    """UsageError where a stream does not fit into a sheet."""
    *names, about = _sheet_names([*(s.name for s in content.streams), "about"])
    sheets = []
    for name, s in zip(names, content.streams, strict=True):
        columns = _columns(content, s)
        sheets.append((name, _head(content, [c for c, _, _ in columns]), _rows(content, columns)))
    for stream in content.streams:
        wide = 2 + len(stream.values) + len(stream.flags)
        if stream.t_s.size + _HEAD > MOST_ROWS or wide > MOST_COLUMNS:
            raise UsageError(
                "the test does not fit into a sheet of Excel",
                where=f"{content.campaign}/{content.test}, {stream.name}",
                expected=f"at most {MOST_ROWS - _HEAD} rows and {MOST_COLUMNS} columns",
                got=f"{stream.t_s.size} rows, {wide} columns",
                hint="a longer --step, or --format mat",
            )
    sheets.append((about, _widths([max(_wide(name) for name in ("duration_s", *content.channels))]), _about(content)))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, text in _parts([name for name, _, _ in sheets]).items():
            file.writestr(name, text)
        for n, (_, head, rows) in enumerate(sheets, 1):
            with file.open(f"xl/worksheets/sheet{n}.xml", "w", force_zip64=True) as sheet:
                sheet.write(f'{_XML}<worksheet xmlns="{_MAIN}">{head}<sheetData>'.encode())
                for row in rows:
                    sheet.write(f"<row>{''.join(row)}</row>".encode())
                sheet.write(b"</sheetData></worksheet>")


def _columns(content: Content, stream: Stream) -> list[_Column]:
    columns: list[_Column] = []
    if content.start_ns is not None:
        days = (content.start_ns / 1e9 + stream.t_s) / 86_400.0 + _EPOCH_DAYS
        columns.append((TIME_UTC, "UTC", days))
    columns.append(("t_s", "s", stream.t_s))
    for name, values in stream.values.items():
        columns.append((name, content.unit(name), values))
        if name in stream.flags:
            columns.append((f"{name}.flag", "", stream.flags[name]))
    return columns


def _rows(content: Content, columns: Sequence[_Column]) -> Iterator[list[str]]:
    yield [_text(name, _HEADING) for name, _, _ in columns]
    yield [_text(unit, _HEADING) for _, unit, _ in columns]
    dated = content.start_ns is not None
    lists = [values.tolist() for _, _, values in columns]
    for row in zip(*lists, strict=True):
        yield [_cell(value, dated and i == 0) for i, value in enumerate(row)]


def _about(content: Content) -> Iterator[list[str]]:
    for name, value in (*content.about.items(), ("step", content.step), *content.written.items()):
        yield [_text(name), _text(value)]
    yield [_text("flags"), _text(flag_bits())]
    yield []
    keys = list(dict.fromkeys(k for own in content.channels.values() for k in own))
    yield [_text(k) for k in ("channel", *keys)]
    for name, own in content.channels.items():
        yield [_text(name), *(_text(own.get(k, "")) for k in keys)]


def _cell(value: Any, is_time: bool = False) -> str:
    if isinstance(value, str):
        return _text(value)
    if value is None or not np.isfinite(value):
        return "<c/>"
    style = ' s="1"' if is_time else ""
    return f"<c{style}><v>{value!r}</v></c>"


def _text(value: str, style: int = 0) -> str:
    if not value:
        return "<c/>"
    look = f' s="{style}"' if style else ""
    return f'<c{look} t="inlineStr"><is><t xml:space="preserve">{escape(in_xml(value))}</t></is></c>'


def in_xml(text: str) -> str:
    """Without what no XML can say: control characters."""
    return _NO_XML.sub("", text)


def _head(content: Content, names: Sequence[str]) -> str:
    """Names and units stay in sight, and so do times; each column is as wide as its name."""
    times = 1 if content.start_ns is None else 2
    corner = f"{'ABC'[times]}{_HEAD + 1}"
    pane = f'<pane xSplit="{times}" ySplit="{_HEAD}" topLeftCell="{corner}" activePane="bottomRight" state="frozen"/>'
    view = f'<sheetViews><sheetView workbookViewId="0">{pane}</sheetView></sheetViews>'
    return view + _widths([_TIME_WIDE if name == TIME_UTC else _wide(name) for name in names])


def _wide(name: str) -> int:
    return min(max(len(name) + 2, _NARROWEST), _WIDEST)


def _widths(wide: Sequence[int]) -> str:
    """Of the first columns [characters]."""
    each = (f'<col min="{n}" max="{n}" width="{w}" customWidth="1"/>' for n, w in enumerate(wide, 1))
    return f"<cols>{''.join(each)}</cols>"


def _sheet_names(names: Sequence[str]) -> list[str]:
    """As Excel takes them; what is too long, or alike but for its case, differs by its number."""
    made: list[str] = []
    for number, name in enumerate(names):
        plain = re.sub(r"[\[\]:*?/\\']", "_", name) or "sheet"
        if len(plain) > _NAME or plain.casefold() in {m.casefold() for m in made}:
            plain = f"{plain[: _NAME - 1 - len(str(number))]}_{number}"
        made.append(plain)
    return made


def _parts(names: Sequence[str]) -> dict[str, str]:
    """The files of the workbook beside its sheets."""
    numbers = range(1, len(names) + 1)
    types = "".join(
        f'<Override PartName="/xl/{part}.xml" ContentType="{_TYPE}.{kind}+xml"/>'
        for part, kind in (
            ("workbook", "sheet.main"),
            ("styles", "styles"),
            *((f"worksheets/sheet{n}", "worksheet") for n in numbers),
        )
    )
    sheets = "".join(
        f'<sheet name={quoteattr(name)} sheetId="{n}" r:id="rId{n}"/>' for n, name in zip(numbers, names, strict=True)
    )
    links = "".join(
        f'<Relationship Id="rId{n}" Type="{_REL}/worksheet" Target="worksheets/sheet{n}.xml"/>' for n in numbers
    )
    links += f'<Relationship Id="rId{len(names) + 1}" Type="{_REL}/styles" Target="styles.xml"/>'
    return {
        "[Content_Types].xml": f'{_XML}<Types xmlns="{_PACKAGE}/content-types"><Default Extension="rels" '
        f'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>{types}</Types>',
        "_rels/.rels": f'{_XML}<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="rId1" '
        f'Type="{_REL}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'{_XML}<workbook xmlns="{_MAIN}" xmlns:r="{_REL}"><sheets>{sheets}</sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'{_XML}<Relationships xmlns="{_PACKAGE}/relationships">{links}</Relationships>',
        "xl/styles.xml": _STYLES,
    }
