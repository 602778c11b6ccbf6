"""A zone that is named, and leaves open where the times stand in summer: 'Zeit (MEZ)', 'Time [EST]', or an offset above
the rows beside 'Daylight saving: on', which may hold it or not."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

from thermodata.reader.text.cells.time_forms.zone_words import HOURS, offset_and_saving, zone_above
from thermodata.reader.text.preamble.zone_places import places_above, zone_by_name
from thermodata.reader.text.tables.table import TimedGroup
from thermodata.reader.times.zone import utc_offset_ns

SAYS = "the head says"
OPEN = "whose clocks may be put ahead in summer or not"
_NO_NAMES = ("Z", "UT", "UTC", "GMT")  # which are told without a question, or are no words of a header
_WORDS = "|".join(sorted(set(HOURS).difference(_NO_NAMES), key=len, reverse=True))
_NAMED = re.compile(rf"(?:^|[\s_,;(\[])(?P<word>{_WORDS})(?=$|[\s,;)\]])")  # in capitals, or 'est' would be one
_SAVING = re.compile(
    r"(?i)(?:dst|daylight[ -]?saving(?:s)?(?: time)?|summer ?time|sommerzeit|heure d'été|ora legale|horario de verano|"
    r"horário de verão|letní čas|czas letni|zomertijd|sommartid|夏令时|夏時間|サマータイム)"
)
_LONGEST = 80  # letters of a line in a note
_ON = ("on", "yes", "1", "true", "ein", "an", "ja", "aktiv", "active", "enabled", "oui", "si", "sì", "sí", "ano", "tak")


def named_in(headers: Iterable[str]) -> tuple[str, str] | None:
    """(the IANA zone of the offset that a word in a header names, the header): 'Zeit (MEZ)'. None where none does."""
    for header in headers:
        if match := _NAMED.search(header):
            hours = HOURS[match["word"]]
            return f"Etc/GMT{-hours:+d}" if hours else "UTC", header  # signs as POSIX has them
    return None


def saving_on(lines: Iterable[Sequence[str]]) -> str | None:
    """The line above the rows that says that clocks are put ahead: 'Daylight saving,On'. None where none says so."""
    for cells in lines:
        text = " ".join(c.strip() for c in cells if c.strip()).strip("#%;/* \t\"'")
        match = _SAVING.match(text)
        if match is not None and text[match.end() :].strip(" \t:=,;").casefold() in _ON:
            return text
    return None


def zones_said(
    groups: tuple[TimedGroup, ...], names: Sequence[str], above: Iterable[Sequence[str]], timezone: str | None
) -> tuple[tuple[TimedGroup, ...], tuple[str, str] | None, str | None]:
    """(the groups with the zone of the lines above them where that is sure and none is declared; what zone is said at
    all, and where; the note on one that is not taken, for it is open). names: of the columns."""
    lines = list(offset_and_saving(above))
    zone, saving = zone_above(lines), saving_on(lines)
    if saving is not None and zone is not None:
        return groups, None, _note_of_open_zone(f"{zone[1]}; {saving}", zone[0]) if timezone is None else None
    if zone is not None:
        if timezone is None:
            groups = tuple(g if g.stated else replace(g, stated=zone[0], above=zone[1]) for g in groups)
        return groups, zone, None
    placed = places_above(lines)
    if placed is not None:
        known = None if placed[0] is None else (placed[0], placed[1])
        return groups, known, _of_places(placed[1], placed[0]) if timezone is None else None
    open_groups = [g for g in groups if g.absolute and not (g.zoned or g.stated)]
    if open_groups and (by_name := zone_by_name(lines)) is not None:
        return groups, by_name, None if timezone else f"{SAYS} '{by_name[1][:_LONGEST]}': timezone: {by_name[0]}"
    named = named_in(names[i] for g in open_groups for i in g.group.time)
    return groups, named, None if named is None or timezone is not None else _note_of_open_zone(named[1], named[0])


def named_note(headers: Sequence[str], timezone: str | None, first_ns: int, last_ns: int) -> str | None:
    """What is said of a zone that headers name: open where none is declared, contradicted where the declared one stands
    elsewhere at the first or the last row [ns since 1970]; None else."""
    named = named_in(headers)
    if named is None or timezone is None:
        return None if named is None else _note_of_open_zone(named[1], named[0])
    ends = (first_ns // 10**9, last_ns // 10**9)
    other = any(utc_offset_ns(timezone, s) != utc_offset_ns(named[0], s) for s in ends)
    return f"the header says '{named[1][:60]}'; the declared {timezone} is used" if other else None


def _of_places(said: str, zone: str | None) -> str:
    """The note on a zone with places."""
    return f"{SAYS} '{said[:_LONGEST]}', {OPEN}" + (f": timezone: {zone} where they are" if zone else "")


def _note_of_open_zone(said: str, zone: str) -> str:
    return f"{SAYS} '{said[:60]}', {OPEN}: timezone: {zone} where they never are"
