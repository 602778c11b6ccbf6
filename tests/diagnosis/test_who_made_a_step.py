"""What is said of a step that goes with nothing logged: a slip, or a body that nobody logs (steps/who_made.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.steps.artefact import as_artefacts, find_steps
from thermodata.diagnosis.steps.repeating import as_artefacts as as_repeated
from thermodata.diagnosis.steps.repeating import repeating
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.steps.who_made import evenly, which

from .hand_made import Parts, problem

TESTS = [b.test for b in problem(*(Parts(np.zeros(400)) for _ in range(3)), noise=0.05).blocks]
BODY = "speaks for a body that moved"
SLIP = "so do slips"


def at(hours: float, size: float, test: int = 0) -> Step:
    return Step(TESTS[test], 3600.0 * hours, size, 20.0, within_s=60.0)


def test_what_an_unlogged_table_does_is_told_as_what_may_be_a_body_and_not_as_a_slip() -> None:
    """An indexing table turns to where the probe reads 6 um more, and back."""
    i = np.arange(300)
    course = 0.05 * np.random.default_rng(0).normal(size=300) + 6.0 * ((i >= 80) & (i < 210))
    there, back = as_artefacts(sorted(find_steps(problem(Parts(course), noise=0.05)), key=lambda s: s.at_s), "um")
    for told in (there, back):
        assert told.kind == "step"
        assert "nothing logged goes with it" in told.why
        assert "a probe or fixture slipped, or a body that nobody logs moved (an indexing table" in told.why
        assert BODY in told.why
    assert "the level of before it comes back at 3.5 h" in there.why
    assert "it brings back the level of before 1.3 h" in back.why


@pytest.mark.parametrize(("last", "says"), [(-7.0, BODY), (-6.37, BODY), (-6.35, SLIP), (-5.0, SLIP)])
def test_a_level_that_comes_back_over_several_steps_speaks_for_a_body(last: float, says: str) -> None:
    """Within a tenth of the largest of them; the middle one goes with it."""
    some = [at(1.0, 3.0), at(1.7, 4.0), at(4.0, last)]
    assert [says in which(s, some) for s in some] == [True] * 3


@pytest.mark.parametrize(
    ("hours", "said"),
    [
        ((1.0, 2.0, 3.0), "the jumps come every 60 min"),
        ((1.0, 2.0, 4.0), "the jumps come every 60 min, or a multiple of it"),
        ((1.0, 2.0, 4.01), "the jumps come every 60 min, or a multiple of it"),
        ((1.0, 2.0, 4.1), ""),
        ((1.0, 2.0), ""),
        ((1.0, 1.5, 2.0), ""),  # 120 s of 30 min by chance: 7 %
        ((1.0, 1.03, 1.06), ""),
    ],
)
def test_even_distances_speak_for_a_programme(hours: tuple[float, ...], said: str) -> None:
    some = [at(h, size) for h, size in zip(hours, (3.0, 7.0, 12.0), strict=False)]
    assert evenly(some) == said
    assert (BODY in which(some[0], some)) is bool(said)
    alone = at(1.4, 20.0, 1)
    assert BODY not in which(alone, [*some, alone]), "of another test they say nothing"


def test_one_time_of_several_tests_speaks_for_a_programme() -> None:
    some = [at(2.0, 3.0), at(2.01, 7.0, 1)]
    assert "t1 has one at the same time from the start, which speaks for a body" in which(some[0], some)
    assert SLIP in which(some[0], [some[0], at(2.1, 7.0, 1)])
    assert SLIP in which(some[0], [*some, *(at(2.5 + 0.7 * k, 14.0 + 5 * k, k % 3) for k in range(4))]), "so many"


@pytest.mark.parametrize(("later_s", "says"), [(0.95, BODY), (1.05, SLIP)])
def test_moments_are_known_to_a_second_where_nobody_said_how_long_a_step_takes(later_s: float, says: str) -> None:
    some = [replace(s, within_s=0.0) for s in (at(2.0, 3.0), at(2.0 + later_s / 3600, 7.0, 1))]
    assert says in which(some[0], some)


def test_one_as_large_elsewhere_may_be_chance() -> None:
    some = [at(1.0, 5.0), at(3.3, 5.4, 1), at(2.0, 9.0, 2)]
    assert "that in t1 at 3.3 h is as large, which a body repeats, and two slips are by chance" in which(some[0], some)
    assert SLIP in which(some[2], some)


def test_of_one_step_alone_nothing_is_known() -> None:
    [told] = as_artefacts([at(1.0, 5.0)], "um")
    assert "it is the only jump of these tests, and its level does not come back: so does a slip, and so" in told.why
    assert BODY not in told.why
    assert SLIP not in told.why


@pytest.mark.parametrize(("third", "evenly_told"), [(3.0, True), (3.3, False)])
def test_steps_of_one_size_may_be_a_bodys_and_say_where_they_come_evenly(third: float, evenly_told: bool) -> None:
    [told] = as_repeated(repeating([at(h, 6.8) for h in (1.0, 2.0, third)]), "um")
    assert "or to a body that nobody logs and that moves by one amount (an indexing table" in told.why
    assert ("the jumps come every 60 min, as a programme has it" in told.why) is evenly_told
