"""What the model leaves as it stands, and what is offered for it (verdict/as_modelled.py)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.tell.candidate.ladder import rungs
from thermodata.diagnosis.tell.listing.errors_told import judged_beside
from thermodata.diagnosis.verdict.as_modelled import AsModelled, as_modelled, refined
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.verdict.selection import Selection, first_ranking, select

from .hand_made import Parts, candidate, measure, problem, scored

TESTS = 6
OTHER = ("T_other", "T_b")


def of_slow(slow: Sequence[float]) -> Problem:
    """A model of one column; beside it a slower one, so much of it in each test, which the model's effect may do where
    it may act otherwise, and which T_a reads; T_b reads neither."""
    rng = np.random.default_rng(3)

    def one(much: float) -> Parts:
        walks = np.cumsum(rng.normal(size=(120, 3)), axis=0) / 5
        quick, late, neither = (walks - walks.mean(axis=0)).T
        noise = rng.normal(size=120)
        y = quick + much * late + 0.02 * (noise - noise.mean())
        values = {"T_a": late, "T_b": neither}
        return Parts(y - quick, response=y, base=quick[:, None], slack=late[:, None], values=values)

    return problem(*map(one, slow), noise=0.02)


def asked(of: Problem, *, floor: float = 0.0, offers: bool = True) -> tuple[AsModelled | None, Selection]:
    first = first_ranking(of, [candidate("lag", family="generic"), candidate(*OTHER[:1], channels=OTHER[1:])])
    assert first is not None
    selection = select(of, first, lambda s: False, among=[s.columns for s in first.ranked])
    by = Measure(1.0, floor, np.zeros(0)) if floor else measure(floor=0.001)
    return as_modelled(of, selection, by, offers=offers), selection


def test_what_foretells_left_out_tests_beside_the_model_as_it_stands_is_offered() -> None:
    found, selection = asked(of_slow([0.5] * TESTS))
    assert found is not None
    assert found.offered is not None
    assert selection.left < 0.05, "where its effect may act otherwise nothing is missing"
    assert found.left > 0.1
    one = found.offered.scored
    assert one.candidate.channels == ("T_a",)
    assert one.as_modelled
    assert one.error_of_all < 0.05
    assert found.offered.refines is not None
    assert "can't tell a cause of its own" in found.offered.refines


@pytest.mark.parametrize(
    ("slow", "left"),
    [([0.0] * TESTS, False), ([0.5, -0.5] * 3, True), ([1.0, 0.6, 0.3] * 2, True)],
)
def test_nothing_is_offered_where_noise_is_left_or_it_acts_otherwise_in_each_test(
    slow: list[float], left: bool
) -> None:
    found, _ = asked(of_slow(slow))
    assert (found is not None) is left
    assert found is None or found.offered is None


def test_what_acts_nearly_alike_in_all_tests_is_offered() -> None:
    """Its gain differs by 48 %, and by 52 % where nothing is offered."""
    found, _ = asked(of_slow([1.5, 1.0, 0.5] * 2))
    assert found is not None
    assert found.offered is not None


def test_what_is_noise_is_left_alone() -> None:
    found, _ = asked(of_slow([0.5] * TESTS), floor=0.5)
    assert found is not None
    assert found.offered is None
    assert asked(of_slow([0.5] * TESTS), floor=0.01)[0] is not None


def test_its_error_is_told_where_nothing_is_asked_for() -> None:
    found, _ = asked(of_slow([0.5] * TESTS), offers=False)
    assert found is not None
    assert (found.offered, found.left > 0.1) == (None, True)
    assert as_modelled(of_slow([0.5]), None, measure(), offers=True) is None


def test_what_one_test_alone_has_is_fitted_and_not_foretold() -> None:
    """A tool that one test had: the others say nothing of its gain, and of the model."""

    def with_a_tool(block: Block, number: int) -> Block:
        tool = np.sin(np.arange(120) / 9)
        own = tool - tool.mean() if number == 0 else np.zeros(120)
        return replace(block, response=block.response + 5 * own, base=np.column_stack([block.base, own]))

    of = of_slow([0.5] * TESTS)
    alone = replace(of, blocks=tuple(with_a_tool(b, i) for i, b in enumerate(of.blocks)))
    (found, _), (before, _) = asked(alone), asked(of)
    assert found is not None
    assert before is not None
    assert found.left == pytest.approx(before.left, rel=0.3), "and not 3.5 um"


def test_only_what_finds_nothing_missing_is_refined_by_it() -> None:
    found, _ = asked(of_slow([0.5] * TESTS))
    nothing, by = Judgement("none", (), (), (), ""), measure(floor=0.001)
    with_it = refined(nothing, found, by)
    assert found is not None
    assert (with_it.verdict, with_it.refinements, with_it.judged) == ("refine", (found.offered,), (found.offered,))
    at_floor = refined(nothing, found, measure(floor=1.01 * found.left))
    assert (at_floor.verdict, at_floor.refinements) == ("none", (found.offered,)), "an error that is left alone"
    assert refined(nothing, found, measure(floor=0.99 * found.left)).verdict == "refine"
    unknown = replace(nothing, verdict="unknown")
    assert refined(unknown, found, by) is unknown
    assert refined(nothing, None, by) is nothing
    assert refined(nothing, AsModelled(1.0, None), by) is nothing


def test_a_name_is_offered_for_a_lag_of_its_channels() -> None:
    of = of_slow([0.5] * TESTS)
    first = first_ranking(of, [candidate("lag", family="generic"), candidate("screw")])
    assert first is not None
    selection = select(of, first, lambda s: False, among=[s.columns for s in first.ranked])
    found = as_modelled(of, selection, measure(floor=0.001), offers=True)
    assert found is not None
    assert found.offered is not None
    assert found.offered.scored.candidate.effect.name == "screw"


def test_what_is_offered_for_the_model_as_it_stands_is_held_against_no_chance() -> None:
    one = scored("mode")
    told = {r.name for r in rungs(one, measure(), "um")}
    offered = {r.name for r in rungs(replace(one, as_modelled=True), measure(), "um")}
    assert told - offered == {"chance", "probability"}


def test_what_is_offered_for_the_model_as_it_stands_stands_beside_no_other() -> None:
    one, other = scored("one"), scored("other", channels=("T_b",))
    own = Judged(one, one, None, ())
    offer = Judged(replace(other, as_modelled=True), replace(other, as_modelled=True), "it refines", ())
    judgement = Judgement("refine", (), (offer,), (own, offer), "")
    investigation: Any = SimpleNamespace(selection=None)
    assert judged_beside(one, own, investigation, judgement) == []
    assert judged_beside(offer.scored, offer, investigation, judgement) == []
    both = replace(judgement, judged=(own, Judged(other, other, None, ())))
    assert judged_beside(one, own, investigation, both) == ["other:T_b"]
