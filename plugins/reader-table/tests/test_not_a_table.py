"""Workbooks and archives that hold no table as it is read: refused with what they are and what to do."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Head, Source
from thermodata.reader.finding.explain import explain
from thermodata.reader.finding.registry import head

from .test_sheets import seconds, sheet, workbook

Rows = list[list[object]]


def sideways(times: int = 20) -> Rows:
    return [
        ["Machine", "138"],
        ["time [s]", *(i * 0.5 for i in range(times))],
        ["T1 [degC]", *(20.0 + i for i in range(times))],
        ["n [rpm]", *(100.0 * i for i in range(times))],
    ]


def test_a_sheet_on_its_side_is_told(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="a table on its side") as caught:
        Reader().describe(workbook(tmp_path / "x.xlsx", {"a": sheet(sideways())}), Source())
    assert "row 2 'time [s]' holds 20 times; rows below it: T1 [degC], n [rpm]" in str(caught.value)
    assert "transpose" in str(caught.value)


def test_a_text_of_dates_on_its_side_is_told_whatever_its_first_cell_says(tmp_path: Path) -> None:
    times = [f"2026/06/15 09:{k:02d}:00" for k in range(40)]
    rows = (["Group1", *times], *([f"HOST1:DM{n:05d}", *(str(230 + k * n) for k in range(40))] for n in range(5)))
    path = tmp_path / "Trd001.csv"
    path.write_text("\n".join([*(",".join(row) for row in rows), ""]))
    with pytest.raises(FormatError, match="a table on its side") as caught:
        Reader().describe(path, Source())
    assert "row 1 'Group1' holds 40 times" in str(caught.value)
    assert "pandas.read_csv('Trd001.csv', header=None).T.to_csv('Trd001_turned.csv'" in str(caught.value)


def test_another_sheet_is_read_beside_one_on_its_side(tmp_path: Path) -> None:
    book = workbook(tmp_path / "x.xlsx", {"a": sheet(sideways()), "b": sheet(seconds(30))})
    found = Reader().describe(book, Source())
    assert [s.name for s in found.signals] == ["T1 [degC]"]
    assert any("on its side" in n for n in found.notes)


@pytest.mark.parametrize("rows", [sideways(9), [["time [s]", *([1.0] * 20)], *sideways()[2:]]])
def test_a_few_times_or_times_that_stand_still_are_no_table_on_its_side(tmp_path: Path, rows: Rows) -> None:
    with pytest.raises(FormatError) as caught:
        Reader().describe(workbook(tmp_path / "x.xlsx", {"a": sheet(rows)}), Source())
    assert "side" not in caught.value.what


@pytest.mark.parametrize("packing", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("name", ["prova 04.xlsx", "alte/Versuch.csv"])
def test_an_archive_of_files_is_no_workbook(tmp_path: Path, packing: int, name: str) -> None:
    inside = workbook(tmp_path / "x.xlsx", {"a": sheet(seconds(30))})
    assert Reader().sniff(head(inside)) is not None
    path = tmp_path / "old.dat"  # whose name does not say that it is one
    with zipfile.ZipFile(path, "w", packing) as archive:
        archive.write(inside, name)
    assert Reader().sniff(head(path)) is None
    said = explain(path)
    how = "python -m zipfile -e old.dat ."
    assert (said.kind, said.advice) == (f"a ZIP archive of files ({name}, ...): unpack it first: {how}", None)
    with pytest.raises(FormatError, match="not a readable workbook") as caught:
        Reader().describe(path, Source())
    assert f"a ZIP archive of {name}" in str(caught.value)
    assert "unpack it" in str(caught.value)


@pytest.mark.parametrize("first", ["_rels/.rels", "xl/workbook.xml", "docProps/app.xml", "mimetype", "[trash]/0.dat"])
def test_a_workbook_may_begin_with_any_of_its_parts(first: str) -> None:
    start = b"PK\x03\x04" + bytes(22) + len(first).to_bytes(2, "little") + bytes(2) + first.encode() + b"..xl/.."
    assert Reader().sniff(Head("a.xlsx", 999, start)) is not None


def test_an_archive_that_is_not_read_says_the_command_that_unpacks_it(tmp_path: Path) -> None:
    (tmp_path / "run 1.7z").write_bytes(b"7z\xbc\xaf\x27\x1c\0\4" + bytes(200))
    assert explain(tmp_path / "run 1.7z").kind == '7-Zip: unpack it first: 7z x "run 1.7z"'


def test_a_log_packed_by_xz_is_explained_as_the_log_that_it_is(tmp_path: Path) -> None:
    import lzma

    text = "".join(f"{k};{20 + k / 10}\n" for k in range(40)).encode()
    (tmp_path / "run 1.csv.xz").write_bytes(lzma.compress(text))
    assert "'0;20.0'" in explain(tmp_path / "run 1.csv.xz").kind
