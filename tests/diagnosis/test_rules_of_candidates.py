"""What may be asked for, and within which bounds (candidates/of_library.py, candidates/grid.py)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.grid import grid
from thermodata.diagnosis.candidates.of_library import candidates
from thermodata.diagnosis.candidates.seen import Seen
from thermodata.diagnosis.candidates.warm_at_rest import warm_at_rest
from thermodata.diagnosis.claims.refines import mode_of
from thermodata.diagnosis.question.present import Present
from thermodata.diagnosis.tell.candidate.why import would_be_a_mode
from thermodata.effect import effects
from thermodata.plugin import Effect, Need, Param
from thermodata.view.grid.dataset import ChannelInfo, TestData

from .hand_made import PlainEffect

CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", at="tcp"),
        ChannelInfo("dX", "displacement", "um", at="tcp"),
        ChannelInfo("tilt", "tilt", "urad", at="tcp"),
        ChannelInfo("program", "label", "1"),
        ChannelInfo("T_nut", "temperature", "degC", at="axis.x.nut"),
        ChannelInfo("T_oil", "temperature", "degC", at="hydraulics"),
        ChannelInfo("T_free", "temperature", "degC"),
    )
}
NUT = PlainEffect("screw", "feed_x", needs=(Need("u", "temperature", ("axis.x.nut",)),))
LAG = PlainEffect("lag", "generic", needs=(Need("u", "*"),))
REFINED = replace(NUT, name="screw_lead", refines=("screw",))


def asked(*library: Effect, present: tuple[Present, ...] = (), response: str = "dZ") -> list[str]:
    return [c.id for c in candidates({e.name: e for e in library}, CHANNELS, present, response)]


def has(effect: str, *channels: str, family: str = "", modes: int = 1, whole: bool = True) -> Present:
    return Present(effect, frozenset(channels), family, modes, whole)


def test_a_plain_lag_of_every_channel_is_asked_for_beside_its_names() -> None:
    assert asked(NUT, LAG) == ["screw:T_nut", "lag:T_nut", "lag:T_oil", "lag:T_free"]
    assert asked(NUT, LAG, present=(has("spindle", "T_oil"),)) == ["screw:T_nut", "lag:T_nut", "lag:T_free"]
    assert asked(replace(LAG, name="static")) == [], "a lag whose time constant is zero"


def test_a_plain_lag_is_a_twentieth_as_probable_where_a_name_could_have_it() -> None:
    found = {c.id: c.log_prior for c in candidates({"screw": NUT, "lag": LAG}, CHANNELS, (), "dZ")}
    assert found == {"screw:T_nut": 0.0, "lag:T_nut": -3.0, "lag:T_oil": 0.0, "lag:T_free": 0.0}


def test_neither_displacements_nor_labels_nor_the_response_drive_anything() -> None:
    assert not {"lag:dX", "lag:dZ", "lag:tilt", "lag:program"} & set(asked(LAG))
    assert "lag:T_oil" not in asked(LAG, response="T_oil")


def test_what_the_model_has_is_not_asked_for() -> None:
    assert asked(NUT, present=(has("screw", "T_nut"),)) == []
    assert asked(NUT, present=(has("screw", "T_oil"),)) == ["screw:T_nut"], "by other channels it may be missing"


def test_a_channel_that_the_model_lags_already_is_not_asked_for_by_name() -> None:
    assert asked(NUT, LAG, present=(has("lag", "T_nut"),)) == ["lag:T_oil", "lag:T_free"]
    assert asked(NUT, present=(has("not_in_the_library", "T_nut"),)) == []


def test_a_refinement_is_asked_for_where_the_model_has_what_it_refines_on_the_same_channel() -> None:
    spindle = PlainEffect("spindle", "spindle", needs=(Need("u", "rotational_speed"),))
    assert asked(REFINED) == []
    assert asked(NUT, REFINED, present=(has("screw", "T_nut"),)) == ["screw_lead:T_nut"]
    assert asked(NUT, REFINED, present=(has("screw", "T_oil"),)) == ["screw:T_nut"]
    assert asked(spindle, REFINED, present=(has("spindle", "T_nut"),)) == []


PLACED = {**CHANNELS, "x": ChannelInfo("x", "position", "mm", at="axis.x")}
GROWS = replace(
    REFINED,
    name="growth",
    needs=(Need("u", "temperature", ("axis.x.nut",)), Need("place", "position", ("axis.x",))),
    told_by="place",
)


@pytest.mark.parametrize(
    ("moving", "present", "kin"),
    [
        ((), (), "not asked"),
        (("y",), (), "not asked"),
        (("x",), (), None),
        (("x",), (has("screw", "T_oil", family="feed_y"),), None),
        (("x",), (has("screw", "x", family="feed_x"),), "same"),
        (("x",), (has("screw", "T_oil", family="feed_x"),), "not asked"),
        ((), (has("screw", "T_nut", family="feed_x"),), "same"),
        (("x",), (has("motor", "T_oil", family="feed_x"),), "related"),
    ],
)
def test_what_a_place_tells_from_what_it_refines_is_asked_alone_where_that_moves(
    moving: tuple[str, ...], present: tuple[Present, ...], kin: str | None
) -> None:
    """Where the model has what it refines it is a mode of it, as before; and by another channel it isn't asked."""
    library = {e.name: e for e in (NUT, GROWS, replace(NUT, name="motor"))}
    found = {c.id: c.kin for c in candidates(library, PLACED, present, "dZ", Seen(moving))}
    assert found.get("growth:T_nut,x", "not asked") == kin


