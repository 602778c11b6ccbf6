"""XLSX: cells, rows, shared words, dates, styles, relations, the ZIP around them."""

from __future__ import annotations

import io
import random
import re
import zipfile
from functools import lru_cache

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, flip, insert

READER = "table"
_PRAGUE = Source(timezone="Europe/Prague")
_N = 30
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_TYPES = "application/vnd.openxmlformats-package.relationships+xml"
_SHEETS = "application/vnd.openxmlformats-officedocument.spreadsheetml"


def _cell(column: int, row: int, value: object, style: int = 0) -> str:
    at = f"{chr(65 + column)}{row}"
    if isinstance(value, str):
        return (
            f'<c r="{at}" t="s"><v>{value}</v></c>'
            if value.isdigit()
            else f'<c r="{at}" t="inlineStr"><is><t>{value}</t></is></c>'
        )
    mark = f' s="{style}"' if style else ""
    return f'<c r="{at}"{mark}><v>{value}</v></c>'


def _sheet(kind: str) -> str:
    heads = {"seconds": "time [s]", "dates": "Datum", "minutes": "t (min)"}
    rows = [[heads[kind], "T1 [degC]", "dZ", "0"]]
    for i in range(_N):
        time: object = {"seconds": i * 15.0, "dates": 46082.25 + i / 1440, "minutes": i * 0.25}[kind]
        rows.append([time, 20 + i / 8, -i * 1.25 if i != 4 else None, "1" if i % 3 else "2"])  # type: ignore[list-item]
    return "".join(
        f'<row r="{r}">'
        + "".join(
            _cell(c, r, v, 1 if kind == "dates" and r > 1 and c == 0 else 0) for c, v in enumerate(row) if v is not None
        )
        + "</row>"
        for r, row in enumerate(rows, 1)
    )


def book(sheet: str, pack: int = zipfile.ZIP_DEFLATED) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", pack) as archive:
        archive.writestr(
            "[Content_Types].xml",
            f'<Types xmlns="{_PACKAGE}/content-types">'
            f'<Default Extension="rels" ContentType="{_TYPES}"/>'
            f'<Default Extension="xml" ContentType="{_SHEETS}.worksheet+xml"/>'
            f'<Override PartName="/xl/workbook.xml" ContentType="{_SHEETS}.sheet.main+xml"/></Types>',
        )
        archive.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="r1" '
            f'Target="xl/workbook.xml" Type="{_OFFICE}/officeDocument"/></Relationships>',
        )
        archive.writestr(
            "xl/workbook.xml",
            f'<workbook xmlns="{_MAIN}" xmlns:r="{_OFFICE}"><sheets>'
            '<sheet name="data" sheetId="1" r:id="r1"/></sheets></workbook>',
        )
        archive.writestr(
            "xl/_rels/workbook.xml.rels",
            f'<Relationships xmlns="{_PACKAGE}/relationships">'
            f'<Relationship Id="r1" Target="worksheets/sheet1.xml" Type="{_OFFICE}/worksheet"/>'
            f'<Relationship Id="r2" Target="styles.xml" Type="{_OFFICE}/styles"/>'
            f'<Relationship Id="r3" Target="sharedStrings.xml" Type="{_OFFICE}/sharedStrings"/>'
            "</Relationships>",
        )
        archive.writestr(
            "xl/styles.xml",
            f'<styleSheet xmlns="{_MAIN}"><cellXfs count="2"><xf numFmtId="0"/>'
            '<xf numFmtId="22"/></cellXfs></styleSheet>',
        )
        archive.writestr(
            "xl/sharedStrings.xml",
            f'<sst xmlns="{_MAIN}"><si><t>mode</t></si><si><t>idle</t></si><si><t>cut</t></si></sst>',
        )
        archive.writestr(
            "xl/worksheets/sheet1.xml", f'<worksheet xmlns="{_MAIN}"><sheetData>{sheet}</sheetData></worksheet>'
        )
    return out.getvalue()


