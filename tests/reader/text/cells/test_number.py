"""The policy of a cell: what is a number, what is nothing, and that whole columns are judged as single cells are."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.errors import FormatError
from thermodata.reader.text.cells.values.column import values_of
from thermodata.reader.text.cells.values.number import (
    EXACT,
    is_empty,
    is_number,
    is_overload,
    to_bool,
    to_float,
    to_int,
    why_none,
)
from thermodata.reader.text.cells.values.quotes import clean


@pytest.mark.parametrize(
    ("cell", "decimal", "value"),
    [
        ("20.5", ".", 20.5),
        ("20,5", ",", 20.5),
        ("20,5", ".", None),
        ("20.5", ",", None),
        (".5", ".", 0.5),
        ("5.", ".", 5.0),
        ("-1.5e-3", ".", -0.0015),
        ("1,5E+02", ",", 150.0),
        ("+   23.5", ".", 23.5),
        ("- 3,5", ",", -3.5),
        ("1 234,5", ",", 1234.5),
        ("1\u00a0234.5", ".", 1234.5),
        ("1'234.5", ".", 1234.5),
        ("1’234’567", ".", 1234567.0),
        ("1.234,5", ",", 1234.5),
        ("1,234.5", ".", 1234.5),
        ("1.234.567", ",", 1234567.0),
        ("1.500", ",", None),
        ("1,500", ".", None),
        ("12.34,5", ",", None),
        ("inf", ".", np.inf),
        ("-Infinity", ",", -np.inf),
        ("TRUE", ".", 1.0),
        ("falsch", ",", 0.0),
        ("1e308", ".", 1e308),
        ("1e999", ".", None),
        ("1_000", ".", None),
        ("0x1F", ".", None),
        ("12 %", ".", None),
        ("١٢٣", ".", None),
        ("1.5.5", ".", None),
        (str(EXACT), ".", float(EXACT)),
        (str(EXACT + 1), ".", None),
        (str(EXACT + 2), ".", float(EXACT + 2)),
        (f"-{EXACT + 1}", ".", None),
        (f"{EXACT + 1}.0", ".", float(EXACT)),
    ],
)
def test_numbers(cell: str, decimal: str, value: float | None) -> None:
    assert to_float(cell, decimal) == value


def test_a_declared_mark_tells_thousands_from_fractions() -> None:
    assert to_float("1.500", ",", declared=True) == 1500.0
    assert to_float("1,500", ".", declared=True) == 1500.0
    assert to_float("0.500", ",", declared=True) is None  # no thousands begin with 0
    assert to_float("0,500", ".", declared=True) is None


@pytest.mark.parametrize(
    ("cell", "value"),
    [
        ("7", 7),
        ("+7", 7),
        ("- 7", -7),
        (str(2**63 - 1), 2**63 - 1),
        (str(2**63), None),
        (str(-(2**63)), -(2**63)),
        (str(-(2**63) - 1), None),
        ("7.0", 7),
        ("7.5", None),
        ("1e3", 1000),
        ("1e300", None),
        ("inf", None),
        ("x", None),
    ],
)
def test_integers(cell: str, value: int | None) -> None:
    assert to_int(cell) == value


def test_unsigned_integers_have_limits_of_their_own() -> None:
    assert to_int(str(2**64 - 1), dtype="uint64") == 2**64 - 1
    assert to_int(str(2**64), dtype="uint64") is None
    assert to_int("-1", dtype="uint64") is None


@pytest.mark.parametrize(
    "word", ["", " ", "---", "#N/A", "n/a", "NaN", "NULL", "UNAVAILABLE", "Unavailable", "-1.#IND"]
)
def test_words_for_nothing(word: str) -> None:
    assert is_empty(word)
    assert not is_overload(word)


@pytest.mark.parametrize(
    "word", ["OL", "-OL", "+OVER", "Overload", "BURNOUT", "over range", "+++++++", "Open TC", "+FFFFFFF", "-FFFFFFF"]
)
def test_words_for_overload(word: str) -> None:
    assert is_overload(word)
    assert not is_empty(word)


@pytest.mark.parametrize("word", ["ERR", "open", "0", "nothing", "-" * 13, "o"])
def test_other_words_are_neither(word: str) -> None:
    assert not is_empty(word)
    assert not is_overload(word)


def test_truth_values() -> None:
    assert [to_bool(c) for c in ("TRUE", "wahr", "False", "FALSCH", "1", "ja")] == [
        True,
        True,
        False,
        False,
        None,
        None,
    ]


def test_a_loss_says_why() -> None:
    assert why_none("1.500", "float64", ",") == (
        "'1.500' may be thousands or a fraction: declare table: {decimal: ','} or '.'"
    )
    assert why_none(str(EXACT + 1), "float64") == f"an integer that float64 would round, got '{EXACT + 1}'"
    assert why_none("x" * 99, "float64") == f"expected a number, got '{'x' * 40}'"
    assert why_none("7.5", "int64") == "expected a whole number of 64 bits, got '7.5'"
    assert why_none("ja", "bool") == "expected TRUE or FALSE, got 'ja'"


CELLS = st.one_of(
    st.sampled_from(["", "---", "NaN", "OL", "ERR", "1e999", "1_000", "TRUE", "inf", "-inf", "1.500", "1,500", "0x10"]),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.integers(-(2**70), 2**70).map(str),
    st.decimals(-1000, 1000, places=3).map(str),
    st.decimals(-1000, 1000, places=2).map(lambda d: str(d).replace(".", ",")),
    st.text(alphabet="0123456789.,eE+- '%", max_size=8),
)


@settings(deadline=None)
@given(st.lists(CELLS, min_size=1, max_size=8), st.sampled_from(".,"), st.booleans())
def test_a_column_is_judged_as_its_cells_are(cells: list[str], decimal: str, declared: bool) -> None:
    """By Arrow, a hundred cells at once and more, and one by one."""
    many = values_of(cells * 100, "float64", decimal, declared)
    few = values_of(cells, "float64", decimal, declared)
    for found, times in ((many, 100), (few, 1)):
        for at, cell in enumerate(cells * times):
            value = (
                None if is_empty(cell) or is_overload(cell) else to_float(cell.strip().strip('"'), decimal, declared)
            )
            assert found.empty[at] == (value is None)
            assert found.over[at] == is_overload(cell)
            np.testing.assert_array_equal(found.values[at], np.nan if value is None else value)
            assert ((at, cell.strip()) in found.odd) == (value is None and not is_empty(cell) and not is_overload(cell))


@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("others", [["7"], ["7", "x"]], ids=["plain", "one is none"])
def test_no_column_rounds_an_integer(decimal: str, others: list[str]) -> None:
    """Whichever way it is parsed; 2**53 is the last that stands for itself alone."""
    cells = [*others * 100, str(EXACT + 1), str(-EXACT - 1), str(EXACT)]
    found = values_of(cells, "float64", decimal)
    assert [cell for _, cell in found.odd if cell != "x"] == [str(EXACT + 1), str(-EXACT - 1)]
    np.testing.assert_array_equal(found.values[-3:], [np.nan, np.nan, EXACT])


def test_what_stands_around_a_cell_is_no_part_of_it() -> None:
    assert [clean(c) for c in (' "a b" ', "\ufeff x", '""', '" "', "'", '"', '"""')] == [
        "a b",
        "x",
        "",
        "",
        "'",
        '"',
        '"',
    ]


