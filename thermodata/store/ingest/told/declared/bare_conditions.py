"""Conditions of tests that are numbers without a unit, where their name says that they should have one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermodata.errors import ThermodataError
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.strict.lines import read_document
from thermodata.schema.units.quantity import CANONICAL_UNIT
from thermodata.schema.units.value import split_value
from thermodata.store.catalogue.conditions import plain_value

# what a condition is called -> the unit in which `plain_value` keeps what has one; a count (`nr: 3`) has none
_KEPT = {name: unit for name, unit in CANONICAL_UNIT.items() if unit != "1" and plain_value(f"3 {unit}") == 3.0}
UNIT = _KEPT | {
    "speed": "rpm",
    "air": "degC",
    "preload": "N",
    "force": "N",
    "length": "mm",
    "diameter": "mm",
    "duration": "s",
}
_WHOLE = frozenset({"position"})  # as the last of several words it is one of a row: fan_position: 2
_SWITCH = frozenset({"air"})  # cutting air, or the air that seals, is on or off


def conditions_without_unit(campaign: Campaign, path: Path) -> list[str]:
    """A sentence a condition, with the line of the first test that has it so. path: of the campaign file."""
    found: dict[tuple[str, str], list[tuple[str, Any]]] = {}
    for test in campaign.tests:
        for name, value in test.conditions.items():
            unit = _unit(name)
            if unit is not None and _lacks_unit(name, value):
                found.setdefault((name, unit), []).append((test.id, value))
    lines = _lines(path) if found else {}
    said = []
    for (name, unit), tests in found.items():
        first, value = tests[0]
        others = f" and {len(tests) - 1} more" if len(tests) > 1 else ""
        where = f" ({path.name}, line {lines[first, name]})" if (first, name) in lines else ""
        said.append(
            f"{first}{others}: the condition '{name}: {value}' has no unit and is kept as the number alone, as if it "
            f"were {unit}; write '{name}: {value} {unit}', or the unit that it has{where}"
        )
    return said


def _unit(name: str) -> str | None:
    """The unit that a condition of this name is read in: by its whole name, else by its last word."""
    last = _last_word(name)
    return UNIT.get(name.lower()) or (None if last in _WHOLE else UNIT.get(last))


def _last_word(name: str) -> str:
    return name.lower().rpartition("_")[2]


def _lacks_unit(name: str, value: Any) -> bool:
    """Of a number alone, but for 0, which is nothing in any unit, and 1 of what may be switched."""
    if isinstance(value, bool):
        return False
    try:
        number, unit = split_value(value)
    except ThermodataError:
        return False
    return not unit and number != 0 and not (number == 1 and _last_word(name) in _SWITCH)


def _lines(path: Path) -> dict[tuple[str, str], int]:
    """(test, condition) -> its line; of tests that stand in the file one by one."""
    try:
        document = read_document(path)
    except (ThermodataError, OSError):
        return {}
    tests = document.data.get("tests")
    return {
        (test["id"], name): document.line["tests", i, "conditions", name]
        for i, test in enumerate(tests if isinstance(tests, list) else [])
        if isinstance(test, dict) and isinstance(test.get("conditions"), dict)
        for name in test["conditions"]
        if ("tests", i, "conditions", name) in document.line
    }
