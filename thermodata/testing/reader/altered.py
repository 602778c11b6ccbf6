"""Checks: what becomes of a row of a good file that is written twice, elsewhere, or not as it should be.

The kit changes a row of the author's own file, reads it again, and holds what comes against what came before: every row
in its place, no number where none is written, and a word (a Loss, a flag, a note, a refusal) for whatever is gone.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.plugin import Array, Source
from thermodata.schema.flag import INVALID
from thermodata.testing.reader.case import Case, Data, fault, load, tells
from thermodata.testing.reader.records import (
    Arrange,
    Cell,
    Record,
    cells,
    changed,
    not_looked_at,
    otherwise,
    two_records,
    without,
)

Change = tuple[str, bytes]  # what is changed, in words, and the bytes that stand in its place
_TELL = "yield a Loss with its line and the reason"


def a_row_that_is_written_twice_arrives_twice(case: Case, path: Path, source: Source) -> None:
    whole = load(case.make(), path, source)
    record, _ = two_records(case, path, source, whole)

    def twice(stream: str, column: Array) -> Array:
        row = record.rows.get(stream)
        return column if row is None else np.insert(column, row, column[row])

    what = f"{path.name} with {record.where} written twice"
    data = changed(case, path, source, record.replaced(record.own * 2), what)
    _arrive(whole, data, twice, what, f"{record.row_words} twice", "leave a repeated row in: ingest flags its time; "
            "where a format sends the same again by design, say in a note or a Loss what was left out")  # fmt: skip


def rows_arrive_in_the_order_of_the_file(case: Case, path: Path, source: Source) -> None:
    if case.unordered or getattr(case.make(), "unordered", False):
        not_looked_at("said to be `unordered`: its rows need not stand in the order of their times")
    whole = load(case.make(), path, source)
    first, second = two_records(case, path, source, whole)

    def swapped(stream: str, column: Array) -> Array:
        row, column = first.rows.get(stream), column.copy()
        if row is not None:
            column[[row, row + 1]] = column[[row + 1, row]]
        return column

    both = Record(first.content, first.first, second.last, first.rows, first.is_text)
    what = f"{path.name} with {first.where} behind the next"
    data = changed(case, path, source, both.replaced(second.own + first.own), what)
    _arrive(whole, data, swapped, what, f"{first.row_words} behind the next, with its own time", "sort nothing, and "
            "drop no row whose time goes back: ingest flags it; where rows of many writers are mixed by design, set "
            "`unordered = True` on the class, or give it to the kit")  # fmt: skip


def a_cell_without_a_value_gives_no_number(case: Case, path: Path, source: Source) -> None:
    """An empty cell, NaN in a text or as a binary number, null of JSON."""
    _spoil_cells(case, path, source, _without_value, "give NaN where the file has no value (in whole numbers: as "
                 "float64, or flagged by thermodata.schema.flag), never 0 and never the value before")  # fmt: skip


def a_word_among_numbers_gives_no_number(case: Case, path: Path, source: Source) -> None:
    _spoil_cells(case, path, source, _with_a_word, f"give NaN where a number can't be read, or {_TELL}, or keep the "
                 "column as text; drop no row without a word")  # fmt: skip


def a_line_that_is_no_row_is_told(case: Case, path: Path, source: Source) -> None:
    """A line that ends before its last number, and one that holds something else."""
    whole = load(case.make(), path, source)
    record, _ = two_records(case, path, source, whole)
    if not record.is_text:
        not_looked_at(f"{path.name} is no text of lines")
    for said, line in _no_rows(record, whole):
        what = f"{path.name} with {record.where} {said}"
        data = changed(case, path, source, record.replaced(line), what)
        if data is None or tells(whole, data):
            continue
        wrong = _but_for_a_number(whole, data, record)
        if wrong is not None:
            _fault(what, f"a Loss, a flag, or no number in {record.row_words}", f"{wrong}, and no word of it",
                   f"{_TELL} for each line that is left out, and go on behind it")  # fmt: skip


# ---- what is written in a row's place ------------------------------------------------------------


def _without_value(cell: Cell) -> Iterable[Change]:
    if cell.form != "text":
        return [("is NaN", struct.pack(cell.form, np.nan))]
    if cell.record.is_json:
        return [("is null", b"null")]
    return [("is empty", b""), ("says NaN", b"NaN")] if cell.may_be_empty else [("says NaN", b"NaN")]


def _with_a_word(cell: Cell) -> Iterable[Change]:
    if cell.form != "text":
        not_looked_at("its numbers are binary, and no word can stand for one")
    return [("says 'Fault'", b'"Fault"' if cell.record.is_json else b"Fault")]


def _no_rows(record: Record, whole: Data) -> Iterable[Change]:
    line = record.own.rstrip(b"\r\n")
    end = record.own[len(line) :]
    last = max((cell.first for cell in cells(record, whole)), default=0)
    cut = [("ending before its last number", line[:last] + end)] if last else []
    return [*cut, ("holding other words", b"?? no row of this log ??" + end)]


# ---- what comes of it ----------------------------------------------------------------------------


def _spoil_cells(case: Case, path: Path, source: Source, spoil: Callable[[Cell], Iterable[Change]], do: str) -> None:
    whole = load(case.make(), path, source)
    record, _ = two_records(case, path, source, whole)
    found = list(cells(record, whole))
    if not found:
        not_looked_at(f"{path.name}: the kit finds no number of {record.where} that stands there once, as it is read")
    for cell in found:
        for said, by in spoil(cell):
            what = f"{path.name} where '{cell.name}' of {record.where} {said}"
            data = changed(case, path, source, cell.replaced(by), what)
            wrong = None if data is None else _in_place_of(cell, whole, data)
            if wrong is not None:
                _fault(what, f"no number in row {cell.row} of stream '{cell.stream}', all else as it was", wrong, do)


def _arrive(whole: Data, data: Data | None, expected: Arrange, what: str, words: str, do: str) -> None:
    wrong = None if data is None or tells(whole, data) else otherwise(whole, data, expected)
    if wrong is not None:
        _fault(what, words, f"{wrong}, and no word of it", do)


def _in_place_of(cell: Cell, whole: Data, data: Data) -> str | None:
    """What is wrong where a cell holds no number."""
    key = (cell.stream, cell.name)
    told = tells(whole, data)
    if data.t_ns.get(cell.stream, np.zeros(0)).size == whole.t_ns[cell.stream].size and key in data.values:
        value = data.values[key][cell.row]
        held = any(s.held and (s.stream, s.name) == key for s in data.recording.signals)
        if _is_number(value) and not held and not int(data.flags[key][cell.row]) & INVALID:
            return f"{value} there, unflagged"
    return None if told else _but_for_a_number(whole, data, cell.record)


def _but_for_a_number(whole: Data, data: Data, record: Record) -> str | None:
    """The first difference beside the record's row, and where all of that row is a number; None where none is."""
    for stream, t_ns in whole.t_ns.items():
        got = data.t_ns.get(stream, t_ns[:0])
        if got.size != t_ns.size:
            return f"{got.size} rows in stream '{stream}', where the whole file has {t_ns.size}"
    differs = otherwise(_but(whole, record), _but(data, record), lambda _, column: column)
    if differs is not None:
        return differs
    held = {s.name for s in data.recording.signals if s.held}
    here = [
        (name, column[record.rows[stream]]) for (stream, name), column in data.values.items() if stream in record.rows
    ]
    return (
        None
        if held or not all(_is_number(value) for _, value in here)
        else ", ".join(f"{name} = {value}" for name, value in here)
    )


def _but(data: Data, record: Record) -> Data:
    """The same without the record's row; text that says a number as the number, for a word makes a column text."""
    cut = without(record.rows)
    return Data(
        data.recording,
        {stream: cut(stream, t_ns) for stream, t_ns in data.t_ns.items()},
        {key: _as_numbers(cut(key[0], column)) for key, column in data.values.items()},
        data.flags,
        data.losses,
    )


def _as_numbers(column: Array) -> Array:
    try:
        return column.astype(np.float64)
    except (TypeError, ValueError):
        return column


def _is_number(value: Any) -> bool:
    try:
        return bool(np.isfinite(float(value)))
    except (TypeError, ValueError):
        return False


def _fault(what: str, expected: str, got: str, do: str) -> None:
    fault(f"{what}\nexpected: {expected}\ngot: {got}", do)
