"""What an effect stands for in a legend: its id alone ('lag_2') tells nobody what drives it."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from thermodata.view.lists.driven import driven, effects_driven

from .conftest import NOW, Builder

PLACES = {"T_mot": "spindle.motor", "T_brg": "spindle.bearing", "T_hall": "hall", "n": "spindle"}


@pytest.mark.parametrize(
    ("name", "drivers", "said"),
    [
        ("lag_2", ["T_mot"], "lag_2 (T_mot at spindle.motor)"),
        ("spindle_bearing", ["T_brg"], "spindle_bearing (T_brg)"),  # the name says its part
        ("ambient_frame", ["T_hall"], "ambient_frame (T_hall)"),  # the channel does
        ("coolant_heat_lag2", ["T_x", "on"], "coolant_heat_lag2 (T_x, on)"),
        ("slip", [], "slip"),
    ],
)
def test_a_name_says_what_drives_it_and_the_part_where_nothing_else_does(
    name: str, drivers: list[str], said: str
) -> None:
    assert driven(name, drivers, PLACES) == said


def stored(builder: Builder, identity: str, effects: list[dict[str, object]]) -> None:
    builder.add(
        "model", model=identity, name="m", parent=None, campaigns=["lab"], response="dZ",
        spec=json.dumps({"effects": effects}), data_version="v1", stale=False, created_at=NOW, result="{}",
    )  # fmt: skip


def test_drivers_are_those_of_the_model_file_or_found_by_place_as_the_fit_took_them(
    build: Callable[..., Builder],
) -> None:
    builder = build()
    builder.test("lab", "warm")
    builder.channel("lab", "warm", "T_mot", "temperature", at="spindle.motor")
    builder.channel("lab", "warm", "T_front", "temperature", at="spindle.bearing")
    lags = [{"effect": "lag", "drivers": {"input": "T_front"}}, {"effect": "lag", "drivers": {"input": "T_mot"}}]
    motor = {"effect": "spindle_motor", "drivers": {"temperature": {"at": "spindle.motor"}}}
    stored(builder, "a", [*lags, {"effect": "spindle_bearing"}, motor])
    stored(builder, "b", [{"effect": "lag", "drivers": {"input": "T_mot"}}])
    store = builder.store()
    found = effects_driven(store, ["a"])
    assert found["lag"] == "lag (T_front at spindle.bearing)"
    assert found["lag_2"] == "lag_2 (T_mot at spindle.motor)"
    assert found["spindle_bearing"] == "spindle_bearing (T_front)"
    assert found["spindle_motor"] == "spindle_motor (T_mot)"
    both = effects_driven(store, ["a", "b"])["lag"]
    assert both == "lag (T_front at spindle.bearing or T_mot at spindle.motor)"
