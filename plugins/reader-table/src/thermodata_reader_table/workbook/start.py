"""The start that stands above the rows of a sheet, which rows without a date count from, as those of a text do."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence, Set
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Int1D, Source
from thermodata.reader.text.preamble.begin import (
    ROWS,
    Begin,
    FirstTimes,
    anew_note,
    begun_anew,
    declared_start,
    find_begin,
    unused_start,
)
from thermodata.reader.text.times.in_memory import Stamps, times_of_dates
from thermodata.reader.text.times.local_clock import DayCount
from thermodata.reader.times.zone import NAT, local_to_utc_ns


@dataclass(frozen=True, slots=True)
class Heads:
    """above: the rows above the data; columns: the cells of the data; repeats: the numbers of its rows, counted from 0,
    that repeat the header."""

    above: Sequence[Sequence[Any]]
    columns: Sequence[Sequence[Any]]
    repeats: Set[int]


def begun(times: Stamps, heads: Heads, source: Source, zone: str | None, where: str) -> tuple[Stamps, list[int]]:
    """(times that count from a start, or tell times of day, from the start or date that stands above them; as they are
    where none does; the numbers of rows that are further starts). FormatError where what is declared of it fits
    nothing."""
    declared = declared_start(source.table or {})
    if times.absolute:
        unused = unused_start(declared)
        return Stamps(times.t_ns, True, (*times.notes, unused)) if unused else times, []
    since_ns = np.where(times.t_ns == NAT, NAT, times.t_ns + np.int64(times.zero_ns))
    first = since_ns[since_ns != NAT][:ROWS].tolist()
    begin, doubt = find_begin(texts_of(heads.above), FirstTimes(tuple(first), times.of_day), declared, where)
    if begin is None:
        notes = (*times.notes, *([doubt] if doubt else []))
        return Stamps(times.t_ns, False, notes, times.zero_ns, times.of_day), []
    known = [n for n in times.notes if n not in (DayCount.NOTE, DayCount.NOTE_MINUTES, DayCount.NOTE_SPANS)]
    if begin.of_day:
        local_ns = np.where(since_ns == NAT, NAT, since_ns + np.int64(begin.ns))
        dated = times_of_dates(local_ns.view("datetime64[ns]"), zone)
        return Stamps(dated.t_ns, True, (*known, begin.note(), *dated.notes)), []
    zoneless = local_to_utc_ns(np.array([begin.ns]).view("datetime64[ns]"), zone)[1] if begin.local else []
    t_ns, anew = begin.utc(since_ns, zone), _further_starts(since_ns, heads, begin)
    for row, further in anew.items():
        t_ns[row:] = further.utc(since_ns[row:], zone)
    told = [*known, begin.note(), *map(anew_note, anew.values()), *zoneless]
    return Stamps(t_ns, True, tuple(told)), list(anew)


def _further_starts(since_ns: Int1D, heads: Heads, begin: Begin) -> dict[int, Begin]:
    """By their numbers the rows that say a further start, where the time of the rows behind them begins anew: a logger
    that was started again. since_ns: shape (n,)."""
    found: dict[int, Begin] = {}
    good = np.flatnonzero(since_ns != NAT)
    for row in np.flatnonzero(since_ns == NAT).tolist():
        k = int(np.searchsorted(good, row))
        if row not in heads.repeats and 0 < k < good.size and since_ns[good[k]] < since_ns[good[k - 1]]:
            further = begun_anew([_texts([c[row] for c in heads.columns])], begin)
            found |= {} if further is None else {row: further}
    return found


def texts_of(head: Sequence[Sequence[Any]]) -> list[list[str]]:
    """The filled cells of the rows above the data, as a text would have them."""
    return [_texts(row) for row in head]


def _texts(row: Sequence[Any]) -> list[str]:
    return [_text(c) for c in row if c not in ("", None)]


def _text(cell: Any) -> str:
    """A cell as a text would have it: a date without a time of day is a midnight in a workbook."""
    if isinstance(cell, dt.datetime) and cell.time() == dt.time():
        return cell.date().isoformat()
    return str(cell)
