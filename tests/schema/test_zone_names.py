"""Cities that IANA does not list are answered with their zone, and not with a name of like letters."""

from __future__ import annotations

from zoneinfo import available_timezones

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.load import parse_campaign
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


@pytest.mark.parametrize(
    ("written", "zone"),
    [
        ('"+01:00"', "Etc/GMT-1"),
        ("+01:00", "Etc/GMT-1"),
        ("UTC+1", "Etc/GMT-1"),
        ("UTC+01:00", "Etc/GMT-1"),
        ("GMT-5", "Etc/GMT+5"),
        ("UTC+0", "UTC"),
        ("Etc/GMT-1", "Etc/GMT-1"),
        ("Europe/Prague", "Europe/Prague"),
    ],
)
def test_a_clock_on_winter_time_all_year_has_an_offset(written: str, zone: str) -> None:
    assert parse_campaign(_ONE.format(written)).sources["nc"].timezone == zone


@pytest.mark.parametrize(
    ("written", "said"), [("+05:30", "Asia/Kolkata"), ("+10:00", "quotes"), ("UTC+15", "whole hours")]
)
def test_an_offset_that_no_zone_has_is_answered_with_what_to_write(written: str, said: str) -> None:
    with pytest.raises(SpecError, match=said):
        parse_campaign(_ONE.format(written))


_ONE = """\
schema: thermodata/campaign/1
id: lab
sources:
  nc: {{reader: cnc, files: "raw/{{test}}.csv", timezone: {}}}
channels: {{}}
tests: [{{id: day1}}]
"""
