"""A quantity that a campaign file leaves out: taken from a unit that has only one, proposed where there are several."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.load import parse_campaign
from thermodata.schema.units.quantity_of import quantities_of

FILE = """schema: thermodata/campaign/1
id: c
machine: {{id: M1}}
sources:
  log: {{reader: table, files: "raw/{{test}}.csv", table: {{header_rows: 1, time: {{column: 1, unit: s}}}}}}
channels:
  ch: {{source: log, signal: S, {keys}}}
tests:
  - {{id: a}}
"""


@pytest.mark.parametrize(
    ("keys", "quantity"),
    [
        ("unit: degC", "temperature"),
        ("unit: 0.1 degC", "temperature"),
        ("unit: U/min", "rotational_speed"),
        ("unit: kW", "power"),
        ("unit: m/min", "feed"),
        ("unit: m/min, axis: X", "feed"),
        ("unit: Nm", "torque"),
        ("unit: um, axis: Z", "displacement"),
        ("unit: mm, at: tcp", "displacement"),
        ("unit: mm, at: axis.x", "position"),
    ],
)
def test_a_unit_that_has_one_quantity_says_it(keys: str, quantity: str) -> None:
    assert parse_campaign(FILE.format(keys=keys)).channels["ch"].quantity == quantity


@pytest.mark.parametrize(
    ("keys", "proposed"),
    [
        ("unit: um", "displacement or position"),
        ("unit: mm, axis: Z, at: axis.z", "displacement or position"),
        ("unit: K", "temperature or temperature_difference"),
        ("unit: '%'", "load or humidity"),
        ("unit: '1'", "state or label"),
        ("unit: V, axis: Z", "displacement or voltage"),
        ("unit: V, calibration: jump", "voltage"),
        ("at: hall", "state or label"),
    ],
)
def test_an_open_quantity_is_asked_with_what_the_unit_allows(keys: str, proposed: str) -> None:
    with pytest.raises(SpecError, match="the key 'quantity' is missing") as told:
        parse_campaign(FILE.format(keys=keys))
    assert str(told.value.expected).endswith(proposed)
    assert str(told.value.where).endswith("(channels.ch)")


def test_a_misspelt_quantity_is_asked_as_a_slip() -> None:
    with pytest.raises(SpecError, match="unknown key 'quantiy'") as told:
        parse_campaign(FILE.format(keys="unit: K, quantiy: temperature"))
    assert "did you mean 'quantity'?" in str(told.value.hint)


def test_an_energy_and_a_word_that_is_no_unit_say_nothing() -> None:
    assert quantities_of("kWh") == quantities_of("foo") == ()


def test_the_published_schema_asks_no_quantity_of_a_channel() -> None:
    schema = json.loads((Path(__file__).parents[2] / "schemas" / "campaign-1.schema.json").read_text())
    assert "quantity" not in schema["$defs"]["Channel"].get("required", [])
