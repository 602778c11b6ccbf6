"""Which channels fit which effect: by quantity, place and letter."""

from __future__ import annotations

import pytest

from thermodata.effect import effect
from thermodata.effect.binding import bindings, candidate_id, family_of, unnamed
from thermodata.effect.places import match
from thermodata.view.grid.dataset import ChannelInfo

CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
        ChannelInfo("T_front", "temperature", "degC", "spindle.bearing.front"),
        ChannelInfo("T_rear", "temperature", "degC", "spindle.bearing.rear"),
        ChannelInfo("T_motor", "temperature", "degC", "spindle.motor"),
        ChannelInfo("n", "rotational_speed", "rpm", "spindle"),
        ChannelInfo("n_table", "rotational_speed", "rpm", "table"),
        ChannelInfo("T_nut_z", "temperature", "degC", "axis.z.nut"),
        ChannelInfo("T_nut_x", "temperature", "degC", "axis.x.nut"),
        ChannelInfo("T_motor_z", "temperature", "degC", "axis.z.motor"),
        ChannelInfo("feed_z", "feed", "m/min", "axis.z"),
        ChannelInfo("pos_x", "position", "mm", "axis.x"),
        ChannelInfo("T_top", "temperature", "degC", "hall.top"),
        ChannelInfo("T_low", "temperature", "degC", "hall.bottom"),
        ChannelInfo("T_cf", "temperature", "degC", "column.front"),
        ChannelInfo("T_cr", "temperature", "degC", "column.rear"),
        ChannelInfo("T_cl", "temperature", "degC", "column.left"),
        ChannelInfo("T_cool", "temperature", "degC", "coolant.supply"),
        ChannelInfo("cool_on", "state", "1", "coolant.supply"),
        ChannelInfo("T_somewhere", "temperature", "degC"),
        ChannelInfo("P", "power", "kW", "spindle"),
        ChannelInfo("P_load", "load", "%", "spindle"),
        ChannelInfo("z_load", "load", "%", "axis.z"),
        ChannelInfo("T_chiller", "temperature", "degC", "chiller.return"),
        ChannelInfo("T_guide_z", "temperature", "degC", "axis.z.guide"),
        ChannelInfo("T_gear", "temperature", "degC", "spindle.gearbox"),
        ChannelInfo("n_b", "rotational_speed", "rpm", "rotary.b"),
        ChannelInfo("T_b", "temperature", "degC", "rotary.b.motor"),
        ChannelInfo("remark", "label", "1"),
    )
}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("spindle_bearing", [{"temperature": "T_front"}, {"temperature": "T_rear"}]),
        ("spindle_motor", [{"temperature": "T_motor"}]),
        ("spindle_friction", [{"speed": "n"}]),
        ("centrifugal_shift", [{"speed": "n"}]),
        ("ambient_frame", [{"temperature": "T_top"}, {"temperature": "T_low"}]),
        ("vertical_gradient", [{"top": "T_top", "bottom": "T_low"}]),
        ("feed_screw", [{"temperature": "T_nut_z"}, {"temperature": "T_nut_x"}, {"feed": "feed_z"}]),
        ("feed_motor", [{"temperature": "T_motor_z"}]),
        ("screw_growth", [{"temperature": "T_nut_x", "position": "pos_x"}]),
        ("table_bearing", [{"speed": "n_table"}]),
        ("tool_elongation", []),
        ("cutting_power", [{"power": "P"}]),
        ("cutting_load", [{"load": "P_load"}]),
        ("coolant", [{"state": "cool_on"}]),
        ("coolant_temperature", [{"temperature": "T_cool"}]),
        ("chiller_temperature", [{"temperature": "T_chiller"}]),
        ("guideway", [{"temperature": "T_guide_z"}]),
        ("spindle_gearbox", [{"temperature": "T_gear"}]),
        ("rotary_axis", [{"temperature": "T_b"}]),
        ("rotary_friction", [{"speed": "n_b"}]),
        ("column_bending", [{"warm_side": "T_cr", "cold_side": "T_cf"}]),
        ("drift", [{}]),
    ],
)
def test_channels_are_found_by_quantity_and_place(name: str, expected: list[dict[str, str]]) -> None:
    assert bindings(effect(name), CHANNELS) == expected


