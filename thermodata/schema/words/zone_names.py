"""The time zone that a name of a city means which IANA does not list."""

from __future__ import annotations

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


def meant_zone(name: str, known: Sequence[str]) -> str | None:
    """The zone that a name most likely means; None where none is near."""
    city = name.rsplit("/", 1)[-1].strip().replace(" ", "_").casefold()
    zone = _ZONES.get(city)
    same = next((z for z in known if z.rsplit("/", 1)[-1].casefold() == city), None)
    return zone if zone in known else same or nearest(name, known)
