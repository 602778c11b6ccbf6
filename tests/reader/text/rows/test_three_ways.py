"""Rows by Arrow's types, by Arrow's text and line by line are the same rows; and where they stand."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from thermodata.reader.text.cells.values.number import to_float
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.rows.grid import TIME, Grid, Rows
from thermodata.reader.text.rows.odd_rows import line_by_line
from thermodata.reader.text.rows.typed import _as_text, _typed, parse

FIRST = 17  # the line of the file that a part begins with
KINDS = (TIME, "float64", "str", "int64", "bool")
CELLS = (
    st.sampled_from(["2026-03-02 08:00:00", "08:00", "", "x"]),
    st.sampled_from(["1.5", "-7", "1e3", "", "NaN", "OL", "x", "1e999", "1_000", str(2**53 + 1), "TRUE", " 4 ", '"5"']),
    st.sampled_from(["on", "", "---", "é", '"a b"', " x ", '""']),
    st.sampled_from(["3", "", "-1", str(2**62), "x", "2.0", "1.5"]),
    st.sampled_from(["TRUE", "false", "", "wahr", "1"]),
)
ROW = st.tuples(*CELLS).map(list)
DAMAGE = st.one_of(
    ROW.flatmap(lambda r: st.sampled_from([r[:4], [*r, ""], [*r, "", ""], [*r, "x"], r[:1]])),
    st.sampled_from([[""], ["", "", "", "", ""], ["junk"], ["   "], [""] * 9]),
)
TABLES = st.lists(st.one_of(ROW, ROW, ROW, DAMAGE), min_size=1, max_size=12)


def shown(rows: Rows) -> tuple[object, ...]:
    """All that is told of rows, to compare."""
    columns = {
        i: ([repr(v) for v in c.values.tolist()], c.empty.tolist(), c.over.tolist(), c.odd)
        for i, c in rows.columns.items()
    }
    times = {i: [cell or "" for cell in t.to_pylist()] for i, t in rows.times.items()}
    bad = [(b.line, b.cells, b.text) for b in rows.bad]
    return rows.line.tolist(), columns, times, bad, rows.short.tolist()


@settings(deadline=None, max_examples=400)
@given(TABLES, st.sampled_from(["\n", "\r\n"]), st.booleans(), st.sampled_from([None, 3]), st.booleans())
@example([["08:00", "1.5", "on", "3", "TRUE"], ["08:01", "OL", "on", "3", "TRUE"]], "\n", False, None, False)
@example(
    [["08:00", "1.5", "on", "3", "TRUE"], ["08:01", "", "on", "3", ""], ["", "", '""', ""]], "\n", False, None, False
)
def test_three_ways_give_the_same_rows(
    table: list[list[str]], end: str, exact: bool, least: int | None, blank_rows: bool
) -> None:
    data = "".join(";".join(row) + end for row in table).encode()
    if data.isspace():
        return
    grid = Grid(";", ".", KINDS, quoted=True, least=least, exact=exact, blank_rows=blank_rows)
    slow = shown(line_by_line(data, FIRST, grid))
    for fast in (_typed, _as_text):
        found = fast(data, FIRST, grid)
        if found is not None:
            assert shown(found) == slow, fast.__name__
    assert shown(parse(data, FIRST, grid)) == slow


@settings(deadline=None, max_examples=200)
@given(TABLES, st.sampled_from([None, 3]), st.booleans())
def test_rows_stand_where_an_editor_shows_them(table: list[list[str]], least: int | None, exact: bool) -> None:
    """Against a reading as plain as can be."""
    grid = Grid(";", ".", KINDS, quoted=True, least=least, exact=exact)
    lines, floats, bad, short = [], [], [], []
    for number, row in enumerate(table, FIRST):
        cells = next(csv.reader(io.StringIO(";".join(row)), delimiter=";"), [""])
        filled = [clean(c) for c in cells]
        if not any(c.strip() for c in cells):
            continue
        while not exact and len(filled) > len(KINDS) and not any(filled[len(KINDS) :]):
            filled.pop()
        if least is not None and least <= len(filled) < len(KINDS):
            short.append(number)
            filled += [""] * (len(KINDS) - len(filled))
        if len(filled) != len(KINDS):
            bad.append((number, len(cells)))
            continue
        lines.append(number)
        value = to_float(filled[1]) if filled[1] not in ("", "NaN", "OL") else None
        floats.append(np.nan if value is None else value)
    data = "".join(";".join(row) + "\n" for row in table).encode()
    found = parse(data, FIRST, grid)
    assert found.line.tolist() == lines
    np.testing.assert_array_equal(found.columns[1].values, floats)
    assert [(b.line, b.cells) for b in found.bad] == bad
    assert found.short.tolist() == short


@settings(deadline=None)
@given(st.lists(ROW, min_size=2, max_size=8), st.data())
def test_a_part_and_its_pieces_give_the_same_rows(table: list[list[str]], data: st.DataObject) -> None:
    lines = [(";".join(row) + "\n").encode() for row in table]
    cut = data.draw(st.integers(1, len(lines) - 1))
    grid = Grid(";", ".", KINDS, quoted=True)
    whole = parse(b"".join(lines), FIRST, grid)
    parts = [parse(b"".join(lines[:cut]), FIRST, grid), parse(b"".join(lines[cut:]), FIRST + cut, grid)]
    assert whole.line.tolist() == [n for part in parts for n in part.line.tolist()]
    for i in whole.columns:
        joined = [repr(v) for part in parts for v in part.columns[i].values.tolist()]
        assert [repr(v) for v in whole.columns[i].values.tolist()] == joined


@pytest.mark.parametrize("kinds", [KINDS[:2], (TIME, "int64"), (TIME, "bool")])
def test_the_fast_way_is_taken_by_good_parts(kinds: Sequence[str]) -> None:
    cell = {"float64": "1.5", "int64": "3", "bool": "TRUE"}[kinds[1]]
    grid = Grid(";", ".", tuple(kinds))
    assert _typed(f"08:00;{cell}\n08:01;\n\n".encode(), 0, grid) is not None
    assert _typed(f"08:00;{cell}\n08:01;x\n".encode(), 0, grid) is None
    assert _as_text(f"08:00;{cell}\n08:01;x\njunk\n".encode(), 0, grid) is not None


@pytest.mark.parametrize("number", [str(2**53 + 1), f"-{2**53 + 1}", "1e999"])
def test_a_number_that_would_be_rounded_is_no_number_in_any_way(number: str) -> None:
    grid = Grid(";", ".", ("float64", "str"))
    found = parse(f"1;a\n{number};b\n".encode(), 0, grid)
    assert found.columns[0].odd == ((1, number),)
    np.testing.assert_array_equal(found.columns[0].values, [1.0, np.nan])
    exact = parse(f"{2**53};a\n{-(2**53)};b\n".encode(), 0, grid)
    assert exact.columns[0].values.tolist() == [2.0**53, -(2.0**53)]
    assert exact.columns[0].odd == ()


def test_cells_in_quotes_over_lines_and_quotes_that_stay_open() -> None:
    grid = Grid(";", ".", ("float64", "str"), quoted=True)
    rows = parse(b'1;"a\nb"\n2;c\n3;"d\n4;e\n', 10, grid)
    assert rows.line.tolist() == [10, 12, 13, 14]
    assert rows.columns[1].values.tolist() == ["a\nb", "c", "d", "e"]
    assert rows.bad == ()


def test_a_cell_over_lines_moves_no_other_row() -> None:
    rows = parse(b'1;"a\nb"\n2;c\n', 10, Grid(";", ".", ("float64", "str"), quoted=True))
    assert rows.line.tolist() == [10, 12]
    assert rows.columns[1].values.tolist() == ["a\nb", "c"]


def test_two_quotes_that_stay_open_take_no_row_with_them() -> None:
    """Where what stands between them would be no row."""
    rows = parse(b'1;2;"a\n3;"b;4\n5;6;c\n', 10, Grid(";", ".", ("float64", "str", "str"), quoted=True))
    assert rows.line.tolist() == [10, 11, 12]
    assert rows.columns[1].values.tolist() == ["2", "b", "6"]
    assert rows.columns[2].values.tolist() == ["a", "4", "c"]


def test_bytes_of_zero_are_told_with_their_line() -> None:
    rows = parse(b"1;a\n\0\0\0\n\0\x002;b\n", 5, Grid(";", ".", ("float64", "str")))
    assert rows.nul == ((6, 3), (7, 2))
    assert rows.line.tolist() == [5, 7]
    assert rows.columns[0].values.tolist() == [1.0, 2.0]
    before = rows.before(7)
    assert (before.line.tolist(), before.nul) == ([5], ((6, 3),))
    assert parse(b"\0\0", 5, Grid(";", ".", ("float64",))).nul == ((5, 2),)


def test_one_line_of_a_million_cells_is_no_row() -> None:
    data = b"1;a\n" + b";" * 1_000_000 + b"x\n2;b\n"
    rows = parse(data, 0, Grid(";", ".", ("float64", "str")))
    assert rows.line.tolist() == [0, 2]
    assert [(b.line, b.cells, len(b.text)) for b in rows.bad] == [(1, 1_000_001, 200)]
