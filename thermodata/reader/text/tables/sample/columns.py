"""What the value columns of a table hold, told from sampled cells: numbers, truth values, big integers, text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.values.no_value import EMPTY, OVERLOAD
from thermodata.reader.text.cells.values.number import (
    EXACT,
    decimal_mark,
    is_number,
    may_be_thousands,
    to_bool,
    to_float,
)
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.names.of_text import OF_TEXT
from thermodata.reader.times.open_questions import UNKNOWN

# of fewer digits than an integer that float64 would change has
_PLAIN = re.compile(r"(?:[+-]?\d{1,15}(?:[.,]\d{1,15})?(?:\n|\Z))+", re.ASCII)
_INTEGER = re.compile(r"[+-]?\d{1,19}", re.ASCII)
_FRACTIONS = 200  # cells of a column that are asked for their decimal mark
_SHARE = 0.1  # of a column's numbers other than 0; fewer are told as losses
_ONE_GROUP = re.compile(r"[+-]?[1-9]\d{0,2}\.\d{3}", re.ASCII)
_BARE_THOUSANDS = re.compile(r"[+-]?\d{4,}", re.ASCII)
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+", re.ASCII)


def dtype_of(cells: Sequence[str], name: str = "", unit: str | None = None) -> str:
    """The dtype of a column by sampled cells: float64 where more than half of those that hold anything are numbers, but
    int64 where a float64 would change one, bool where all are TRUE or FALSE, else str. A few words in a column that is
    called a comment, an alarm or the like make it text; such a column without any cell is text too.

    It does not depend on how long the file is: integers are float64 like other numbers.
    """
    if _PLAIN.fullmatch("\n".join(cells)):  # nearly every column, told by one look instead of one a cell
        return "float64"
    full = [c for c in map(clean, cells) if c.casefold() not in EMPTY and c.casefold() not in OVERLOAD]
    if not full:
        return "str" if unit is None and OF_TEXT.search(name) else "float64"
    if all(to_bool(c) is not None for c in full):
        return "bool"
    numbers = sum(is_number(c) or to_bool(c) is not None for c in full)
    words = len(full) - numbers
    if 2 * words >= len(full) or (words > max(1, 0.02 * len(full)) and OF_TEXT.search(name)):
        return "str"
    if not words and all(_INTEGER.fullmatch(c) for c in full):
        most = max(abs(int(c)) for c in full)
        return "int64" if EXACT < most < 2**63 else "float64"
    return "float64"


def kind_of(cells: Sequence[str], name: str, unit: str | None) -> str | None:
    """The dtype of a column that is no time; None of the empty one of rows that end with a delimiter."""
    if name.startswith("column ") and unit is None and not any(map(clean, cells)):
        return None
    return dtype_of(cells, name, unit)


def dtype_of_counts(cells: Sequence[str]) -> str:
    """The dtype of counts since a date: of nanoseconds or ticks they are too long for a float64."""
    whole = [c for c in map(clean, cells) if c.lstrip("-").isdecimal()]  # a few cells may be torn
    return "int64" if 2 * len(whole) > len(cells) and dtype_of(whole) == "int64" else "float64"


def find_decimal(columns: Iterable[Sequence[str]], delimiter: str, where: str) -> str | None:
    """The decimal mark of the number cells of some columns; None where none has a fraction.

    QuestionError: both marks occur; commas stand in quotes between commas, or points between semicolons (which part
    cells where the comma is the decimal mark), and each of them may part thousands or begin a fraction.
    """
    columns = list(columns)
    cells = _fractions(columns, _FRACTIONS)
    if delimiter != ",":
        mark = _one_mark(cells, where)
        if delimiter != ";" or mark != "." or not _all_one_group(cells):
            return mark
        # a column that stays high for hours may reach the 0.000 of its rest far below
        every = _fractions(columns)
        mark = _one_mark(every, where)
        # a thousand that is not parted proves that points don't part thousands here
        bare = any(_BARE_THOUSANDS.fullmatch(clean(c)) for column in columns for c in column)
        if mark == "." and _all_one_group(every) and not bare:
            raise _either("points", _with_points(every)[0], "semicolons", where)
        return mark
    commas = [c for c in map(clean, cells) if "," in c and to_float(c, ",") is not None]
    if not commas:
        return "."
    if any(re.fullmatch(r"[+-]?\d*\.\d+", clean(c)) for c in cells):
        return "."
    if all(_GROUPED.fullmatch(c) for c in commas):
        raise _either("commas", f'"{commas[0]}"', "commas", where)
    return ","


def _fractions(columns: Sequence[Sequence[str]], most: int | None = None) -> list[str]:
    """The cells with a mark, of each column the first `most`."""
    return [c for column in columns for c in [c for c in column if "," in c or "." in c][:most]]


def _one_mark(cells: Sequence[str], where: str) -> str | None:
    """The decimal mark of cells; QuestionError where both marks occur."""
    try:
        return decimal_mark(cells)
    except FormatError as error:
        raise QuestionError(
            error.what,
            where=where,
            expected=error.expected,
            got=error.got,
            hint=error.hint,
            ask=f"decimal: '.' or ','? {error.got}; the other then parts thousands",
            declare={"decimal": UNKNOWN},
            meanwhile={"decimal": "."},
        ) from None


def _with_points(cells: Sequence[str]) -> list[str]:
    return [c for c in map(clean, cells) if "." in c and is_number(c)]


def _all_one_group(cells: Sequence[str]) -> bool:
    """Whether each number with a point could be thousands: one group of three digits, no zero before it."""
    return all(_ONE_GROUP.fullmatch(c) for c in _with_points(cells))


def ask_for_thousands(columns: Mapping[str, Sequence[str]], decimal: str | None, where: str) -> None:
    """QuestionError where a tenth of a column's numbers other than 0 have the file's other mark before three digits:
    unread, they would leave the zeros alone, and a spindle would seem to rest. columns: cells by name."""
    if decimal is None:
        return
    for name, cells in columns.items():
        parted = [c for c in map(clean, cells) if may_be_thousands(c, decimal)]
        if len(parted) < 2:
            continue
        others = sum(bool(to_float(clean(c), decimal)) for c in cells)
        if len(parted) < _SHARE * (len(parted) + others):
            continue
        said = (
            f"{len(parted)} of {len(parted) + others} numbers other than 0 in column '{name}' look like thousands "
            f"('{parted[0]}'), beside decimals with '{decimal}'"
        )
        raise QuestionError(
            "numbers that may be written with thousands separators",
            where=where,
            expected="a decimal mark that is declared",
            got=said,
            hint=f"declare table: {{decimal: '{decimal}'}} where '{parted[0]}' is "
            f"{re.sub('[.,]', '', parted[0])}; else write numbers of one kind",
            ask=f"decimal: '.' or ','? {said}; with decimal: '{decimal}' they are read as thousands",
            declare={"decimal": UNKNOWN},
            meanwhile={"decimal": decimal},
        )


def _either(marks: str, got: str, between: str, where: str) -> QuestionError:
    thousands, fraction = (".", ",") if marks == "commas" else (",", ".")
    return QuestionError(
        f"{marks} that may part thousands or begin a fraction",
        where=where,
        expected="a decimal mark that is declared",
        got=f"{got} between {between}",
        hint=f"declare table: {{decimal: '{thousands}'}} where they part thousands, or {{decimal: '{fraction}'}}",
        ask=f"decimal: '.' or ','? {got} may be thousands or a fraction",
        declare={"decimal": UNKNOWN},
        meanwhile={"decimal": fraction},
    )
