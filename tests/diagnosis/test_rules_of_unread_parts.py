"""Which other part of its axis a candidate may be (candidates/unread.py), and what that does to a claim."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.diagnosis.candidates.of_library import candidates
from thermodata.diagnosis.claims.probability import (
    TOLD_APART,
    at_best,
    elsewhere,
    of_either,
    probability,
    sharpness_asked,
)
from thermodata.diagnosis.claims.rules_together import blunt
from thermodata.diagnosis.question.present import Present
from thermodata.diagnosis.tell.advising.bare import to_log, with_fixture
from thermodata.diagnosis.tell.advising.to_find import to_find
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.effect import effects
from thermodata.report.verdict.verdict import causes, verdict_sentence
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.words.places import heat_at
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import scored

NUT = ChannelInfo("T_nut", "temperature", "degC", at="axis.z.nut")
HOUSE = ChannelInfo("T_house", "temperature", "degC", at="axis.z.bearing")
GUIDE = ChannelInfo("T_guide", "temperature", "degC", at="Axis.Z.guide")
MOTOR = ChannelInfo("T_motor", "temperature", "degC", at="axis.z.motor")
MOTOR_S = ChannelInfo("T_motor_s", "temperature", "degC", at="spindle.motor")
FEED = ChannelInfo("v", "feed", "m/min", at="axis.z")
FEED_X = ChannelInfo("v_x", "feed", "m/min", at="axis.x")
OTHER = ChannelInfo("T_nut_x", "temperature", "degC", at="axis.x.nut")
LOW = ChannelInfo("T_low", "temperature", "degC", at="hall.bottom")
HIGH = ChannelInfo("T_high", "temperature", "degC", at="hall.top")
HOLDER = ChannelInfo("T_holder", "temperature", "degC", at="fixture")
PROBE = ChannelInfo("T_probe", "temperature", "degC", at="probe")
SUN = ChannelInfo("sun", "irradiance", "W/m^2", at="hall.window")
OIL = ChannelInfo("T_oil", "temperature", "degC", at="hydraulics")


def unread(*logged: ChannelInfo, has: tuple[Present, ...] = ()) -> dict[str, tuple[str, ...]]:
    found = candidates(effects(), {c.name: c for c in logged}, has, "dZ")
    return {c.id: c.unread for c in found if c.unread}


def test_a_temperature_tells_its_part_from_those_that_have_a_sensor() -> None:
    assert unread(NUT)["feed_screw:T_nut"] == ("axis.z.guide",)
    assert unread(GUIDE)["guideway:T_guide"] == ("axis.z.nut",)
    assert unread(NUT, GUIDE) == {}
    assert "guideway:T_guide" not in unread(HOUSE, GUIDE), "the house is the screw's"
    assert unread(NUT, OTHER)["feed_screw:T_nut_x"] == ("axis.x.guide",), "each axis for itself"


def test_a_guideway_is_the_lesser_part_where_no_sensor_reads_its_screw() -> None:
    def lesser(*logged: ChannelInfo, has: tuple[Present, ...] = ()) -> set[str]:
        return {c.id for c in candidates(effects(), {c.name: c for c in logged}, has, "dZ") if c.lesser}

    assert lesser(GUIDE) == {"guideway:T_guide", "lag:T_guide"}
    assert lesser(GUIDE, OTHER) == {"guideway:T_guide", "lag:T_guide"}, "the screw of another axis"
    assert lesser(GUIDE, HOUSE) == set()
    assert lesser(GUIDE, FEED) == set(), "what moves the axis says what its screw does"
    assert lesser(GUIDE, FEED_X) == {"guideway:T_guide", "lag:T_guide"}, "of another axis"
    assert lesser(GUIDE, MOTOR) == {"guideway:T_guide", "lag:T_guide"}, "a motor warms with both"
    assert lesser(GUIDE, has=(Present("feed_screw", frozenset({"T_gone"}), "feed_z"),)) == {
        "guideway:T_guide",
        "lag:T_guide",
    }
    assert lesser(GUIDE, FEED, has=(Present("feed_screw", frozenset({"v"}), "feed_z"),)) == set(), "the model has it"
    assert lesser(NUT) == set(), "the screw is the greater part"
    assert lesser(MOTOR, FEED) == set()


@pytest.mark.parametrize(("evidence", "claimed"), [(2000.0, False), (2200.0, True)])
def test_the_lesser_part_is_claimed_where_its_timing_is_very_sharp(evidence: float, claimed: bool) -> None:
    """1 / (1 + exp(-2.45 - 2.2 log10(sharpness) - 1.1 * 0.6 + 0.9 + 2.3)): 65 % at 2.1 a sample."""
    beside = on_axis(evidence, "axis.z.nut")
    lesser = replace(beside, candidate=replace(beside.candidate, lesser=True))
    assert blunt(beside) is None
    assert (blunt(lesser) is None) == claimed
    if not claimed:
        assert "what it reads does not tell it from heat at axis.z.nut" in str(blunt(lesser))


def test_a_motor_warms_with_both() -> None:
    assert unread(MOTOR)["feed_motor:T_motor"] == ("axis.z.nut", "axis.z.guide")
    assert unread(MOTOR, NUT)["lag:T_motor"] == ("axis.z.guide",)


def test_a_motion_tells_no_part_from_another() -> None:
    found = unread(NUT, GUIDE, FEED)
    assert found["feed_screw:v"] == ("axis.z.guide",)
    assert found["lag:v"] == ("axis.z.nut", "axis.z.guide")
    assert set(found) == {"feed_screw:v", "lag:v"}
    by_motion = {c.id: c.of_motion for c in candidates(effects(), {c.name: c for c in (NUT, FEED)}, (), "dZ")}
    assert by_motion == {"feed_screw:T_nut": False, "feed_screw:v": True, "lag:T_nut": False, "lag:v": True}


def test_what_the_model_has_is_no_other_part() -> None:
    guideway = Present("guideway", frozenset({"T_guide"}), "guide_z")
    assert "feed_screw:v" not in unread(NUT, GUIDE, FEED, has=(guideway,))
    assert "lag:v" not in unread(NUT, GUIDE, FEED, has=(guideway,)), "only one is left"
    by_feed = Present("feed_screw", frozenset({"v"}), "feed_z")
    assert "guideway:T_guide" not in unread(GUIDE, FEED, has=(by_feed,)), "named for the screw"


def test_what_holds_the_probes_stands_in_the_same_air_as_the_frame() -> None:
    found = unread(LOW)
    assert found["ambient_frame:T_low"] == ("fixture",)
    assert found["lag:T_low"] == ("fixture",)
    assert unread(LOW, HOLDER) == {}
    assert unread(LOW, PROBE) == {}
    assert unread(HOLDER)["probe_temperature:T_holder"] == ("hall",)
    known = Present("probe_temperature", frozenset({"T_holder"}), "probe")
    assert "ambient_frame:T_low" not in unread(LOW, replace(HOLDER, faulty="stuck"), has=(known,))


@pytest.mark.parametrize(
    ("channel", "name"),
    [
        (ChannelInfo("pump", "state", "1", at="coolant"), "coolant"),
        (ChannelInfo("T_fluid", "temperature", "degC", at="coolant.supply"), "coolant_temperature"),
        (ChannelInfo("T_part", "temperature", "degC", at="workpiece"), "workpiece"),
        (ChannelInfo("P", "power", "kW", at="spindle"), "cutting_power"),
        (ChannelInfo("load", "load", "%", at="spindle"), "cutting_load"),
    ],
)
def test_what_holds_the_probes_warms_with_all_in_the_working_space(channel: ChannelInfo, name: str) -> None:
    found = unread(MOTOR_S, channel)
    assert found[f"{name}:{channel.name}"] == ("fixture",)
    assert found[f"lag:{channel.name}"] == ("fixture",)
    for sensor in (HOLDER, PROBE):
        assert not any("fixture" in other for other in unread(channel, sensor).values())
    known = Present("probe_temperature", frozenset({"T_holder"}), "probe")
    assert unread(MOTOR_S, channel, replace(HOLDER, faulty="stuck"), has=(known,)) == {}


@pytest.mark.parametrize(("quantity", "name"), [("power", "cutting_power"), ("load", "cutting_load")])
def test_what_a_spindle_takes_up_heats_its_motor_too(quantity: str, name: str) -> None:
    taken = ChannelInfo("P", quantity, "1", at="counter_spindle")
    assert unread(taken)[f"{name}:P"] == ("counter_spindle.motor", "fixture")
    assert unread(taken, HOLDER)[f"{name}:P"] == ("counter_spindle.motor",)
    motor = replace(MOTOR_S, at="counter_spindle.motor")
    assert unread(taken, motor)[f"{name}:P"] == ("fixture",)
    assert unread(taken, MOTOR_S)[f"{name}:P"] == ("counter_spindle.motor", "fixture"), "each spindle for itself"
    assert unread(ChannelInfo("pump", "state", "1", at="coolant"))["coolant:pump"] == ("fixture",)


def test_torque_and_speed_are_what_a_spindle_takes_up_and_either_alone_is_not() -> None:
    torque, speed = ("M", "torque", "N m"), ("n", "rotational_speed", "rpm")
    both = unread(*(ChannelInfo(*told, at="spindle") for told in (torque, speed)))
    assert both["cutting_torque:M,n"] == ("spindle.motor", "fixture")
    assert {name for name in both if not name.startswith("cutting")} == set()
    of_turret = unread(ChannelInfo(*torque, at="turret"), ChannelInfo(*speed, at="spindle"))
    assert of_turret == {}


def test_what_does_not_reach_the_working_space_warms_no_holder_of_probes() -> None:
    assert unread(ChannelInfo("P_z", "power", "kW", at="axis.z.motor")) != {}, "the heat of its axis"
    assert unread(ChannelInfo("P_table", "power", "kW", at="table")) == {}
    assert unread(ChannelInfo("n", "rotational_speed", "rpm", at="spindle")) == {}
    assert unread(ChannelInfo("T_chiller", "temperature", "degC", at="chiller.supply")) == {}
    both = unread(ChannelInfo("T_fluid", "temperature", "degC", at="coolant"), OIL)
    assert set(both) == {"coolant_temperature:T_fluid", "lag:T_fluid"}


def test_a_difference_of_two_airs_and_the_sun_are_neither() -> None:
    found = unread(LOW, HIGH, SUN)
    assert "vertical_gradient:T_high,T_low" not in found
    assert "sun:sun" not in found
    assert "lag:T_high" in found


def test_nothing_elsewhere_is_asked() -> None:
    assert unread(OIL) == {}
    assert unread(replace(NUT, at="rotary.c.bearing")) == {}
    assert unread(replace(NUT, at="axis.c.bearing")) == {}


@pytest.mark.parametrize("word", ["drive", "scale", "guideway", "left.nut"])
def test_of_a_place_that_is_no_part_nothing_is_said(word: str) -> None:
    assert unread(replace(NUT, at=f"axis.z.{word}")) == {}


def test_only_what_moves_an_axis_makes_its_heat() -> None:
    assert unread(replace(FEED, quantity="position")) == {}
    assert unread(replace(FEED, quantity="state")) == {}
    assert unread(replace(NUT, quantity="temperature_difference")) == {}
    at_the_motor = unread(replace(FEED, at="axis.z.motor"))
    assert at_the_motor["feed_screw:v"] == ("axis.z.guide",), "the effect is named for the screw"
    assert unread(replace(FEED, quantity="load"))["lag:v"] == ("axis.z.nut", "axis.z.guide")


def test_the_response_reads_its_own_part() -> None:
    channels = {c.name: c for c in (NUT, GUIDE, FEED)}
    found = {c.id: c.unread for c in candidates(effects(), channels, (), "T_nut")}
    assert found["guideway:T_guide"] == ()


def test_a_reference_is_no_part_that_the_model_has() -> None:
    against = Present("column_bending", frozenset({"T_oil", "T_nut"}), "column")
    assert unread(NUT, OIL, FEED, has=(against,))["lag:v"] == ("axis.z.nut", "axis.z.guide")


def test_heats_in_words() -> None:
    assert heat_at(["axis.z.nut", "axis.z.guide"], " or ") == "heat at axis.z.nut or axis.z.guide"
    assert heat_at(["hall"], " or ") == "the air of the hall"
    assert heat_at(["enclosure"], " or ") == "the air of the working space"
    holder = "a warming fixture of the probes or the part (no sensor there)"
    assert heat_at(["fixture"], " or ") == holder
    assert heat_at(["hall", "fixture"], " and ") == f"{holder} and the air of the hall"
    assert heat_at(["axis.z.nut", "fixture"], " or ") == f"heat at axis.z.nut or {holder}"


def on_axis(evidence: float, *places: str) -> Scored:
    one = scored(evidence=evidence, after=0.4)
    return replace(one, candidate=replace(one.candidate, unread=places))


@pytest.mark.parametrize(("evidence", "claimed"), [(188.0, False), (191.0, True)])
def test_it_is_less_probable_and_says_why(evidence: float, claimed: bool) -> None:
    """1 / (1 + exp(-2.45 - 2.2 log10(sharpness) - 1.1 * 0.6 + 0.9)): 65 % at 0.19 a sample; alone at 0.07."""
    alone, beside = on_axis(evidence), on_axis(evidence, "axis.z.guide")
    assert blunt(alone) is None
    assert (blunt(beside) is None) == claimed
    assert probability(beside) < probability(alone)
    if not claimed:
        assert "what it reads does not tell it from heat at axis.z.guide" in str(blunt(beside))
    assert at_best(beside, 1000) < at_best(alone, 1000)
    assert sharpness_asked(0.6, beside.candidate) > sharpness_asked(0.6, alone.candidate)


def test_what_stands_in_the_same_air_is_no_other_cause_and_is_named_all_the_same() -> None:
    """The odds are those of the air alone; which body it is takes 0.9 of them: a fixture is named until 93 % beside it,
    97 % of the air."""

    def air(evidence: float, *places: str) -> Scored:
        one = on_axis(evidence, *places)
        return replace(one, candidate=replace(one.candidate, around=True))

    for evidence in (100.0, 600.0):
        assert probability(air(evidence, "fixture")) == probability(air(evidence))
        assert probability(on_axis(evidence, "fixture")) < probability(on_axis(evidence))
    assert "does not tell it from" not in str(blunt(air(60.0, "fixture")))
    dull, sharp = air(1200.0, "fixture"), air(1600.0, "fixture")
    assert TOLD_APART < probability(dull) < 0.97 < probability(sharp)
    assert (elsewhere(dull), elsewhere(sharp)) == (("fixture",), ())


def test_what_is_sure_is_told_apart_by_its_timing() -> None:
    dull, sharp = on_axis(600.0, "axis.z.guide"), on_axis(3000.0, "axis.z.guide")
    assert probability(dull) < TOLD_APART < probability(sharp)
    assert elsewhere(dull) == ("axis.z.guide",)
    assert elsewhere(sharp) == ()
    moved = replace(sharp, candidate=replace(sharp.candidate, of_motion=True))
    assert elsewhere(moved) == ("axis.z.guide",), "a motion has the timing of no part"


def test_the_sensor_that_tells_them_apart_is_advised() -> None:
    one, channels = on_axis(600.0, "axis.z.guide"), {"T_nut": NUT}
    advice = "to tell plain:T_a from heat at axis.z.guide: log a temperature there"
    assert to_log(one, channels) == advice
    assert to_log(one, {"T_guide": GUIDE}) is None, "it is logged"
    assert to_log(one, {"T_guide": replace(GUIDE, faulty="stuck")}) == advice
    assert advice in to_find(9, (), channels, one)
    assert advice not in to_find(9, (), {"T_guide": GUIDE}, one)
    assert advice not in to_find(9, (), channels, on_axis(600.0))
    few = to_find(5, (), channels, one)
    assert few.startswith(f"{advice}; 5 tests took part"), "it says more than more of the same tests"


def test_of_a_screw_without_a_sensor_the_advice_asks_what_closes_the_loop() -> None:
    told = to_log(on_axis(600.0, "axis.y.nut"), {})
    assert told is not None
    assert ": log a temperature there; or, where a linear scale closes the loop of Y, declare that" in told
    assert "(machine: {axes: {Y: {feedback: scale}}})" in told
    assert "scale" not in str(to_log(on_axis(600.0, "axis.y.guide"), {})), "a guideway acts behind any"


def test_to_be_unsure_of_the_part_is_not_to_be_unsure_of_the_heat() -> None:
    """What its place and its rank among the parts take from the probability of one is no doubt of both."""
    one = on_axis(60.0, "axis.z.nut")
    lesser = replace(one, candidate=replace(one.candidate, lesser=True))
    alone = probability(on_axis(60.0))
    assert probability(lesser) < probability(one) < alone
    assert of_either(one) == of_either(lesser) == alone


SENSOR = (
    "put a sensor on what holds the probes or the part and declare it at: fixture, or declare so the logged "
    "temperature that sits there"
)
FOR_HOLDER = "to tell plain:T_a from a warming fixture of the probes or the part (no sensor there)"


def test_of_a_fixture_the_advice_says_where_and_how_it_is_declared() -> None:
    assert to_log(on_axis(600.0, "fixture"), {}) == f"{FOR_HOLDER}: {SENSOR}"
    both = to_log(on_axis(600.0, "axis.z.guide", "fixture"), {})
    assert both is not None
    assert both.endswith(f": log a temperature there, and {SENSOR}")


@pytest.mark.parametrize(
    ("said", "places", "logged", "told"),
    [
        ("add tests", ("fixture",), (), f"add tests; and {FOR_HOLDER}, {SENSOR}"),
        (None, ("axis.z.guide", "fixture"), (), f"{FOR_HOLDER}, {SENSOR}"),
        (f"{FOR_HOLDER}: {SENSOR}", ("fixture",), (), f"{FOR_HOLDER}: {SENSOR}"),  # once
        ("add tests", ("axis.z.guide",), (), "add tests"),
        ("add tests", ("fixture",), (HOLDER,), "add tests"),
    ],
)
def test_where_the_likeliest_may_be_a_fixture_every_advice_says_what_tells_it(
    said: str | None, places: tuple[str, ...], logged: tuple[ChannelInfo, ...], told: str
) -> None:
    assert with_fixture(said, on_axis(600.0, *places), {c.name: c for c in logged}) == told
    assert with_fixture(said, None, {}) == said


def test_a_claim_names_it() -> None:
    claim = Candidate(
        rank=1,
        id="feed_screw:T_nut",
        effect="feed_screw",
        family="feed_z",
        drivers=["T_nut"],
        claimed=True,
        probability=0.8,
        p_value=0.005,
        rmse_um_before=4.0,
        rmse_um_after=2.0,
        fit_before=None,
        fit_after=None,
        unread=["axis.z.guide"],
    )
    found = Diagnosis(
        model="m",
        response="dZ",
        verdict="effect",
        noise_um=0.1,
        rmse_um=4.0,
        explainable=0.7,
        weak_spots=[],
        candidates=[claim],
        artefacts=[],
    )
    assert (
        "missing: feed_screw (T_nut) or heat at axis.z.guide, which T_nut can't tell from it, probability 80 %;"
        in verdict_sentence(found)
    )
    assert (
        causes([claim])
        == "feed_screw (T_nut) or heat at axis.z.guide, which T_nut can't tell from it, probability 80 %"
    )
    plain = claim.model_copy(update={"unread": []})
    assert causes([plain]) == "feed_screw (T_nut), probability 80 %"
