"""A power claimed as heat of the cut, beside the heat of its motor or where nothing is cut (tell/candidate/why.py)."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from thermodata.diagnosis.tell.candidate.of_claim import also_of_motor, heats_its_motor, where_nothing_is_cut
from thermodata.diagnosis.tell.candidate.row import _unread_places
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Need
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import PlainEffect, a_test, scored


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


MOTOR_AT = "spindle.motor"


def at(name: str, quantity: str, place: str) -> ChannelInfo:
    return ChannelInfo(name, quantity, "degC" if quantity == "temperature" else "kW", at=place)


KINDS = ("cutting", "mixed", "other", "spindle", "etve", *("mixed",) * 5)


@pytest.mark.parametrize(
    ("family", "acts", "told"),
    [
        ("cutting", (0, 1, 2), ""),
        ("cutting", (0, 3), "it acts in t3 (spindle), where nothing is cut"),
        ("cutting", (3, 4), "it acts in t3 (spindle), t4 (etve), where nothing is cut"),
        ("spindle", (0, 3), ""),
    ],
)
def test_what_acts_in_tests_without_a_cut_is_told_not_to_be_of_the_cut(
    family: str, acts: tuple[int, ...], told: str
) -> None:
    tests = [replace(a_test(f"t{k}"), kind=kind) for k, kind in enumerate(KINDS)]
    one = scored(family=family, size=[1.0 if k in acts else 0.0 for k in range(len(tests))])
    said = where_nothing_is_cut(one, tests)
    assert told in said
    assert bool(said) is bool(told)


@pytest.mark.parametrize(
    ("family", "acts", "first"),
    [
        ("cutting", (3, 1), True),  # a mixed test may cut or not
        ("cutting", (3, 0), False),
        ("cutting", (1, 2), False),
        ("spindle", (3,), False),
    ],
)
def test_the_motor_comes_first_of_what_acts_where_nothing_is_cut_alone(
    family: str, acts: tuple[int, ...], first: bool
) -> None:
    tests = [replace(a_test(f"t{k}"), kind=kind) for k, kind in enumerate(KINDS)]
    one = scored(family=family, size=[1.0 if k in acts else 0.0 for k in range(len(tests))])
    assert heats_its_motor(one, tests) is first


@pytest.mark.parametrize(("claimed", "places"), [(False, ["spindle.motor"]), (True, [])])
def test_a_motor_that_a_twin_reads_is_named_and_one_that_is_claimed_is_not(claimed: bool, places: list[str]) -> None:
    """'cutting_power or a warming fixture' headed a claim by tests in which nothing is cut."""
    tests = [replace(a_test(f"t{k}"), kind="spectrum") for k in range(10)]
    power, motor = scored("cutting_power", family="cutting", channels=("P",)), scored("motor", channels=("T_m",))
    data: Any = SimpleNamespace(channels={"P": at("P", "power", "spindle"), "T_m": at("T_m", "temperature", MOTOR_AT)})
    claims = (power, motor) if claimed else (power,)
    judged = tuple(Judged(one, one, None, ()) for one in claims)
    told: Any = SimpleNamespace(listed=power, twins=() if claimed else (motor.candidate,))
    problem = SimpleNamespace(blocks=[SimpleNamespace(test=t) for t in tests])
    outcome: Any = SimpleNamespace(
        judgement=Judgement("effect", judged, (), judged, ""), investigation=SimpleNamespace(problem=problem)
    )
    assert _unread_places(told, outcome, data) == places
