"""Units that only humidity has, as loggers of air write them."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess
from thermodata.reader.text import split_unit


@pytest.mark.parametrize("unit", ["%H", "%rF", "% r.H.", "%RH"])
def test_a_share_that_only_air_has_is_its_humidity(unit: str) -> None:
    said = guess("Halle", unit)
    assert (said.quantity, said.unit, said.at) == ("humidity", unit, "hall")
    assert split_unit(f"M01: {unit}") == ("M01", unit)


def test_a_bare_share_is_asked_and_a_load_stays_one() -> None:
    assert guess("Halle", "%").quantity is None
    assert guess("Last Spindel", "%").quantity == "load"


def test_a_name_that_says_another_share_than_its_unit_is_asked() -> None:
    said = guess("Last Spindel", "%rF")
    assert said.quantity == "humidity"
    assert "quantity: load?" in said.comment()


def test_a_right_hand_bearing_is_no_humidity() -> None:
    """RH is the right-hand one as well, where the name says a temperature."""
    assert guess("T bearing", "RH").quantity is None
    assert guess("Halle", "RH").quantity == "humidity"
