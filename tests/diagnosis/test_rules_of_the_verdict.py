"""Every rule from evidence to a verdict (diagnosis/judge.py), just inside and just outside its limit."""

from __future__ import annotations

import pytest

from thermodata.diagnosis.judge import Judgement, Pair, equivalents, judge, simplest
from thermodata.diagnosis.scored import Scored

from .hand_made import measure, of_tests, scored

ALONE = Pair(None, 1.0)


def verdict(
    *ranked: Scored, tests: int = 5, floor: float = 0.2, pairs: dict[str, Pair] | None = None
) -> tuple[Judgement, list[str]]:
    """(judgement, effects that a second one was asked for). pairs: by the name of the first effect."""
    asked: list[str] = []

    def pair(first: Scored) -> Pair:
        asked.append(first.candidate.effect.name)
        return (pairs or {}).get(first.candidate.effect.name, ALONE)

    return judge(of_tests(tests), ranked, measure(floor=floor), pair), asked


GOOD = {"drop": 0.8, "before": 1.0, "after": 0.2}
PROXY = {"drop": 0.6, "before": 1.0, "after": 0.63}  # passes every rule of a claim, but leaves too much
PROMISING = {"drop": 0.2, "before": 1.0, "after": 0.9}  # fails the rule of the fall alone
HOPELESS = {"p_value": 0.5, "before": 1.0, "after": 0.9}


@pytest.mark.parametrize(("tests", "expected"), [(1, "not_testable"), (2, "effect")])
def test_two_tests_are_needed(tests: int, expected: str) -> None:
    found, _ = verdict(scored(**GOOD), tests=tests)
    assert found.verdict == expected
    assert (found.claimed is None) == (expected == "not_testable")


def test_without_a_candidate_nothing_is_testable() -> None:
    assert verdict()[0].verdict == "not_testable"


@pytest.mark.parametrize(("place", "expected"), [(3, "effect"), (4, "unknown")])
def test_only_the_best_three_may_be_claimed(place: int, expected: str) -> None:
    ranked = [scored(f"bad{i}", **HOPELESS) for i in range(1, place)] + [scored("good", **GOOD)]
    found, _ = verdict(*ranked)
    assert found.verdict == expected
    assert (None if found.claimed is None else found.claimed.candidate.effect.name) == (
        "good" if expected == "effect" else None
    )


@pytest.mark.parametrize(("after", "expected"), [(0.499, "effect"), (0.501, "unknown")])
def test_what_leaves_half_of_the_error_is_no_cause(after: float, expected: str) -> None:
    found, asked = verdict(scored(drop=0.8, before=1.0, after=after), floor=0.01)
    assert found.verdict == expected
    assert asked == ([] if expected == "effect" else ["plain"])


@pytest.mark.parametrize(("before", "expected"), [(0.199, "none"), (0.201, "unknown")])
def test_an_error_at_the_floor_is_none(before: float, expected: str) -> None:
    found, _ = verdict(scored(p_value=0.5, before=before, after=0.15), floor=0.2)
    assert found.verdict == expected
    assert ("is at the floor" in found.reason) == (expected == "none")


def test_a_strong_effect_is_claimed_though_the_error_is_at_the_floor() -> None:
    assert verdict(scored(drop=0.7, before=0.19, after=0.05), floor=0.2)[0].verdict == "effect"


@pytest.mark.parametrize(("left", "expected"), [(0.349, "effect"), (0.351, "unknown")])
def test_two_effects_must_leave_little(left: float, expected: str) -> None:
    second = scored("second")
    found, _ = verdict(scored("first", **PROXY), floor=0.01, pairs={"first": Pair(second, left)})
    assert found.verdict == expected
    assert found.second is (second if expected == "effect" else None)
    assert ("stands in for something that was not logged" in found.reason) == (expected == "unknown")


def test_a_second_effect_must_be_there() -> None:
    found, _ = verdict(scored("first", **PROXY), floor=0.01, pairs={"first": Pair(None, 0.01)})
    assert found.verdict == "unknown"


