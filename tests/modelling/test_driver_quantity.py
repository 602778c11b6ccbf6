"""A named effect takes the quantity that it needs, for its gain has a unit by it; a generic one takes any."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from thermodata.errors import SpecError
from thermodata.modelling.model_file.resolve import resolve
from thermodata.view.grid.dataset import ChannelInfo, Dataset

from .conftest import Spec


@pytest.fixture(scope="module")
def plant(world: Dataset) -> Dataset:
    """The world with more of what a control logs."""
    infos = {
        "dT": ChannelInfo("dT", "temperature_difference", "K", "column"),
        "feed_Z": ChannelInfo("feed_Z", "feed", "m/min", "axis.z"),
        "power": ChannelInfo("power", "power", "kW", "spindle"),
    }
    tests = tuple(
        replace(t, channels={**t.channels, **infos}, values={**t.values, **dict.fromkeys(infos, t.values["speed"])})
        for t in world.tests
    )
    return replace(world, tests=tests, channels={**world.channels, **infos})


def _bound(data: Dataset, spec: Spec, effect: str, drivers: dict[str, Any]) -> dict[str, str]:
    _, (response,) = resolve(spec({"effect": effect, "drivers": drivers}), data)
    return dict(response.terms[0].binding)


@pytest.mark.parametrize(
    ("effect", "drivers"),
    [
        ("spindle_bearing", {"temperature": "T_nut"}),
        ("spindle_bearing", {"temperature": "T_bearing - T_hall"}),
        ("spindle_bearing", {"temperature": "dT"}),
        ("spindle_bearing", {"temperature": "2 * dT"}),
        ("spindle_friction", {"speed": "abs(speed)"}),
        ("coolant", {"state": "speed > 100 rpm"}),
        ("cutting_power", {"power": "power"}),
        ("feed_screw", {"feed": "feed_Z"}),
        ("lag", {"u": "speed"}),
        ("lag", {"u": "coolant_on * T_nut"}),
        ("transfer_function", {"u": "power"}),
    ],
)
def test_what_it_needs_is_taken(plant: Dataset, spec: Spec, effect: str, drivers: dict[str, str]) -> None:
    assert _bound(plant, spec, effect, drivers) == drivers


@pytest.mark.parametrize(
    ("effect", "drivers", "expected", "kind", "hint"),
    [
        (
            "spindle_bearing",
            {"temperature": "speed"},
            "T_bearing, T_nut, T_hall",
            "of quantity rotational_speed",
            "lag",
        ),
        ("spindle_bearing", {"temperature": "2 * speed"}, "a temperature", "of quantity rotational_speed", "lag"),
        ("spindle_bearing", {"temperature": "T_nut > 30 degC"}, "a temperature", "of quantity state", "lag"),
        (
            "spindle_bearing",
            {"temperature": "T_nut * speed"},
            "a temperature",
            "in kelvin * revolutions_per_minute",
            "lag",
        ),
        ("spindle_friction", {"speed": "coolant_on"}, "a rotational_speed: speed", "of quantity state", "lag"),
        ("cutting_power", {"power": "speed"}, "a power: power", "of quantity rotational_speed", "lag"),
        ("feed_screw", {"temperature": "feed_Z"}, "a temperature", "of quantity feed", "drivers: {feed: feed_Z}"),
        ("coolant", {"flow": "coolant_on"}, "no channel is one", "of quantity state", "drivers: {state: coolant_on}"),
    ],
)
def test_another_quantity_is_refused_with_what_would_fit(
    plant: Dataset, spec: Spec, effect: str, drivers: dict[str, str], expected: str, kind: str, hint: str
) -> None:
    with pytest.raises(SpecError) as caught:
        _bound(plant, spec, effect, drivers)
    error = caught.value
    ((role, driver),) = drivers.items()
    assert effect in error.what
    assert error.where == f"effect '{effect}', campaign c: drivers.{role}"
    assert expected in (error.expected or "")
    assert error.what.endswith(f"'{driver}' is {kind}")
    assert error.got == driver
    assert hint in (error.hint or "")
