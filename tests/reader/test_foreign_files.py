"""Files that no reader takes: `sniff` says what they are and gives the line that makes a table of them, which works."""

from __future__ import annotations

import pickle
import re
import sqlite3
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.feather
import pyarrow.parquet as pq
import pytest

from thermodata.draft.make import draft_files
from thermodata.reader.finding.explain import explain

TABLE = pa.table({"t": np.arange(5.0), "T": np.linspace(20, 21, 5)})


def ran(folder: Path, kind: str, **names: str) -> None:
    """Runs the line of Python that a message gives."""
    found = re.search(r'python -c "(.*?)"(?:,|;|:|$| )', kind)
    assert found is not None, kind
    code = found[1]
    for name, other in names.items():
        code = code.replace(name, other)
    subprocess.run([sys.executable, "-c", code], cwd=folder, check=True, timeout=60)


def test_a_database_is_exported_by_its_program(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "log.db") as con:
        con.execute("create table samples (ts real, T real)")
    said = explain(tmp_path / "log.db")
    assert said.kind.startswith('an SQLite database: export its table as CSV: sqlite3 -header -csv log.db "select')
    assert said.advice is None


def test_feather_becomes_parquet(tmp_path: Path) -> None:
    pyarrow.feather.write_feather(TABLE, tmp_path / "run 1.feather")
    said = explain(tmp_path / "run 1.feather")
    assert said.kind.startswith("Feather (Arrow): make a Parquet file")
    ran(tmp_path, said.kind)
    assert pq.read_table(tmp_path / "run 1.parquet").equals(TABLE)


def test_an_array_becomes_a_csv(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.arange(10.0).reshape(5, 2))
    said = explain(tmp_path / "a.npy")
    assert said.kind.startswith("an array of NumPy: name its columns in a CSV")
    ran(tmp_path, said.kind)
    assert (tmp_path / "a.csv").read_text().startswith("time [s],T_1 [degC]\n0.0")


