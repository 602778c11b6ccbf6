"""What a cell of a text is, the same whoever claims the file: a number, a truth value, a word for nothing, or none.

The policy, a cell at a time (`docs/formats.md` states it for users; `to_float` is it, and `column` gives the same):

- **Nothing**: `EMPTY`, whatever the case. **Overload**: `OVERLOAD`: no value, and flagged as saturated.
- **Decimal mark**: one a file, declared or found; a number with the other mark is none.
- **Thousands**: blanks and apostrophes part them; so does the other mark, where a fraction, a second group or a
  declared decimal mark proves it. `1.500` beside decimal commas could be either, so it is refused, but where the
  columns of the file tell it (`told_thousands`).
- **Signs**: the minus of typography (U+2212) is one; `0.2-` and `(0.2)` are negative, with a fraction.
- **Exponents** are an e, or Fortran's `D+03` in full.
- **Integers** that a float64 would change (beyond 2**53) are kept exactly in a column of int64, else refused.
- **Too large** for a float64 (`1e999`): refused. `inf` is a value. `1_000`, `0x1F` and `12 %` are no numbers.
- **Truth values** (`TRUE`, `wahr`) make a column of bool; between numbers they are 1 and 0.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

import numpy as np

from thermodata.errors import FormatError
from thermodata.reader.text.cells.values.no_value import EMPTY, OVERLOAD
from thermodata.reader.text.cells.values.quotes import clean

TRUE = frozenset({"true", "wahr"})
FALSE = frozenset({"false", "falsch"})
EXACT = 2**53  # up to here a float64 holds every integer

_PLAIN = {
    ".": re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII),
    ",": re.compile(r"[+-]?(?:\d+(?:,\d*)?|,\d+)(?:[eE][+-]?\d+)?", re.ASCII),
}
_INFINITE = re.compile(r"[+-]?inf(?:inity)?", re.IGNORECASE | re.ASCII)
_BLANK = " \u00a0\u202f'’"
_PARTED = {m: re.compile(rf"[+-]?\d{{1,3}}(?:[{_BLANK}]\d{{3}})+(?:{re.escape(m)}\d*)?", re.ASCII) for m in ".,"}
_GROUPED = {
    ".": re.compile(r"[+-]?\d{1,3}(?:(?:,\d{3})+\.\d+|(?:,\d{3}){2,})", re.ASCII),
    ",": re.compile(r"[+-]?\d{1,3}(?:(?:\.\d{3})+,\d+|(?:\.\d{3}){2,})", re.ASCII),
}
_ONE_GROUP = {
    ".": re.compile(r"[+-]?[1-9]\d{0,2},\d{3}", re.ASCII),
    ",": re.compile(r"[+-]?[1-9]\d{0,2}\.\d{3}", re.ASCII),
}
# with a fraction, for '2-' and '(2)' are words as well
_BEHIND = re.compile(r"(?P<behind>\d[\d.,]*[.,]\d+)-|\((?P<inside>\d[\d.,]*[.,]\d+)\)", re.ASCII)
_PADDED_SIGN = re.compile(r"^([+-]) +")
_INTEGER = re.compile(r"[+-]?\d{1,40}", re.ASCII)
_FORTRAN = re.compile(r"([+-]?(?:\d+[.,]\d*|[.,]\d+))[dD]([+-]\d{2,3})", re.ASCII)  # it always writes all of these
_POINT = re.compile(r"^[+-]?\d*\.\d+(?:[eE][+-]?\d+)?$|^[+-]?\d+\.\d*(?:[eE][+-]?\d+)?$")
_COMMA = re.compile(r"^[+-]?\d*,\d+(?:[eE][+-]?\d+)?$|^[+-]?\d+,\d*(?:[eE][+-]?\d+)?$")


def spelled(text: str) -> str:
    """A number as others write it: with a keyboard's sign for the minus of typography (some locales write it), which
    stands before it and not behind or as brackets (SAP, bookkeeping), and Fortran's exponent (1.5D+03) by an e."""
    if not text.isascii():
        text = text.replace("\u2212", "-")
    if text.endswith(("-", ")")) and (negative := _BEHIND.fullmatch(text)) is not None:
        return f"-{negative['behind'] or negative['inside']}"
    found = _FORTRAN.fullmatch(text)
    return f"{found[1]}e{found[2]}" if found else text


def is_empty(cell: str) -> bool:
    """Whether a cell says that there is no value."""
    return cell.strip().casefold() in EMPTY


