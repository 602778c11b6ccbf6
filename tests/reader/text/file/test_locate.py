"""Where rows stand, and a table without its header."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Block, Loss
from thermodata.reader.text.file.lines import chunks, from_line, split_last_line
from thermodata.reader.text.file.locate import line_of, lines_of


def block(stream: str, *at: int) -> Block:
    return Block(stream, np.arange(len(at)), {}, None, np.array(at, np.int64))


ITEMS = [block("a", 3, 5), block("b", 4), Loss("x", reason="y"), block("a"), block("a", 9, 6)]


@pytest.mark.parametrize(
    ("row", "one", "several"),
    [
        (0, "line 3", "lines 3 to 4"),
        (1, "line 5", "line 5"),
        (2, "line 9", "line 9"),
        (3, "line 6", "lines 6 to 8"),
        (4, None, None),
    ],
)
def test_a_row_tells_its_lines(row: int, one: str | None, several: str | None) -> None:
    assert line_of(ITEMS, "a", row) == one
    assert lines_of(ITEMS, "a", row) == several


def test_rows_that_do_not_say_where_they_stand_are_told_by_nobody() -> None:
    assert line_of([Block("a", np.arange(2), {})], "a", 1) is None
    assert line_of(ITEMS, "c", 0) is None


@pytest.mark.parametrize("size", [3, 8, 1 << 20])
def test_a_table_without_its_header(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(b"name\n\nT\n1\n2\n3")
    parts = list(from_line(chunks(path, "utf-8", size), 3))
    assert b"".join(part.data for part in parts) == b"1\n2\n3"
    assert parts[0].line == 3
    assert parts[-1].last
    assert list(from_line(chunks(path, "utf-8", size), 60))[-1].data == b""
    assert split_last_line(b"1\n2\n3") == (b"1\n2\n", b"3")
    assert split_last_line(b"3") == (b"", b"3")