def test_hdf5_becomes_parquet(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["t"], file["T"] = TABLE["t"].to_numpy(), TABLE["T"].to_numpy()
    said = explain(tmp_path / "a.h5")
    assert said.kind.startswith("HDF5, and no MAT file: ")
    ran(tmp_path, said.kind)
    assert pq.read_table(tmp_path / "a.parquet").select(["t", "T"]).equals(TABLE)


FIXED = """\
TIME                 T_FRONT   T_REAR       DZ       DX
2026-03-12 08:00:00    21.30    20.90      0.4  -2000.0
2026-03-12 08:01:00    21.76    21.02      2.0 -16000.0
2026-03-12 08:02:00             21.13      3.6-110000.0
2026-03-12 08:03:00    22.61    21.24           -6000.0
2026-03-12 08:04:00    22.61               3.7  -6000.0
2026-03-12 08:05:00                        3.7  -6000.0
2026-03-12 08:06:00    22.61    21.24      3.7  -6000.0
"""


def test_columns_of_fixed_width_become_a_csv(tmp_path: Path) -> None:
    (tmp_path / "run1.prn").write_text(FIXED)
    said = explain(tmp_path / "run1.prn")
    assert said.kind.startswith("text in columns of fixed width")
    assert "read_fwf('run1.prn')" in said.others["table"]
    draft = draft_files(tmp_path).campaign.read_text()
    assert "read_fwf('run1.prn')" in draft
    pytest.importorskip("pandas")
    ran(tmp_path, said.kind)
    assert (tmp_path / "run1.csv").read_text().count("\n") == FIXED.count("\n")


def test_a_scrape_of_prometheus_is_named(tmp_path: Path) -> None:
    one = '# HELP temp t\n# TYPE temp gauge\ntemp{s="a"} 21.3 1773298800000\ndisp_m 4e-07 1773298800000\n'
    (tmp_path / "scrape.prom").write_text(one * 8)
    assert explain(tmp_path / "scrape.prom").kind.startswith("the text of a scrape of Prometheus: export")


@pytest.mark.parametrize("nuls", [2, 70])
def test_a_text_with_bytes_that_are_zero_is_one(tmp_path: Path, nuls: int) -> None:
    rows = [f"2026-03-12 08:{k:02}:00\t{20 + k / 10}\t{k}" for k in range(40)]
    rows[20] = rows[20].replace("\t", "\0" * nuls, 1)
    (tmp_path / "run1.txt").write_text("Time\tT\tdZ\n" + "\n".join(rows) + "\n")
    said = explain(tmp_path / "run1.txt")
    assert said.kind.startswith(f"text that is damaged: {nuls} bytes in it are zero, the first in line 22: ")
    assert said.kind.endswith("tr '\\000' ' ' < run1.txt > run1_mended.txt")
    (tmp_path / "mended.txt").write_bytes((tmp_path / "run1.txt").read_bytes().replace(b"\0", b" "))
    assert explain(tmp_path / "mended.txt").reader is not None


@pytest.mark.parametrize(
    "text",
    [
        "Dear colleague\nthe probe was moved by 3 mm at 8:20\nand back at 9:00\n",
        "a note\n" * 12,
        "t T\n" + "".join(f"{k} {20 + k}\n" for k in range(20)),  # blanks part these
        "\n".join(f"step {k} of 20 is done, by hand" for k in range(20)),
    ],
)
def test_the_nearest_texts_are_none_of_these(tmp_path: Path, text: str) -> None:
    (tmp_path / "memo.txt").write_text(text)
    assert "fixed width" not in explain(tmp_path / "memo.txt").kind


def test_bytes_are_none(tmp_path: Path) -> None:
    (tmp_path / "x.dat").write_bytes(bytes(range(256)) * 20)
    assert explain(tmp_path / "x.dat").kind.startswith("binary; it starts with")


def test_a_data_set_of_three_columns_becomes_three(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["t"], file["tcp"] = np.arange(5.0), np.arange(15.0).reshape(5, 3)
    said = explain(tmp_path / "a.h5")
    assert "what other attributes say, as when it began, is yours to declare" in said.kind
    ran(tmp_path, said.kind)
    table = pq.read_table(tmp_path / "a.parquet")
    assert sorted(table.column_names) == ["t", "tcp_0", "tcp_1", "tcp_2"]
    assert table["tcp_1"].to_pylist() == [1, 4, 7, 10, 13]


def test_scales_and_units_of_data_sets_come_with_them(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        counts = np.array([100, 101, -32768, 103, 104], np.int16)
        for name, values, attributes in (
            ("t", np.arange(5.0), {"units": "seconds since 2026-04-20 06:00:00"}),
            ("T", counts, {"unit": "°C", "scale_factor": [0.01], "add_offset": 20.0, "_FillValue": counts[2:3]}),
        ):
            file[f"daq/{name}"] = values
            file[f"daq/{name}"].attrs.update(attributes)
        file["daq/serial"], file["daq/version"] = "4711", np.arange(2)
    ran(tmp_path, explain(tmp_path / "a.h5").kind)
    table = pq.read_table(tmp_path / "a.parquet").to_pydict()
    assert sorted(table) == ["T [°C]", "t [seconds since 2026-04-20 06:00:00]"]
    np.testing.assert_allclose(table["T [°C]"], [21.0, 21.01, np.nan, 21.03, 21.04])


def test_named_arrays_become_columns(tmp_path: Path) -> None:
    times = np.datetime64("2026-04-21T06:00", "ms") + 5000 * np.arange(5)
    np.savez(tmp_path / "run 1.npz", time=times, T=np.arange(5.0), tcp=np.arange(10.0).reshape(5, 2), gain=2.0)
    said = explain(tmp_path / "run 1.npz")
    assert said.kind.startswith("arrays of NumPy by their names (NPZ): make a Parquet file")
    assert (said.claims, said.advice) == ({}, None)
    ran(tmp_path, said.kind)
    table = pq.read_table(tmp_path / "run 1.parquet")
    assert table.column_names == ["time", "T", "tcp_0", "tcp_1"]
    assert table["time"].to_pylist()[1].second == 5


@pytest.mark.parametrize(
    ("name", "start", "what", "by"),
    [
        ("a.nc", b"CDF\x01\0\0\0\0", "netCDF (classic)", "scipy"),
        ("a.dat", b"CDF\x02\0\0\0\0", "netCDF (classic)", "scipy"),
        ("a.nc", b"\x89HDF\r\n\x1a\n", "netCDF-4 (HDF5)", "h5netcdf"),
        ("a.h5", b"\x89HDF\r\n\x1a\n" + bytes(90) + b"_NCProperties\0", "netCDF-4 (HDF5)", "h5netcdf"),
    ],
)
def test_netcdf_is_opened_by_what_knows_its_scales(tmp_path: Path, name: str, start: bytes, what: str, by: str) -> None:
    (tmp_path / name).write_bytes(start + bytes(200))
    said = explain(tmp_path / name)
    assert said.kind.startswith(f"{what}: make a Parquet file of it: python -c")
    assert f"pip install xarray pandas pyarrow {by}" in said.kind
    assert (said.claims, said.advice) == ({}, None)


@pytest.mark.parametrize("kind", ["NETCDF3_64BIT", "NETCDF4"])
def test_what_is_packed_in_netcdf_is_unpacked(tmp_path: Path, kind: str) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    times = np.datetime64("2026-04-20T06:00", "ns") + 10**9 * np.arange(5)
    data = xarray.Dataset({"T": ("time", [20.0, 20.5, np.nan, 21.0, 21.5], {"units": "degC"})}, {"time": times})
    data["T"].encoding = {"dtype": "int16", "scale_factor": 0.5, "add_offset": 20.0, "_FillValue": -1}
    data.to_netcdf(tmp_path / "a.nc", format=kind, engine="scipy" if kind == "NETCDF3_64BIT" else "h5netcdf")
    ran(tmp_path, explain(tmp_path / "a.nc").kind)
    table = pq.read_table(tmp_path / "a.parquet").to_pydict()
    np.testing.assert_allclose(np.array(table["T [degC]"], float), [20.0, 20.5, np.nan, 21.0, 21.5])
    assert str(table["time"][1]).startswith("2026-04-20 06:00:01")


@pytest.mark.parametrize("protocol", [2, 3, 4, 5])
def test_a_pickle_is_never_opened(tmp_path: Path, protocol: int) -> None:
    pytest.importorskip("pandas")
    (tmp_path / "a.pkl").write_bytes(pickle.dumps({"t": [0.0, 1.0], "T": [20.0, 21.0]}, protocol))
    said = explain(tmp_path / "a.pkl")
    assert said.kind.startswith("a pickle of Python, which is never opened, for it runs what stands in it: where you")
    assert said.advice is None
    ran(tmp_path, said.kind)
    assert pq.read_table(tmp_path / "a.parquet").column_names == ["t", "T"]


def office(path: Path, **parts: str) -> Path:
    with zipfile.ZipFile(path, "w") as file:
        for name, text in parts.items():
            file.writestr(name, text)
    return path


def test_a_sheet_of_another_office_and_a_document_are_named(tmp_path: Path) -> None:
    ods = office(
        tmp_path / "a.ods", mimetype="application/vnd.oasis.opendocument.spreadsheet", **{"content.xml": "<a/>"}
    )
    said = explain(ods)
    assert (said.kind, said.claims, said.advice) == ("ODS: save it as XLSX", {}, None)
    word = office(tmp_path / "a.docx", **{"[Content_Types].xml": "<a/>", "word/document.xml": "<a/>"})
    said = explain(word)
    assert (said.kind, said.claims) == ("a document of Word: save a table in it as XLSX or CSV", {})
    book = office(tmp_path / "a.xlsx", **{"[Content_Types].xml": "<a/>", "xl/workbook.xml": "<a/>"})
    assert list(explain(book).claims) == ["table"]


@pytest.mark.parametrize(
    ("name", "start", "what"),
    [
        ("X.raw", b"|CF,2,1,1;|CK,1,3,1,1;", "FAMOS of imc: export it"),
        (
            "a.tdm",
            b'<?xml version="1.0" encoding="UTF-8"?>\n<usi:tdm xmlns:usi="x">',
            "the header of a TDM data set of NI",
        ),
        ("a.DAT", b"DIAEXTENDED  {@:ENGLISH\r\n", "the header of a DIAdem data set: save it as TDMS"),
        ("a.BIN", bytes.fromhex("9413580200000c00") + b"catman test", "a binary file of catman: export it"),
        ("a.mea", bytes.fromhex("711700000100000004000000"), "a binary file of an HBM amplifier (MEA): export it"),
        ("a.dat", bytes.fromhex("006b000c00") + b"Q.brixx 101\0", "UDBF of Gantner: export it"),
        ("b.dat", bytes.fromhex("01006b000c") + b"Q.brixx 101\0", "UDBF of Gantner: export it"),
    ],
)
def test_files_of_measuring_systems_say_what_to_export(tmp_path: Path, name: str, start: bytes, what: str) -> None:
    (tmp_path / name).write_bytes(start + bytes(range(256)) * 4 if name != "a.tdm" else start)
    said = explain(tmp_path / name)
    assert said.kind.startswith(what)
    assert (said.claims, said.advice) == ({}, None)


def test_json_with_paths_of_a_control_is_no_trace(tmp_path: Path) -> None:
    signals = ", ".join(f'{{"Name": "/Channel/Spindle/x{k}", "Value": {k}}}' for k in range(9))
    (tmp_path / "amw.json").write_text(f'{{"Header": {{"Version": "3"}},\n"Signals": [{signals}]}}\n')
    said = explain(tmp_path / "amw.json")
    assert (said.kind, said.claims) == ("JSON: export it as CSV", {})


def test_a_universal_file_with_binary_sets_is_named(tmp_path: Path) -> None:
    head = b"    -1\n    58b     1     2          11        2880     0     0           0           0\n"
    (tmp_path / "n3000.uff").write_bytes(head + b"dZ\n" * 11 + np.arange(360.0).tobytes() + b"\n    -1\n")
    said = explain(tmp_path / "n3000.uff")
    assert said.kind.startswith("a universal file (UFF 58b)")
    assert "pyuff.UFF('n3000.uff')" in said.kind
    assert said.advice is None


@pytest.mark.parametrize(
    ("name", "start", "what", "do"),
    [
        ("bag_0.db3", b"SQLite format 3\0" + bytes(80), "a bag of ROS 2", "mcap convert bag_0.db3 bag_0.mcap"),
        ("log.db", b"SQLite format 3\0" + bytes(80), "an SQLite database", "sqlite3 -header -csv log.db"),
        ("hall.ttd", b"File format: Tinytag 4\r\nPK\x03\x04" + bytes(80), "Tinytag", "unzip -p hall.ttd"),
        ("run.dxd", b"\0\0DEWESoft DXD\0\x01\x02" + bytes(80), "a recording of Dewesoft", "MAT, CSV or MDF"),
    ],
)
def test_recordings_of_other_programs_are_named(tmp_path: Path, name: str, start: bytes, what: str, do: str) -> None:
    (tmp_path / name).write_bytes(start)
    said = explain(tmp_path / name)
    assert what in said.kind
    assert do in said.kind
    assert said.advice is None


def test_letters_that_were_encoded_twice_are_shown_as_they_were_meant(tmp_path: Path) -> None:
    meant = "Zeit;Spindelkühlung [°C];Weg [µm]"
    rows = "".join(f"2026-03-01 08:0{i}:00;21.{i};3\n" for i in range(9))
    (tmp_path / "a.csv").write_text(meant.encode().decode("cp1252") + "\n" + rows, encoding="utf-8")
    assert f", meant '{meant}': its letters were encoded twice" in explain(tmp_path / "a.csv").kind
    (tmp_path / "a.csv").write_text(meant + "\n" + rows, encoding="utf-8")
    assert "twice" not in explain(tmp_path / "a.csv").kind