def test_a_plain_lag_takes_every_driver_and_no_response() -> None:
    bound = {b["u"] for b in bindings(effect("lag"), CHANNELS)}
    assert "T_somewhere" in bound
    assert bound == set(CHANNELS) - {"dZ", "remark"}


def test_a_speed_without_a_place_is_the_spindles() -> None:
    channels = {
        "speed": ChannelInfo("speed", "rotational_speed", "rpm"),
        "T1": ChannelInfo("T1", "temperature", "degC"),
    }
    assert bindings(effect("centrifugal_shift"), channels) == [{"speed": "speed"}]
    assert bindings(effect("table_bearing"), channels) == []
    assert bindings(effect("spindle_bearing"), channels) == []


def test_sides_of_the_column_pair_up() -> None:
    both = CHANNELS | {"T_right": ChannelInfo("T_right", "temperature", "degC", "column.right")}
    found = [(b["warm_side"], b["cold_side"]) for b in bindings(effect("column_bending"), both)]
    assert found == [("T_cr", "T_cf"), ("T_cl", "T_right")]


def test_the_bed_bends_by_two_opposite_sides() -> None:
    sides = {s: ChannelInfo(s, "temperature", "degC", f"bed.{s}") for s in ("top", "bottom", "front")}
    found = [tuple(b.values()) for b in bindings(effect("bed_bending"), sides)]
    assert found == [("top", "bottom")]
    assert bindings(effect("bed_bending"), {"T_bed": ChannelInfo("T_bed", "temperature", "degC", "bed")}) == []


TWO_SPINDLES = {
    "T_main": ChannelInfo("T_main", "temperature", "degC", "spindle.bearing.front"),
    "T_counter": ChannelInfo("T_counter", "temperature", "degC", "counter_spindle.bearing"),
    "n_main": ChannelInfo("n_main", "rotational_speed", "rpm", "spindle"),
    "n_counter": ChannelInfo("n_counter", "rotational_speed", "rpm", "counter_spindle"),
}


def test_each_spindle_has_effects_of_its_own() -> None:
    bearing, mixed = effect("spindle_bearing"), effect("spindle_heating_cooling")
    assert bindings(bearing, TWO_SPINDLES) == [{"temperature": "T_main"}, {"temperature": "T_counter"}]
    assert [tuple(b.values()) for b in bindings(mixed, TWO_SPINDLES)] == [
        ("T_main", "n_main"),
        ("T_counter", "n_counter"),
    ]
    assert family_of(bearing, {"temperature": "T_main"}, TWO_SPINDLES) == "spindle"
    assert family_of(bearing, {"temperature": "T_counter"}, TWO_SPINDLES) == "counter_spindle"
    assert family_of(effect("spindle_gearbox"), {"temperature": "T_main"}, TWO_SPINDLES) == "gearbox"


def test_a_speed_without_a_place_is_of_the_spindle_without_a_name() -> None:
    speeds = {"n": ChannelInfo("n", "rotational_speed", "rpm"), "n_counter": TWO_SPINDLES["n_counter"]}
    friction = effect("spindle_friction")
    assert bindings(friction, speeds) == [{"speed": "n"}, {"speed": "n_counter"}]
    assert unnamed(friction, speeds) == [{"speed": "n"}]
    mixed = bindings(effect("spindle_heating_cooling"), speeds | {"T": TWO_SPINDLES["T_counter"]})
    assert [tuple(b.values()) for b in mixed] == [("T", "n_counter")], "nor is it of the counter spindle"


