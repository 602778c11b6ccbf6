"""Columns that bring times of their own: `t1;T1;t2;T2;T3`, "Time,CH1,Time,CH2". Each such group is a stream.

Where each time shares its name with other columns, that tells which are its own (tagged_columns.py). Else a later
column starts a group where it is named like the first time (the same word, numbered, or with the name of the column
behind it; any word where both have a unit of time), rises like a time, and has columns behind it. Two times of the same
rows are one group: the second is a signal. What may be either is asked.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.errors import FormatError, UsageError
from thermodata.reader.text.cells.cell import TIME_WORD, Cell, is_empty, is_number, is_stamp, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.tagged_columns import tagged
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.times.time_units import SECONDS, known_unit

_NUMBERED = re.compile(r"^(?P<word>.*?)[ _.#-]*(?P<number>\d{1,3})$")
_COUNTED = re.compile(r"^(?P<word>[^\W\d_]+)\s*\d{1,2}\s*[-–:]\s")  # 'Zeit  2 - fast': the rates of catman
_HINT = (
    "declare table: {time: [{column: 1, unit: s}, {column: 3, unit: s}]}, each with the columns behind it, or "
    "with signals: [...]; or one time for all: table: {time: {column: 1}}"
)


@dataclass(frozen=True)
class Span:
    """A group before its time is known. times: columns that may be its time; columns: all of it, in order; named:
    whether a name that they share tells so."""

    times: tuple[int, ...]
    columns: tuple[int, ...]
    named: bool = False


@dataclass(frozen=True)
class _Name:
    """What a header says of time. word: "time", "zeit", "t", ...; beside: what stands beside it ("" or a name)."""

    word: str
    beside: str
    bare: bool  # the word alone, or numbered


def one_time(table: Mapping[str, Any] | None, where: str) -> Mapping[str, Any]:
    """The declared time of a format that keeps its times apart by itself. UsageError for a list of several."""
    said = (table or {}).get("time") or {}
    if isinstance(said, list | tuple):
        if len(said) > 1:
            raise UsageError(
                "several times are declared",
                where=where,
                expected="one: in this format the file itself tells which signals belong to which time",
                got=f"{len(said)} in a list",
                hint="declare table: {time: {column: ...}}, or none",
            )
        said = said[0] if said else {}
    found: Mapping[str, Any] = said
    return found


def time_name(header: str) -> _Name | None:
    """None where a header does not name a time."""
    name = split_unit(re.sub(r"#\d+$", "", header))[0].strip()
    last = name.rsplit("/", 1)[-1].strip()
    for text in (name, last):
        if TIME_WORD.match(text):
            return _Name(text.rstrip(".:").casefold(), "", True)
    match = _NUMBERED.match(last)
    if match and TIME_WORD.match(match["word"]):
        return _Name(match["word"].casefold(), "", True)
    match = _COUNTED.match(last)
    if match and TIME_WORD.match(match["word"]):
        return _Name(match["word"].casefold(), "", True)
    parts = re.split(r"[\s_.:()\[\]-]+", last.strip("()[] "))
    for word, rest in ((parts[0], parts[1:]), (parts[-1], parts[:-1])):
        if len(word) > 1 and rest and TIME_WORD.match(word):
            return _Name(word.casefold(), "".join(rest).casefold(), False)
    return None


def spans(seen: FirstRows) -> tuple[list[Span], list[str]]:
    """(groups, notes) of a table by its headers and first rows; no groups where one time is for all columns.

    FormatError where a second time may be one of its own rows or of the first's.
    """
    named = {i: n for i, name in enumerate(seen.names) if (n := time_name(name))} or _by_unit(seen)
    said = {i: n for i, n in named.items() if _goes_on_like_time(i, n, seen.units[i], seen.rows)}
    by_name, left = tagged(seen, tuple(said))
    if by_name and left and not _one_clock([i for one in by_name for i in one.times], seen):
        raise _of_no_name([seen.names[i] for i in left], seen)
    if by_name and not left:
        return [Span(one.times, one.columns, named=True) for one in by_name], []
    runs = _runs(said)
    if len(runs) < 2:
        return [], []
    first = said[runs[0][0]]
    own, notes = [runs[0]], []
    for run in runs[1:]:
        if all(said[i].word != first.word or said[i].bare != first.bare for i in run[:1]):
            notes += _other(runs[0][0], run[0], said, seen)
        elif not first.bare and not (_names_next_column(run, said, seen) and _names_next_column(runs[0], said, seen)):
            _ask_if_apart(runs[0][0], run[0], seen)
            notes.append(_note_of_kept_signal(seen.names[run[0]]))
        else:
            own.append(run)
    if len(own) < 2:
        return [], notes
    if own[0][0] > 0 and own[-1][-1] == len(seen.names) - 1:
        raise FormatError(
            "several time columns, each behind its columns or before them",
            where=seen.where,
            got=", ".join(seen.names[:12]),
            expected="a time before the columns that it is of",
            hint=_HINT,
        )
    if own[-1][-1] == len(seen.names) - 1:
        notes.append(_note_of_kept_signal(seen.names[own.pop()[0]]))
    if len(own) < 2 or (first.word == "t" and own[0][0] != 0):
        return [], notes
    edges = [0, *(run[0] for run in own[1:]), len(seen.names)]
    return [Span(tuple(run), tuple(range(a, b))) for run, a, b in zip(own, edges, edges[1:], strict=False)], notes


def _by_unit(seen: FirstRows) -> dict[int, _Name]:
    """The columns of a unit of time that share the name of a first one, whatever that is, or number it: 'x [s]',
    'x [min]'."""
    bare = [split_unit(re.sub(r"#\d+$", "", name))[0].strip().casefold() for name in seen.names]
    words = [match["word"] if (match := _NUMBERED.match(name)) else name for name in bare]
    alike = [
        i
        for i, unit in enumerate(seen.units)
        if words[i] == words[0] and (unit or "").strip("[]() ").lower() in SECONDS
    ]
    return {i: _Name(words[0], "", True) for i in alike} if alike[:1] == [0] and len(alike) > 1 else {}


def _note_of_kept_signal(name: str) -> str:
    return (
        f"column '{name}' is named like a time and rises: it is read as a signal; declare table: {{time: "
        "[{column: ...}, {column: ...}]} if columns behind it have it for their time"
    )


def _runs(said: Mapping[int, _Name]) -> list[list[int]]:
    """Columns side by side: a date and a time, or a date and elapsed seconds."""
    runs: list[list[int]] = []
    for i in sorted(said):
        if runs and runs[-1][-1] == i - 1:
            runs[-1].append(i)
        else:
            runs.append([i])
    return runs


def _names_next_column(run: Sequence[int], said: Mapping[int, _Name], seen: FirstRows) -> bool:
    """Whether 'CH1 time' stands before a column of CH1."""
    if run[-1] + 1 >= len(seen.names):
        return False
    behind = re.sub(r"[\s_.:()\[\]-]+", "", split_unit(seen.names[run[-1] + 1])[0]).casefold()
    beside = said[run[0]].beside
    return beside in behind or behind in beside


def _goes_on_like_time(column: int, name: _Name, unit: str | None, data: Sequence[Sequence[Cell]]) -> bool:
    """Dates and times of day, whose unit says how they are written ("hh:mm:ss"), or numbers of a unit of time that
    never fall; what is only called t must rise with every row."""
    cells = [r[column] for r in data if not is_empty(r[column])]
    if len(cells) < 2:
        return False
    if sum(map(is_stamp, cells)) > 0.8 * len(cells):
        return True
    if unit is not None and known_unit(unit) is None:
        return False
    values = np.array([v for c in cells if is_number(c) and (v := number_of(c)) is not None])
    if values.size < max(2, 0.8 * len(cells)) or values[-1] <= values[0]:
        return False
    steps = np.diff(values)
    return bool((steps > 0).all() if name.word == "t" and unit is None else (steps >= 0).mean() > 0.98)


def _other(first: int, second: int, said: Mapping[int, _Name], seen: FirstRows) -> list[str]:
    """Another word for time behind columns: the same clock in other words is a signal (no note), one that runs
    apart from the first is asked."""
    if said[second].word == "t" and seen.units[second] is None:
        return []  # a temperature that rises
    apart = _difference_of_times(first, second, seen)
    if apart is None or (apart >= 0 and (not said[second].bare or second == len(seen.names) - 1)):
        return [_note_of_kept_signal(seen.names[second])]
    if apart == 0:
        return []
    raise _question(first, second, seen)


def _ask_if_apart(first: int, second: int, seen: FirstRows) -> None:
    """FormatError where a second time of the same word is another clock than the first: what stands behind it would
    get times that are not its own."""
    if second < len(seen.names) - 1 and _difference_of_times(first, second, seen):
        raise _question(first, second, seen)


def _difference_of_times(first: int, second: int, seen: FirstRows) -> float | None:
    """By how much two times differ: 0 where they are one clock (but for an offset), -1 where one stands alone in a row;
    None where that cannot be told, for one is a date."""
    if sum(is_empty(r[first]) != is_empty(r[second]) for r in seen.rows):
        return -1.0
    pairs = [(number_of(r[first]), number_of(r[second])) for r in seen.rows]
    rows = np.array([(a, b) for a, b in pairs if a is not None and b is not None]).reshape(-1, 2)
    if rows.shape[0] < 2:
        return None  # a date and a number of seconds
    a, b = (
        rows[:, k] * SECONDS.get((seen.units[i] or "s").strip("[]() ").lower(), 1.0)
        for k, i in ((0, first), (1, second))
    )
    step = float(np.median(np.abs(np.diff(a)))) or 1.0
    spread = float(np.ptp(b - a))
    return spread if spread > max(2 * step, 1e-3 * float(np.ptp(a))) else 0.0


def _of_no_name(left: Sequence[str], seen: FirstRows) -> FormatError:
    return FormatError(
        "columns that share their name with none of several times",
        where=seen.where,
        got=", ".join(f"'{name}'" for name in left[:6]) + " of " + ", ".join(seen.names[:12]),
        expected="each column to share its name with its time, as the others do",
        hint=_HINT,
    )


def _one_clock(times: Sequence[int], seen: FirstRows) -> bool:
    """Whether the times of a row tell the same moment in each, as those of a PC and a control: dates are written alike,
    and numbers differ by an offset. A date beside a number is another clock of the same rows where both run on."""
    first, *others = times
    for other in others:
        pairs = [(r[first], r[other]) for r in seen.rows]
        if any(is_empty(a) != is_empty(b) for a, b in pairs):
            return False
        if all(a == b for a, b in pairs):
            continue
        apart = _difference_of_times(first, other, seen)
        stamped = [any(is_stamp(p[k]) for p in pairs) for k in (0, 1)]
        if apart is None and stamped[0] is not stamped[1]:
            continue
        if apart is None or apart:
            return False
    return True


def _question(first: int, second: int, seen: FirstRows) -> FormatError:
    return FormatError(
        "two time columns that run apart",
        where=seen.where,
        got=f"'{seen.names[first]}' and '{seen.names[second]}'",
        expected="one time for all columns, or each for its own",
        hint=_HINT,
    )
