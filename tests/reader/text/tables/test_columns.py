"""What a column holds, just below and above each limit; and its decimal mark."""

from __future__ import annotations

import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.values.number import EXACT
from thermodata.reader.text.tables.sample.columns import dtype_of, find_decimal


@pytest.mark.parametrize(
    ("cells", "name", "unit", "dtype"),
    [
        # nothing at all
        ([], "T1", None, "float64"),
        (["", "---", "OL"], "T1", None, "float64"),
        (["", ""], "comment", None, "str"),
        (["", ""], "comment", "degC", "float64"),
        # words: half of what is filled, however many cells are empty
        (["1", "2", "x"], "T1", None, "float64"),
        (["1", "x"], "T1", None, "str"),
        (["1", "2", "x", "", "---", "OL", "NaN"], "T1", None, "float64"),
        (["1", "x", "", "2", "y"], "T1", None, "str"),
        # a few words in what is called a comment
        ([*["1"] * 9, "x"], "Bemerkung", None, "float64"),
        ([*["1"] * 9, "x", "y"], "Bemerkung", None, "str"),
        ([*["1"] * 9, "x", "y"], "T1", None, "float64"),
        ([*["1"] * 98, "x", "y"], "alarm", None, "float64"),
        ([*["1"] * 97, "x", "y", "z"], "alarm", None, "str"),
        ([*["1"] * 200, "x", "y", "z", "v"], "alarm", None, "float64"),
        # truth values
        (["TRUE", "falsch", "", "True"], "ok", None, "bool"),
        (["TRUE", "FALSE", "1"], "ok", None, "float64"),
        (["TRUE", "FALSE", "1", "maybe"], "ok", None, "float64"),
        # integers that a float64 would change
        ([str(EXACT)], "n", None, "float64"),
        ([str(EXACT + 1)], "n", None, "int64"),
        ([str(-EXACT - 1), "1", ""], "n", None, "int64"),
        ([str(2**63 - 1)], "n", None, "int64"),
        ([str(2**63)], "n", None, "float64"),
        ([str(EXACT + 1), "1.5", "2"], "n", None, "float64"),
        ([str(EXACT + 1), "x", "2"], "n", None, "float64"),
        (["0", "1", "1"], "n", None, "float64"),
    ],
)
def test_the_dtype_of_a_column(cells: list[str], name: str, unit: str | None, dtype: str) -> None:
    assert dtype_of(cells, name, unit) == dtype


@pytest.mark.parametrize(
    ("columns", "delimiter", "mark"),
    [
        ([["1", "2"]], ";", None),
        ([["1.5", "2"]], ";", "."),
        ([["1,5"], ["2"]], ";", ","),
        ([["1,5"], ["1.234,5"]], "\t", ","),
        ([["1", "x,y"]], ",", "."),
        ([["1,5", "20,25"]], ",", ","),
        ([["8,000", "7.5"]], ",", "."),
        ([["8,000", "7,25"]], ",", ","),
        ([["1,234,567.5"]], ",", "."),
    ],
)
def test_the_decimal_mark_of_the_numbers(columns: list[list[str]], delimiter: str, mark: str | None) -> None:
    assert find_decimal(columns, delimiter, "a.csv") == mark


def test_marks_that_may_be_either_are_asked() -> None:
    for marks, cell, delimiter, fraction in (("commas", "8,000", ",", ","), ("points", "8.000", ";", ".")):
        with pytest.raises(QuestionError, match=f"{marks} that may part thousands") as error:
            find_decimal([[cell, "12" + cell[1:]]], delimiter, "a.csv")
        assert error.value.where == "a.csv"
        assert error.value.declare == {"decimal": "unknown"}
        assert error.value.meanwhile == {"decimal": fraction}
    with pytest.raises(FormatError, match="decimal point and with a decimal comma"):
        find_decimal([["1,5"], ["1.5"]], ";", "a.csv")


def test_the_mark_of_a_column_is_looked_for_among_its_fractions() -> None:
    """Which may stand behind any number of whole numbers."""
    assert find_decimal([["7"] * 5000 + ["7,5"]], ";", "a.csv") == ","


HIGH = [f"{80 + k % 9}.{600 + k % 7}" for k in range(500)]


@pytest.mark.parametrize("told", ["0.000", "-0.125", "7.25", "1234"])
def test_one_number_far_below_tells_that_points_begin_fractions(told: str) -> None:
    """An axis that runs for hours before it rests, at three decimals."""
    assert find_decimal([HIGH, [*HIGH, told]], ";", "a.csv") == "."


@pytest.mark.parametrize("silent", ["0", "950", "81.000", "-9.125", "---"])
def test_numbers_far_below_that_may_be_either_are_asked_all_the_same(silent: str) -> None:
    with pytest.raises(QuestionError, match="points that may part thousands"):
        find_decimal([HIGH, [*HIGH, silent]], ";", "a.csv")


def test_a_comma_far_below_points_that_may_part_thousands_is_asked_as_both_marks() -> None:
    with pytest.raises(QuestionError, match="decimal point and with a decimal comma"):
        find_decimal([HIGH, [*HIGH, "7,25"]], ";", "a.csv")
