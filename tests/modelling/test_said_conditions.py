"""A gain by a condition that not every test says: what is asked, and how it is answered."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.errors import UsageError
from thermodata.modelling import fit_model
from thermodata.modelling.model_file.resolve import resolve
from thermodata.modelling.predictions.table import prediction_tables
from thermodata.modelling.versions.result import make_result
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS, Spec

BY_DIAMETER = {"effect": "spindle_bearing", "gain_by": "tool.diameter"}


def _with_tools(world: Dataset, *without: str, roles: dict[str, str] | None = None) -> Dataset:
    """Tools of 25 and 63 mm by turns, but for some tests."""
    tests = tuple(
        replace(
            t,
            role=(roles or {}).get(t.test, t.role),
            conditions={} if t.test in without else {"tool.diameter": (25.0, 63.0)[i % 2], "tool.id": "D"},
        )
        for i, t in enumerate(world.tests)
    )
    return replace(world, tests=tests)


def _refused(data: Dataset, model: object) -> str:
    with pytest.raises(UsageError) as caught:
        resolve(model, data)  # type: ignore[arg-type]
    return str(caught.value)


def test_a_gain_by_the_diameter_of_the_tool(world: Dataset, spec: Spec) -> None:
    found = fit_model(spec(BY_DIAMETER, *EFFECTS[1:]), _with_tools(world)).parameters()
    assert {"spindle_bearing.gain[25]", "spindle_bearing.gain[63]"} <= set(found)


@pytest.mark.parametrize("by", ["tool.diameter", "conditions.tool.diameter"])
def test_the_tests_that_do_not_say_it_are_named_with_what_the_others_say(by: str, world: Dataset, spec: Spec) -> None:
    said = _refused(_with_tools(world, "t1"), spec({**BY_DIAMETER, "gain_by": by}))
    assert "some tests have no condition 'tool.diameter'" in said
    assert "none in t1; 25 in t0, t2, t4, t6; 63 in t3, t5, t7" in said
    assert "tests: [t0, t2, t3, t4, t5, t6, t7]" in said


def test_what_is_advised_works(world: Dataset, spec: Spec) -> None:
    having = [t.test for t in world.tests if t.test != "t1"]
    data = _with_tools(world, "t1")
    found = fit_model(spec({**BY_DIAMETER, "tests": having}, *EFFECTS[1:]), data)
    assert {"spindle_bearing.gain[25]", "spindle_bearing.gain[63]"} <= set(found.parameters())
    # in the test that does not say it the effect does nothing, and all others are predicted
    assert "t1" in {s.test for s in make_result(found, data, "m").scores}
    assert all(prediction_tables(found, data).values())


def test_what_is_advised_of_several_campaigns_works(world: Dataset, spec: Spec) -> None:
    """Every test is named, each with its campaign, for names may be alike."""
    ours = _with_tools(world, *(t.test for t in world.tests))
    theirs = tuple(replace(t, campaign="d") for t in _with_tools(world).tests)
    more = tuple(replace(t, test=f"u{i}") for i, t in enumerate(theirs))
    data, model = replace(world, tests=(*ours.tests, *theirs, *more)), {"campaigns": ["c", "d"], "campaign": None}
    advised = _refused(data, spec(BY_DIAMETER, *EFFECTS[1:]).model_copy(update=model)).partition("tests: [")[2]
    named = advised.partition("]")[0].split(", ")
    found = fit_model(spec({**BY_DIAMETER, "tests": named}, *EFFECTS[1:]).model_copy(update=model), data)
    assert {"spindle_bearing.gain[25]", "spindle_bearing.gain[63]"} <= set(found.parameters())
    assert {s.campaign for s in make_result(found, data, "m").scores} == {"c", "d"}


def test_what_no_test_says_is_unknown(world: Dataset, spec: Spec) -> None:
    said = _refused(_with_tools(world), spec({**BY_DIAMETER, "gain_by": "diameter"}))
    assert "no condition 'diameter'" in said
    assert "did you mean 'tool.diameter'" in said
    bare = _refused(world, spec({**BY_DIAMETER, "gain_by": "tool"}))
    assert "no condition 'tool'" in bare
    assert "did you mean" not in bare, "no test has a tool"


def test_a_test_that_the_model_does_not_use_is_not_asked(world: Dataset, spec: Spec) -> None:
    resolve(spec(BY_DIAMETER), _with_tools(world, "t1", roles={"t1": "none"}))
    locked = next(t.test for t in world.tests if t.role == "locked")
    assert f"none in {locked};" in _refused(_with_tools(world, locked), spec(BY_DIAMETER))
    blind = tuple(
        replace(t, values={n: v for n, v in t.values.items() if n != "T_bearing"}) if t.test == "t1" else t
        for t in _with_tools(world, "t1").tests
    )
    resolve(spec(BY_DIAMETER), replace(world, tests=blind))  # it can't be predicted anyway
