"""What stands between cells: by most lines, whatever the preamble is and whichever mark the numbers have."""

from __future__ import annotations

import pytest

from thermodata.reader.text.cells.lines.delimiter import declared, fields, find_delimiter


@pytest.mark.parametrize(
    ("lines", "delimiter"),
    [
        (["a;b", "1,5;2,5", "2,5;3,5"], ";"),
        (["a\tb", "1,5\t2,5", "2,5\t3,5"], "\t"),
        (["a,b", "1.5,2.5"], ","),
        (["a|b", "1|2"], "|"),
        (["a,b", '"x;y",1', '"x;z",2'], ","),
        (["one, two", "three; four; five", "six", "seven", "eight", "nine"], None),
        (["a,b", "c,d", "a,b,c", "a,b,c,d", "a,b,c,d,e", "x"], None),
        (["no table at all", "of any kind"], None),
        ([], None),
        (["sep=|", "a;b", "1;2"], "|"),
        # more lines agree on a comma, but hardly: it may be a decimal mark
        (["t;T", *["0;1,5"] * 9, "torn"], ";"),
        (["t;T", *["0;1,5"] * 8, "0,5"], ";"),
        # a preamble that agrees on something else
        ([*["name,value"] * 4, *["1;2;3"] * 8], ";"),
        ([*["name;value"] * 6, *["1,2,3"] * 6], ","),
        # blanks part numbers with decimal commas; a date, a time of day and what a comma parts from it they do not
        (["t  T", *["0  1,5", "10  2,5"] * 3], " "),
        (["2025-10-25 22:00:00 1,5", "2025-10-25 22:00:10 2,5"], " "),
        (["time,T", *["2025-10-25 22:00:00,0", "2025-10-25 22:00:10,1"] * 3], ","),
        (["time,T", *["2025-10-25 22:00:00.5,0.25", "2025-10-25 22:00:10.5,1.5"] * 3], ","),
    ],
)
def test_the_delimiter_of_most_lines(lines: list[str], delimiter: str | None) -> None:
    assert find_delimiter(lines) == delimiter


@pytest.mark.parametrize(
    ("line", "cells"),
    [
        ('1;"a;b";2', ["1", "a;b", "2"]),
        ('1;"a""b"', ["1", 'a"b']),
        ('1;"a;2', ["1", '"a', "2"]),
        ("", [""]),
        (";", ["", ""]),
    ],
)
def test_cells_of_a_line(line: str, cells: list[str]) -> None:
    assert fields(line, ";") == cells
    assert fields(line, ";", quoted=False) == line.split(";")


def test_a_cell_that_no_parser_takes_is_cut_by_its_delimiters() -> None:
    long = "x" * 200_000
    assert fields(f'"{long}";1', ";") == [f'"{long}"', "1"]


def test_words_for_delimiters() -> None:
    assert [declared(word) for word in ("tab", "\\t", "semicolon", "comma", "|")] == ["\t", "\t", ";", ",", "|"]
