"""Whether a header says that its column is the time, and in what unit."""

from __future__ import annotations

import re

from thermodata.reader.text.cells.cell import TIME_WORD
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.times.since import count_in
from thermodata.reader.times.time_units import EPOCHS, SECONDS, known_unit
from thermodata.reader.times.time_words import UNIT_OF_WORD

_UNIT_BEHIND = re.compile(
    r"^(?P<word>[^\W\d_]+(?: [^\W\d_]+)??)(?P<between>\s+(?:in|en|v|w|i)\s+|\s*[/,:]\s*|[ _.]+)"
    r"(?P<unit>[^\W\d_]{1,10})\.?$"
)
_FIRST_WORD = re.compile(r"^[^\W\d_]+")
_BRACKETS = re.compile(r"^(?P<name>.*\S)\s*[(\[](?P<unit>[^()\[\]]+)[)\]]$")
_SECONDS = r"s|secs?|seconds?|sekunden|ms|millis(?:econds?)?|millisekunden"
_OF_DAY = re.compile(
    rf"(?i)(?<![^\W_])(?:(?P<unit>{_SECONDS}|minutes?|minuten|hours|stunden)[ _]?"
    r"(?:since|after|past|from|seit|nach)[ _](?:last[ _])?(?:midnight|mitternacht|0?0:00)|"
    rf"(?P<of>{_SECONDS})[ _]of[ _](?:the[ _])?day)(?![^\W_])"
)
_MARK = re.compile(r"^\s*[#%;]+\s*")  # of a comment that holds the header


def unit_of_time(header: str, unit: str | None = None) -> str | None:
    """The unit of time that a header names, in brackets or behind the word for time: "Zeit in h", "t / min", "time_ms".
    unit: what was split from it, or stands in a row of its own. None where it names none."""
    name, own = _name_and_time_unit(header)
    for text in (unit, own):
        if text is not None:
            return known_unit(text)
    match = _UNIT_BEHIND.match(_MARK.sub("", name).strip())
    if match is None or not TIME_WORD.match(match["word"]):
        return None
    low = match["unit"].lower()
    return low if low in SECONDS else UNIT_OF_WORD.get(low)


def is_time_header(header: str, unit: str | None = None) -> bool:
    """Whether a header says that its column is the time: by its word, or by a unit of time behind that."""
    if since_midnight(header) is not None:
        return True
    name, own = _name_and_time_unit(header)
    name = _MARK.sub("", name).strip()
    if unit is not None and unit_of_time(header, unit) is None:
        return False
    return TIME_WORD.match(name) is not None or (own is None and unit_of_time(header) is not None)


def since_midnight(header: str) -> str | None:
    """'s since midnight' of a header that says such a count in words: numbers that tell the time of day. None of
    others."""
    match = _OF_DAY.search(header)
    if match is None:
        return None
    word = (match["unit"] or match["of"]).lower()
    each = SECONDS["ms"] if word.startswith("milli") else SECONDS[word]
    return next((f"{unit} since midnight" for unit in ("s", "ms", "min", "h") if SECONDS[unit] == each), None)


def says_time(cell: str) -> bool:
    """Whether a cell is a word for time, or begins with one: 'Zeit  1 - Standard [s]', 'Date Time, GMT+01:00'."""
    first = _FIRST_WORD.match(cell)
    word = split_unit(cell)[0]
    return TIME_WORD.match(word) is not None or (
        first is not None and len(first[0]) > 1 and TIME_WORD.match(first[0]) is not None
    )


def _name_and_time_unit(header: str) -> tuple[str, str | None]:
    """(name, unit or None), a count from a date as a unit, too: 'Timestamp (OADate)'."""
    if (stated := count_in(header)) is not None:  # 'seconds since 2000-01-01', 't [s since 1900-01-01]'
        return "time", stated
    name, unit = split_unit(header)
    match = _BRACKETS.match(name.strip()) if unit is None else None
    known = None if match is None else known_unit(match["unit"])
    if match is None or known is None or (known not in EPOCHS and TIME_WORD.match(match["name"]) is None):
        return name, unit
    return match["name"], match["unit"]
