"""The cells of a whole column as values, by the policy of `number`: Arrow reads what is plain, `to_float` the rest."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Array, Bool1D
from thermodata.reader.text.cells.values import arrow
from thermodata.reader.text.cells.values.no_value import EMPTY, OVERLOAD
from thermodata.reader.text.cells.values.number import EXACT, to_bool, to_float, to_int
from thermodata.reader.text.cells.values.quotes import clean

_FEW = 100  # cells below which the way through Arrow costs more than it saves


@dataclass(frozen=True, slots=True)
class Values:
    """A column's cells as values. values: shape (n,), of the kind's dtype (NaN, 0 or None where there is none);
    empty, over: shape (n,), True at cells without a value, and those of them that say overload; odd: (row, cell) of
    cells that are no value of the kind."""

    values: Array
    empty: Bool1D
    over: Bool1D
    odd: tuple[tuple[int, str], ...] = ()


def values_of(column: Any, kind: str, decimal: str = ".", declared: bool = False) -> Values:
    """The cells of a column by the policy. column: an Arrow array of strings, or a sequence of str; kind: float64,
    int64, uint64, bool or str."""
    if kind == "float64" and isinstance(column, list) and len(column) < _FEW:
        return _one_by_one(column, np.dtype(np.float64), lambda cell: to_float(cell, decimal, declared))
    import pyarrow as pa

    cells = column if isinstance(column, pa.Array | pa.ChunkedArray) else arrow.text_array(list(column))
    if isinstance(cells, pa.ChunkedArray):
        cells = cells.combine_chunks()
        cells = cells if isinstance(cells, pa.Array) else pa.array([], pa.string())
    if kind == "str":
        return _texts(cells)
    if kind == "float64":
        return _floats(cells, decimal, declared)
    scalar: Callable[[str], Any] = to_bool if kind == "bool" else lambda cell: to_int(cell, decimal, kind)
    return _one_by_one(cells.to_pylist(), np.dtype(kind), scalar)


def _texts(cells: Any) -> Values:
    """Text as objects that share their strings; None for a blank cell. Words such as '---' are text like any other."""
    coded = cells.dictionary_encode()
    words = np.array([*((clean(w) or None) for w in coded.dictionary.to_pylist()), None], object)
    taken = words[arrow.codes(coded)]
    none = np.zeros(len(cells), bool)
    return Values(taken, none, none)


def _floats(cells: Any, decimal: str, declared: bool) -> Values:
    """Numbers that are all plain by Arrow's cast, or those that are; all else by `to_float`."""
    import pyarrow as pa
    import pyarrow.compute as pc

    text = pc.utf8_trim_whitespace(cells.fill_null("") if cells.null_count else cells)
    if decimal == "." and (sure_all := _all_plain(text)) is not None:
        return sure_all
    plain = pc.match_substring_regex(text, rf"^-?\d{{1,15}}(?:{re.escape(decimal)}\d{{1,30}})?(?:[eE][+-]?\d{{1,2}})?$")
    sure = arrow.values(plain, "bool")
    numbers = pc.if_else(plain, text, "nan")
    if decimal == ",":
        numbers = pc.replace_substring(numbers, ",", ".")
    values = arrow.values(pc.cast(numbers, pa.float64()), "float64")
    rest = np.flatnonzero(~sure)
    if not rest.size:
        none = np.zeros(len(cells), bool)
        return Values(values, none, none)
    slow = _one_by_one(
        pc.filter(text, pc.invert(plain)).to_pylist(), np.dtype(np.float64), lambda c: to_float(c, decimal, declared)
    )
    values[rest] = slow.values
    empty, over = np.zeros(values.size, bool), np.zeros(values.size, bool)
    empty[rest], over[rest] = slow.empty, slow.over
    return Values(values, empty, over, tuple((int(rest[i]), cell) for i, cell in slow.odd))


def _all_plain(text: Any) -> Values | None:
    """The cells where all are numbers that a float64 holds; None where one needs a second look."""
    import pyarrow as pa
    import pyarrow.compute as pc

    try:
        cast = pc.cast(text, pa.float64())
    except pa.ArrowInvalid:
        return None
    values = np.frombuffer(cast.buffers()[1] or b"", np.float64)[cast.offset : cast.offset + len(cast)]
    if not (np.abs(values) < EXACT).all():  # NaN is not either
        return None
    none = np.zeros(values.size, bool)
    return Values(values.copy(), none, none)


def _one_by_one(cells: Sequence[str | None], dtype: np.dtype[Any], scalar: Callable[[str], Any]) -> Values:
    """The policy itself; each different cell is judged once."""
    known: dict[str, tuple[Any, bool, bool, bool]] = {}
    nothing = np.nan if dtype.kind == "f" else 0
    values = np.zeros(len(cells), dtype)
    empty, over = np.zeros(len(cells), bool), np.zeros(len(cells), bool)
    odd = []
    for i, raw in enumerate(cells):
        cell = clean(raw or "")
        if cell not in known:
            low = cell.casefold()
            gone, beyond = low in EMPTY, low in OVERLOAD
            value = None if gone or beyond else scalar(cell)
            known[cell] = (nothing if value is None else value, value is None, beyond, value is None and not gone)
        values[i], empty[i], over[i], wrong = known[cell]
        if wrong and not over[i]:
            odd.append((i, (raw or "").strip()))
    return Values(values, empty, over, tuple(odd))
