"""Workbooks and Parquet: the real one, dates, and files made to take all memory."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.archive import workbook as archived_workbook
from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Source
from thermodata.testing.reader import load

REAL = Path(__file__).parents[4] / "shared" / "data" / "fl_thermal" / "data.xlsx"
real = pytest.mark.skipif(not REAL.is_file(), reason="the folder of real files is not there")


@real
def test_the_real_spindle_test_is_found_without_a_declaration() -> None:
    data = load(Reader(), REAL, Source())
    names = [s.name for s in data.recording.signals]
    assert names[:2] == ["spindle(RPM)", "ch1(um)"]
    assert [s.unit for s in data.recording.signals] == ["RPM"] + ["um"] * 5 + ["°C"] * 16
    np.testing.assert_array_equal(data.t_ns["table"], np.arange(11_115) * 15_000_000_000)
    assert data.recording.clock == "relative"
    assert data.values["table", "ch3(um)"][0] == 0.106198061
    assert data.losses == ()


@real
def test_the_same_as_declared_and_sheets_by_number_and_name() -> None:
    time = {"column": 1, "unit": "s"}
    found = load(Reader(), REAL, Source())
    for sheet in (1, "工作表1"):
        said = load(Reader(), REAL, Source(table={"sheet": sheet, "header_rows": 1, "time": time}))
        np.testing.assert_array_equal(said.values["table", "t16(°C)"], found.values["table", "t16(°C)"])
    with pytest.raises(UsageError, match="no sheet 2"):
        load(Reader(), REAL, Source(table={"sheet": 2}))


def bomb(path: Path, members: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as book:
        for name, content in members.items():
            book.writestr(name, content)
    return path


@pytest.mark.parametrize("tag", ["row", "x:row"])
@pytest.mark.parametrize("sheets", [1, 20])
def test_a_workbook_of_too_many_rows_is_refused_before_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sheets: int, tag: str
) -> None:
    def made(rows: int) -> Path:
        path = tmp_path / f"{rows}.xlsx"
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as book:
            for i in range(sheets):
                inside = f"<{tag}><c><v>1</v></c></{tag}>" * (rows // sheets)
                book.writestr(f"xl/worksheets/sheet{i}.xml", f"<worksheet><sheetData>{inside}</sheetData></worksheet>")
        return path

    monkeypatch.setattr(archived_workbook, "MAX_ROWS", 100_000)
    archived_workbook.check_size(made(100_000))
    with pytest.raises(FormatError, match="too many rows") as error:
        archived_workbook.check_size(made(100_020))
    assert "at most 100000 rows" in str(error.value)


def test_a_workbook_that_unpacks_to_too_much_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archived_workbook, "MAX_UNPACKED", 10_000_000)
    path = bomb(tmp_path / "x.xlsx", {"xl/workbook.xml": b"<a/>", "xl/worksheets/sheet1.xml": b" " * 20_000_000})
    assert path.stat().st_size < 100_000
    with pytest.raises(FormatError, match="unpacks to more than"):
        Reader().describe(path, Source())


def test_a_header_that_lies_about_the_size_does_not_help(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archived_workbook, "MAX_UNPACKED", 1_000_000)
    path = bomb(tmp_path / "x.xlsx", {"xl/worksheets/sheet1.xml": b" " * 2_000_000})
    size = (2_000_000).to_bytes(4, "little")
    path.write_bytes(path.read_bytes().replace(size, (1000).to_bytes(4, "little")))
    with pytest.raises(FormatError, match="unpacks to more than"):
        archived_workbook.check_size(path)


def test_two_cells_far_apart_are_refused(tmp_path: Path) -> None:
    sheet = b'<row r="1"><c r="A1"><v>1</v></c></row><row r="1048576"><c r="XFD1048576"><v>1</v></c></row>'
    path = bomb(tmp_path / "x.xlsx", {"xl/workbook.xml": b"<a/>", "xl/worksheets/sheet1.xml": sheet})
    with pytest.raises(FormatError, match="absurd area"):
        Reader().describe(path, Source())


def test_a_zip_without_a_workbook_is_refused(tmp_path: Path) -> None:
    path = bomb(tmp_path / "x.xlsx", {"readme.txt": b"hello"})
    with pytest.raises(FormatError, match="not a readable workbook"):
        Reader().describe(path, Source())


def test_parquet_keeps_dtypes_and_takes_local_and_utc_times(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    t = np.datetime64("2026-03-01T08:00:00", "ns") + np.arange(3) * np.timedelta64(1, "s")
    columns = {
        "T [degC]": np.arange(3, dtype=np.float32),
        "n": pa.array([1, None, 3]),
        "i": np.arange(3, dtype=np.int16),
        "mode": ["a", None, "c"],
    }
    for zone, hour in ((None, 7), ("UTC", 8)):
        path = tmp_path / f"{zone}.parquet"
        pq.write_table(pa.table({"time": pa.array(t, pa.timestamp("ns", zone)), **columns}), path)
        data = load(Reader(), path, Source(timezone="Europe/Prague"))
        assert {s.name: s.dtype for s in data.recording.signals} == {
            "T [degC]": "float32",
            "n": "float64",
            "i": "int16",
            "mode": "str",
        }
        assert data.t_ns["table"][0] == np.datetime64(f"2026-03-01T{hour:02}:00", "ns").astype(np.int64)
        np.testing.assert_array_equal(data.values["table", "n"], [1, np.nan, 3])
        assert list(data.values["table", "mode"]) == ["a", "", "c"]


def test_parquet_with_nanoseconds_of_its_own(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = tmp_path / "x.parquet"
    pq.write_table(pa.table({"t_ns": np.array([0, 2**53 + 1]), "T": [1.0, 2.0]}), path)
    np.testing.assert_array_equal(load(Reader(), path, Source()).t_ns["table"], [0, 2**53 + 1])


def least(path: Path, sheet: str, more: str = "") -> Path:
    """A workbook with one sheet, or with a second one of the same rows."""
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    package = "http://schemas.openxmlformats.org/package/2006"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    types = "application/vnd.openxmlformats-"
    data = f'<worksheet xmlns="{main}"><sheetData>{sheet}</sheetData></worksheet>'.encode()
    return bomb(
        path,
        {
            "[Content_Types].xml": f'<Types xmlns="{package}/content-types"><Default Extension="rels" '
            f'ContentType="{types}package.relationships+xml"/><Default Extension="xml" ContentType="{types}'
            'officedocument.spreadsheetml.worksheet+xml"/></Types>'.encode(),
            "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
            f'Target="xl/workbook.xml" Type="{office}/officeDocument"/></Relationships>'.encode(),
            "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets><sheet name="data" sheetId="1" '
            f'r:id="r1"/>{more}</sheets></workbook>'.encode(),
            "xl/_rels/workbook.xml.rels": (
                f'<Relationships xmlns="{package}/relationships">'
                + "".join(
                    f'<Relationship Id="r{i}" Target="worksheets/sheet1.xml" Type="{office}/worksheet"/>'
                    for i in (1, 2)
                )
                + "</Relationships>"
            ).encode(),
            "xl/worksheets/sheet1.xml": data,
        },
    )


HEAD = (
    '<row r="1"><c r="A1" t="inlineStr"><is><t>time [s]</t></is></c><c r="B1" t="inlineStr"><is><t>T</t></is></c></row>'
)


def test_errors_formulas_without_value_and_hidden_rows_are_told(tmp_path: Path) -> None:
    cells = [
        '<c r="B2" t="e"><v>#N/A</v></c>',
        '<c r="B3"><f>A1*2</f></c>',
        '<c r="B4"><v>5</v></c>',
        '<c r="B5"><f>A1</f><v>7.5</v></c>',
    ]
    rows = "".join(
        f'<row r="{i}"{" hidden=" + chr(34) + "1" + chr(34) if i == 4 else ""}><c r="A{i}"><v>{i}</v></c>{c}</row>'
        for i, c in enumerate(cells, 2)
    )
    data = load(Reader(), least(tmp_path / "x.xlsx", HEAD + rows), Source())
    np.testing.assert_array_equal(data.values["table", "T"], [np.nan, np.nan, 5, 7.5])
    assert [x.reason.split(":")[0] for x in data.losses] == [
        "1 cell of the workbook with an error such as #N/A",
        "1 cell of the workbook with a formula without its value (open the workbook once in a spreadsheet and save it)",
    ]
    assert "1 hidden row: it is read like the others" in data.recording.notes


def test_a_stray_cell_far_off_is_refused_with_what_to_do(tmp_path: Path) -> None:
    stray = '<row r="900000"><c r="Z900000"><v>1</v></c></row>'
    with pytest.raises(FormatError, match="delete the stray cells"):
        load(Reader(), least(tmp_path / "x.xlsx", HEAD + '<row r="2"><c r="A2"><v>1</v></c></row>' + stray), Source())


def test_parquet_takes_structs_apart_and_reads_decimals_dictionaries_durations_and_text_times(tmp_path: Path) -> None:
    from decimal import Decimal

    import pyarrow as pa
    import pyarrow.parquet as pq

    path = tmp_path / "x.parquet"
    probe = pa.StructArray.from_arrays([pa.array([1.5, 2.5]), pa.array([1, None])], ["X", "n"])
    for time, clock in (
        (pa.array([0, 500], pa.duration("ms")), "relative"),
        (pa.array(["2026-03-01 08:00:00", "2026-03-01 08:00:00.5"]), "absolute"),
        (pa.array([1_770_000_000.0, 1_770_000_000.5]), "absolute"),
    ):
        pq.write_table(
            pa.table(
                {
                    "time": time,
                    "probe": probe,
                    "kW": pa.array([Decimal("1.25"), None]),
                    "mode": pa.array(["a", None]).dictionary_encode(),
                    "spectrum": [[1, 2], [3]],
                }
            ),
            path,
        )
        data = load(Reader(), path, Source(timezone="UTC"))
        (t_ns,) = data.t_ns.values()
        assert (data.recording.clock, int(np.diff(t_ns)[0])) == (clock, 500_000_000)
        np.testing.assert_array_equal(data.values["table", "probe/X"], [1.5, 2.5])
        np.testing.assert_array_equal(data.values["table", "probe/n"], [1, np.nan])
        np.testing.assert_array_equal(data.values["table", "kW"], [1.25, np.nan])
        assert list(data.values["table", "mode"]) == ["a", ""]
        assert any("spectrum" in n for n in data.recording.notes)


@pytest.mark.parametrize(
    "cell",
    [
        '<c r="A99999999999"><v>1</v></c>',
        "<c  r='XFD1048576'><v>1</v></c>",
        '<c s="0" r="zzzz9"><v>1</v></c>',
        '<x:c r="A1048577"><x:v>1</x:v></x:c>',
    ],
)
def test_cells_outside_of_any_sheet_are_refused_however_they_are_written(tmp_path: Path, cell: str) -> None:
    row = f'<row r="2"><c r="A2"><v>1</v></c>{cell}</row>'
    with pytest.raises(FormatError, match=r"outside of any sheet|absurd area"):
        load(Reader(), least(tmp_path / "x.xlsx", HEAD + row), Source())


def test_cells_without_a_place_in_a_row_far_down_are_refused(tmp_path: Path) -> None:
    row = '<row r="2"><c r="Z2"><v>1</v></c></row><row r="1048576"><c><v>1</v></c></row>'
    with pytest.raises(FormatError, match="absurd area"):
        load(Reader(), least(tmp_path / "x.xlsx", HEAD + row), Source())
