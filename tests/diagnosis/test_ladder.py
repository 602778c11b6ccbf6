"""The ladder says exactly what the rules decide."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.diagnosis.claims.rules_together import blunt, failed_rules
from thermodata.diagnosis.tell.candidate.ladder import chance, courses, left_out, rungs
from thermodata.effect import effects
from thermodata.effect.unbound import unbound
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import measure, of_tests, problem, scored


@pytest.mark.parametrize("seed", range(60))
def test_a_rung_does_not_hold_exactly_where_its_rule_fails(seed: int) -> None:
    rng = np.random.default_rng(seed)
    one = scored(
        evidence=float(rng.choice([5.0, 80.0, 500.0])),
        after=float(rng.uniform(0, 1.2)),
        gained=rng.normal(0.3, 1.0, 10),
        spread=float(rng.uniform(0, 1)),
        size=rng.uniform(0.05, 1.5, 10),
    )
    held = measure(spread=float(rng.uniform(0.5, 12)), chance=np.linspace(0, float(rng.choice([10.0, 300.0])), 200))
    found = rungs(one, held, "um")
    said = len(failed_rules(one, held, "um")) + (blunt(one) is not None)
    assert sum(not r.holds for r in found) == said
    assert [r.name for r in found] == ["chance", "fall", "tests", "gain", "others", "worth", "probability"]
    for r in found:
        # where the evidence overwhelms, or left-out tests are foretold, some are not asked
        if r.value is not None and r.name in ("chance", "tests", "probability"):
            assert r.holds is (r.value <= r.limit if r.at == "most" else r.value >= r.limit)
        met = r.value is not None and (r.value <= r.limit if r.at == "most" else r.value >= r.limit)
        assert r.asked is (met or not r.holds), "what misses its limit and holds was not asked"


def test_a_rule_that_is_outweighed_is_not_asked() -> None:
    one = scored(evidence=5000.0, after=0.99)
    (fall,) = (r for r in rungs(one, measure(spread=0.0), "um") if r.name == "fall")
    assert (fall.holds, fall.asked) == (True, False)


def test_what_a_claim_breaks_is_outweighed_by_the_locked_tests() -> None:
    """A claim whose own rung is denied contradicts itself: `worth` missed its limit, and the locked tests outweighed
    it."""
    one, held = scored(evidence=80.0, after=0.9), measure(spread=100.0)
    open_, claimed = ({r.name: r for r in rungs(one, held, "um", claimed=how)} for how in (False, True))
    broken = [name for name, r in open_.items() if not r.holds]
    assert "worth" in broken
    for name in broken:
        told = claimed[name]
        assert (told.holds, told.asked, told.fails) == (True, False, None)
        assert told.asks == f"{open_[name].asks}; not asked, for the locked tests outweigh it"
        assert (told.value, told.limit) == (open_[name].value, open_[name].limit)
    assert all(claimed[name] == r for name, r in open_.items() if r.holds)


def test_the_rung_of_the_probability_is_of_what_the_row_states_one_of() -> None:
    """A row that is told as another of the same equation has the rules of that, and its own probability."""
    one, other = scored(evidence=400.0, after=0.5), scored(evidence=80.0, after=0.9)
    told = {r.name: r for r in rungs(one, measure(), "um", sure=other)}
    (own,) = (r for r in rungs(other, measure(), "um") if r.name == "probability")
    assert told["probability"] == own.model_copy(update={"fails": (own.fails or "").partition(": ")[0]})
    assert told["fall"] in rungs(one, measure(), "um")
    assert told["probability"] not in rungs(one, measure(), "um")


def test_chance_is_told_by_its_quantiles() -> None:
    told = chance(measure(chance=np.arange(201.0)))
    assert (told[0], told[20], told[-1]) == (0.0, 100.0, 200.0)
    assert chance(measure(chance=np.empty(0))) == []


def test_nothing_is_left_out_of_nothing() -> None:
    assert left_out(scored(), problem()) == []
    assert courses(scored(), problem()) == []


def test_each_left_out_test_and_its_course_are_told() -> None:
    one = scored(
        before=2.0, after=0.5, size=[1.0] * 6 + [0.0] * 4, contribution=[np.full(4, 3.0)] * 10, coefficient=2.0
    )
    told = left_out(one, of_tests(10))
    assert [(r.test, r.acts, r.rmse_um_before, r.rmse_um_after) for r in told[5:7]] == [
        ("t5", True, 2.0, 0.5),
        ("t6", False, 2.0, 0.5),
    ]
    drawn = courses(one, of_tests(10))
    assert [c.test for c in drawn] == [f"t{i}" for i in range(6)]
    assert drawn[0].contribution_um == [6.0] * 4
    assert len(drawn[0].t_s) == len(drawn[0].residual_um) == 4


def test_what_no_sensor_can_drive_says_which_is_lacking() -> None:
    channels = {
        "T": ChannelInfo("T", "temperature", "degC", at="spindle.bearing.front"),
        "n": ChannelInfo("n", "rotational_speed", "rpm", at="spindle"),
    }
    found = {u.effect: u.why for u in unbound(effects(), channels)}
    assert "spindle_bearing" not in found
    assert "axis" in found["feed_screw"]
    assert found["feed_screw"].startswith("no ")
    assert not unbound({}, channels)
