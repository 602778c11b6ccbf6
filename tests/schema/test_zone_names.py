"""Cities that IANA does not list are answered with their zone, and not with a name of like letters."""

from __future__ import annotations

from zoneinfo import available_timezones

import pytest

from thermodata.schema.words.zone_names import _ZONES, meant_zone

KNOWN = sorted(available_timezones())


@pytest.mark.parametrize(
    ("name", "zone"),
    [
        ("Asia/Beijing", "Asia/Shanghai"),
        ("Europe/Munich", "Europe/Berlin"),
        ("America/San Francisco", "America/Los_Angeles"),
        ("Prag", "Europe/Prague"),
        ("prague", "Europe/Prague"),
        ("Europe/Pragu", "Europe/Prague"),
        ("US/Tokyo", "Asia/Tokyo"),
        ("x", None),
    ],
)
def test_a_city_is_answered_with_its_zone(name: str, zone: str | None) -> None:
    assert meant_zone(name, KNOWN) == zone


def test_all_zones_of_cities_exist() -> None:
    assert set(_ZONES.values()) <= set(KNOWN)
