"""Rows of delimited text: shorter rows, rows of delimiters alone, a last line that may be cut, and what is imported."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from thermodata.reader.text.file.lines import chunks, without_cut_line
from thermodata.reader.text.rows.grid import Grid
from thermodata.reader.text.rows.typed import parse

KINDS = ("float64", "float64", "str")


TEXT, LINES = "x\t4\n", "9\0\t9\n"  # a line by which a part is parsed as text, or line by line


@pytest.mark.parametrize(("odd", "kept"), [("", True), (TEXT, True), (LINES, True), (TEXT, False), (LINES, False)])
def test_rows_of_delimiters_alone_are_rows_where_rows_are_counted(odd: str, kept: bool) -> None:
    rows = parse(f"1\t2\n\n\t\n5\t6\n{odd}".encode(), 10, Grid("\t", ".", KINDS, least=2, blank_rows=kept))
    wanted = [10, 12, 13] if kept else [10, 13]
    assert rows.line.tolist() == wanted + ([14] if odd else [])
    np.testing.assert_array_equal(rows.columns[0].values[: len(wanted)], [1, np.nan, 5] if kept else [1, 5])


def test_rows_that_lack_their_last_cell_read_as_the_others() -> None:
    rows = parse(b"1\t2\n3\t4\tlost\n5\tx\n", 0, Grid("\t", ".", KINDS, least=2))
    assert rows.columns[2].values.tolist() == [None, "lost", None]
    np.testing.assert_array_equal(rows.columns[1].values, [2, 4, np.nan])
    assert rows.columns[1].odd == ((2, "x"),)
    assert rows.short.tolist() == [0, 2]


@pytest.mark.parametrize(
    ("data", "kept", "cut"),
    [
        (b"1\t2.25\n3\t4.5", b"1\t2.25\n", True),
        (b"1\t2.25\n3\t4.50", b"1\t2.25\n3\t4.50", False),
        (b"3\t4.50", b"", True),
        (b"1\t2\n", b"1\t2\n", False),
        (b"", b"", False),
    ],
)
def test_a_last_line_that_may_be_cut_is_left_out(data: bytes, kept: bytes, cut: bool) -> None:
    assert without_cut_line(data, "\t") == (kept, cut)


@pytest.mark.parametrize("size", [1, 7, 64, 1 << 20])
def test_chunks_of_any_size_hold_whole_lines(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes("first line\nsecond, with an ž\nlast".encode())
    found = list(chunks(path, "utf-8", size))
    assert b"".join(c.data for c in found) == path.read_bytes()
    assert all(c.data.endswith(b"\n") for c in found[:-1] if c.data)
    assert [c.line for c in found] == [sum(b.data.count(b"\n") for b in found[:i]) for i in range(len(found))]


def test_a_part_that_reads_at_once_imports_no_pandas() -> None:
    # Arrow may still start a thread when so short a process ends, which aborts it (1 of 200 on a busy machine)
    code = (
        "import os, sys; from thermodata.reader.text.rows.grid import Grid; "
        "from thermodata.reader.text.rows.typed import parse; "
        "r = parse(b'1;2;a\\n3;;b\\n', 0, Grid(';', '.', ('float64', 'int64', 'str'))); "
        "assert r.columns[1].empty.tolist() == [False, True]; assert 'pandas' not in sys.modules; os._exit(0)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
