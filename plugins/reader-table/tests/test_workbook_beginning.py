"""A look at a large workbook: its first rows, as the whole has them."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader
from thermodata_reader_table.workbook import beginning as workbook_beginning

from thermodata.cli import main
from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.finding.preview import preview
from thermodata.testing.reader import load

from .test_sheets import MAIN, workbook


def book(path: Path, rows: int, sheets: int = 1, space: str = "", more: str = "") -> Path:
    """Sheets of a time and a value. space: of the tags of a sheet; more: further cells, in the first row of data."""
    x = f"{space}:" if space else ""
    name = f"<{x}c t='inlineStr'><{x}is><{x}t>%s</{x}t></{x}is></{x}c>"
    number = f"<{x}c><{x}v>%s</{x}v></{x}c>"

    def row(cells: str) -> str:
        return f"<{x}row>{cells}</{x}row>"

    def sheet(first: float) -> str:
        body = "".join(row(number % k + number % (first + k / 4) + ("" if k else more)) for k in range(rows))
        data = row(name % "Time [s]" + name % "T [degC]") + body
        kind = f"xmlns:{space}" if space else "xmlns"
        return f'<{x}worksheet {kind}="{MAIN}"><{x}sheetData>{data}</{x}sheetData></{x}worksheet>'

    return workbook(path, {f"s{i}": sheet(20.0 + i) for i in range(sheets)})


@pytest.mark.parametrize("sheets", [1, 3])
def test_the_beginning_is_what_the_whole_begins_with(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sheets: int
) -> None:
    monkeypatch.setattr(workbook_beginning, "ROWS", 6000)
    path = book(tmp_path / "x.xlsx", 7000, sheets)
    first = Reader().beginning(path, Source())
    assert first is not None
    part, whole = load(first, path, Source()), load(Reader(), path, Source())
    assert part.recording == whole.recording
    assert sorted(part.t_ns) == sorted(whole.t_ns)
    for stream, t_ns in part.t_ns.items():
        assert len(t_ns) == 6000 // sheets - 1  # the header is a row of it
        np.testing.assert_array_equal(t_ns, whole.t_ns[stream][: len(t_ns)])
    for name, values in part.values.items():
        np.testing.assert_array_equal(values, whole.values[name][: len(values)])


def test_a_sheet_whose_tags_have_a_prefix_begins_as_others_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workbook_beginning, "ROWS", 1000)
    path = book(tmp_path / "x.xlsx", 3000, space="x")
    first = Reader().beginning(path, Source())
    assert first is not None
    assert len(load(first, path, Source()).t_ns["table"]) == 999


def test_a_workbook_too_large_to_be_read_can_be_looked_at(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from thermodata.archive.workbook import MAX_ROWS

    path = book(tmp_path / "x.xlsx", 2000)
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    sheet = parts["xl/worksheets/sheet1.xml"]
    row = sheet[sheet.rfind(b"<row>") : sheet.rfind(b"</sheetData>")]
    parts["xl/worksheets/sheet1.xml"] = sheet.replace(b"</sheetData>", row * MAX_ROWS + b"</sheetData>")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    with pytest.raises(FormatError, match="too many rows"):
        Reader().describe(path, Source())
    found = preview(path)
    assert not found["whole"]
    assert found["streams"][0]["first_rows"][4] == {"t": 4.0, "T [degC]": 21.0}
    assert main(["preview", str(path)]) == 0
    assert f"the first {found['rows_read']} rows only" in capsys.readouterr().out


def test_a_small_workbook_and_other_files_are_read_as_they_are(tmp_path: Path) -> None:
    path = book(tmp_path / "x.xlsx", 300)
    assert Reader().beginning(path, Source()) is None
    assert preview(path)["whole"]
    text = tmp_path / "x.csv"
    text.write_text("Time [s],T\n" + "".join(f"{i},{20 + i / 4}\n" for i in range(9)))
    assert Reader().beginning(text, Source()) is None


def test_what_cannot_be_taken_apart_is_left_to_who_reads_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workbook_beginning, "ROWS", 1000)
    monkeypatch.setattr(workbook_beginning, "_OTHER_BYTES", 100)
    path = book(tmp_path / "x.xlsx", 3000)
    assert Reader().beginning(path, Source()) is None
    data = path.read_bytes()
    (tmp_path / "cut.xlsx").write_bytes(data[: len(data) // 2])
    assert Reader().beginning(tmp_path / "cut.xlsx", Source()) is None


def test_the_beginning_is_held_against_the_same_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workbook_beginning, "ROWS", 1000)
    path = book(tmp_path / "x.xlsx", 3000, more='<c r="XFD1048576"><v>1</v></c>')
    with pytest.raises(FormatError, match="absurd area"):
        preview(path)


def test_a_few_rows_of_an_absurd_length_are_no_beginning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workbook_beginning, "_SHEET_BYTES", 1 << 18)
    path = book(tmp_path / "x.xlsx", 10, more="<c><v>1</v></c>" * 200_000)
    assert Reader().beginning(path, Source()) is None