def test_where_an_axis_stands_tells_no_part_of_it_from_another() -> None:
    """Its guide may be what its screw seems, as where the place is not read."""
    library = {"feed_screw": effects()["feed_screw"], "screw_growth": effects()["screw_growth"]}
    found = {c.id: c.unread for c in candidates(library, PLACED, (), "dZ", Seen(("x",)))}
    assert found == {"feed_screw:T_nut": ("axis.x.guide",), "screw_growth:T_nut,x": ("axis.x.guide",)}


def test_artefacts_and_effects_without_drivers_are_no_candidates() -> None:
    assert asked(replace(NUT, family="artefact"), replace(NUT, name="drift", needs=())) == []


@pytest.mark.parametrize(("at", "placeless"), [(None, True), ("hydraulics", False)])
def test_a_lag_is_placeless_where_no_temperature_has_a_place(at: str | None, placeless: bool) -> None:
    library = {e.name: e for e in (LAG, replace(NUT, name="anywhere", needs=(Need("u", "temperature"),)))}
    speed = ChannelInfo("n", "rotational_speed", "rpm", at="spindle")
    channels = {"T_free": CHANNELS["T_free"], "T_oil": ChannelInfo("T_oil", "temperature", "degC", at=at), "n": speed}
    found = {c.id: c.placeless for c in candidates(library, channels, (), "dZ")}
    assert found == {
        "lag:T_free": placeless,
        "lag:T_oil": placeless,
        "lag:n": placeless,
        "anywhere:T_free": False,
        "anywhere:T_oil": False,
    }


def test_a_lag_of_a_body_that_makes_no_heat_is_passive() -> None:
    """Castings, a scale, what stands beside the machine, and what nobody declared where it sits, while something has a
    place."""
    at = {"T_bed": "bed.feet", "T_head": "headstock", "T_nut": "axis.x.nut", "T_rib": "rear_wall", "T_free": None}
    at |= {
        "T_box": "cabinet",
        "T_cnc": "cnc",
        "T_amplifier": "axis.x.drive",
        "T_rail": "crossrail.left",
        "T_scale": "axis.y.scale",
    }
    channels = {n: ChannelInfo(n, "temperature", "degC", at=place) for n, place in at.items()}
    channels |= {"n": ChannelInfo("n", "rotational_speed", "rpm")}
    library = {e.name: e for e in (LAG, replace(NUT, name="anywhere", needs=(Need("u", "temperature"),)))}
    found = {c.id for c in candidates(library, channels, (), "dZ") if c.passive}
    assert found == {f"lag:T_{n}" for n in ("bed", "head", "free", "box", "cnc", "rail", "scale")}, (
        "no speed, no name, no place of which nothing is known"
    )
    nowhere = {n: replace(c, at=None) for n, c in channels.items()}
    assert not any(c.passive for c in candidates(library, nowhere, (), "dZ")), "then all are alike"