@lru_cache(maxsize=1)
def _seeds() -> tuple[Seed, ...]:
    return (
        *(Seed(f"{kind}.xlsx", book(_sheet(kind)), _PRAGUE) for kind in ("seconds", "dates", "minutes")),
        Seed("stored.xlsx", book(_sheet("seconds"), zipfile.ZIP_STORED), _PRAGUE),
    )


def seeds() -> list[Seed]:
    return list(_seeds())


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    data = seed.data
    what = rng.choice(("cut", "zip", "junk", "row", "row", "cell", "cell", "part", "entity", "huge", "xml", "xml"))
    if what == "cut":
        return Mutation(cut(data, rng), "cut", False, False)
    if what == "zip":
        return Mutation(flip(data, rng), "bytes of the ZIP", False, True)
    if what == "junk":
        return Mutation(insert(data, rng), "junk in the ZIP", False, True)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
        pack = archive.infolist()[0].compress_type
    name = "xl/worksheets/sheet1.xml"
    sheet = parts[name].decode()
    fine = touched = False
    kind = what
    if what == "part":
        gone = rng.choice(list(parts))
        parts[gone] = rng.choice((b"", b"<a/>", b"\0" * 50, parts[gone][: rng.randrange(len(parts[gone]) + 1)]))
        kind, touched = f"part {gone.rsplit('/', 1)[-1]} damaged", True
    elif what == "xml":
        gone = rng.choice(list(parts))
        parts[gone] = flip(parts[gone], rng, 0, None, 2)
        kind, touched = "bytes of the XML", True
    elif what == "entity":
        parts[name] = (
            '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY x "'
            + "9" * 9
            + '">'
            + "".join(f'<!ENTITY x{i} "{f"&x{i - 1 or chr(32).strip()};" * 10}">' for i in range(1, 9))
            + "]>"
        ).encode() + sheet.replace("<v>20.125</v>", "<v>&x8;</v>").encode()
        touched = True
    elif what == "huge":
        at = rng.choice(("A1048576", "XFD2", "XFD1048576", "ZZZ9", "A99999999999", "A0", "1A"))
        parts[name] = re.sub(r'r="B5"', f'r="{at}"', sheet, count=1).encode()
        touched = True
    elif what == "row":
        rows = re.findall(r"<row .*?</row>", sheet)
        i, j = rng.randrange(1, len(rows)), rng.randrange(1, len(rows))
        how = rng.choice(("dropped", "doubled", "swapped"))
        if how == "dropped":
            del rows[i]
        elif how == "doubled":
            rows.insert(i, rows[i])
        else:
            rows[i], rows[j] = rows[j], rows[i]
        parts[name] = re.sub(r"<sheetData>.*</sheetData>", f"<sheetData>{''.join(rows)}</sheetData>", sheet).encode()
        kind, fine = f"row {how}", True
    else:
        cells = re.findall(r"<c .*?</c>", sheet)
        old = rng.choice(cells[4:])
        at = re.search(r'r="(\w+)"', old)
        assert at is not None
        new = rng.choice(
            (
                "",
                f'<c r="{at[1]}" t="e"><v>#N/A</v></c>',
                f'<c r="{at[1]}"><f>A1*2</f></c>',
                f'<c r="{at[1]}" t="s"><v>99999</v></c>',
                f'<c r="{at[1]}" t="b"><v>1</v></c>',
                f'<c r="{at[1]}"><v>1e999</v></c>',
                f'<c r="{at[1]}" t="d"><v>2026</v></c>',
                f'<c r="{at[1]}" s="77"><v>5</v></c>',
                f'<c r="{at[1]}"><v>abc</v></c>',
            )
        )
        parts[name] = sheet.replace(old, new, 1).encode()
        kind, fine, touched = "cell replaced", True, True
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", pack) as archive:
        for part, content in parts.items():
            archive.writestr(part, content)
    return Mutation(out.getvalue(), kind, fine, touched)