def test_integers_and_truth_values_of_a_column() -> None:
    found = values_of(["1", "---", "x", str(EXACT + 1), "OL"], "int64")
    assert found.values.tolist() == [1, 0, 0, EXACT + 1, 0]
    assert found.empty.tolist() == [False, True, True, False, True]
    assert found.over.tolist() == [False, False, False, False, True]
    assert found.odd == ((2, "x"),)
    found = values_of(["TRUE", "", "falsch", "2"], "bool")
    assert found.values.tolist() == [True, False, False, False]
    assert found.odd == ((3, "2"),)


def test_text_keeps_its_words() -> None:
    assert values_of(['"a b"', " ", "---", "x"], "str").values.tolist() == ["a b", None, "---", "x"]


def test_what_counts_as_a_number_for_a_layout() -> None:
    assert all(is_number(c) for c in ("1", "1,5", "1.5", "1 234,5", "1.234,5", "+  2", "inf", str(2**70)))
    assert not any(is_number(c) for c in ("", "TRUE", "1_000", "x", "1.5.5", "08:00"))


def test_both_marks_in_a_file_are_refused() -> None:
    from thermodata.reader.text.cells.values.number import decimal_mark

    assert decimal_mark(["1", "2"]) is None
    assert decimal_mark(["1.5", "2"]) == "."
    assert decimal_mark(["1,5", "1.234,5"]) == ","
    with pytest.raises(FormatError, match="decimal point and with a decimal comma"):
        decimal_mark(["1.5", "1,5"])