@pytest.mark.parametrize("part", ["table.bearing", "table.motor", "table", "hydraulics"])
def test_a_body_whose_heated_part_has_a_sensor_has_no_name_and_is_passive(part: str) -> None:
    """A table that coolant washes: its own warmth is no friction of its bearing where that is read by itself."""
    table = ChannelInfo("T_table", "temperature", "degC", at="table")
    beside = ChannelInfo("T_part", "temperature", "degC", at=part)
    turns = ChannelInfo("n_table", "rotational_speed", "rpm", at="table")
    channels = {c.name: c for c in (CHANNELS["dZ"], table, beside, turns)}
    found = {c.id: c.passive for c in candidates(effects(), channels, (), "dZ")}
    told = part in ("table.bearing", "table.motor")
    assert ("table_bearing:T_table" in found) is not told
    assert found["lag:T_table"] is told
    assert found["lag:T_part"] is False
    speed = ChannelInfo("T_part", "rotational_speed", "rpm", at="table.bearing")
    moved = candidates(effects(), {**channels, "T_part": speed}, (), "dZ")
    assert "table_bearing:T_table" in {c.id for c in moved}, "no temperature tells it"


@pytest.mark.parametrize(
    ("quantity", "at", "turns"),
    [
        ("rotational_speed", "table", True),
        ("current", "table.motor", True),
        ("feed", "rotary.b", True),
        ("feed", "axis.x", False),
        ("rotational_speed", "spindle", False),
        ("temperature", "rotary.b.motor", False),
        ("state", "table", False),
    ],
)
def test_a_table_that_nothing_turns_makes_no_heat(quantity: str, at: str, turns: bool) -> None:
    table = ChannelInfo("T_table", "temperature", "degC", at="table")
    other = ChannelInfo("other", quantity, "1", at=at)
    channels = {c.name: c for c in (CHANNELS["dZ"], table, other)}
    found = {c.id: c.passive for c in candidates(effects(), channels, (), "dZ")}
    assert ("table_bearing:T_table" in found) is turns
    assert found["lag:T_table"] is not turns
    bearing = {**channels, "T_table": replace(table, at="table.bearing")}
    assert "table_bearing:T_table" in {c.id for c in candidates(effects(), bearing, (), "dZ")}, (
        "where it is at a bearing"
    )


@pytest.mark.parametrize(("stood", "body"), [(1.0, True), (0.8, True), (0.7, False), (0.0, False), (None, False)])
def test_a_table_that_is_as_warm_where_nothing_turns_it_makes_no_heat(stood: float | None, body: bool) -> None:
    """stood: how far its temperature moves in tests in which nothing turns it; None: it turns in all."""
    table = ChannelInfo("T_table", "temperature", "degC", at="table")
    head = ChannelInfo("n_A", "rotational_speed", "rpm", at="rotary.a")
    channels = {c.name: c for c in (CHANNELS["dZ"], table, head)}
    turning, resting = (1.0, 8.0), (stood or 0.0, 0.1)
    tests = [
        _turned(i, channels, *own)
        for i, own in enumerate([turning, turning, *([] if stood is None else 2 * [resting])])
    ]
    found = {
        c.id: c.passive for c in candidates(effects(), channels, (), "dZ", Seen(at_rest=warm_at_rest(channels, tests)))
    }
    assert ("table_bearing:T_table" in found) is not body
    assert found["lag:T_table"] is body


def test_a_table_that_turns_in_no_test_makes_no_heat() -> None:
    table = ChannelInfo("T_table", "temperature", "degC", at="table")
    part = ChannelInfo("T_bearing", "temperature", "degC", at="table.bearing")
    channels = {c.name: c for c in (table, part, ChannelInfo("n_A", "rotational_speed", "rpm", at="rotary.a"))}
    assert warm_at_rest(channels, [_turned(0, channels, 1.0, 0.0)]) == {"T_table"}, "of its bearing nothing is said"
    assert warm_at_rest(channels, []) == frozenset()