def is_overload(cell: str) -> bool:
    """Whether a cell says that the value was beyond the instrument's range."""
    return cell.strip().casefold() in OVERLOAD


def to_bool(cell: str) -> bool | None:
    """TRUE or FALSE, in English or German; None for any other word."""
    low = cell.strip().casefold()
    return True if low in TRUE else False if low in FALSE else None


def to_int(cell: str, decimal: str = ".", dtype: str = "int64") -> int | None:
    """A whole number that its dtype holds, exactly; None for what is none, or has a fraction."""
    text = _PADDED_SIGN.sub(r"\1", spelled(cell.strip()))
    if _INTEGER.fullmatch(text):
        whole, limits = int(text), np.iinfo(dtype)
        return whole if limits.min <= whole <= limits.max else None
    value = to_float(text, decimal)
    return int(value) if value is not None and value.is_integer() and abs(value) <= EXACT else None


def to_float(cell: str, decimal: str = ".", declared: bool = False) -> float | None:
    """The number in a cell that is not empty; None where it is none. declared: the decimal mark is (see the policy)."""
    text = cell.strip()
    plain = _PLAIN[decimal].fullmatch(text)
    if plain is None:
        text = spelled(text)
        plain = _PLAIN[decimal].fullmatch(text)
    if plain is None and text.startswith(("+ ", "- ")):
        text = _PADDED_SIGN.sub(r"\1", text)
        plain = _PLAIN[decimal].fullmatch(text)
    if plain is not None:
        value = float(text if decimal == "." else text.replace(",", "."))
        if math.isinf(value) or (abs(value) >= EXACT and _INTEGER.fullmatch(text) and int(text) != value):
            return None
        return value
    if _PARTED[decimal].fullmatch(text):
        return float(re.sub(f"[{_BLANK}]", "", text).replace(",", "."))
    if _GROUPED[decimal].fullmatch(text) or (declared and _ONE_GROUP[decimal].fullmatch(text)):
        return float(text.replace("," if decimal == "." else ".", "").replace(",", "."))
    if _INFINITE.fullmatch(text):
        return float(text)
    truth = to_bool(text)
    return None if truth is None else float(truth)


def of_either_mark(cell: str) -> float | None:
    """The number in a cell of a header or a status, where no decimal mark is declared: a comma is one."""
    return to_float(cell, "," if "," in cell else ".")


def why_none(cell: str, kind: str, decimal: str = ".") -> str:
    """Why a cell is no value of its column, for a loss: "expected a number, got 'x'"."""
    text, shown = _PADDED_SIGN.sub(r"\1", cell.strip()), cell[:40]
    if kind == "bool":
        return f"expected TRUE or FALSE, got '{shown}'"
    if kind in ("int64", "uint64"):
        return f"expected a whole number of 64 bits, got '{shown}'"
    if _ONE_GROUP[decimal].fullmatch(text):
        other = "," if decimal == "." else "."
        return f"'{shown}' may be thousands or a fraction: declare table: {{decimal: '{decimal}'}} or '{other}'"
    if _INTEGER.fullmatch(text):
        return f"an integer that float64 would round, got '{shown}'"
    return f"expected a number, got '{shown}'"


def may_be_thousands(cell: str, decimal: str) -> bool:
    """Whether a cell (as `clean` gives it) holds the mark that is not the decimal one before its only three digits."""
    return _ONE_GROUP[decimal].fullmatch(_PADDED_SIGN.sub(r"\1", spelled(cell))) is not None


def is_number(cell: str) -> bool:
    """Whether a cell is a number with either decimal mark."""
    text = _PADDED_SIGN.sub(r"\1", spelled(clean(cell)))
    if any(pattern.fullmatch(text) for pattern in (*_PLAIN.values(), _INFINITE)):
        return True
    return any(p.fullmatch(text) for patterns in (_PARTED, _GROUPED) for p in patterns.values())


def decimal_mark(cells: Iterable[str]) -> str | None:
    """'.' or ',' by the number cells of a file's first data rows; None where none has a fraction.
    FormatError where both occur, for then no choice is right."""
    points = commas = 0
    for cell in cells:
        text = spelled(clean(cell))
        points += _POINT.match(text) is not None
        commas += _COMMA.match(text) is not None
    if points and commas:
        raise FormatError(
            "numbers with a decimal point and with a decimal comma",
            expected="one of them",
            got=f"{points} with a point, {commas} with a comma",
            hint="declare table: {decimal: ...}",
        )
    return "." if points else "," if commas else None
