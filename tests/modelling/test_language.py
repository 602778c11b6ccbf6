"""What a model file can say: phases and responses of an effect, gains by groups and places, models inside of models."""

from __future__ import annotations

from dataclasses import replace
from textwrap import dedent
from typing import Any

import numpy as np
import pytest
import yaml

from thermodata.effect.lag import lag
from thermodata.errors import SpecError, UsageError
from thermodata.modelling import fit_model
from thermodata.modelling.compare.left_out_error import LeftOut
from thermodata.modelling.compare.portability import portability
from thermodata.modelling.terms.acting import acting
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.versions.result import make_result, model_id
from thermodata.modelling.versions.second_lag import with_second_lags
from thermodata.plugin import Float1D
from thermodata.schema.files.load import parse_model
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP = 60.0
INFOS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
        ChannelInfo("dZ_stator", "displacement", "um", "stator", "Z"),
        ChannelInfo("dZ_far", "displacement", "um", "table.d3000", "Z"),
        ChannelInfo("T_sp", "temperature", "degC", "spindle.bearing"),
        ChannelInfo("T_hall", "temperature", "degC", "hall"),
        ChannelInfo("T_table", "temperature", "degC", "table"),
        ChannelInfo("T_tool", "temperature", "degC", "tool"),
        ChannelInfo("speed", "rotational_speed", "rpm", "spindle"),
    )
}