def _turned(i: int, channels: dict[str, ChannelInfo], warm: float, rpm: float) -> TestData:
    """A test in which the table's temperature moves so far while it turns so fast."""
    t_s, wave = 60.0 * np.arange(50), np.sin(np.linspace(0.0, 6.0, 50))
    values = {"T_table": 20.0 + warm * wave, "T_bearing": 20.0 + warm * wave, "n_A": np.full(50, rpm)}
    valid = {name: np.ones(50, dtype=np.bool_) for name in values}
    return TestData("c", f"t{i}", "mixed", "calibration", t_s, values, valid, valid["n_A"], channels=channels)


def test_a_switch_beside_what_the_model_reads_is_no_mode_of_it() -> None:
    """The door of the hall, beside an effect of the hall's air."""
    channels = {
        "T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall"),
        "T_door": ChannelInfo("T_door", "temperature", "degC", at="hall.door"),
        "door": ChannelInfo("door", "state", "1", at="hall.door"),
    }
    found = {c.id: c.kin for c in candidates({LAG.name: LAG}, channels, (has("frame", "T_hall"),), "dZ")}
    assert found == {"lag:T_door": "same", "lag:door": "near"}
    one = {LAG.name: replace(LAG, params=ONE_MODE)}
    switched = candidates(one, channels, (has("static", "door", modes=0),), "dZ")
    assert {c.id: c.kin for c in switched}["lag:door"] == "same", "another mode of the switch that is read"


@pytest.mark.parametrize(("other", "passive"), [("T_bed", True), ("T_nut", False)])
def test_a_difference_is_passive_where_it_reads_such_a_body(other: str, passive: bool) -> None:
    at = {"T_bed": "bed", "T_nut": "axis.x.nut", "T_oil": "hydraulics"}
    channels = {n: ChannelInfo(n, "temperature", "degC", at=place) for n, place in at.items() if n in ("T_oil", other)}
    two = PlainEffect("both", "control", needs=(Need("u", "temperature"), Need("v", "temperature")))
    found = candidates({"both": two}, channels, (), "dZ")
    assert {c.passive for c in found} == {passive}


def kin(effect: PlainEffect, channel: str, *present: Present) -> object:
    at = {
        "T_nut": "axis.x.nut",
        "T_axis": "axis.x",
        "T_other": "axis.y.nut",
        "T_nut_2": "axis.x.nut",
        "n": "spindle",
    }
    channels = {c: ChannelInfo(c, "temperature", "degC", at=place) for c, place in at.items()}
    two = PlainEffect("bent", "feed_x", needs=(Need("u", "temperature"), Need("v", "temperature")))
    found = candidates({e.name: e for e in (effect, NUT, two)}, channels, present, "dZ")
    return next(c.kin for c in found if c.effect is effect and c.channels == (channel,))


@pytest.mark.parametrize(
    ("effect", "channel", "family", "expected"),
    [
        ("mount", "T_nut", "feed_x", "same"),  # another reading of its channels
        ("mount", "T_nut_2", "feed_x", "near"),
        ("mount", "T_axis", "feed_x", "near"),  # around it
        ("mount", "n", "feed_x", "related"),
        ("mount", "T_nut", "feed_y", None),
        ("mount", "T_nut", "generic", None),
        ("lag", "T_nut_2", "", "same"),
        ("lag", "T_axis", "", "same"),
        ("lag", "T_other", "", None),
        ("refining", "T_nut", "", "same"),
    ],
)
def test_a_candidate_is_kin_by_family_channel_and_place(
    effect: str, channel: str, family: str, expected: str | None
) -> None:
    """To a model that has the screw of X, read at its nut."""
    needs = (Need("u", "temperature"),)
    made = {
        "mount": PlainEffect("mount", "feed_x", needs=needs),
        "lag": LAG,
        "refining": PlainEffect("refining", "wear", needs=needs, refines=("screw",)),
    }[effect]
    assert kin(made, channel, has("screw", "T_nut", family=family)) == expected


