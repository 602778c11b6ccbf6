"""A zone above the rows that is named by its places, as Windows has them: 'Zeitzone: (UTC+01:00) Berlin, Bern', also
behind a start. Its offset is that of winter: nobody says whether the clock was put ahead."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cache
from zoneinfo import available_timezones

from thermodata.reader.times.zone import utc_offset_ns

_PLACED = re.compile(
    r"\s*\((?:UTC|GMT)\s?(?P<sign>[+\u2212-])(?P<hours>\d{1,2})(?::?(?P<minutes>\d\d))?\)\s*(?P<places>[^\W\d_][^;()\d]*)$"
)
_BY_NAME = re.compile(r"(?<![\w/])[A-Z][A-Za-z]+(?:/[A-Z][A-Za-z_+-]+\d*){1,2}(?![\w/])")
_WINTER_S, _SUMMER_S = 1767268800, 1782907200  # of 2026; south of the equator the other way round


_zones = cache(available_timezones)


def without_places(text: str) -> str:
    """A time without the zone behind it: '08:00:00 (UTC+01:00) Berlin' is a time of the place."""
    return _PLACED.sub("", text)


def place_in(text: str) -> tuple[str | None, str]:
    """(the IANA zone that a text names, the rest of it): '08:00:00 [Europe/Berlin]'. None where it names none."""
    for match in _BY_NAME.finditer(text):
        if match[0] in _zones():
            return match[0], f"{text[: match.start()]} {text[match.end() :]}"
    return None, text


def places_above(lines: Iterable[Sequence[str]]) -> tuple[str | None, str] | None:
    """(the IANA zone of the places; where they have none, that of their offset, or None; the line) of a zone above the
    rows. None where no line names one."""
    for cells in lines:
        text = " ".join(c.strip() for c in cells if c.strip()).strip("#%;/* \t\"'")
        match = _PLACED.search(text)
        if match is None:
            continue
        hours, minutes = int(match["hours"]), int(match["minutes"] or 0)
        east = (1 if match["sign"] == "+" else -1) * (hours * 60 + minutes)
        plain = f"Etc/GMT{-east // 60:+d}" if hours <= 12 and not minutes else None
        return _zone_of(re.split(r"\s*,\s*", match["places"].strip()), east * 60) or plain, text
    return None


def zone_by_name(lines: Iterable[Sequence[str]]) -> tuple[str, str] | None:
    """(the IANA zone, the line) of lines above the rows that name one: 'Time zone: America/New_York'. None where none
    does, or they name several."""
    found: dict[str, str] = {}
    for cells in lines:
        text = " ".join(c.strip() for c in cells if c.strip()).strip("#%;/* \t\"'")
        for match in _BY_NAME.finditer(text):
            if match[0] in _zones():
                found.setdefault(match[0], text)
    return next(iter(found.items())) if len(found) == 1 else None


def _zone_of(places: Sequence[str], east_s: int) -> str | None:
    """The zone that is called by the first of some places, with this offset in its winter [s]."""
    by_place: dict[str, list[str]] = {}
    for name in sorted(_zones()):
        area, _, place = name.rpartition("/")
        if area and "/" not in area and area != "Etc":
            by_place.setdefault(place.replace("_", " ").casefold(), []).append(name)
    for place in places:
        for name in by_place.get(place.casefold(), ()):
            if min(utc_offset_ns(name, s) for s in (_WINTER_S, _SUMMER_S)) == east_s * 10**9:
                return name
    return None