def _test(
    name: str,
    role: str,
    seed: int,
    *,
    hours: float = 10.0,
    work: bool = True,
    turning: float = 1.0,
    tool: str = "D25",
    noise: float = 0.1,
    campaign: str = "lab",
    without: tuple[str, ...] = (),
    phases: dict[str, tuple[float, float]] | None = None,
    **conditions: float | str,
) -> TestData:
    """Frame by spindle and hall; at the tool centre point twice that, a tool, and a table whose gain differs."""
    rng = np.random.default_rng(seed)
    n = int(hours * 60)
    t = np.arange(n) * STEP

    def blocks(length: int) -> Float1D:
        out = np.repeat(rng.choice([0.0, 0.5, 1.0], n // length + 1), length)[:n] * work
        out[:20] = 0.0
        return out

    drive = blocks(90)
    spindle, table, chips = 20 * lag(drive, 900, STEP), 8 * lag(blocks(70), 1500, STEP), 12 * lag(blocks(40), 240, STEP)
    hall = 2 * (np.sin(2 * np.pi * (t / 86400 + seed / 5)) - np.sin(2 * np.pi * seed / 5))
    frame = 1.5 * lag(spindle, 2400, STEP) - 2.0 * lag(hall, 9000, STEP)
    turn = turning * (2.0 * lag(table, 1200, STEP) + 1.0 * lag(table, 7200, STEP))
    values = {
        "dZ": 2.0 * frame - 1.7 * lag(chips, 300, STEP) + turn,
        "dZ_stator": frame,
        "dZ_far": 2.0 * frame + 2.2 * turn,
        "T_sp": 20 + spindle,
        "T_hall": 20 + hall,
        "T_table": 20 + table,
        "T_tool": 20 + chips,
        "speed": 9000 * drive,
    }
    values = {k: v + (noise * rng.normal(size=n) if k.startswith("d") else 0.0) for k, v in values.items()}
    values = {k: v for k, v in values.items() if k not in without}
    valid = {k: np.ones(n, bool) for k in values}
    infos = {k: i for k, i in INFOS.items() if k in values}
    kind = "spectrum" if work else "etve"
    said = {"tool.id": tool, **conditions}
    return TestData(
        campaign, name, kind, role, t, values, valid, np.ones(n, bool), said, phases or {}, machine="m", channels=infos
    )


def _data(*tests: TestData) -> Dataset:
    return Dataset(STEP, tests, INFOS)


def _spec(text: str, **more: Any) -> Model:
    head = {"schema": "thermodata/model/1", "name": "m", "campaign": "lab", "step": "60 s"}
    return Model.model_validate(head | yaml.safe_load(dedent(text)) | more)


def _value(fitted: FittedModel, name: str) -> float:
    return fitted.parameters()[name].value


@pytest.fixture(scope="module")
def lab() -> Dataset:
    return _data(
        _test("idle", "calibration", 9, hours=24, work=False),
        _test("a", "calibration", 1),
        _test("b", "calibration", 2),
        _test("c", "verification", 3),
    )


FRAME = """
  - {effect: spindle_bearing, id: spindle}
  - {effect: ambient_frame, id: hall}
"""
CUT = """
  - {effect: tool_elongation, id: tool}
  - {effect: transfer_function, id: turning, drivers: {u: T_table}, orders: [2, 2]}
"""


# ---- phases of an effect


def _two_ways(name: str, role: str, seed: int) -> TestData:
    """Heating with 1.5 um/K and 40 min, cooling with 1.2 um/K and 120 min, without a step between them."""
    test = _test(name, role, seed, hours=20)
    n = len(test.t_s)
    speed = np.where((np.arange(n) > 30) & (np.arange(n) < 500) | (np.arange(n) > 900), 9000.0, 0.0)
    warm = 20 * lag(speed / 9000, 900, STEP)
    hot, cold = 1.5 * lag(warm, 2400, STEP), 1.2 * lag(warm, 7200, STEP)
    steps = np.where(speed > 0, np.diff(hot, prepend=0.0), np.diff(cold, prepend=0.0))
    steps[speed == 0] *= np.cumsum(speed > 0)[speed == 0] > 0
    y = np.cumsum(steps) - 2.0 * lag(test.values["T_hall"] - 20, 9000, STEP)
    values = {**test.values, "dZ": y + np.random.default_rng(seed).normal(0, 0.1, n), "T_sp": 20 + warm, "speed": speed}
    return replace(test, values=values)


TWO_WAYS = """
response: {axis: Z, at: tcp}
effects:
  - {effect: lag, id: heating, drivers: {u: T_sp}, phases: [heating]}
  - {effect: lag, id: cooling, drivers: {u: T_sp}, phases: [cooling]}
  - {effect: ambient_frame, id: hall, calibrate_on: [idle]}
"""


def test_heating_and_cooling_have_functions_of_their_own_in_one_model(lab: Dataset) -> None:
    idle = lab.tests[0]
    hall_only = replace(idle, values={**idle.values, "dZ": idle.values["dZ"] / 2})
    data = _data(hall_only, _two_ways("a", "calibration", 1), _two_ways("c", "verification", 3))
    fitted = fit_model(_spec(TWO_WAYS), data)
    assert _value(fitted, "heating.gain") == pytest.approx(1.5, rel=0.03)
    assert _value(fitted, "heating.tau") == pytest.approx(40, rel=0.1)
    assert _value(fitted, "cooling.gain") == pytest.approx(1.2, rel=0.03)
    assert _value(fitted, "cooling.tau") == pytest.approx(120, rel=0.1)
    unseen = data.test("lab", "c")
    assert np.std(fitted.responses[0].residual(unseen)) < 0.2
    blind = {k: v for k, v in unseen.values.items() if not k.startswith("d")}
    assert np.allclose(
        fitted.responses[0].predict(replace(unseen, values=blind)), fitted.responses[0].predict(unseen)
    ), "phases are told without a displacement"


def test_an_idle_test_counts_whatever_phases_the_model_wants(lab: Dataset) -> None:
    text = """
    response: {axis: Z, at: tcp}
    phases: [heating, steady]
    effects:
      - {effect: spindle_bearing, id: spindle}
      - {effect: ambient_frame, id: hall, calibrate_on: [idle]}
    """
    fitted = fit_model(_spec(text), lab)
    assert _value(fitted, "hall.gain") == pytest.approx(-4.0, rel=0.05)


def test_declared_phases_say_when_an_effect_acts(lab: Dataset) -> None:
    test = replace(lab.tests[1], phases={"heating": (600.0, 6000.0), "rest": (6000.0, 9000.0)})
    where = acting(test, ["heating"])
    assert where is not None
    assert np.array_equal(test.t_s[where][[0, -1]], [600.0, 6000.0])
    untold = replace(test, phases={}, channels={k: v for k, v in INFOS.items() if k != "speed"})
    assert acting(untold, ["heating"]) is None
    data = _data(*lab.tests[:3], replace(lab.tests[3], channels=untold.channels))
    fitted = fit_model(_spec(TWO_WAYS), data, uncertainty=False)
    why = fitted.responses[0].why_not(data.tests[3])
    assert why is not None
    assert "heating" in why


# ---- a model inside of a model


def _inside(lab: Dataset) -> dict[str, Any]:
    frame = _spec(f"name: frame\nresponse: {{axis: Z, at: stator}}\neffects:{FRAME}", name="frame")
    return frame.model_dump(mode="json", by_alias=True)


def test_another_models_output_times_a_gain(lab: Dataset) -> None:
    effects = [
        {"effect": "model", "name": "frame", "gain": "K", "inside": _inside(lab)},
        *yaml.safe_load(CUT),
    ]
    spec = _spec("response: {axis: Z, at: tcp}", effects=effects)
    fitted = fit_model(spec, lab)
    assert _value(fitted, "model.K") == pytest.approx(2.0, rel=0.01)
    assert _value(fitted, "tool.gain") == pytest.approx(-1.7, rel=0.03)
    held = _spec("response: {axis: Z, at: tcp}", effects=[{**effects[0], "gain": 2}, *effects[1:]])
    assert _value(fit_model(held, lab, uncertainty=False), "model.gain") == 2.0
    assert model_id(spec, "v") != model_id(held, "v")


def test_one_part_of_another_model_times_a_gain(lab: Dataset) -> None:
    """The spindle's function as found at the stator acts twice at the tool centre point, the hall's once."""
    whole = {t.test: t for t in lab.tests}
    hall = {name: -2.0 * lag(t.values["T_hall"] - 20, 9000, STEP) for name, t in whole.items()}
    once = _data(*(replace(t, values={**t.values, "dZ": t.values["dZ"] - hall[t.test]}) for t in lab.tests))
    effects = [
        {"effect": "model", "id": "g", "name": "frame", "parts": ["spindle"], "inside": _inside(lab)},
        {"effect": "model", "id": "h", "name": "frame", "parts": ["hall"], "gain": 1, "inside": _inside(lab)},
        *yaml.safe_load(CUT),
    ]
    fitted = fit_model(_spec("response: {axis: Z, at: tcp}", effects=effects), once)
    assert _value(fitted, "g.gain") == pytest.approx(2.0, rel=0.01)
    spindle, both = fitted.responses[0].terms[:2]
    test = once.test("lab", "c")
    assert np.std(both.contribution(test) - hall["c"]) < 0.05
    assert np.std(spindle.contribution(test)) > 5
    unknown = [{**effects[0], "parts": ["spindel"]}, *effects[1:]]
    with pytest.raises(UsageError, match="spindel") as refusal:
        fit_model(_spec("response: {axis: Z, at: tcp}", effects=unknown), once)
    assert "spindle" in str(refusal.value.hint)
    with pytest.raises(SpecError, match="'parts' belongs to model"):
        fit_model(_spec("response: {axis: Z, at: tcp}\neffects: [{effect: ambient_frame, parts: [a]}]"), lab)


def test_a_model_inside_has_to_be_found_first(lab: Dataset) -> None:
    with pytest.raises(SpecError, match="needs the name of a model"):
        fit_model(_spec("response: {axis: Z, at: tcp}\neffects: [{effect: model, name: frame}]"), lab)
    inside = {**_inside(lab), "campaign": "other"}
    with pytest.raises(SpecError, match="other campaigns") as refusal:
        fit_model(_spec("response: {axis: Z, at: tcp}", effects=[{"effect": "model", "inside": inside}]), lab)
    assert refusal.value.expected == "campaigns: [lab, other]"
    with pytest.raises(SpecError, match="'name' belongs to model") as named:
        fit_model(_spec("response: {axis: Z, at: tcp}\neffects: [{effect: ambient_frame, name: frame}]"), lab)
    assert named.value.hint == "an effect is called by 'id: frame'"


# ---- an effect identified on another response


def test_the_frame_is_identified_at_the_stator_and_used_at_the_tool(lab: Dataset) -> None:
    half = _data(*(replace(t, values={**t.values, "dZ": t.values["dZ"] - t.values["dZ_stator"]}) for t in lab.tests))
    seen = FRAME.replace("}", ", response: {axis: Z, at: stator}}")
    fitted = fit_model(_spec(f"response: {{axis: Z, at: tcp}}\neffects:{seen}{CUT}"), half)
    stator = fit_model(_spec(f"response: {{axis: Z, at: stator}}\neffects:{FRAME}"), half)
    for name in ("spindle.gain", "spindle.tau", "hall.gain", "hall.tau"):
        assert _value(fitted, name) == pytest.approx(_value(stator, name), rel=1e-6), name
    assert _value(fitted, "tool.gain") == pytest.approx(-1.7, rel=0.03)
    no_stator = _data(*(replace(t, values={k: v for k, v in t.values.items() if k != "dZ_stator"}) for t in half.tests))
    with pytest.raises(SpecError, match="stator"):
        fit_model(_spec(f"response: {{axis: Z, at: tcp}}\neffects:{seen}{CUT}"), no_stator)


# ---- an effect that acts on some responses only


ACTS = """
response: [{axis: Z, at: tcp}, {axis: Z, at: stator}]
effects:
  - {effect: spindle_bearing, id: spindle}
  - {effect: ambient_frame, id: hall}
  - {effect: tool_elongation, id: tool, acts_on: [%s]}
  - {effect: transfer_function, id: turning, drivers: {u: T_table}, acts_on: [{axis: Z, at: tcp}]%s}
"""


def test_an_effect_acts_on_some_responses_only(lab: Dataset) -> None:
    spec = _spec(ACTS % ("{axis: Z, at: tcp}", ", orders: [2, 2]"))
    fitted = fit_model(spec, lab)
    tcp, stator = fitted.responses
    assert [[t.id for t in r.terms] for r in (tcp, stator)] == [
        ["spindle", "hall", "tool", "turning"],
        ["spindle", "hall"],
    ]
    found = fitted.parameters()
    assert found["dZ/tool.gain"].value == pytest.approx(-1.7, rel=0.03)
    assert not [name for name in found if name.startswith(("dZ_stator/tool", "dZ_stator/turning"))]
    alone = fit_model(_spec(f"response: {{axis: Z, at: stator}}\neffects:{FRAME}"), lab).parameters()
    assert found["dZ_stator/hall.tau"].value == alone["hall.tau"].value
    # orders that are left open are each effect's own, wherever it stands in a response
    left_out = LeftOut(_spec(ACTS % ("{axis: Z, at: tcp}", "")), lab)
    assert left_out.errors(left_out.whole.spec).rmse("dZ_stator") < 0.2
    second = with_second_lags(_spec(ACTS % ("{axis: Z, at: stator}", ", orders: [2, 2]")), lab)
    assert second.notes


def test_an_effect_acts_on_responses_of_its_model(lab: Dataset) -> None:
    for where in ("{channel: dZ_far}", ""):
        with pytest.raises(SpecError, match="acts on responses of its model") as refusal:
            fit_model(_spec(ACTS % (where, ", orders: [2, 2]")), lab)
        assert refusal.value.expected == "some of dZ, dZ_stator"
    with pytest.raises(SpecError, match="share time constants"):
        fit_model(_spec(ACTS % ("{axis: Z, at: tcp}", ", orders: [2, 2], gain_by: place")), lab)


# ---- gains by place, by groups, and one factor


def test_places_share_time_constants_and_differ_in_gain(lab: Dataset) -> None:
    text = f"""
response: [{{axis: Z, at: tcp}}, {{channel: dZ_far}}]
effects:{FRAME}
  - {{effect: tool_elongation, id: tool}}
  - {{effect: transfer_function, id: turning, drivers: {{u: T_table}}, orders: [2, 2], gain_by: place}}
"""
    fitted = fit_model(_spec(text), lab)
    by_name = fitted.parameters()
    for k in ("tau_1", "tau_2"):
        assert by_name[f"dZ/turning.{k}"].value == by_name[f"dZ_far/turning.{k}"].value
    assert by_name["dZ/spindle.tau"].value != by_name["dZ_far/spindle.tau"].value
    at_rest = [sum(by_name[f"{place}/turning.gain_{k}"].value for k in (1, 2)) for place in ("dZ", "dZ_far")]
    assert at_rest == [pytest.approx(3.0, rel=0.03), pytest.approx(6.6, rel=0.03)]
    unseen = lab.test("lab", "c")
    for response in fitted.responses:
        assert np.std(response.residual(unseen)) < 0.2, response.name
        assert response.checks
    alone = fit_model(_spec(text.replace(", gain_by: place", "")), lab, uncertainty=False).parameters()
    assert alone["dZ/turning.tau_1"].value != alone["dZ_far/turning.tau_1"].value


ALIKE = ", gain_by: place, groups: {dZ: both, dZ_far: both}}\n"


def test_places_share_an_effect_that_was_identified_on_tests_of_its_own(lab: Dataset) -> None:
    """The hall on an idle test; turning on a test that has all places, and only the tool's place on the other."""
    near = replace(lab.tests[1], values={k: v for k, v in lab.tests[1].values.items() if k != "dZ_far"})
    data = _data(lab.tests[0], near, *lab.tests[2:])
    frame = FRAME.replace("}\n", ALIKE)
    text = f"""
response: [{{axis: Z, at: tcp}}, {{channel: dZ_far}}]
effects:{frame}
  - {{effect: tool_elongation, id: tool, gain_by: place}}
  - {{effect: transfer_function, id: turning, drivers: {{u: T_table}}, orders: [2, 2], gain_by: place, one_gain: true}}
"""
    whole = fit_model(_spec(text), data).parameters()
    staged = text.replace("id: hall,", "id: hall, calibrate_on: [idle],").replace(
        "id: turning,", "id: turning, calibrate_on: [b],"
    )
    found = fit_model(_spec(staged), data).parameters()
    assert {name: p.value for name, p in found.items()} == pytest.approx(
        {n: p.value for n, p in whole.items()}, rel=1e-3
    )
    assert found["dZ_far/turning.g"].value == pytest.approx(2.2, rel=0.03)


def test_a_place_without_a_calibration_test_takes_what_all_places_share(lab: Dataset) -> None:
    bare = [replace(t, values={k: v for k, v in t.values.items() if k != "dZ_far"}) for t in lab.tests[:3]]
    same = replace(lab.tests[3], values={**lab.tests[3].values, "dZ_far": lab.tests[3].values["dZ"]})
    data = _data(*bare, same)
    text = "response: [{axis: Z, at: tcp}, {channel: dZ_far}]\neffects:" + (FRAME + CUT).replace("}\n", ALIKE)
    fitted = fit_model(_spec(text), data)
    far = fitted.responses[1]
    assert (far.checks, far.noise) == ((), None)
    assert np.std(far.residual(same)) == pytest.approx(np.std(fitted.responses[0].residual(same)))


def _by_tool() -> Dataset:
    return _data(
        _test("a", "calibration", 1, tool="D25"),
        _test("b", "calibration", 2, tool="D63"),
        _test("d", "calibration", 4, tool="D100", turning=0.4),
        _test("c", "verification", 3, tool="D63"),
        _test("e", "verification", 5, tool="D100", turning=0.4),
        _test("f", "verification", 6, tool="D160"),
    )


TOOLS = """
response: {axis: Z, at: tcp}
effects:
  - {effect: spindle_bearing, id: spindle}
  - {effect: ambient_frame, id: hall}
  - {effect: tool_elongation, id: tool}
  - {effect: transfer_function, id: turning, drivers: {u: T_table}, orders: [2, 2], gain_by: tool, %s}
"""


def test_one_factor_over_all_gains_of_an_effect_by_groups_of_tools() -> None:
    data = _by_tool()
    text = "schema: thermodata/model/1\nname: m\ncampaign: lab\nstep: 60 s" + TOOLS
    spec = parse_model(text % "one_gain: true, groups: {[D25, D63]: k1, D100: k2}")
    assert spec.effects[3].groups == {"D25": "k1", "D63": "k1", "D100": "k2"}
    fitted = fit_model(spec, data)
    found = fitted.parameters()
    assert found["turning.g[k1]"].value == 1.0
    assert found["turning.g[k2]"].value == pytest.approx(0.4, rel=0.03)
    low, high = found["turning.g[k2]"].low, found["turning.g[k2]"].high
    assert low is not None
    assert high is not None
    assert low < 0.4 < high
    assert {n for n in found if n.startswith("turning.gain")} == {"turning.gain_1", "turning.gain_2"}
    assert found["turning.gain_1"].value + found["turning.gain_2"].value == pytest.approx(3.0, rel=0.03)
    for name in ("c", "e"):
        assert np.std(fitted.responses[0].residual(data.test("lab", name))) < 0.2, name
    own = fit_model(_spec(TOOLS % "shared: [tau_1, tau_2]"), data).parameters()
    assert {"turning.gain_1[D25]", "turning.gain_2[D100]"} <= set(own)


def test_a_test_that_cannot_be_predicted_is_listed_with_the_reason() -> None:
    data = _by_tool()
    fitted = fit_model(_spec(TOOLS % "one_gain: true"), data)
    result = make_result(fitted, data, "m")
    assert "f" not in {s.test for s in result.scores}
    (said,) = [c for c in result.checks if c.name == "not_predicted:lab/f"]
    assert said.advice == "dZ: no calibration test gave turning a gain for 'D160'"
    assert not said.passed


def test_a_locked_test_that_cannot_be_predicted_is_listed_too() -> None:
    data = _by_tool()
    locked = replace(data, tests=tuple(replace(t, role="locked") if t.test == "f" else t for t in data.tests))
    result = make_result(fit_model(_spec(TOOLS % "one_gain: true"), locked), locked, "m")
    (said,) = [c for c in result.checks if c.name == "not_predicted:lab/f"]
    assert said.advice == "dZ: no calibration test gave turning a gain for 'D160'"


@pytest.mark.parametrize(
    ("effect", "by", "refused"),
    [
        ({"effect": "lag", "drivers": {"u": "T_table"}}, "test", True),
        ({"effect": "lag", "drivers": {"u": "T_table"}}, "campaign", False),  # whose gain is known
        ({"effect": "warm_start"}, "test", False),
        ({"effect": "drift"}, "test", False),
    ],
)
def test_what_is_driven_is_not_foretold_without_a_gain_for_the_test(
    effect: dict[str, object], by: str, refused: bool
) -> None:
    """What nothing drives is of a test itself: another one is foretold without it."""
    data = _by_tool()
    known = {"effect": "spindle_bearing", "id": "spindle"}
    fitted = fit_model(_spec("response: {axis: Z, at: tcp}", effects=[known, {**effect, "gain_by": by}]), data)
    result = make_result(fitted, data, "m")
    said = {c.name: c.advice for c in result.checks if c.name.startswith("not_predicted")}
    why = f"dZ: no calibration test gave {effect['effect']} a gain for 'f'"
    assert said.get("not_predicted:lab/f") == (why if refused else None)
    assert ("f" in {s.test for s in result.scores}) is not refused
    assert fitted.responses[0].can_predict(data.test("lab", "a"))


def test_groups_need_something_to_group() -> None:
    for more in ({"groups": {"D25": "k1"}}, {"one_gain": True}):
        with pytest.raises(ValueError, match="needs 'gain_by'"):
            _spec("response: {axis: Z}", effects=[{"effect": "lag", **more}])
    with pytest.raises(ValueError, match="two groups"):
        _spec("response: {axis: Z}", effects=[{"effect": "lag", "gain_by": "D", "groups": {"[a, b]": "k", "b": "l"}}])


# ---- a sensor missing on one machine


def test_a_sensor_missing_on_one_machine_is_an_x_in_the_table(lab: Dataset) -> None:
    bare = _test("n", "verification", 7, campaign="other", without=("T_tool",))
    whole = _test("o", "verification", 8, campaign="other2")
    data = _data(*lab.tests, bare, whole)
    text = f"response: {{axis: Z, at: tcp}}\neffects:{FRAME}{CUT}"
    spec = _spec(text, campaign=None, campaigns=["lab", "other", "other2"])
    fitted = fit_model(spec, data)
    rows = {r.test: r for r in portability(fitted, data)}
    assert rows["o"].verdict == "portable"
    assert rows["n"].verdict == "x"
    assert rows["n"].fit_n is None
    assert "tool" in str(rows["n"].why)
    none = _data(*(replace(t, values={k: v for k, v in t.values.items() if k != "T_tool"}) for t in data.tests))
    with pytest.raises(UsageError, match="no channel fits"):
        fit_model(spec, none)


# ---- what a driver goes through, weights, a warm start


def _late(name: str, role: str, seed: int) -> TestData:
    """The bearing acts 5 min late, and its sensor shows it with a lag of 3 min."""
    test = _test(name, role, seed, noise=0.02)
    warm = test.values["T_sp"] - 20
    late = np.interp(test.t_s - 300.0, test.t_s, warm)
    y = 1.5 * lag(late, 2400, STEP) + np.random.default_rng(seed).normal(0, 0.02, len(late))
    return replace(test, values={**test.values, "dZ": y, "T_sp": 20 + lag(warm, 180.0, STEP)})


def test_dead_time_and_sensor_lag_are_parameters_of_any_effect() -> None:
    data = _data(_late("a", "calibration", 1), _late("b", "calibration", 2), _late("c", "verification", 3))
    text = "response: {axis: Z, at: tcp}\neffects: [{effect: spindle_bearing, also: [dead_time], %s}]"
    slow = _data(*(replace(t, values={**t.values, "T_sp": t.values["T_sp"]}) for t in data.tests))
    found = fit_model(_spec(text % "start: {dead_time: 60}"), slow)
    # 5 min late, seen 3 min late: 2 min are left
    assert _value(found, "spindle_bearing.dead_time") == pytest.approx(120, abs=15)
    assert found.parameters()["spindle_bearing.dead_time"].unit == "s"
    both = text.replace("[dead_time]", "[dead_time, sensor_lag]")
    held = fit_model(_spec(both % "fixed: {sensor_lag: 180}"), data)
    assert _value(held, "spindle_bearing.dead_time") == pytest.approx(300, abs=15)
    assert _value(held, "spindle_bearing.tau") == pytest.approx(40, rel=0.03)
    assert np.std(held.responses[0].residual(data.tests[2])) < 0.03
    sensor = fit_model(_spec(both % "fixed: {dead_time: 300}"), data)
    assert _value(sensor, "spindle_bearing.sensor_lag") == pytest.approx(180, rel=0.1)
    with pytest.raises(UsageError, match="dead_tim"):
        fit_model(_spec("response: {axis: Z, at: tcp}\neffects: [{effect: spindle_bearing, also: [dead_tim]}]"), data)


def test_weights_say_what_counts(lab: Dataset) -> None:
    wrong = replace(lab.tests[2], values={**lab.tests[2].values, "dZ_stator": lab.tests[2].values["dZ_stator"] * 1.5})
    data = _data(lab.tests[0], lab.tests[1], wrong)
    text = f"response: {{axis: Z, at: stator}}\neffects:{FRAME}"
    gains = [
        _value(fit_model(_spec(text, weights={"b": weight}), data, uncertainty=False), "spindle.gain")
        for weight in (1.0, 0.05, 0.0)
    ]
    assert gains[0] > gains[1] > gains[2]
    assert gains[2] == pytest.approx(1.5, rel=0.01)
    assert gains[0] > 1.7
    where = acting(lab.tests[1], ["cooling"])
    assert where is not None
    moved = lab.tests[1].values["dZ_stator"] + 5.0 * where
    cooled = replace(lab.tests[1], values={**lab.tests[1].values, "dZ_stator": moved})
    data = _data(lab.tests[0], cooled)
    spoilt, spared = (
        _value(fit_model(_spec(text, weights=w), data, uncertainty=False), "spindle.gain") for w in ({}, {"cooling": 0})
    )
    assert abs(spared - 1.5) < 0.5 * abs(spoilt - 1.5)
    with pytest.raises(UsageError, match="cooling"):
        fit_model(_spec(text, weights={"coolin": 1}), data)


def test_a_test_that_began_warm_does_not_bend_the_fit(lab: Dataset) -> None:
    warm = []
    for k, test in enumerate(lab.tests[:3]):
        fades = (10.0 + 5 * k) * np.exp(-test.t_s / 5000.0)
        warm.append(replace(test, values={**test.values, "dZ_stator": test.values["dZ_stator"] + fades}))
    text = f"response: {{axis: Z, at: stator}}\neffects:{FRAME}"
    bent = fit_model(_spec(text), _data(*warm))
    data = _data(*(replace(t, start_state="warm") for t in warm))
    fitted = fit_model(_spec(text), data)
    for name, truth in (("spindle.gain", 1.5), ("spindle.tau", 40.0), ("hall.gain", -2.0), ("hall.tau", 150.0)):
        assert _value(fitted, name) == pytest.approx(truth, rel=0.05), name
    assert abs(_value(bent, "spindle.gain") - 1.5) > 0.1
    assert {c.name for c in fitted.checks() if c.name.startswith("warm")} >= {"warm_start:lab/a"}


def test_a_gain_that_a_bound_holds_says_so(lab: Dataset) -> None:
    text = "response: {axis: Z, at: stator}\neffects: [{effect: spindle_bearing, bounds: {gain: [0, 1]}}]"
    (said,) = [c for c in fit_model(_spec(text), lab).checks() if c.name == "at_bound:spindle_bearing.gain"]
    assert said.threshold == 1.0
    assert "a bound of the model file" in said.advice
