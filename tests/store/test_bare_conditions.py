"""A condition that is a number without a unit is kept, and told where its name says that it should have one."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.schema.files.load import load_campaign
from thermodata.store.catalogue.conditions import plain_value
from thermodata.store.ingest.told.declared.bare_conditions import UNIT, conditions_without_unit

TEXT = """schema: thermodata/campaign/1
id: c
sources: {log: {reader: table, files: "raw/{test}.csv"}}
channels: {}
tests:
  - {id: a, conditions: {speed: 9000 rpm, nr: 3, dry: true}}
  - {id: b, conditions: {speed: 6000, air: 20 degC}}
  - {id: c, conditions: {speed: "3000", oil: type 2}}
  - id: d
    conditions:
      Table_feed: 1.5
"""


def told(text: str, folder: Path) -> list[str]:
    path = folder / "campaign.yaml"
    path.write_text(text)
    return conditions_without_unit(load_campaign(path), path)


def test_it_is_told_once_with_the_line_and_what_it_is_taken_for(tmp_path: Path) -> None:
    assert told(TEXT, tmp_path) == [
        "b and 1 more: the condition 'speed: 6000' has no unit and is kept as the number alone, as if it were rpm; "
        "write 'speed: 6000 rpm', or the unit that it has (campaign.yaml, line 7)",
        "d: the condition 'Table_feed: 1.5' has no unit and is kept as the number alone, as if it were m/min; write "
        "'Table_feed: 1.5 m/min', or the unit that it has (campaign.yaml, line 11)",
    ]


def test_with_units_nothing_is_told(tmp_path: Path) -> None:
    text = TEXT.replace("6000", "6000 rpm").replace('"3000"', "50 1/s").replace("1.5", "1.5 m/min")
    assert told(text, tmp_path) == []


@pytest.mark.parametrize(
    ("condition", "is_told"),
    [
        ("speed: 0", False),
        ('load: "0"', False),
        ("fan_position: 2", False),
        ("position: 2", True),
        ("air: 1", False),
        ("air: 0", False),
        ("sealing_air: 1", False),
        ("air: 21", True),
        ("speed: 1", True),
        ("Table_feed: 1", True),
    ],
)
def test_a_zero_a_switch_and_one_of_a_row_need_no_unit(tmp_path: Path, condition: str, is_told: bool) -> None:
    assert bool(told(TEXT[: TEXT.index("  - ")] + f"  - {{id: a, conditions: {{{condition}}}}}\n", tmp_path)) is is_told


@pytest.mark.parametrize(("name", "unit"), UNIT.items())
def test_the_unit_that_is_named_is_that_of_the_numbers_beside_it(name: str, unit: str) -> None:
    assert plain_value(f"3 {unit}") == plain_value(3), name
