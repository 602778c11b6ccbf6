"""A power that is claimed beside the heat of its motor (tell/why.py)."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.diagnosis.tell.why import also_of_motor
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Need

from .hand_made import PlainEffect, scored


def reading(quantity: str, place: str, evidence: float) -> Scored:
    one = scored(quantity, channels=(f"of_{quantity}",), evidence=evidence)
    effect = PlainEffect(quantity, needs=(Need("u", quantity, (place,)),))
    return replace(one, candidate=replace(one.candidate, effect=effect))


MOTOR = reading("temperature", "{s}spindle.motor", 900.0)


@pytest.mark.parametrize(
    ("one", "other", "told"),
    [
        (reading("power", "{s}spindle", 60.0), MOTOR, True),
        (reading("load", "{s}spindle", 60.0), MOTOR, True),
        (reading("feed", "axis.x", 60.0), MOTOR, False),
        (reading("power", "{s}spindle", 2000.0), MOTOR, False),  # sharper, and surely a cause
        (reading("power", "{s}spindle", 60.0), reading("temperature", "{s}spindle.bearing", 900.0), False),
        (reading("power", "{s}spindle", 60.0), reading("temperature", "{s}spindle.motor", 50.0), False),
    ],
)
def test_a_power_beside_the_sharper_heat_of_its_motor_may_be_more_of_it(one: Scored, other: Scored, told: bool) -> None:
    said = also_of_motor(one, [other, one])
    assert bool(said) is told
    if told:
        assert f"{one.candidate.channels[0]} heats the motor too, which is claimed as {other.candidate.id}" in said
