"""The time zone that a name means which IANA does not list: a city, or an offset that holds all year."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import nearest

# large cities of the field by the zone that they keep: a name alike in letters may be a thousand kilometres away
_CITIES = {
    "Asia/Shanghai": "beijing peking china shenzhen guangzhou tianjin wuhan chengdu nanjing suzhou dalian "
    "shenyang xian",
    "Asia/Tokyo": "osaka nagoya kyoto japan yokohama",
    "Asia/Seoul": "busan changwon daejeon korea",
    "Asia/Kolkata": "mumbai delhi new_delhi bangalore bengaluru pune chennai india",
    "Europe/Berlin": "munich muenchen münchen stuttgart frankfurt hamburg cologne koeln köln aachen chemnitz dresden "
    "hannover germany",
    "Europe/Rome": "milan milano turin torino bologna italy roma",
    "Europe/Madrid": "barcelona bilbao san_sebastian spain",
    "Europe/Paris": "lyon toulouse france",
    "Europe/Prague": "praha prag brno plzen pilsen",
    "Europe/Warsaw": "krakow lodz wroclaw gdansk poland warszawa",
    "Europe/Zurich": "geneva bern basel lausanne switzerland zuerich",
    "Europe/Vienna": "wien linz graz austria",
    "Europe/London": "birmingham manchester sheffield england uk",
    "America/New_York": "boston atlanta washington pittsburgh cincinnati",
    "America/Chicago": "dallas houston milwaukee",
    "America/Los_Angeles": "seattle san_francisco san_diego",
}
_ZONES = {city: zone for zone, cities in _CITIES.items() for city in cities.split()}


_OFFSET = re.compile(r"(?:UTC|GMT)?\s*(?P<sign>[+\u2212-])(?P<hours>\d{1,2})(?::?(?P<minutes>\d\d))?", re.IGNORECASE)
# how far zones are ahead of UTC, and behind it [h]
_AHEAD, _BEHIND = 14, 12
OF_OFFSET = (
    "a clock that keeps one offset all year is ahead of UTC by whole hours here: +01:00, or Etc/GMT-1, its IANA name, "
    "whose sign is turned; one of half hours has the name of a place without summer time, such as Asia/Kolkata"
)


AS_A_NUMBER = "YAML takes an offset such as +10:00 for a number: write UTC+10, or put it in quotes"


def hint_for_offset(name: str) -> str | None:
    """What to do where a zone is written as an offset from UTC that is none of whole hours, or as one that YAML has
    made a number of; None for any other name."""
    if re.fullmatch(r"-?\d+", name.strip()) is not None:
        return AS_A_NUMBER
    return OF_OFFSET if _OFFSET.fullmatch(name.strip()) is not None else None


def zone_of_offset(name: str) -> str:
    """The IANA name of an offset of whole hours, 'Etc/GMT-1' of '+01:00', for it counts from there to UTC; any other
    name as it is."""
    found = _OFFSET.fullmatch(name.strip())
    if found is None or int(found["minutes"] or 0):
        return name
    hours = int(found["hours"]) * (1 if found["sign"] == "+" else -1)
    if not -_BEHIND <= hours <= _AHEAD:
        return name
    return f"Etc/GMT{-hours:+d}" if hours else "UTC"


def meant_zone(name: str, known: Sequence[str]) -> str | None:
    """The zone that a name most likely means; None where none is near."""
    city = name.rsplit("/", 1)[-1].strip().replace(" ", "_").casefold()
    zone = _ZONES.get(city)
    same = next((z for z in known if z.rsplit("/", 1)[-1].casefold() == city), None)
    return zone if zone in known else same or nearest(name, known)