def test_the_same_effect_on_other_channels_is_the_same() -> None:
    twice = PlainEffect("screw", "feed_x", needs=(Need("u", "temperature"),))
    channels = {c: CHANNELS[c] for c in ("T_nut", "T_oil")}
    (found,) = candidates({"screw": twice}, channels, (has("screw", "T_nut", family="feed_x"),), "dZ")
    assert (found.id, found.kin) == ("screw:T_oil", "same")


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ((PlainEffect("screw", "feed_x"),), "same"),  # the other end of the screw that the model reads
        ((PlainEffect("screw", "feed_x"), PlainEffect("mount", "feed_x")), "related"),
        ((PlainEffect("screw", "feed_x"), PlainEffect("sun", "sun")), None),  # it may be the sun
        ((), None),
    ],
)
def test_a_lag_is_as_near_to_the_model_as_the_furthest_name_of_its_channel(
    names: tuple[PlainEffect, ...], expected: str | None
) -> None:
    library = {e.name: e for e in (*names, LAG)}
    channels = {
        "T_nut": ChannelInfo("T_nut", "temperature", "degC", at="axis.x.nut"),
        "T_end": ChannelInfo("T_end", "temperature", "degC", at="axis.x.bearing"),
    }
    found = {c.id: c.kin for c in candidates(library, channels, (has("screw", "T_nut", family="feed_x"),), "dZ")}
    assert found["lag:T_end"] == expected


@pytest.mark.parametrize(
    ("family", "expected"), [("cutting", ("cut:P",)), ("spindle", ()), ("generic", ())], ids=["cut", "spindle", "none"]
)
def test_a_lag_at_the_place_of_what_is_read_says_of_which_named_heat_the_model_has_nothing(
    family: str, expected: tuple[str, ...]
) -> None:
    """The power of a spindle whose bearing is read: of the heat of cutting the model has nothing."""
    cut = replace(PlainEffect("cut", family), needs=(Need("u", "power"),))
    channels = {
        "T_brg": ChannelInfo("T_brg", "temperature", "degC", at="spindle.bearing.front"),
        "P": ChannelInfo("P", "power", "kW", at="spindle"),
    }
    found = candidates({e.name: e for e in (cut, LAG)}, channels, (has("bearing", "T_brg", family="spindle"),), "dZ")
    (lag,) = (c for c in found if c.id == "lag:P")
    assert (lag.kin, lag.unmodelled) == ("same", expected)
    said = would_be_a_mode(lag)
    assert ("it would be another mode of what the model has" in said) is not expected
    assert ("or it is cut:P, of whose heat the model has nothing" in said) is bool(expected)
    assert ("though of the heat of cut:P it has nothing" in mode_of([], lag.unmodelled)) is bool(expected)
    assert "nothing" not in mode_of(["lag"], lag.unmodelled)


@pytest.mark.parametrize(
    ("present", "expected"),
    [
        ((has("bent", "T_nut", "T_axis", family="feed_x"),), "part"),
        ((has("bent", "T_nut", "T_axis", family="feed_x"), has("screw", "T_nut", family="feed_x")), "same"),
        ((has("bent", "T_nut", "T_axis", family="sun"), has("screw", "T_other", family="feed_x")), "same"),
        ((has("bent", "T_axis", "n", family="feed_x"),), "near"),
    ],
)
def test_one_of_the_temperatures_that_an_effect_reads_together_is_a_part_of_it(
    present: tuple[Present, ...], expected: str
) -> None:
    """The air, where the model has its gradient alone: two states, not two readings of one."""
    made = PlainEffect("mount", "feed_x", needs=(Need("u", "temperature"),))
    assert kin(made, "T_nut", *present) == expected


@pytest.mark.parametrize(
    ("present", "expected"),
    [
        ((has("bent", "T_nut", "T_axis", family="feed_x"),), "part"),
        ((has("bent", "T_nut", "T_axis", family="feed_x"), has("screw", "T_nut", family="feed_x")), "same"),
        ((has("screw", "T_axis", family="feed_x"),), "same"),
    ],
)
def test_so_is_a_plain_lag_of_one_of_them(present: tuple[Present, ...], expected: str) -> None:
    assert kin(LAG, "T_nut", *present) == expected


