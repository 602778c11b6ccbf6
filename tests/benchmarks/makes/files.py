"""Files as laboratories have them: tables of spreadsheets and controls, workbooks, YAML."""

from __future__ import annotations

import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import yaml

from .bodies import Array

_EPOCH = datetime(1899, 12, 30)  # day 0 of a workbook
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_KIND = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_PARTS = {  # of a workbook of one sheet, but for the sheet; style 1 is a date with its time
    "[Content_Types].xml": f'<Types xmlns="{_PACKAGE}/content-types"><Default Extension="rels" '
    f'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="xml" '
    f'ContentType="{_KIND}.worksheet+xml"/><Override PartName="/xl/workbook.xml" ContentType="{_KIND}.sheet.main+xml"/>'
    f'<Override PartName="/xl/styles.xml" ContentType="{_KIND}.styles+xml"/></Types>',
    "_rels/.rels": f'<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="r1" Target="xl/workbook.xml" '
    f'Type="{_OFFICE}/officeDocument"/></Relationships>',
    "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="r1" '
    f'Target="worksheets/sheet1.xml" Type="{_OFFICE}/worksheet"/><Relationship Id="r2" Target="styles.xml" '
    f'Type="{_OFFICE}/styles"/></Relationships>',
    "xl/styles.xml": f'<styleSheet xmlns="{_MAIN}"><numFmts count="1"><numFmt numFmtId="164" '
    'formatCode="yyyy-mm-dd h:mm:ss"/></numFmts><fonts count="1"><font/></fonts>'
    '<fills count="1"><fill><patternFill/></fill></fills>'
    '<borders count="1"><border/></borders><cellStyleXfs count="1"><xf/></cellStyleXfs><cellXfs count="2">'
    '<xf numFmtId="0"/><xf numFmtId="164" applyNumberFormat="1"/></cellXfs>'
    '<cellStyles count="1"><cellStyle name="Normal" xfId="0"/></cellStyles></styleSheet>',
}


@dataclass(frozen=True)
class Form:
    """How a table is spelled: between cells, before decimals, times. cut: digits that a time loses at its end."""

    separator: str
    mark: str
    time: str
    cut: int = 0
    encoding: str = "cp1250"


GERMAN = Form(";", ",", "%d.%m.%Y %H:%M:%S")
POINT = Form(",", ".", "%Y-%m-%d %H:%M:%S")


def csv(
    path: Path,
    heads: Sequence[Sequence[str]],
    times: Sequence[datetime],
    columns: Sequence[Array],
    form: Form = GERMAN,
    digits: int = 3,
) -> None:
    """A table. heads: its lines above. columns: beside the times, shape (n,) each."""
    rows = (
        [f"{t:{form.time}}"[: -form.cut or None], *(f"{v:.{digits}f}".replace(".", form.mark) for v in values)]
        for t, values in zip(times, zip(*columns, strict=True), strict=True)
    )
    lines = map(form.separator.join, [*heads, *rows])
    path.write_text("\n".join(lines) + "\n", encoding=form.encoding)


def workbook(path: Path, sheet: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """An XLSX file of one sheet."""

    def cell(value: object) -> str:
        if isinstance(value, str):
            return f'<c t="inlineStr"><is><t>{escape(value)}</t></is></c>'
        if isinstance(value, datetime):
            past = value - _EPOCH
            return f'<c s="1"><v>{past.days + (past.seconds + past.microseconds / 1e6) / 86400}</v></c>'
        return f"<c><v>{value}</v></c>"

    named = f'<sheets><sheet name="{escape(sheet)}" sheetId="1" r:id="r1"/></sheets>'
    body = "".join(f"<row>{''.join(map(cell, row))}</row>" for row in [head, *rows])
    parts = _PARTS | {
        "xl/workbook.xml": f'<workbook xmlns="{_MAIN}" xmlns:r="{_OFFICE}">{named}</workbook>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{_MAIN}"><sheetData>{body}</sheetData></worksheet>',
    }
    with zipfile.ZipFile(path, "w") as file:
        for name, content in parts.items():  # a ZipInfo of its own has no clock: the same case is the same bytes
            file.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)


def document(path: Path, said: Mapping[str, Any]) -> None:
    """A campaign or a model."""
    path.write_text(yaml.safe_dump(said, sort_keys=False, allow_unicode=True), encoding="utf-8")


def first_model(
    path: Path, campaign: str, axis: str, step: str, effects: Iterable[tuple[str, Mapping[str, str]]]
) -> None:
    """The model that a laboratory begins with. effects: each with its drivers."""
    said = {
        "schema": "thermodata/model/1",
        "name": "baseline",
        "campaign": campaign,
        "step": step,
        "response": {"axis": axis, "at": "tcp"},
        "effects": [{"effect": effect, "drivers": drivers} for effect, drivers in effects],
    }
    document(path, said)
