"""A gain for each value of a condition, as a candidate (weigh/gain_by.py)."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.tell.advising import next_test
from thermodata.diagnosis.tell.advising.to_find import to_find
from thermodata.diagnosis.weigh.gain_by import gains_by_condition, named
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.errors import UsageError
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis, WeakSpot
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset

from .conftest import STEP_S, base, make_data
from .hand_made import scored

Add = Callable[[dict[str, Any], np.ndarray], np.ndarray]
TOOLS = ("T1", "T2", "T3", "T1", "T2", "T3", "T2")  # the last test is locked
ID = "gain_by:spindle_bearing,conditions.tool"


def bearing(channels: dict[str, Any]) -> np.ndarray:
    """What the spindle does to dZ in `make_data`."""
    return lag(-3 * (channels["T_bearing"] - channels["T_bearing"][0]), 3000, STEP_S)


def by_tool(gains: dict[str, float], tools: Sequence[str] = TOOLS) -> Add:
    """The spindle acts so many times as strong with each tool."""
    each = iter(tools)

    def add(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        return (gains[next(each)] - 1.0) * bearing(channels)

    return add


def with_conditions(data: Dataset, **conditions: Sequence[float | str]) -> Dataset:
    """A value of each test; '' where a test has none."""
    tests = tuple(
        replace(t, conditions={n: v[i] for n, v in conditions.items() if v[i] != ""}) for i, t in enumerate(data.tests)
    )
    return replace(data, tests=tests)


def diagnosis(data: Dataset, spec: Model) -> Diagnosis:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis


def asked(data: Dataset, spec: Model) -> list[str]:
    return [c.id for c in found_in(data, spec)]


def found_in(data: Dataset, spec: Model) -> list[Any]:
    response = response_of(data, spec)
    return gains_by_condition(response, [t for t in data.tests if t.role != "locked"], data.tests)


def response_of(data: Dataset, spec: Model) -> FittedResponse:
    return fit_model(spec, data, uncertainty=False).responses[0]


def one(found: Diagnosis, name: str = ID) -> Candidate | None:
    return next((c for c in found.candidates if c.id == name), None)


@pytest.fixture(scope="module")
def of_three_tools() -> Diagnosis:
    data = make_data(by_tool({"T1": 1.0, "T2": 0.6, "T3": 0.3}))
    return diagnosis(with_conditions(data, tool=TOOLS), base())


def test_a_gain_that_differs_by_tool_is_offered_as_a_refinement(of_three_tools: Diagnosis) -> None:
    head = of_three_tools.candidates[0]
    assert of_three_tools.verdict == "refine"
    assert (head.id, head.effect, head.drivers) == (ID, "spindle_bearing", ["T_bearing"])
    assert (head.refinement, head.claimed, head.gain_by) == (True, False, "conditions.tool")
    said = re.search(
        r"spindle_bearing acts with another gain for each conditions.tool \(T1 1, T2 (\S+), T3 (\S+) times\)", head.why
    )
    assert said is not None
    assert [float(g) for g in said.groups()] == pytest.approx([0.6, 0.3], abs=0.02)
    assert head.rmse_um_before is not None
    assert head.rmse_um_after is not None
    assert head.rmse_um_after < 0.2 * head.rmse_um_before
    assert not any(c.claimed for c in of_three_tools.candidates)
    assert head.probability is None


def test_equal_gains_are_not_offered(spec: Model) -> None:
    found = diagnosis(with_conditions(make_data(by_tool(dict.fromkeys(TOOLS, 1.0))), tool=TOOLS), spec)
    assert found.verdict == "none"
    offered = one(found)
    assert offered is not None
    assert not offered.refinement


def of_nut(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
    return lag(2.0 * (channels["T_nut_X"] - channels["T_nut_X"][0]), 2400, STEP_S)


def test_a_cause_that_goes_with_the_condition_is_named_and_the_condition_is_not(spec: Model) -> None:
    """The screw runs with one of the tools only, so that the error differs by tool too."""
    each = iter(TOOLS)

    def add(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        if next(each) != "T2":
            channels["T_nut_X"] = 22 + np.random.default_rng(1).normal(0, 0.02, len(t))
        return of_nut(channels, t)

    found = diagnosis(with_conditions(make_data(add), tool=TOOLS), spec)
    assert found.verdict == "effect"
    assert found.candidates[0].id == "feed_screw:T_nut_X"
    assert found.candidates[0].claimed
    offered = one(found)
    assert offered is None or not (offered.refinement or offered.claimed)


def test_a_cause_and_another_gain_are_both_found(spec: Model) -> None:
    tools = by_tool({"T1": 1.0, "T2": 0.5, "T3": 0.2})
    found = diagnosis(with_conditions(make_data(lambda c, t: tools(c, t) + of_nut(c, t)), tool=TOOLS), spec)
    assert [c.id for c in found.candidates if c.claimed] == ["feed_screw:T_nut_X"]
    offered = one(found)
    assert offered is not None
    assert offered.refinement


def test_the_gains_that_are_told_are_those_of_the_next_version(spec: Model) -> None:
    """Something slow that nobody logs is missing too, which effects that may act slower take up."""
    tools = by_tool({"T1": 1.0, "T2": 0.5, "T3": 0.2})

    def add(channels: dict[str, Any], t: np.ndarray) -> np.ndarray:
        unlogged = 0.5 * of_nut(channels, t)
        channels["T_nut_X"] = 22 + np.random.default_rng(1).normal(0, 0.02, len(t))
        return tools(channels, t) + unlogged

    data = with_conditions(make_data(add), tool=TOOLS)
    offered = one(diagnosis(data, spec))
    assert offered is not None
    said = re.search(r"\(T1 (\S+), T2 (\S+), T3 (\S+) times\)", offered.why)
    assert said is not None
    groups = response_of(data, with_candidate(spec, ID, data.channels)).terms[0].groups
    gains = np.array([groups[tool].gains["gain"] for tool in ("T1", "T2", "T3")])
    assert [float(g) for g in said.groups()] == pytest.approx(gains / gains[0], abs=0.006)


def test_a_value_of_one_test_is_said_to_be_foretold_by_none(spec: Model) -> None:
    """T3 stands in one open test, and in the locked one."""
    tools = ("T1", "T2", "T1", "T2", "T1", "T3", "T3")
    found = diagnosis(with_conditions(make_data(by_tool({"T1": 1.0, "T2": 0.6, "T3": 0.3}, tools)), tool=tools), spec)
    offered = one(found)
    assert offered is not None
    assert not offered.refinement
    assert "values that stand in one test only: T3 (t5); no other test foretells their gain" in offered.why
    assert "ask the locked t6" in offered.why
    assert found.verdict == "unknown"
    said = str(found.next_test)
    assert said.startswith(f"{ID} could not be asked: conditions.tool has values that stand in one test only: T3 (t5)")
    assert "ask the locked t6 (thermodata confirm); if it is not that, " in said


@pytest.mark.parametrize(
    ("tools", "there"),
    [
        (("T1",) * 7, False),
        (("T1", "T2", "T1", "T2", "T1", "T2", "T1"), True),
        (("T1", "T2", "T3", "T4", "T5", "T5", "T1"), True),
        (("T1", "T2", "T3", "T4", "T5", "T6", "T1"), False),
        (("T1", "T2", "T1", "T2", "T1", "T2", ""), False),
    ],
    ids=["one value", "two values", "values + 1 tests", "a value a test", "the locked test has none"],
)
def test_a_condition_parts_the_tests_of_every_role(tools: Sequence[str], there: bool, spec: Model) -> None:
    assert (ID in asked(with_conditions(make_data(), tool=tools), spec)) is there


@pytest.mark.parametrize(("values", "there"), [(8, True), (9, False)])
def test_more_than_eight_values_are_no_groups(values: int, there: bool, spec: Model) -> None:
    data = make_data(tests=19)
    tools = [f"T{i % values}" for i in range(19)]
    assert (ID in asked(with_conditions(data, tool=tools), spec)) is there


def test_a_value_whose_tests_rest_is_no_value(spec: Model) -> None:
    """T3 stands in one test, in which the spindle stays as cold as it was."""
    tools = ("T1", "T2", "T1", "T2", "T1", "T3", "T1")
    data = make_data(by_tool({"T1": 1.0, "T2": 0.6, "T3": 1.0}, tools))
    resting = data.tests[5]
    cold = np.full(len(resting.t_s), 22.0)
    still = replace(resting, values={**resting.values, "T_bearing": cold, "dZ": 0.0 * cold})
    data = replace(data, tests=(*data.tests[:5], still, data.tests[6]))
    (found,) = found_in(with_conditions(data, tool=tools), spec)
    assert (found.id, found.unforetold) == (ID, None)
    assert [g.name for g in found.effect.gains] == ["T1", "T2"]
    assert not found.in_test(still)({}).any()


def test_conditions_that_part_the_tests_alike_are_one_candidate(spec: Model) -> None:
    diameters = [{"T1": 25.0, "T2": 63.0, "T3": 100.0}[t] for t in TOOLS]
    named_so: dict[str, Sequence[float | str]] = {"tool.id": TOOLS, "tool.diameter": diameters}
    data = with_conditions(make_data(), **named_so)
    (found,) = found_in(data, spec)
    assert (found.id, found.alike) == ("gain_by:spindle_bearing,conditions.tool.id", ("conditions.tool.diameter",))


def test_machines_part_the_tests_too(spec: Model) -> None:
    data = make_data()
    tests = tuple(replace(t, machine="AB"[i % 2]) for i, t in enumerate(data.tests))
    assert asked(replace(data, tests=tests), spec) == ["gain_by:spindle_bearing,machine"]


@pytest.mark.parametrize(
    "changed",
    [{"gain_by": "conditions.tool"}, {"fixed": {"gain": -3.0}}, {"calibrate_on": ["t0", "t1", "t2"]}],
    ids=["has them", "is fixed", "identified first"],
)
def test_a_gain_that_is_not_one_free_gain_is_not_asked_about(changed: dict[str, Any], spec: Model) -> None:
    effect = spec.effects[0].model_copy(update=changed)
    data = with_conditions(make_data(), tool=TOOLS)
    assert asked(data, spec) == [ID]
    assert asked(data, spec.model_copy(update={"effects": [effect]})) == []


MACHINES = ("A", "B", "B", "A", "B", "B", "A")  # A has T1 and, locked, T2


def on_machines(data: Dataset) -> Dataset:
    """With tools, and two machines."""
    tests = with_conditions(data, tool=TOOLS).tests
    return replace(data, tests=tuple(replace(t, machine=m) for t, m in zip(tests, MACHINES, strict=True)))


def with_a_gain_by(spec: Model, by: str | list[str]) -> Model:
    return spec.model_copy(update={"effects": [spec.effects[0].model_copy(update={"gain_by": by}), *spec.effects[1:]]})


def test_a_gain_for_each_machine_is_parted_by_tool_within_the_machines() -> None:
    """Of B the tools differ, so a gain for each machine leaves what a tool does."""
    data = on_machines(make_data(by_tool({"T1": 1.0, "T2": 0.6, "T3": 0.3})))
    spec = with_a_gain_by(base(), "machine")
    found = diagnosis(data, spec)
    assert found.verdict == "refine"
    head = found.candidates[0]
    assert (head.id, head.gain_by, head.refinement) == (ID, "conditions.tool", True)
    said = re.search(r"conditions.tool \(A, T1 1; B, T2 (\S+); B, T3 (\S+) times\)", head.why)
    assert said is not None
    assert [float(g) for g in said.groups()] == pytest.approx([0.6, 0.3], abs=0.02)
    more = with_candidate(spec, ID, data.channels)
    assert more.effects[0].gain_by == ["machine", "conditions.tool"]
    assert set(response_of(data, more).terms[0].groups) == {"A, T1", "B, T2", "B, T3"}


def test_what_parts_no_further_than_the_gains_is_not_asked(spec: Model) -> None:
    data = on_machines(make_data())
    assert asked(data, with_a_gain_by(spec, "machine")) == [ID]
    assert asked(data, with_a_gain_by(spec, "conditions.tool")) == []
    with pytest.raises(UsageError, match="for each of them already"):
        with_candidate(with_a_gain_by(spec, "tool"), ID, data.channels)


def test_an_effect_of_some_tests_is_parted_within_these(spec: Model) -> None:
    more = EffectSpec(effect="lag", id="some", drivers={"u": "T_tank"}, tests=["t0", "t1", "t2", "t3"])
    wide = spec.model_copy(update={"effects": [*spec.effects, more]})
    tools = ("T1", "T2", "T1", "T2", "", "", "")
    assert asked(with_conditions(make_data(), tool=tools), wide) == ["gain_by:some,conditions.tool"]


def test_what_a_user_names_must_be_there(spec: Model) -> None:
    data = with_conditions(make_data(), tool=TOOLS)
    response = response_of(data, spec)
    assert named(response, "spindle_bearing", "conditions.tool", data.tests).id == ID
    with pytest.raises(UsageError, match="spindle_bering"):
        named(response, "spindle_bering", "conditions.tool", data.tests)
    with pytest.raises(UsageError, match="condition"):
        named(response, "spindle_bearing", "conditions.tol", data.tests)


class Differs(CandidateEffect):
    """A known effect with other gains, as far as advice asks."""

    protocol = "the same work with each value of conditions.tool"
    id = ID


def test_the_advice_is_the_same_work_with_each_value() -> None:
    cause, plain = scored("coolant", channels=("T_c",)), scored("screw", channels=("T_b",), after=0.4)
    differs = replace(plain, candidate=Differs(plain.candidate.effect, plain.candidate.binding, "feed_x"))
    said = next_test.to_separate(cause, [differs], {})
    assert said == f"to tell coolant:T_c from {ID}: the same work with each value of conditions.tool"
    spots: list[WeakSpot] = []
    assert "do the same work with each value of conditions.tool" in to_find(8, spots, {}, differs)
    assert "T_b is logged and ranks first" in to_find(8, spots, {}, plain)