@pytest.mark.parametrize(("axis", "expected"), [("c", "heat"), ("a", None)])
def test_the_heat_of_a_turning_axis_is_one_by_its_temperature_and_by_its_speed(axis: str, expected: str | None) -> None:
    channels = {
        "T_c": ChannelInfo("T_c", "temperature", "degC", at="rotary.c"),
        "n": ChannelInfo("n", "rotational_speed", "rpm", at=f"rotary.{axis}"),
    }
    found = candidates(effects(), channels, (has("rotary_axis", "T_c", family="rotary_c"),), "dZ")
    assert next(c.kin for c in found if c.id == "rotary_friction:n") == expected


@dataclass(frozen=True)
class Caused(PlainEffect):
    cause: str = "cutting heat"


@pytest.mark.parametrize(("other", "expected"), [("cutting heat", "heat"), ("the sun", None)])
def test_one_heat_read_elsewhere_is_told_in_any_family(other: str, expected: str | None) -> None:
    """The spindle's power, and what the cut warms."""
    needs = (Need("u", "temperature"),)
    library = {n: Caused(n, n, needs=needs, cause=c) for n, c in (("power", "cutting heat"), ("part", other))}
    channels = {c: CHANNELS[c] for c in ("T_nut", "T_oil")}
    found = candidates(library, channels, (has("power", "T_nut", family="power"),), "dZ")
    assert next(c.kin for c in found if c.id == "part:T_oil") == expected
    assert {e.name for e in effects().values() if getattr(e, "cause", "") == "cutting heat"} == {
        "cutting_load",
        "cutting_power",
        "cutting_torque",
        "workpiece",
    }


def test_a_distributed_machine_acts_five_times_faster_and_slower() -> None:
    params = (Param("tau", "min", 30, 1, 360, ""), Param("p", "1", 1.5, 1, 2.5, ""), Param("lead", "s", 5, 1, 9, ""))
    effect = CandidateEffect(replace(NUT, params=params), {"u": "T_nut"}, "feed_x")
    slack = effect.slack_params({"tau": 10.0, "p": 2.0, "lead": 5.0})
    assert [(p["tau"], p["p"], p["lead"]) for p in slack] == [
        (2.0, 2.0, 5.0),
        (50.0, 2.0, 5.0),
        (10.0, 2.0, 1.0),
        (10.0, 2.0, 25.0),
    ]


@pytest.mark.parametrize(("count", "points"), [(0, 1), (1, 10), (2, 25), (3, 27)])
def test_the_grid_is_finer_the_fewer_parameters_there_are(count: int, points: int) -> None:
    assert len(grid([Param(f"tau{i}", "min", 30, 1, 360, "") for i in range(count)], 60.0)) == points


def test_the_grid_keeps_to_the_bounds_and_to_what_a_sample_resolves() -> None:
    taus = [p["tau"] for p in grid([Param("tau", "min", 30, 0.1, 360, "")], 120.0)]
    assert (taus[0], taus[-1]) == (pytest.approx(0.5), pytest.approx(360.0))
    np.testing.assert_allclose(np.diff(np.log(taus)), np.log(720) / 9)
    wide = [p["k"] for p in grid([Param("k", "1", 1, 1.0, 10.1, "")], 60.0)]
    assert wide[1] / wide[0] == pytest.approx(wide[-1] / wide[-2])
    narrow = [p["k"] for p in grid([Param("k", "1", 1, 1.0, 9.9, "")], 60.0)]
    assert narrow == pytest.approx(np.linspace(1.0, 9.9, 4))


def test_the_grid_goes_on_beyond_the_bounds_twice_as_far_apart() -> None:
    usual = [p["tau"] for p in grid([Param("tau", "min", 30, 10, 120, "")], 60.0)]
    taus = [p["tau"] for p in grid([Param("tau", "min", 30, 10, 120, "", reach=(1, 360))], 60.0)]
    assert [t for t in taus if 10 <= t <= 120] == pytest.approx(usual)
    assert (taus[0], taus[-1]) == (pytest.approx(1), pytest.approx(360))
    apart = np.diff(np.log(taus)) / np.log(usual[1] / usual[0])
    np.testing.assert_allclose(apart, [*[2.0] * 4, *[1.0] * 9, *[2.0] * 2], rtol=0.1)


