"""Sheets of a workbook: several tables, covers, merged headers, durations, the date system of 1904."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_workbook import bomb

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
TYPES = "application/vnd.openxmlformats-"
# cell formats: 0 general, 1 date and time, 2 duration, 3 time of day, 4 date, 5 per cent
STYLES = (
    f'<styleSheet xmlns="{MAIN}"><numFmts count="1"><numFmt numFmtId="164" formatCode="[h]:mm:ss"/></numFmts>'
    '<fonts count="1"><font/></fonts><fills count="1"><fill/></fills><borders count="1"><border/></borders>'
    '<cellStyleXfs count="1"><xf/></cellStyleXfs><cellXfs count="6"><xf numFmtId="0"/><xf numFmtId="22"/>'
    '<xf numFmtId="164"/><xf numFmtId="21"/><xf numFmtId="14"/><xf numFmtId="10"/></cellXfs></styleSheet>'
)


def sheet(rows: list[list[object]], styles: tuple[int, ...] = (), merged: str = "") -> str:
    """Rows of words, numbers and None; styles: of the number cells of each column."""
    lines = []
    for r, row in enumerate(rows, 1):
        cells = ""
        for c, value in enumerate(row):
            place = f"{chr(65 + c)}{r}"
            if isinstance(value, str):
                cells += f'<c r="{place}" t="inlineStr"><is><t>{value}</t></is></c>'
            elif value is not None:
                cells += f'<c r="{place}" s="{styles[c] if c < len(styles) else 0}"><v>{value!r}</v></c>'
        lines.append(f'<row r="{r}">{cells}</row>')
    joined = f'<mergeCells count="1"><mergeCell ref="{merged}"/></mergeCells>' if merged else ""
    return f'<worksheet xmlns="{MAIN}"><sheetData>{"".join(lines)}</sheetData>{joined}</worksheet>'


def workbook(path: Path, sheets: dict[str, str], properties: str = "") -> Path:
    numbers = range(1, len(sheets) + 1)
    named = "".join(f'<sheet name="{n}" sheetId="{i}" r:id="r{i}"/>' for i, n in zip(numbers, sheets, strict=True))
    links = (
        "".join(
            f'<Relationship Id="r{i}" Target="worksheets/sheet{i}.xml" Type="{OFFICE}/worksheet"/>' for i in numbers
        )
        + f'<Relationship Id="s" Target="styles.xml" Type="{OFFICE}/styles"/>'
    )
    members = {
        "[Content_Types].xml": f'<Types xmlns="{PACKAGE}/content-types"><Default Extension="rels" ContentType="{TYPES}'
        f'package.relationships+xml"/><Default Extension="xml" ContentType="{TYPES}'
        'officedocument.spreadsheetml.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{PACKAGE}/relationships"><Relationship Id="r1" Target="xl/workbook.xml" '
        f'Type="{OFFICE}/officeDocument"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}">{properties}<sheets>{named}</sheets>'
        "</workbook>",
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{PACKAGE}/relationships">{links}</Relationships>',
        "xl/styles.xml": STYLES,
        **{f"xl/worksheets/sheet{i}.xml": text for i, text in zip(numbers, sheets.values(), strict=True)},
    }
    return bomb(path, {name: text.encode() for name, text in members.items()})


def read(path: Path, sheets: dict[str, str], source: Source | None = None, properties: str = "") -> Data:
    return load(Reader(), workbook(path / "x.xlsx", sheets, properties), source or Source(timezone="UTC"))


def seconds(n: int, first: float = 20.0) -> list[list[object]]:
    return [["time [s]", "T1 [degC]"], *([i * 0.5, first + i] for i in range(n))]


def test_each_sheet_with_a_table_is_a_stream_and_others_are_notes(tmp_path: Path) -> None:
    book = {
        "cover": sheet([["Machine", "138"], ["Operator", "Novák"]]),
        "run 1": sheet(seconds(5)),
        "run 2": sheet(seconds(3, 50)),
    }
    data = read(tmp_path, book)
    assert [(s.name, s.stream, s.unit) for s in data.recording.signals] == [
        ("run 1/T1 [degC]", "run 1", "degC"),
        ("run 2/T1 [degC]", "run 2", "degC"),
    ]
    np.testing.assert_array_equal(data.values["run 1", "run 1/T1 [degC]"], 20 + np.arange(5))
    np.testing.assert_array_equal(data.values["run 2", "run 2/T1 [degC]"], 50 + np.arange(3))
    assert data.recording.notes[0].startswith("sheet 'cover' is not read as a table")
    alone = read(tmp_path, book, Source(table={"sheet": "run 2"}))
    assert [(s.name, s.stream) for s in alone.recording.signals] == [("T1 [degC]", "table")]
    assert alone.recording.notes == ()


def test_a_cover_before_the_only_table(tmp_path: Path) -> None:
    data = read(tmp_path, {"cover": sheet([["Machine", "138"]]), "data": sheet(seconds(4))})
    assert list(data.t_ns) == ["table"]
    assert [s.name for s in data.recording.signals] == ["T1 [degC]"]


def test_columns_with_times_of_their_own_in_sheets(tmp_path: Path) -> None:
    pairs: list[list[object]] = [
        ["t1 [s]", "T1", "t2 [s]", "T2"],
        *([i, 20 + i, i * 0.5, i] for i in range(4)),
        [4, 24, None, None],
        [5, 25, None, None],
    ]
    data = read(tmp_path, {"a": sheet(pairs)})
    assert {k: v.size for k, v in data.t_ns.items()} == {"t1 [s]": 6, "t2 [s]": 4}
    both = read(tmp_path, {"a": sheet(pairs), "b": sheet(pairs)})
    assert list(both.t_ns) == ["a/t1 [s]", "a/t2 [s]", "b/t1 [s]", "b/t2 [s]"]
    assert not (*data.losses, *both.losses)


def test_dates_as_texts_of_a_group_that_ended_long_before_the_other(tmp_path: Path) -> None:
    stamps = [f"2026-04-20 08:{i // 60:02}:{i % 60:02}" for i in range(100)]
    pairs: list[list[object]] = [["Timestamp", "T1", "Timestamp", "T2"]]
    pairs += [[s, 20.5, *((s, 3000) if i < 20 else (None, None))] for i, s in enumerate(stamps)]
    data = read(tmp_path, {"a": sheet(pairs)})
    assert [t.size for t in data.t_ns.values()] == [100, 20]
    assert not data.losses


def test_a_column_that_turns_from_dates_to_their_numbers_goes_on(tmp_path: Path) -> None:
    days: list[list[object]] = [["Zeitstempel", "T"], *([46082 + i / 1440, i] for i in range(40))]
    mixed = sheet(days, (1,)).replace('<c r="A20" s="1">', '<c r="A20" s="0">')
    data = read(tmp_path, {"a": mixed}, Source(timezone="UTC", table={"time": {"unit": "excel"}}))
    assert np.abs(np.diff(data.t_ns["table"]) - 60 * 10**9).max() < 1000


def test_merged_headers_name_what_is_below_them(tmp_path: Path) -> None:
    rows: list[list[object]] = [
        ["time [s]", "spindle", None, "column", None, "air"],
        [None, "front", "rear", "front", "rear", None],
        *([i, 1.5, 2.5, 3.5, 4.5, i] for i in range(4)),
    ]
    data = read(tmp_path, {"a": sheet(rows, (), "B1:C1")})
    assert [s.name for s in data.recording.signals] == [
        "spindle/front",
        "spindle/rear",
        "column/front",
        "column/rear",
        "air",
    ]
    data = read(tmp_path, {"a": sheet([[r[0], *r[1:3], r[5]] for r in rows])})
    assert [s.name for s in data.recording.signals] == ["front", "rear", "air"]


def test_the_date_system_of_1904(tmp_path: Path) -> None:
    rows: list[list[object]] = [["time", "T"], *([43891 + i / 24, i] for i in range(4))]
    for properties, year in (('<workbookPr date1904="1"/>', 2024), ("", 2020)):
        data = read(tmp_path, {"a": sheet(rows, (1,))}, properties=properties)
        assert np.datetime64(int(data.t_ns["table"][0]), "ns").astype("datetime64[Y]").item().year == year
        np.testing.assert_array_equal(np.diff(data.t_ns["table"]), [3600 * 10**9] * 3)


def test_plain_numbers_count_from_1904_too_where_the_workbook_says_so(tmp_path: Path) -> None:
    rows: list[list[object]] = [["Datum", "T"], *([43891 + i / 24, i] for i in range(4))]
    for properties, year in (('<workbookPr date1904="true"/>', 2024), ('<workbookPr date1904="0"/>', 2020)):
        for table in (None, {"time": {"unit": "excel"}}):
            data = read(tmp_path, {"a": sheet(rows)}, Source(timezone="UTC", table=table), properties=properties)
            assert np.datetime64(int(data.t_ns["table"][0]), "ns").astype("datetime64[Y]").item().year == year
            assert ("days count from 1904, as the workbook says" in data.recording.notes) == (year == 2024)


def test_the_zone_that_a_header_says_is_that_of_the_dates_below_it(tmp_path: Path) -> None:
    source = Source(timezone="Europe/Prague")
    for header, utc in (("time", "2020-03-01T07:00"), ("Time (UTC)", "2020-03-01T08:00")):
        rows: list[list[object]] = [[header, "T"], *([43891 + (8 + i) / 24, i] for i in range(4))]
        data = read(tmp_path, {"a": sheet(rows, (1,))}, source)
        assert data.t_ns["table"][0] == np.datetime64(utc, "ns").astype(int)


def test_durations_as_times_and_as_values(tmp_path: Path) -> None:
    rows: list[list[object]] = [["time", "T", "running"], *([i * 0.5, i, i / 86400] for i in range(5))]
    data = read(tmp_path, {"a": sheet(rows, (2, 0, 2))})
    np.testing.assert_array_equal(data.t_ns["table"], np.arange(5) * 43_200 * 10**9)
    np.testing.assert_allclose(data.values["table", "running"], np.arange(5), atol=1e-3)
    assert {s.name: s.unit for s in data.recording.signals} == {"T": None, "running": "s"}
    assert any("running" in note for note in data.recording.notes)


def test_times_of_day_pass_midnight(tmp_path: Path) -> None:
    rows: list[list[object]] = [["time", "T"], *([(0.75 + i / 8) % 1, i] for i in range(5))]
    data = read(tmp_path, {"a": sheet(rows, (3,))})
    np.testing.assert_array_equal(data.t_ns["table"], np.arange(5) * 3 * 3600 * 10**9)


def test_an_archive_whose_parts_are_said_to_begin_before_it_is_refused(tmp_path: Path) -> None:
    path = workbook(tmp_path / "x.xlsx", {"a": sheet(seconds(4))})
    data = bytearray(path.read_bytes())
    end = data.rfind(b"PK\x05\x06")
    at = int.from_bytes(data[end + 16 : end + 20], "little")
    data[end + 16 : end + 20] = (at + 50).to_bytes(4, "little")  # all places are 50 bytes too far
    path.write_bytes(data)
    with pytest.raises(FormatError, match=r"damaged workbook|not a readable workbook"):
        load(Reader(), path, Source())


@pytest.mark.parametrize("head", ["load", "load [%]"])
def test_numbers_that_are_shown_in_per_cent_are_in_per_cent(tmp_path: Path, head: str) -> None:
    rows: list[list[object]] = [["time [s]", head, "T1"], *([i, 0.25 + i / 64, 20.5] for i in range(20))]
    data = read(tmp_path, {"a": sheet(rows, (0, 5, 0))})
    signal = data.recording.signals[0]
    assert signal.unit == "%"
    assert signal.scaling is not None
    assert dict(signal.scaling.properties) == {"gain": 100.0, "offset": 0.0}
    np.testing.assert_array_equal(data.values["table", head], 0.25 + np.arange(20) / 64)  # as it stands in the file
    assert data.recording.signals[1].scaling is None


def test_a_fraction_that_has_a_unit_of_its_own_stays_one(tmp_path: Path) -> None:
    rows: list[list[object]] = [["time [s]", "load [ratio]"], *([i, 0.25] for i in range(20))]
    signal = read(tmp_path, {"a": sheet(rows, (0, 5))}).recording.signals[0]
    assert (signal.unit, signal.scaling) == ("ratio", None)


def test_a_column_partly_in_per_cent_is_refused(tmp_path: Path) -> None:
    rows: list[list[object]] = [["time [s]", "load"], *([i, 0.25] for i in range(20))]
    mixed = sheet(rows, (0, 5)).replace('<c r="B7" s="5">', '<c r="B7" s="0">')
    with pytest.raises(FormatError, match="mixes numbers in per cent"):
        read(tmp_path, {"a": mixed})


@pytest.mark.parametrize("value", ["", "<v/>", "<v></v>"])
def test_a_formula_that_no_sheet_computed_is_a_loss(tmp_path: Path, value: str) -> None:
    rows: list[list[object]] = [["time [s]", "T1", "T2"], *([i, 20.5, 20.5] for i in range(20))]
    never = sheet(rows).replace('<c r="C9" s="0"><v>20.5</v>', f'<c r="C9" s="0"><f>B9*2</f>{value}')
    data = read(tmp_path, {"a": never})
    assert "1 cell of the workbook with a formula without its value" in data.losses[0].reason
    assert np.isnan(data.values["table", "T2"][7])


def test_times_of_day_of_a_sheet_go_over_midnight(tmp_path: Path) -> None:
    rows: list[list[object]] = [["time", "T1"], *([((86_100 + 10 * i) % 86_400) / 86_400, 20.5] for i in range(60))]
    data = read(tmp_path, {"a": sheet(rows, (3, 0))})
    np.testing.assert_allclose(data.t_ns["table"] / 1e9, np.arange(60) * 10.0, atol=1e-3)
