"""TwinCAT Scope's text export: groups with their own time and rate, decimals that differ from the header's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_cnc import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.registry import head
from thermodata.testing.reader import load, reader_checks

HEADER = """Name\tproject
File\tC:\\scope.csv
Starttime of export\t134169120000000000\tMontag, 2. März 2026\t09:00:00.000
Endtime of export\t134169120010000000\tMontag, 2. März 2026\t09:00:01.000


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
        ("fast", "scope1", None, "float64"), ("T_front", "scope2", "°C", "float64"), ("door", "scope2", None, "bool"),
        ("count", "scope2", None, "uint64")]
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
    assert "cut" in data.losses[-1].reason


def test_a_header_without_a_start_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no start of the export"):
        load(Reader(), written(tmp_path, export().replace("134169120000000000", "soon")), Source())


@pytest.fixture(scope="module")
def kit_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("kit"), export())


@pytest.mark.parametrize("number", range(len(reader_checks(Reader, [(Path("x"), Source())]))))
def test_it_keeps_the_rules_of_readers(kit_file: Path, number: int) -> None:
    claims = ["SHDR", "MTCONNECT", "TWINCAT", "SCO", "TRACE_XML", "TRACE_CSV", "OPCUA"]
    reader_checks(Reader, [(kit_file, Source())], claims=claims)[number]()