@pytest.mark.parametrize(("step_s", "first"), [(60.0, 1.0), (960.0, 4.0), (4800.0, 20.0), (40_000.0, 40_000 / 240)])
def test_nor_does_the_grid_reach_what_a_sample_does_not_resolve(step_s: float, first: float) -> None:
    """Nor where a sample is longer than the bounds."""
    taus = [p["tau"] for p in grid([Param("tau", "min", 30, 10, 120, "", reach=(1, 360))], step_s)]
    assert taus[0] == pytest.approx(first)
    assert np.isfinite(taus).all()
    assert (np.diff(taus) > -1e-9).all()


SCREW = PlainEffect("screw", "feed_{a}", needs=(Need("u", "temperature", ("axis.{a}.nut",)),))
TWO_MODES = replace(
    NUT,
    name="screw_2",
    refines=("screw",),
    params=(Param("fast", "min", 15, 1, 60, ""), Param("slow", "min", 150, 60, 360, "")),
)
ONE_MODE = (Param("tau", "min", 60, 1, 1440, ""),)


@pytest.mark.parametrize(
    ("present", "there"),
    [
        (has("lag", "T_nut"), True),
        (has("transfer_function", "T_nut"), True),
        (has("lag", "T_nut", "T_oil"), True),  # of the difference of both
        (has("lag", "T_oil"), False),
        (has("lag", "T_nut", whole=False), False),  # one for each phase
        (has("transfer_function", "T_nut", modes=2), False),  # it has both modes
        (has("screw", "T_nut", whole=False), False),
    ],
)
def test_a_plain_function_is_refined_as_the_effect_that_it_stands_for(present: Present, there: bool) -> None:
    found = asked(SCREW, TWO_MODES, replace(LAG, params=ONE_MODE), present=(present,))
    assert ("screw_2:T_nut" in found) is there


def test_a_plain_function_has_family_and_cause_of_what_it_stands_for() -> None:
    motor = PlainEffect("motor", "feed_x", needs=(Need("u", "temperature", ("hydraulics",)),))
    library = {e.name: e for e in (SCREW, motor, replace(LAG, params=ONE_MODE))}

    def of(*present: Present) -> dict[str, object]:
        return {c.id: c.kin for c in candidates(library, CHANNELS, present, "dZ")}

    assert of(has("lag", "T_nut")) == {"motor:T_oil": "related", "lag:T_oil": "related", "lag:T_free": None}
    assert of(has("lag", "T_free"))["motor:T_oil"] is None


def test_a_gain_without_a_lag_leaves_the_lag_to_be_asked_for_as_another_mode_of_it() -> None:
    library = {e.name: e for e in (replace(NUT, params=ONE_MODE), replace(LAG, params=ONE_MODE))}
    found = {c.id: c.kin for c in candidates(library, CHANNELS, (has("static", "T_nut", modes=0),), "dZ")}
    assert (found["screw:T_nut"], found["lag:T_nut"]) == ("same", "same")


def test_what_holds_the_probes_and_the_tool_is_known() -> None:
    channels = {
        "T_bracket": ChannelInfo("T_bracket", "temperature", "degC", at="fixture"),
        "T_probe": ChannelInfo("T_probe", "temperature", "degC", at="probe.z"),
        "T_tool": ChannelInfo("T_tool", "temperature", "degC", at="Tool.holder"),
        "clamped": ChannelInfo("clamped", "state", "1", at="fixture"),
        "n_tool": ChannelInfo("n_tool", "rotational_speed", "rpm", at="tool"),
        "T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall"),
    }
    found = {c.id for c in candidates({LAG.name: LAG}, channels, (), "dZ") if c.of_holder}
    assert found == {"lag:T_bracket", "lag:T_probe", "lag:T_tool"}


