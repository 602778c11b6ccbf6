"""Words by which a log says in which pass of the hour that repeats in autumn it was written: 'MESZ' in its name,
'Zeit (CET)' above its rows, 'Start: 25.10.2026 02:10 Winterzeit'."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from datetime import timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

from thermodata.archive.unpacked import held
from thermodata.errors import FormatError
from thermodata.reader.text.cells.cell import is_number
from thermodata.reader.text.cells.time_forms.zone_words import HOURS
from thermodata.reader.text.file.encoding import decode_head
from thermodata.reader.times.repeated_hour import RepeatedHour

SUMMER = (
    "sommerzeit|summer ?time|daylight[ -]?saving time|daylight time|heure d[’' ]?été|ora legale|horario de verano|"
    "horário de verão|letní čas|letního času|czas letni|czasu letniego|zomertijd|sommartid|夏令时|夏時間"
)
WINTER = (
    "winterzeit|normalzeit|winter ?time|standard ?time|heure d[’' ]?hiver|ora solare|horario de invierno|"
    "horário de inverno|zimní čas|zimního času|czas zimowy|czasu zimowego|wintertijd|vintertid|normaltid|冬令时|冬時間"
)
# 'Sommerzeit: ein' is a switch of the logger, by which its clock changes by itself
_SWITCH = r"(?![^\W_])(?!\s*[:=;,\t]\s*(?:\w+)?\s*$)"
_SPOKEN = re.compile(rf"(?i)(?<![^\W_])(?:(?P<summer>{SUMMER})|(?P<winter>{WINTER})){_SWITCH}")
_BESIDE_A_TIME = re.compile(
    rf"(?i)\s*[\[(](?:{SUMMER}|{WINTER})[\])]|(?<=\d)\s+(?:Uhr\s+)?(?:{SUMMER}|{WINTER})(?![^\W_])"
)
_WORD = re.compile(r"(?<![^\W_])[^\W\d_]{3,5}(?![^\W_])")
_HEAD, _MOST_LINES = 4096, 60


def pass_said(texts: Iterable[str], hour: RepeatedHour, zone: str) -> tuple[bool, str] | None:
    """(whether texts say the second pass, the first word that does); None where none says one, or words say both.
    zone: whose own abbreviations count, beside those that name one offset alone."""
    found: dict[bool, str] = {}
    for text in texts:
        for second, word in _passes_named(text, hour, zone):
            found.setdefault(second, word)
    return next(iter(found.items())) if len(found) == 1 else None


def _passes_named(text: str, hour: RepeatedHour, zone: str) -> Iterator[tuple[bool, str]]:
    for match in _SPOKEN.finditer(text):
        yield match["winter"] is not None, match[0]
    own = {hour.abbreviation(ZoneInfo(zone), second): second for second in (False, True)}
    hours = {hour.offset(second).utcoffset(None): second for second in (False, True)}
    for word in _WORD.findall(text):  # in capitals, or 'est' would be one
        if word in own:
            yield own[word], word
        elif word in HOURS and (second := hours.get(timedelta(hours=HOURS[word]))) is not None:
            yield second, word


def without_pass(cell: str) -> str:
    """A start above the rows without the word that says its pass: 'Beginn (Sommerzeit): 25.10.2026 02:10'. Without
    brackets it stands behind a time, for 'Beginn Sommerzeit: 29.03.2026' is no start."""
    return _BESIDE_A_TIME.sub("", cell)


def lines_above(path: Path) -> list[str]:
    """The lines of a text above its first row of numbers; [] of other files."""
    try:
        with held(path) as real, real.open("rb") as file:
            text = decode_head(file.read(_HEAD))
    except (FormatError, OSError):
        return []
    found: list[str] = []
    for line in (text or "").splitlines()[:_MOST_LINES]:
        cells = [c.strip() for c in re.split(r"[\t;,|]", line) if c.strip()]
        if len(cells) > 1 and is_number(cells[-1]) and re.match(r"[\"'+-]?\d", cells[0]):
            break
        found.append(line)
    return found


__all__ = ["SUMMER", "WINTER", "lines_above", "pass_said", "without_pass"]
