"""Every rule that a claim must keep (verdict/judge.py), just inside and just outside its limit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.candidates.kin import Kin
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import at_best, probability, sharpness
from thermodata.diagnosis.claims.rules import acting_size, explained
from thermodata.diagnosis.claims.rules_together import blunt, failed_rules
from thermodata.diagnosis.verdict.judge import equivalents
from thermodata.diagnosis.weigh.figures import short
from thermodata.schema.words.sentences import apart

from .hand_made import measure, scored

CHANCE = "chance does as well"
FALL = "tests in which it acts, with its size from the others, the error"
FEW = "tests in which it acts more probable"
GAIN = "its gain differs between tests by"
LITTLE = "it explains"
ALONE = "it acts in one test only"
CASES = "causes like it were right in"
DULL = 20.0  # of a thousand samples: far less probable than a claim asks, whatever falls


def refused(sentence: str, found: Sequence[str]) -> bool:
    """Whether the sentence is the one reason; False where there is none. Another reason is a wrong case."""
    assert all(sentence in reason for reason in found), found
    return bool(found)


def test_the_plain_case_keeps_every_rule() -> None:
    assert failed_rules(scored(), measure(), "um") == []
    assert blunt(scored()) is None


@pytest.mark.parametrize(
    ("sides", "fails"),
    [((389.9, 500.0), False), ((500.0, 389.9), False), ((390.0, 390.1), True), ((500.0, 391.0), True), ((), False)],
)
def test_of_a_difference_one_of_its_two_temperatures_says_less_by_itself(sides: tuple[float, ...], fails: bool) -> None:
    one = replace(scored(channels=("T_rear", "T_front"), evidence=390.0), sides=sides)
    found = failed_rules(one, measure(), "um")
    assert all(why.startswith("each of T_rear and T_front says as much by itself") for why in found)
    assert bool(found) is fails


@pytest.mark.parametrize(("as_well", "fails"), [(1, False), (2, True)])
def test_chance_may_do_as_well_once_in_a_hundred(as_well: int, fails: bool) -> None:
    """Of 199 responses in which nothing is missing, the response itself counted."""
    chance = [500.0] * as_well + [499.9] * (199 - as_well)
    assert refused(CHANCE, failed_rules(scored(evidence=500.0), measure(chance=chance), "um")) is fails


@pytest.mark.parametrize(
    ("kind", "after", "fails"),
    [
        ({}, 0.849, False),
        ({}, 0.851, True),
        ({"family": "generic"}, 0.849, False),
        ({"family": "generic"}, 0.851, True),
        ({"family": "generic", "passive": True}, 0.699, False),
        ({"family": "generic", "passive": True}, 0.701, True),
        ({"family": "control"}, 0.701, True),
        ({"family": "control"}, 0.699, False),
    ],
)
def test_the_left_out_error_falls_by_15_percent_and_by_30_where_anything_slow_would_steady_it(
    kind: dict[str, Any], after: float, fails: bool
) -> None:
    one = scored(after=after, evidence=DULL, **kind)
    assert refused(FALL, failed_rules(one, measure(spread=1.0), "um")) is fails


@pytest.mark.parametrize(
    ("evidence", "better", "kind", "fails"),
    [
        (147.5, 4, {}, ""),
        (146.8, 6, {}, FALL),  # just below 65 %
        (147.5, 3, {}, FEW),
        (77.5, 4, {"placeless": True}, ""),
        (390.0, 6, {"passive": True}, FALL),
        (390.0, 4, {"beaten": True}, ""),
    ],
)
def test_what_is_as_probable_as_a_claim_asks_needs_no_fall_and_two_tests_of_five(
    evidence: float, better: int, kind: dict[str, bool], fails: str
) -> None:
    gained = [1.0] * better + [-1.0] * (10 - better)
    found = failed_rules(scored(evidence=evidence, after=1.0, gained=gained, **kind), measure(spread=0.0), "um")
    assert refused(fails, found) is bool(fails)


def test_the_fall_is_that_of_the_tests_in_which_it_acts() -> None:
    """A test acts from a fifth of the largest on."""
    sizes = [1.0] * 5 + [0.201, 0.199, 0.1, 0.0, 0.0]
    assert scored(size=sizes).acts.sum() == 6
    one = scored(size=sizes, after=[0.4] * 6 + [5.0] * 4)
    assert one.drop == pytest.approx(0.6)
    assert failed_rules(one, measure(), "um") == []
    other = scored(size=sizes, after=[0.4] * 5 + [5.0] * 5)
    assert other.drop < 0.0
    assert acting_size(one) == pytest.approx(np.sqrt((5 + 0.201**2) / 6))


@pytest.mark.parametrize(("better", "fails"), [(6, False), (5, True)])
def test_six_of_ten_tests_become_more_probable(better: int, fails: bool) -> None:
    gained = [1.0] * better + [-1.0] * (10 - better)
    assert refused(FEW, failed_rules(scored(gained=gained, evidence=DULL), measure(), "um")) is fails
    untouched = [1.0] * better + [0.0] * (10 - better)
    assert scored(gained=untouched).better == better / 10, "what changes nothing is no better"


@pytest.mark.parametrize(
    ("spread", "after", "fails"), [(0.499, 0.9, False), (0.501, 0.501, True), (0.501, 0.499, False), (1.5, 0.4, False)]
)
def test_a_cause_acts_alike_unless_left_out_tests_are_foretold(spread: float, after: float, fails: bool) -> None:
    """At a half of their error, whatever the spread."""
    one = scored(spread=spread, after=min(after, 0.84))
    assert refused(GAIN, failed_rules(one, measure(spread=1.0), "um")) is fails


@pytest.mark.parametrize(("spread", "fails"), [(9.99, False), (10.01, True)])
def test_what_explains_under_a_tenth_of_the_response_is_not_worth_a_name(spread: float, fails: bool) -> None:
    """A fall from 1 to 0 explains 1."""
    assert refused(LITTLE, failed_rules(scored(after=0.0), measure(spread=spread), "um")) is fails


@pytest.mark.parametrize(
    ("evidence", "size", "spread", "fails"),
    [
        (200.0, 2.01, 0.199, False),
        (200.0, 1.99, 0.199, True),  # a fifth of the response
        (200.0, 2.01, 0.201, True),  # by a gain that differs by a fifth
        (90.0, 2.01, 0.199, True),  # and as probable as a claim asks
    ],
)
def test_what_surely_does_a_fifth_of_the_response_is_worth_a_name_though_the_error_hardly_falls(
    evidence: float, size: float, spread: float, fails: bool
) -> None:
    """The known effects take for their own what it does: it explains 0.5 of 10."""
    one = scored(evidence=evidence, after=np.sqrt(0.75), size=size, spread=spread)
    assert refused(LITTLE, [w for w in failed_rules(one, measure(spread=10.0), "um") if LITTLE in w]) is fails


@pytest.mark.parametrize(("after", "fails"), [(1.99, False), (2.01, True)])
def test_what_doubles_the_error_of_the_other_tests_is_no_cause_however_evident(after: float, fails: bool) -> None:
    found = failed_rules(scored(evidence=5000.0, after=after), measure(spread=0.0), "um")
    assert refused("the error more than doubles where it acts (1.00 -> 2.01 um)", found) is fails


@pytest.mark.parametrize(("acting", "fails"), [(2, False), (1, True)])
def test_no_other_test_foretells_what_acts_in_one_only(acting: int, fails: bool) -> None:
    one = scored(size=[1.0] * acting + [0.0] * (10 - acting))
    assert refused(ALONE, failed_rules(one, measure(), "um")) is fails


@pytest.mark.parametrize(("kin", "fails"), [(None, False), ("related", True), ("near", True)])
def test_one_test_does_not_tell_a_cause_from_another_mode_of_what_the_model_has(kin: Kin, fails: bool) -> None:
    """However evident: the one lag of the known effect has to hold all that its body does there."""
    one = scored(size=[1.0] + [0.0] * 9, evidence=5000.0, kin=kin)
    assert refused(ALONE, failed_rules(one, measure(), "um")) is fails


@pytest.mark.parametrize(
    ("outweighed", "otherwise"),
    [
        (400.0, {"before": 0.1, "after": 0.01, "size": 0.3}),
        (400.0, {"spread": 0.9, "after": 0.6}),
        (500.0, {"size": [1.0] + [0.0] * 9}),
    ],
)
def test_evidence_outweighs_what_left_out_tests_say(outweighed: float, otherwise: dict[str, Any]) -> None:
    """Four tenths a sample, of a thousand, what it explains and how alike they are; half how many. But never that
    chance does as well, or that tests speak against it."""
    assert failed_rules(scored(evidence=outweighed - 0.1, **otherwise), measure(), "um")
    one = scored(evidence=outweighed + 0.1, **otherwise)
    assert failed_rules(one, measure(), "um") == []
    assert failed_rules(scored(evidence=outweighed + 0.1, gained=-1.0), measure(), "um")
    assert failed_rules(one, measure(chance=[1e4] * 199), "um")


@pytest.mark.parametrize(
    ("after", "kind", "evidence", "fails"),
    [
        (0.4, {}, 73.9, False),
        (0.4, {}, 73.6, True),
        (0.8, {}, 117.0, False),
        (0.8, {}, 116.7, True),
        (0.4, {"beaten": True}, 73.9, False),
        (0.4, {"beaten": True, "around": True}, 486.0, False),
        (0.4, {"beaten": True, "around": True}, 484.0, True),
        (0.4, {"passive": True}, 1182.0, False),
        (0.4, {"passive": True}, 1180.0, True),
        (0.4, {"placeless": True}, 38.7, False),
        (0.4, {"placeless": True}, 38.4, True),
    ],
)
def test_a_cause_is_right_in_two_of_three_cases_and_in_half_where_nothing_has_a_place(
    after: float, kind: dict[str, bool], evidence: float, fails: bool
) -> None:
    """Of a thousand samples, and whether it has a name or not."""
    for family in ("feed_x", "generic"):
        one = scored(family=family, evidence=evidence, after=after, **kind)
        assert sharpness(one) == pytest.approx(evidence / 1000)
        why = blunt(one)
        assert refused(CASES, [why] if why else []) is fails


@pytest.mark.parametrize(
    ("evidence", "after", "kind", "share"),
    [
        (1000.0, 0.4, {}, 0.95730),
        (100.0, 0.4, {}, 0.71300),
        (100.0, 0.8, {}, 0.61538),
        (100.0, 1.5, {}, 0.50750),
        (0.1, 0.4, {}, 3.3682e-3),
        (-50.0, 0.4, {}, 3.3682e-3),
        (100.0, 0.4, {"beaten": True}, 0.71300),
        (100.0, 0.4, {"around": True}, 0.71300),
        (100.0, 0.4, {"beaten": True, "around": True}, 0.29111),
        (100.0, 0.4, {"passive": True}, 0.14931),
        (100.0, 0.4, {"kin": "part"}, 0.15582),
        (100.0, 0.4, {"kin": "near"}, 0.71300),
        (100.0, 0.4, {"of_holder": True}, 0.42799),
        (100.0, 0.4, {"of_source": True}, 0.87103),
    ],
)
def test_the_probability_is_that_of_its_sharpness_and_of_what_it_is(
    evidence: float, after: float, kind: dict[str, Any], share: float
) -> None:
    """1 / (1 + exp(-2.45 - 2.2 log10(sharpness) - 1.1 fall + 1.8 if it is the air, beaten, + 2.65 if passive,
    + 2.6 if the model reads it with others, + 1.2 of what holds the probes, - 1 of what makes heat)); the
    least sharpness is 1e-4, and an error that rises by more than a fifth says no more."""
    assert probability(scored(evidence=evidence, after=after, **kind)) == pytest.approx(share, rel=1e-3)


@pytest.mark.parametrize(("samples", "share"), [(1000, 0.97208), (10000, 0.79413), (0, 0.99996)])
def test_at_best_left_out_tests_are_foretold_and_nothing_is_sharper(samples: int, share: float) -> None:
    """Whatever it was found to foretell: 1 / (1 + exp(-2.45 - 2.2 log10(1000 / samples) - 1.1))."""
    one = scored(evidence=1000.0, after=1.4, beaten=True, around=True)
    assert at_best(one, samples) == pytest.approx(share, rel=1e-3)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ({"beaten": True, "around": True}, "a sharper effect stands beside it, and leaves what is slow, as the air is"),
        ({"passive": True}, "it reads a body that makes no heat, one beside the machine, or one whose place"),
        ({"kin": "part"}, "the model reads it already, together with others"),
        ({"of_holder": True}, "it reads the tool, or what holds the probes, which warms with all in the working space"),
        ({"of_source": True}, "it reads a part that makes heat itself, which speaks for it"),
    ],
)
def test_what_its_probability_hangs_on_is_said(kind: dict[str, Any], words: str) -> None:
    assert words in str(blunt(scored(evidence=20.0, **kind)))
    assert words not in str(blunt(scored(evidence=20.0)))


def test_that_it_makes_heat_says_nothing_where_another_part_may_be_it() -> None:
    """A nut makes heat, and so does the guideway of the same axis that no sensor reads."""
    nut = scored(evidence=100.0, of_source=True)
    plain = scored(evidence=100.0)
    either, neither = (replace(s, candidate=replace(s.candidate, unread=("axis.x.guide",))) for s in (nut, plain))
    assert probability(either) == probability(neither) < probability(plain) < probability(nut)


@pytest.mark.parametrize(
    ("noise", "spread", "floor"),
    [(0.1, 1.9, 0.2), (0.1, 2.1, 0.21), (0.1, 5.1, 0.51), (float("nan"), 3.0, 0.3), (0.0, 2.0, 0.2)],
)
def test_the_floor_is_a_tenth_of_the_response_or_twice_the_noise(noise: float, spread: float, floor: float) -> None:
    assert Measure(spread, noise, np.zeros(0)).floor == pytest.approx(floor)


@pytest.mark.parametrize(
    ("noise", "spread", "said"), [(0.1, 5.1, 0.51), (0.3, 4.0, 0.5), (1.5, 6.3, 1.63), (float("nan"), 3.0, 0.3)]
)
def test_locked_tests_say_something_of_what_is_more_than_the_noise_itself(
    noise: float, spread: float, said: float
) -> None:
    """A probe with a noise of 1.5 um: 1.9 um are left of 6.3, and 1.1 of these are no noise."""
    found = Measure(spread, noise, np.zeros(0))
    assert found.said == pytest.approx(said, rel=0.01)
    assert found.said <= found.floor


@pytest.mark.parametrize(
    ("noise", "spread", "noises"), [(0.1, 5.1, 0.5), (0.1, 4.0, 0.4), (0.1, 1.9, 0.2), (float("nan"), 3.0, 0.0)]
)
def test_noise_is_five_times_the_short_one_and_less_where_that_is_large(
    noise: float, spread: float, noises: float
) -> None:
    """0.5 um beside a response of 8 um: an error of 1.3 um is more than noise."""
    assert Measure(spread, noise, np.zeros(0)).noises == pytest.approx(noises)


def test_a_large_noise_is_that_of_the_means_that_are_compared() -> None:
    """0.7 um a minute are 0.4 um in means of 3 min: 1.17 um of left-out tests are more than noise, as locked samples
    they are not. What is small anyway covers the slow noise, which no mean lessens."""
    loud = Measure(2.5, 0.7, np.zeros(0), averaged=3)
    assert loud.noises == loud.floor == pytest.approx(1.4 / np.sqrt(3))
    assert loud.floor_of_samples == pytest.approx(1.4)
    quiet, alone = (Measure(5.1, 0.1, np.zeros(0), averaged=n) for n in (9, 1))
    assert quiet.noises == alone.noises == pytest.approx(0.5)
    strong = Measure(8.0, 0.7, np.zeros(0), averaged=3)
    assert strong.floor < strong.said == pytest.approx(np.hypot(0.7, 0.8)), "locked tests are judged by samples"


def test_what_is_explained() -> None:
    one = scored(before=[2.0] * 5 + [1.0] * 5, after=[1.0] * 10, size=[1.0] * 5 + [0.0] * 5)
    assert explained(one) == pytest.approx(np.sqrt(3.0)), "where it acts"
    assert explained(scored(before=1.0, after=2.0)) == 0.0, "what makes it worse explains nothing"


# ---- what can't be told apart


def cosine(c: float) -> tuple[float, float]:
    return c, float(np.sqrt(1 - c**2))


@pytest.mark.parametrize(("alike", "found"), [(0.901, True), (0.899, False), (-0.901, True)])
def test_contributions_this_alike_are_twins(alike: float, found: bool) -> None:
    """Though the tests speak for one: the other loses each one by the same."""
    chosen = scored("a", gained=50.0, after=0.5)
    other = scored("b", gained=40.0, after=0.9, shape=cosine(alike))
    assert equivalents(chosen, [chosen, other]) == ([other] if found else [])


@pytest.mark.parametrize(
    ("times", "lost", "found"),
    [
        (1.99, 2.1, True),
        (2.01, 2.1, False),
        (2.01, 1.9, True),
        (3.99, 1.9, True),
        (4.01, 1.9, False),
        (9.0, -2.1, False),
    ],
)
def test_what_acts_alike_and_leaves_far_more_or_surely_twice_as_much_is_no_twin(
    times: float, lost: float, found: bool
) -> None:
    """times: the error that the other leaves. lost: log probability that it loses, in standard errors."""
    wave = np.array([1.0, -1.0] * 5)
    wave /= wave.std(ddof=1)
    chosen = scored("a", gained=(50.0 + wave + lost / np.sqrt(10)).tolist(), after=0.1)
    other = scored("b", gained=50.0, after=0.1 * times, shape=cosine(0.99))
    assert equivalents(chosen, [other]) == ([other] if found else [])


@pytest.mark.parametrize(
    ("alike", "times", "lost", "found"),
    [
        (0.51, 1.19, 1.9, True),
        (0.49, 1.19, 1.9, False),
        (0.51, 1.21, 1.9, False),
        (0.51, 1.19, 2.1, False),
        (-0.51, 1.19, -1.9, True),
        (0.51, 1.19, -2.1, False),
    ],
)
def test_what_acts_alike_at_all_is_a_twin_where_the_tests_do_not_tell(
    alike: float, times: float, lost: float, found: bool
) -> None:
    """times: the error that the other leaves. lost: log probability that it loses, in standard errors."""
    wave = np.array([1.0, -1.0] * 5)
    wave /= wave.std(ddof=1)
    difference = wave + lost / np.sqrt(10)
    chosen = scored("a", gained=(50.0 + difference).tolist(), after=0.4)
    other = scored("b", gained=50.0, after=0.4 * times, shape=cosine(alike))
    assert equivalents(chosen, [other]) == ([other] if found else [])


def test_only_what_was_scored_on_left_out_tests_may_be_a_twin() -> None:
    assert equivalents(scored("a"), [scored("b", shape=())]) == []


@pytest.mark.parametrize(
    ("after", "said"), [(0.9, "falls by 10 % only"), (1.0, "does not fall"), (1.2, "does not fall")]
)
def test_an_error_that_rises_does_not_fall_by_nothing(after: float, said: str) -> None:
    (reason,) = failed_rules(scored(after=after, evidence=DULL), measure(), "um")[:1]
    assert f"the error {said}" in reason
    assert "0 % only" not in reason.replace("10 % only", "")


@pytest.mark.parametrize(("in_parts", "said"), [(False, "tests"), (True, "parts")])
def test_parts_of_few_tests_are_called_parts(in_parts: bool, said: str) -> None:
    against = replace(measure(), in_parts=in_parts)
    (reason,) = failed_rules(scored(after=1.0, evidence=DULL), against, "um")[:1]
    assert reason.startswith(f"in the 10 {said} in which it acts")


@pytest.mark.parametrize(
    ("acting", "said"),
    [
        (1, f"in the one {FALL[:4]} in which it acts{FALL.partition('acts')[2]} falls by 10 % only (limit 15 %)"),
        (1, "it makes the one test in which it acts less probable"),
        (1, "it acts in one test only, so no other tells its gain"),
        (1, "it acts in one test only: no other foretells it"),
        (
            2,
            "in the 2 tests in which it acts, with its size from the others, the error falls by 10 % only (limit 15 %)",
        ),
        (2, "it makes none of the 2 tests in which it acts more probable (limit 60 %)"),
        (2, "its gain differs between tests by 100 % (limit 50 %): a cause acts alike everywhere"),
    ],
)
def test_a_rule_that_is_broken_is_told_of_one_test_and_of_several(acting: int, said: str) -> None:
    size = np.where(np.arange(10) < acting, 1.0, 0.0)
    one = replace(scored(after=0.9, evidence=DULL, spread=1.0, gained=-1.0), size=size)
    assert said in failed_rules(one, measure(), "um")


@pytest.mark.parametrize(("value", "said"), [(0.204, "0.2"), (93.4, "93"), (124.0, "120"), (1e4, "10000")])
def test_a_figure_of_two_digits_has_no_power_of_ten(value: float, said: str) -> None:
    """A time constant was "about 1 instead of 1e+02 min"."""
    assert short(value) == said


def test_what_it_explains_is_told_as_the_share_that_the_rule_asks() -> None:
    little = scored(before=0.3, after=0.1, evidence=DULL)
    assert "of the response's 4 um (limit 10 %)" in " ".join(failed_rules(little, measure(spread=4.0), "um"))
    assert "it explains 0.28 um where it acts, 7.1 % of" in " ".join(failed_rules(little, measure(spread=4.0), "um"))


@pytest.mark.parametrize(
    ("value", "limit", "text"),
    [(0.149, 0.15, "14.9 %"), (0.14, 0.15, "14 %"), (0.1496, 0.15, "14.96 %"), (0.6496, 0.65, "64.96 %")],
)
def test_what_misses_a_limit_never_reads_as_the_limit(value: float, limit: float, text: str) -> None:
    assert apart(value, limit) == text
