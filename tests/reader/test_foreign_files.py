"""Files that no reader takes: `sniff` says what they are and gives the line that makes a table of them, which works."""

from __future__ import annotations

import re
import sqlite3
import subprocess
import sys
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
    found = re.search(r'python -c "(.*?)"(?:,|;|$| )', kind)
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
    ran(tmp_path, said.kind, TIME="t", SIGNAL="T")
    assert pq.read_table(tmp_path / "a.parquet").equals(TABLE)


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
