"""TwinCAT Scope's text export: groups with their own time and rate, decimals that differ from the header's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.finding.registry import head
from thermodata.testing.reader import load, reader_checks

HEADER = """Name\tproject
File\tC:\\scope.csv
Starttime of export\t134169120000000000\tMontag, 2. März 2026\t09:00:00.000
Endtime of export\t134169120000095000\tMontag, 2. März 2026\t09:00:00.009


Name\tfast\tName\tT_front\tdoor\tcount
SymbolComment\t\tSymbolComment\tLager vorn\t\t
Data-Type\tREAL32\tData-Type\tREAL64\tBIT\tUINT64
SampleTime[ms]\t0,5\tSampleTime[ms]\t1\t1\t1
SymbolName\tMAIN.fast\tSymbolName\tMAIN.T\tMAIN.bDoor\tMAIN.n
Offset\t0\tOffset\t0\t0\t0
ScaleFactor\t1\tScaleFactor\t-2\t1\t1
Unit\t(None)\tUnit\t°C (Temperature)\t(None)\t(None)
Unit ScaleFactor\t1\tUnit ScaleFactor\t1\t1\t1
Unit Offset\t0\tUnit Offset\t0\t0\t0

"""
T0 = 13_416_912_000 * 10**9 - 11_644_473_600 * 10**9


def export(decimal: str = ".", rows: int = 20, end: str = "EOF\n") -> str:
    lines = []
    for k in range(rows):
        slow = f"{k}\t{20 + k / 4}\t{k % 2}\t{2**53 + k}" if k < rows // 2 else "\t\t\t"
        lines.append(f"{k / 2}\t{k / 8}\t{slow}".replace(".", decimal))
    return HEADER + "\n".join(lines) + "\n" + end


def written(tmp_path: Path, text: str, encoding: str = "utf-8") -> Path:
    path = tmp_path / "scope.csv"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("encoding", ["utf-8-sig", "cp1252"])
def test_groups_are_streams_with_their_own_time(tmp_path: Path, decimal: str, encoding: str) -> None:
    path = written(tmp_path, export(decimal), encoding)
    assert "TwinCAT" in (Reader().sniff(head(path)) or "")
    data = load(Reader(), path, Source())
    assert not data.losses
    assert data.recording.complete is True
    assert data.recording.start_ns == T0 == np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64)
    assert [(s.name, s.stream, s.unit, s.dtype) for s in data.recording.signals] == [
        ("fast", "scope1", None, "float64"),
        ("T_front", "scope2", "°C", "float64"),
        ("door", "scope2", None, "bool"),
        ("count", "scope2", None, "uint64"),
    ]
    np.testing.assert_array_equal(data.t_ns["scope1"] - T0, np.arange(20) * 500_000)
    np.testing.assert_array_equal(data.t_ns["scope2"] - T0, np.arange(10) * 1_000_000)
    np.testing.assert_array_equal(data.values["scope1", "fast"], np.arange(20) / 8)
    np.testing.assert_array_equal(data.values["scope2", "T_front"], 20 + np.arange(10) / 4)
    assert data.values["scope2", "count"].tolist() == [2**53 + k for k in range(10)]
    assert data.values["scope2", "door"].tolist() == [k % 2 == 1 for k in range(10)]


def test_without_eof_nothing_proves_it_complete_and_a_bad_row_is_named(tmp_path: Path) -> None:
    lines = export(end="").splitlines()
    lines[25] = lines[25].replace("\t", "\tx", 1)
    data = load(Reader(), written(tmp_path, "\n".join(lines) + "\n"), Source())
    assert data.recording.complete is None
    assert [loss.where for loss in data.losses] == ["scope.csv line 26"]
    assert data.t_ns["scope1"].size == 19


def test_a_cut_export_keeps_its_rows(tmp_path: Path) -> None:
    text = export(end="")
    data = load(Reader(), written(tmp_path, text[:-20]), Source())
    assert data.recording.complete is False
    assert data.t_ns["scope1"].size == 18
    assert any("cut" in loss.reason for loss in data.losses)


def small(rows: str, names: str = "Name\ta\tName\tb", start: str = "133238090039920000", more: str = "") -> str:
    return (
        f"Name\tp\nFile\tC:\\x.csv\nStarttime of export\t{start}\tMontag\t19:03:23.992\n"
        f"Endtime of export\t{int(start) + 60_000}\tMontag\n\n\n{names}\n{more}{rows}"
    )


@pytest.mark.parametrize(
    "rows",
    [
        "0\t1,5\t0\t10\n2\t2\t4\t11\n4\t2\n6\t4\n",
        "0\t1,5\t0\t10\n2\t2\t4\t11\n4\t2\t\t\n6\t4\t\t\n",
        "0\t1,5\t0\t10\n2\t2\t0\t10\n4\t2\t4\t11\n6\t4\t4\t11\n",
        "0\t1,5\t0\t10\t\n2\t2\t4\t11\t\n4\t2\t\t\t\n6\t4\t\t\t\n",
    ],
    ids=["short", "blank", "filled", "ended"],
)
def test_a_slower_group_ends_sooner_or_is_filled_with_copies(tmp_path: Path, rows: str) -> None:
    """As Scope View writes them with interpolation off and with 'previous value'; a header of names alone."""
    data = load(Reader(), written(tmp_path, small(rows)), Source())
    assert not data.losses
    assert (data.t_ns["scope1"] - data.recording.start_ns).tolist() == [0, 2_000_000, 4_000_000, 6_000_000]
    assert data.values["scope1", "a"].tolist() == [1.5, 2, 2, 4]
    assert data.values["scope2", "b"].tolist() == [10, 11]


def test_full_time_stamps_are_ticks(tmp_path: Path) -> None:
    rows = "".join(f"{133238090039920000 + k * 20_001}\t{k}\n" for k in range(4))
    data = load(Reader(), written(tmp_path, small(rows, "Name\ta")), Source())
    assert (data.t_ns["scope1"] - data.recording.start_ns).tolist() == [k * 2_000_100 for k in range(4)]
    assert data.recording.start_ns == 1_679_335_403_992_000_000


def test_a_comment_over_lines_triggers_before_the_names_and_a_scaling_that_nobody_knows(tmp_path: Path) -> None:
    text = small(
        "0\t1\t0\t10\n6\t2\t6\t11\n",
        more="SymbolComment\t(* torque\n12\nin Nm *)\tSymbolComment\tb\n"
        "Data-Type\tINT16\tData-Type\tINT16\nOffset\t1\tOffset\t0\nScaleFactor\t-2\tScaleFactor\t1,000\n\n",
    )
    text = text.replace("\n\n\nName", "\nTriggerGroup\tCount\tReleaseTime\tComment\nT1\t1\t5\t\n\nName", 1)
    data = load(Reader(), written(tmp_path, text), Source())
    assert not data.losses
    assert [(s.name, s.dtype) for s in data.recording.signals] == [("a", "float64"), ("b", "int64")]
    assert data.recording.signals[0].properties["SymbolComment"] == "(* torque 12 in Nm *)"
    assert "'a' (scalefactor -2; offset 1)" in data.recording.notes[0]


def test_rows_that_do_not_reach_the_announced_end_are_a_loss(tmp_path: Path) -> None:
    data = load(Reader(), written(tmp_path, small("0\t1\n2\t2\n", "Name\ta\nSampleTime[ms]\t2")), Source())
    assert data.recording.complete is False
    assert "later end" in data.losses[0].reason
    with pytest.raises(FormatError, match="cells and decimals"):
        load(Reader(), written(tmp_path, small("0,0\t1,5\n", "Name\ta").replace("\t", ",")), Source())


@pytest.mark.parametrize("ticks", [False, True])
@pytest.mark.parametrize(("rows", "whole"), [(7, True), (6, False), (3, False), (1, False)])
def test_without_a_sample_time_the_rows_say_how_near_the_end_they_come(
    tmp_path: Path, ticks: bool, rows: int, whole: bool
) -> None:
    """The end is announced 6 ms behind the start, and a row comes every millisecond."""
    times = [133_238_090_039_920_000 + k * 10_000 if ticks else k for k in range(rows)]
    data = load(
        Reader(), written(tmp_path, small("".join(f"{t}\t{k}\n" for k, t in enumerate(times)), "Name\ta")), Source()
    )
    assert data.t_ns["scope1"].size == rows
    assert data.recording.complete is (None if whole else False)
    assert [loss.reason for loss in data.losses] == (
        [] if whole else ["the header announces a later end of the export than its rows reach"]
    )


def test_a_last_row_nearly_a_step_before_the_end_and_copies_of_rows_are_whole(tmp_path: Path) -> None:
    rows = "".join(f"{t}\t{k}\t{k // 2 * 2}\t{k // 2}\n" for k, t in enumerate((0, 1.1, 1.9, 3.0, 4.1, 5.2)))
    data = load(Reader(), written(tmp_path, small(rows, "Name\ta\tName\tb")), Source())
    assert data.recording.complete is None
    assert not data.losses


@pytest.mark.parametrize("junk", ["\t" * 100_000, "x" * 300_000, "\n" * 100_000, "1\t" * 50_000])
def test_huge_lines_are_lost_alone(tmp_path: Path, junk: str) -> None:
    rows = [f"{k}\t{k}\n" for k in range(7)]
    data = load(
        Reader(), written(tmp_path, small("".join(rows[:4]) + junk + "\n" + "".join(rows[4:]), "Name\ta")), Source()
    )
    assert data.values["scope1", "a"].tolist() == list(range(7))
    assert data.losses or not junk.strip("\n;\t")  # a line of nothing is none


def test_a_header_without_a_start_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no start of the export"):
        load(Reader(), written(tmp_path, export().replace("134169120000000000", "soon")), Source())


@pytest.fixture(scope="module")
def kit_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("kit"), export())


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
def test_it_keeps_the_rules_of_readers(kit_file: Path, number: int) -> None:
    reader_checks(Reader, [(kit_file, Source())])[number]()


@pytest.mark.parametrize("at", [0, 5])
def test_a_row_that_lost_a_delimiter_is_told_the_first_one_too(tmp_path: Path, at: int) -> None:
    lines = export(",").removeprefix(HEADER).splitlines()
    lines[at] = lines[at].replace("\t", "", 1)
    data = load(Reader(), written(tmp_path, HEADER + "\n".join(lines) + "\n"), Source())
    line = HEADER.count("\n") + at + 1
    assert [loss.where for loss in data.losses][:1] == [f"scope.csv line {line}"]
    assert len(next(iter(data.t_ns.values()))) == 19


def test_a_row_of_names_with_cells_beyond_all_data_is_refused(tmp_path: Path) -> None:
    """Room was made for each of them in each row: a gigabyte for a file of 100 kB."""
    text = export().replace("Name\tfast\tName", "Name\tfast" + "\t" * 100_000 + "Name")
    with pytest.raises(FormatError, match="the row of names is longer than any row of data") as error:
        Reader().describe(written(tmp_path, text), Source())
    assert error.value.got == "100005 cells"