@pytest.mark.parametrize(
    ("quantity", "place", "known"),
    [
        ("temperature", "Spindle.Bearing.front", True),
        ("temperature", "counter_spindle.bearing", True),
        ("temperature", "axis.z.nut", True),
        ("temperature", "spindle.gearbox", True),
        ("temperature", "hydraulics", True),
        ("temperature", "chiller.supply", True),
        ("temperature", "turret", True),
        ("temperature", "turret.motor", False),  # a winding: as warm as what its drive does
        ("temperature", "axis.z.motor", False),
        ("temperature", "axis.z.guide", False),
        ("temperature", "coolant.tank", False),  # warmed by all that it washes
        ("temperature", "column.front", False),
        ("temperature", "hall", False),
        ("temperature", None, False),
        ("rotational_speed", "spindle.bearing", False),
        ("state", "hydraulics", False),
    ],
)
def test_what_reads_a_part_that_makes_heat_itself_is_known(quantity: str, place: str | None, known: bool) -> None:
    channels = {
        "u": ChannelInfo("u", quantity, "1", at=place),
        "T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall"),
    }
    found = {c.id for c in candidates({LAG.name: LAG}, channels, (), "dZ") if c.of_source}
    assert found == ({"lag:u"} if known else set())


def test_what_is_read_around_the_machine_alone_is_known() -> None:
    library = {e.name: e for e in (LAG, replace(NUT, name="layers", needs=_two("hall.top", "hall.bottom")))}
    air = {
        c.name: c
        for c in (
            ChannelInfo("T_top", "temperature", "degC", at="Hall.top"),
            ChannelInfo("T_low", "temperature", "degC", at="hall.bottom"),
            ChannelInfo("T_floor", "temperature", "degC", at="floor"),
            ChannelInfo("T_out", "temperature", "degC", at="outside"),
            ChannelInfo("door", "state", "1", at="hall.door"),
            ChannelInfo("T_oil", "temperature", "degC", at="hydraulics"),
            ChannelInfo("T_free", "temperature", "degC"),
        )
    }
    found = {c.id: c.around for c in candidates(library, air, (), "dZ")}
    assert {name for name, around in found.items() if around} == {"lag:T_top", "lag:T_low", "lag:T_floor", "lag:T_out"}
    assert "layers:T_top,T_low" in found


def test_the_mask_of_the_measurement_is_no_candidate() -> None:
    state = ChannelInfo("meas", "state", "1")
    library: dict[str, Effect] = {"lag": LAG}
    assert [c.id for c in candidates(library, {"meas": state}, (), "dZ")] == ["lag:meas"]
    assert candidates(library, {"meas": replace(state, is_mask=True)}, (), "dZ") == []


def _two(one: str, other: str) -> tuple[Need, ...]:
    return (Need("a", "temperature", (one,)), Need("b", "temperature", (other,)))


@pytest.mark.parametrize(
    ("effect", "drivers", "present", "expected"),
    [
        ("cutting_load", "load_2", Present("cutting_load", frozenset({"load"}), "cutting"), None),
        ("spindle_bearing", "T_front", Present("spindle_friction", frozenset({"n_2"}), "counter_spindle"), "related"),
        ("spindle_bearing", "T_front", Present("spindle_friction", frozenset({"n"}), "spindle"), "heat"),
    ],
)
def test_the_heat_of_each_spindle_is_its_own(effect: str, drivers: str, present: Present, expected: str | None) -> None:
    """The load of a counter spindle was another mode of that of the main one; the bearing of a grinding spindle one of
    the dresser's friction, where the motor beside it was known."""
    channels = {
        "load": ChannelInfo("load", "load", "%", at="spindle"),
        "load_2": ChannelInfo("load_2", "load", "%", at="counter_spindle"),
        "T_front": ChannelInfo("T_front", "temperature", "degC", at="spindle.bearing.front"),
        "T_motor": ChannelInfo("T_motor", "temperature", "degC", at="spindle.motor"),
        "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle"),
        "n_2": ChannelInfo("n_2", "rotational_speed", "rpm", at="counter_spindle"),
    }
    motor = Present("spindle_motor", frozenset({"T_motor"}), "spindle")
    found = candidates(effects(), channels, (present, motor), "dZ")
    assert next(c.kin for c in found if c.id == f"{effect}:{drivers}") == expected
