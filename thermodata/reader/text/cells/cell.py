"""What a cell of a table looks like: a number, a date, a time of day, nothing. Texts and a workbook's values alike."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

from thermodata.reader.text.cells.time_forms.time_pattern import is_date_text, is_time_of_day
from thermodata.reader.text.cells.values.no_value import EMPTY, OVERLOAD
from thermodata.reader.text.cells.values.number import spelled

Cell = Any  # text, or what a workbook holds: numbers, bool, datetime, date, time, timedelta
# "t" is a time, "T" a temperature
TIME_WORD = re.compile(
    r"^(t|ts|t_s|time_s|[Tt]id|(?i:t_?stamp|row[ _]?times?|epoch([ _](s|ms))?|unix([ _]?time)?([ _](s|ms))?|"
    r"time|zeit|čas|cas|temps|tiempo|tempo|datum|date|dátum|uhrzeit|timestamp|date[ _/]?time|datetime|"
    r"(dat[eu]m?|dato|dátum|data|fecha|дата)( ?[/&+,_-] ?| (und|and|a|y|e|et|i|en|og|och|és|и) | )"
    r"(time|(uhr)?zeit|čas|cas|hora|heure|ora|czas|godzina|tijd|tid|idő|время)|"
    r"ora|orario|czas|godzina|tijd|tijdstip|tidspunkt|klockslag|idő|időpont|время|"
    r"laufzeit|zeitstempel|elapsed([ _]?time)?|rel(ative)?[ _.]?time|heure|horodatage|hora|fecha|"
    r"時間|時間戳|日期|日期時間|时间|时间戳|时刻|日期时间|日時|日付|時刻|시간|시각|일시))\.?:?$"
)
WORDS = EMPTY | OVERLOAD | {"true", "false", "wahr", "falsch", "inf", "-inf"}  # which make no row of words
# loggers that pad their numbers write the sign first: "+   23.5"
_NUMBER = re.compile(r"^[+-]? *(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?$", re.ASCII)


def is_number(cell: Cell) -> bool:
    if isinstance(cell, str):
        text = cell.strip()
        return _NUMBER.match(text) is not None or _NUMBER.match(spelled(text)) is not None
    return isinstance(cell, int | float)


def number_of(cell: Cell) -> float | None:
    try:
        return float(spelled(cell.strip()).replace(",", ".").replace(" ", "") if isinstance(cell, str) else cell)
    except (ValueError, TypeError):
        return None


def is_dated(cell: Cell) -> bool:
    return is_date_text(cell) if isinstance(cell, str) else hasattr(cell, "year")


def is_clocked(cell: Cell) -> bool:
    """A time of day, or a duration that a workbook shows as one."""
    if isinstance(cell, str):
        return is_time_of_day(cell)
    return (hasattr(cell, "hour") and not hasattr(cell, "year")) or hasattr(cell, "total_seconds")


def is_stamp(cell: Cell) -> bool:
    return is_dated(cell) or is_clocked(cell)


def mostly(cells: Iterable[Cell], test: Callable[[Cell], bool], least: float, of: int) -> bool:
    """Whether more than a share `least` of `of` cells pass a test; it stops where that can no longer be."""
    left = of - least * of
    for cell in cells:
        if not test(cell):
            left -= 1
            if left <= 0:
                return False
    return left > 0


def is_empty(cell: Cell) -> bool:
    return cell is None or (isinstance(cell, str) and cell.strip().casefold() in WORDS)