WHOLE = {"T_spindle": ChannelInfo("T_spindle", "temperature", "degC", "spindle")}
SPEED = {"n": ChannelInfo("n", "rotational_speed", "rpm", "spindle")}


def test_a_temperature_of_the_spindle_drives_what_asks_for_its_bearing() -> None:
    for name in ("spindle_bearing", "spindle_bearing_2"):
        assert bindings(effect(name), WHOLE) == [{"temperature": "T_spindle"}]
    for name in ("spindle_heating_cooling", "speed_dependent_gain"):
        assert bindings(effect(name), WHOLE | SPEED) == [{"temperature": "T_spindle", "speed": "n"}]
    assert family_of(effect("spindle_bearing"), {"temperature": "T_spindle"}, WHOLE) == "spindle"


def test_but_not_where_a_bearing_has_a_sensor() -> None:
    front = {"T_front": CHANNELS["T_front"]}
    assert bindings(effect("spindle_bearing"), WHOLE | front) == [{"temperature": "T_front"}]
    assert bindings(effect("spindle_bearing"), front | WHOLE) == [{"temperature": "T_front"}]
    motor = {"T_motor": CHANNELS["T_motor"]}
    assert bindings(effect("spindle_bearing"), WHOLE | motor) == [{"temperature": "T_spindle"}]
    counter = {"T_counter": TWO_SPINDLES["T_counter"]}
    assert bindings(effect("spindle_bearing"), WHOLE | counter) == [
        {"temperature": "T_spindle"},
        {"temperature": "T_counter"},
    ], "each spindle by itself"
    assert bindings(effect("spindle_bearing"), SPEED) == [], "a speed is no temperature"


def test_and_no_other_part_of_it() -> None:
    for name in ("spindle_motor", "spindle_gearbox"):
        assert bindings(effect(name), WHOLE) == []
    counter = {"T": ChannelInfo("T", "temperature", "degC", "counter_spindle")}
    assert family_of(effect("spindle_bearing"), {"temperature": "T"}, counter) == "counter_spindle"


def test_an_effect_without_drivers_means_the_spindle_without_a_name() -> None:
    bearing = effect("spindle_bearing")
    assert unnamed(bearing, TWO_SPINDLES) == [{"temperature": "T_main"}]
    counter = {n: c for n, c in TWO_SPINDLES.items() if "counter" in n}
    assert unnamed(bearing, counter) == [{"temperature": "T_counter"}]
    assert unnamed(effect("feed_screw"), CHANNELS) == bindings(effect("feed_screw"), CHANNELS)


def test_the_family_names_the_axis() -> None:
    screw = effect("feed_screw")
    assert family_of(screw, {"temperature": "T_nut_x"}, CHANNELS) == "feed_x"
    assert family_of(screw, {"feed": "feed_z"}, CHANNELS) == "feed_z"
    assert family_of(screw, {"temperature": "T_somewhere"}, CHANNELS) == "feed"
    assert candidate_id("feed_screw", {"temperature": "T_nut_x"}) == "feed_screw:T_nut_x"


@pytest.mark.parametrize(
    ("pattern", "place", "fits"),
    [
        ("spindle.bearing", "spindle.bearing.front", True),
        ("spindle.bearing", "spindle", False),
        ("spindle.bearing", "spindle.bearings", False),
        ("spindle.bearing?", "spindle.bearing.front", True),
        ("spindle.bearing?", "spindle", True),
        ("spindle.bearing?", "spindle.motor", False),
        ("spindle.bearing?", "headstock", False),
        ("hall.*", "hall", True),
        ("hall.*", "hall.top", True),
        ("axis.{a}.nut", "axis.z.nut", True),
        ("axis.{a}.nut", "axis.z.motor", False),
        ("floor", None, False),
    ],
)
def test_a_place_holds_what_is_below_it(pattern: str, place: str | None, fits: bool) -> None:
    assert (match(pattern, place) is not None) is fits
