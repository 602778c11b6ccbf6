"""The library's own machine as the blind benchmark takes it: as drawn, and little known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.schema.answers.candidate import Candidate
from thermodata.virtual import make_world
from thermodata.virtual.blind.trial import _claims_like_causes, _Fits
from thermodata.virtual.gantry.as_drawn import MOST_LOCKED, SIZE_UM, as_drawn, known, thinly
from thermodata.virtual.gantry.case import case_of
from thermodata.virtual.gantry.catalogue import EFFECTS
from thermodata.virtual.gantry.levers import DRAWS, OWN_UM, own_um
from thermodata.virtual.gantry.plan import Operation
from thermodata.virtual.truth.names import right

NAMES = ("spindle_bearing", "ambient_frame", "feed_screw", "coolant", "hydraulics")


def operation(role: str) -> Operation:
    return Operation(role, "mixed", role, 100, np.zeros(3))


OPS = [operation("calibration"), operation("verification"), operation("locked")]


def units(**sizes: tuple[float, float, float]) -> list[dict[str, np.ndarray]]:
    """Every effect is the same course; sizes: in the three tests."""
    course = np.sin(np.linspace(0, 6, 100))
    return [{e: sizes.get(e, (1.0, 1.0, 1.0))[i] * course for e in EFFECTS} for i in range(len(OPS))]


@pytest.mark.parametrize("seed", range(5))
def test_a_cause_that_all_others_imitate_is_taken_as_it_is(seed: int) -> None:
    """All effects do the same: a demonstration draws again and lets the lever grow, the benchmark does neither."""
    same = units()
    levers = as_drawn(np.random.default_rng(seed), "coolant", 2, same, OPS)
    assert own_um("coolant", levers, 2, same, OPS) < 0.01 * OWN_UM
    size = abs(levers["coolant"][2]) * np.std(same[0]["coolant"])
    assert SIZE_UM[0] <= size <= SIZE_UM[1]
    assert DRAWS > 1


def test_sizes_are_of_the_best_open_test_and_bounded_in_a_locked_one() -> None:
    at_rest = units(coolant=(0.0, 0.0, 1.0), hydraulics=(0.5, 1.0, 2.0))
    for seed in range(20):
        levers = as_drawn(np.random.default_rng(seed), "coolant", 2, at_rest, OPS)
        sizes = {e: [abs(v[2]) * float(np.std(u[e])) for u in at_rest] for e, v in levers.items()}
        assert sizes["coolant"][2] <= MOST_LOCKED * SIZE_UM[1] * (1 + 1e-9), "no open test works it"
        for e in set(sizes) - {"coolant"}:
            assert SIZE_UM[0] <= max(sizes[e][:2]) <= SIZE_UM[1]


def test_a_model_knows_from_one_effect_to_all_but_the_hidden_one() -> None:
    drawn = [thinly(np.random.default_rng(seed), "coolant", NAMES) for seed in range(60)]
    assert {len(some) for some in drawn} == {1, 2, 3, 4}
    assert all("coolant" not in some and set(some) < set(NAMES) for some in drawn)
    assert all("spindle_bearing" in some for some in drawn), "what a laboratory models first"
    assert thinly(np.random.default_rng(0), "none", NAMES) == NAMES
    assert known(np.random.default_rng(0), NAMES, "spindle_bearing", 1) == ("ambient_frame",)


def test_with_nothing_hidden_the_machine_has_as_few_effects_as_are_known() -> None:
    counts = {len(as_drawn(np.random.default_rng(seed), "none", 2, units(), OPS)) for seed in range(60)}
    assert {1, 2, 3, 4} <= counts


def test_a_case_lacks_what_its_world_has_and_its_model_does_not_know() -> None:
    case = case_of("hydraulics", 300)
    assert "hydraulics" in case.key.hidden
    assert not set(case.key.hidden) & set(case.base)
    assert [e.effect for e in case.spec.effects] == list(case.base)
    assert [e.effect for e in case.named().effects] == [*case.base, *case.key.hidden]
    assert case.imitated
    assert not case.nothing
    for test, course in zip(case.data.tests, case.contribution, strict=True):
        assert course.shape == test.t_s.shape
    assert max(float(np.std(c)) for c in case.contribution) > 1.0


def test_a_cause_that_is_not_logged_is_the_only_one_missing_and_has_no_channel() -> None:
    case = case_of("feed_screw, not logged", 300)
    assert case.key.hidden == ("feed_screw",)
    assert case.nothing
    axis = case.response[-1]
    assert not {f"T_nut_{axis}", f"feed_{axis}"} & set(case.data.channels)


def test_what_imitates_a_cause_on_the_open_tests_is_told_from_what_does_not() -> None:
    case = case_of("hydraulics", 300)
    unknown = right([], "", "")  # so that no claim is the cause by its name
    case = replace(case, key=replace(case.key, names={**case.key.names, "hydraulics": unknown}))
    claims = [said("lag:T_tank"), said("lag:T_bed")]
    assert _claims_like_causes(case, claims, _Fits(case.data)) == {("lag:T_tank", "hydraulics")}


def test_a_demonstration_knows_all_but_the_hidden_one() -> None:
    world = make_world("coolant", 3, tests=3, hours=3)
    assert world.known == tuple(e for e in world.present if e != "coolant")


def said(name: str) -> Candidate:
    effect, _, channels = name.partition(":")
    blank = dict.fromkeys(("p_value", "rmse_um_before", "rmse_um_after", "fit_before", "fit_after"))
    return Candidate.model_validate(
        {
            "rank": 1,
            "id": name,
            "effect": effect,
            "family": "generic",
            "drivers": channels.split(","),
            "claimed": True,
            **blank,
        }
    )