def test_the_pair_that_leaves_least_is_claimed() -> None:
    pairs = {"first": Pair(scored("x"), 0.3), "other": Pair(scored("y"), 0.1)}
    found, _ = verdict(scored("first", **PROXY), scored("other", **PROMISING), floor=0.01, pairs=pairs)
    assert found.claimed is not None
    assert found.second is not None
    assert (found.claimed.candidate.effect.name, found.second.candidate.effect.name) == ("other", "y")


def test_a_second_effect_is_asked_for_twice_at_most() -> None:
    _, asked = verdict(*(scored(n, **PROMISING) for n in "abc"), floor=0.01)
    assert asked == ["a", "b"]


def test_a_second_effect_is_asked_for_among_the_best_three_promising_ones() -> None:
    ranked = [scored(n, **HOPELESS) for n in "ab"] + [scored("c", **PROMISING), scored("d", **PROMISING)]
    assert verdict(*ranked, floor=0.01)[1] == ["c"]


def test_the_unknown_says_why_the_best_was_refused() -> None:
    found, asked = verdict(scored("a", **HOPELESS), floor=0.01)
    assert asked == []
    assert "a:T_a, fails because chance does as well in 50%" in found.reason


# ---- twins


@pytest.mark.parametrize(("cosine", "alike"), [(0.901, True), (0.899, False), (-0.901, True)])
def test_contributions_this_alike_are_twins(cosine: float, alike: bool) -> None:
    chosen = scored("a", after=0.2)
    other = scored("b", after=0.9, shape=(cosine, (1 - cosine**2) ** 0.5))
    assert equivalents(chosen, [chosen, other]) == ([other] if alike else [])


@pytest.mark.parametrize(
    ("cosine", "times", "alike"), [(0.601, 1.149, True), (0.601, 1.151, False), (0.599, 1.149, False)]
)
def test_equal_errors_make_twins_of_what_acts_a_little_alike(cosine: float, times: float, alike: bool) -> None:
    """times: of the squared error that the chosen one leaves."""
    chosen = scored("a", before=[200.0] * 10, after=[100.0] * 10)
    other = scored("b", before=[200.0] * 10, after=[100.0 * times] * 10, shape=(cosine, (1 - cosine**2) ** 0.5))
    assert equivalents(chosen, [chosen, other]) == ([other] if alike else [])


@pytest.mark.parametrize(("drop", "alike"), [(0.15, True), (0.149, False)])
def test_what_explains_next_to_nothing_is_no_twin(drop: float, alike: bool) -> None:
    chosen, other = scored("a"), scored("b", drop=drop)
    assert equivalents(chosen, [other]) == ([other] if alike else [])


@pytest.mark.parametrize(("times", "taken"), [(1.049, "simple"), (1.051, "first")])
def test_a_simpler_twin_is_preferred_where_it_costs_little(times: float, taken: str) -> None:
    first = scored("first", channels=("T_a", "T_b"), before=[200.0] * 10, after=[100.0] * 10)
    simple = scored("simple", before=[200.0] * 10, after=[100.0 * times] * 10, order=1.0)
    assert simplest([first, simple]).candidate.effect.name == taken


def test_only_what_acts_alike_replaces_the_first() -> None:
    first, simple = scored("first", channels=("T_a", "T_b")), scored("simple", shape=(0.0, 1.0))
    assert simplest([first, simple]) is first


def test_a_name_goes_before_fewer_channels_before_no_refinement_before_rank() -> None:
    lag = scored("lag", family="generic", order=0.0)
    two = scored("two", channels=("T_a", "T_b"), order=1.0)
    refined = scored("refined", refines=("two",), order=2.0)
    late, early = scored("late", order=4.0), scored("early", order=3.0)
    twins = [lag, two, refined, late, early]
    for expected in ["early", "late", "refined", "two", "lag"]:
        chosen = simplest(twins)
        assert chosen.candidate.effect.name == expected
        twins.remove(chosen)
