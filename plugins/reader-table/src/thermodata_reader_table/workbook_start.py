"""The start that stands above the rows of a sheet, which rows without a date count from, as those of a text do."""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Source
from thermodata.reader.text.preamble.begin import ROWS, FirstTimes, declared_start, find_begin, unused_start
from thermodata.reader.text.times.in_memory import Stamps, times_of_dates
from thermodata.reader.text.times.local_clock import DayCount
from thermodata.reader.times.zone import NAT, local_to_utc_ns


def begun(times: Stamps, head: Sequence[Sequence[Any]], source: Source, zone: str | None, where: str) -> Stamps:
    """Times that count from a start, or tell times of day, from the start or date that stands above them; as they are
    where none does. head: the rows above the data. FormatError where what is declared of it fits nothing."""
    declared = declared_start(source.table or {})
    if times.absolute:
        unused = unused_start(declared)
        return Stamps(times.t_ns, True, (*times.notes, unused)) if unused else times
    since_ns = np.where(times.t_ns == NAT, NAT, times.t_ns + np.int64(times.zero_ns))
    first = since_ns[since_ns != NAT][:ROWS].tolist()
    lines = [[_text(c) for c in row if c not in ("", None)] for row in head]
    begin, doubt = find_begin(lines, FirstTimes(tuple(first), times.of_day), declared, where)
    if begin is None:
        notes = (*times.notes, *([doubt] if doubt else []))
        return Stamps(times.t_ns, False, notes, times.zero_ns, times.of_day)
    known = [n for n in times.notes if n not in (DayCount.NOTE, DayCount.NOTE_MINUTES, DayCount.NOTE_SPANS)]
    if begin.of_day:
        local_ns = np.where(since_ns == NAT, NAT, since_ns + np.int64(begin.ns))
        dated = times_of_dates(local_ns.view("datetime64[ns]"), zone)
        return Stamps(dated.t_ns, True, (*known, begin.note(), *dated.notes))
    zoneless = local_to_utc_ns(np.array([begin.ns]).view("datetime64[ns]"), zone)[1] if begin.local else []
    return Stamps(begin.utc(since_ns, zone), True, (*known, begin.note(), *zoneless))


def _text(cell: Any) -> str:
    """A cell as a text would have it: a date without a time of day is a midnight in a workbook."""
    if isinstance(cell, dt.datetime) and cell.time() == dt.time():
        return cell.date().isoformat()
    return str(cell)
