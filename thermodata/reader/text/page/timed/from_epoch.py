"""The times of a table whose head states what they count from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.text.cells.cell import Cell, is_number, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.counts_of_seconds import scale_question
from thermodata.reader.text.clocks.time_questions import likely_time
from thermodata.reader.text.names.time_header import is_time_header, unit_of_time
from thermodata.reader.text.page.timed.group import Group
from thermodata.reader.text.preamble.epoch_said import SaidEpoch, epoch_said
from thermodata.reader.times.since import PTP
from thermodata.reader.times.time_units import EPOCHS, SECONDS, is_logged

_SETTLED = ("unit", "format", "period")  # where one of these is declared, no head is asked


def stated_epoch(said: Any, lines: Iterable[Sequence[str]]) -> SaidEpoch | None:
    """What the lines above a table say that its times count from. said: its declared times."""
    if not isinstance(said or {}, Mapping) or any((said or {}).get(key) is not None for key in _SETTLED):
        return None
    return epoch_said(lines)


def answer_of(stated: SaidEpoch, seen: FirstRows) -> dict[str, Any] | None:
    """The declaration of a time that nothing else tells; None where none of the columns is one, so counted."""
    worded = [
        i
        for i, n in enumerate(seen.names)
        if is_time_header(n) and sum(is_number(r[i]) for r in seen.rows) > len(seen.rows) / 2
    ]
    place = worded[0] if worded else likely_time(seen.rows)[0]
    unit = stated.of(seen.units[place] or unit_of_time(seen.names[place]))
    values = _column_of(seen.rows, place)
    return {"column": place + 1, "unit": unit} if unit is not None and is_logged(values, unit) else None


def from_epoch(
    stated: SaidEpoch, groups: Sequence[Group], notes: Sequence[str], seen: FirstRows
) -> tuple[list[Group], list[str]]:
    """(groups whose times count from what the head states, notes); those of dates, of no time, and whose names state an
    epoch themselves, as they are. QuestionError where it leaves open whether they count leap seconds."""
    found, noted = [], list(notes)
    for group in groups:
        place = group.time[0] if group.time and not group.dated and not group.counted else None
        if place is not None and (unit_of_time(seen.names[place], seen.units[place]) or "") not in EPOCHS:
            values = _column_of(seen.rows, place)
            number = None if is_time_header(seen.names[place]) else place + 1
            asked = (
                scale_question(seen.names[place], values, seen.where, number, hint=PTP) if stated.scale == PTP else None
            )
            if asked is not None:
                raise asked
            seconds = group.seconds if group.seconds is not None else EPOCHS[group.epoch or ""].seconds
            epoch, note = _epoch_of(stated, seconds, values)
            noted.append(note)
            group = group if epoch is None else replace(group, seconds=None, epoch=epoch)
        found.append(group)
    return found, list(dict.fromkeys(noted))


def _epoch_of(stated: SaidEpoch, seconds: float, values: Array) -> tuple[str | None, str]:
    """(the unit with its epoch of times in a unit of so many seconds, None where they are of no year that is logged, or
    the head means another unit; the note on it)."""
    own = next((u for u in ("s", "min", "h", "d", "ms", "us", "ns") if SECONDS[u] == seconds), None)
    unit = None if own is None else stated.of(own)
    if unit is None or not is_logged(values, unit):
        return None, stated.not_used()
    return unit, stated.note(unit)


def _column_of(data: Sequence[Sequence[Cell]], place: int) -> Array:
    return np.array([v for r in data if (v := number_of(r[place])) is not None], np.float64)
