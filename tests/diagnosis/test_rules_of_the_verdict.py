"""From what was selected to a verdict (verdict/judge.py), just inside and just outside its limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.claims.refines import PART
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.verdict.judge import concluded, judge, parts_offered, sound_twins
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.diagnosis.verdict.selection import Member, Selection
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.diagnosis.weigh.ranking import Ranked
from thermodata.diagnosis.weigh.scored import Scored

from .hand_made import measure, of_tests, scored

NOISE = Noise(0.1, 1.0, 3600.0, 0.5)
UNKNOWN: Any = None  # the known effects of a ranking: no rule of a verdict reads them
HOPELESS = scored("hopeless", before=1.0, after=0.95, evidence=50.0)


def selection(
    *members: Scored,
    first: Sequence[Scored] = (HOPELESS,),
    alone: Sequence[Scored] | None = None,
    dropped: Sequence[Scored] = (),
) -> Selection:
    """alone: each member as it was chosen, by default the same as beside the others. The model leaves what the first
    of all candidates finds."""
    chosen = members if alone is None else alone
    made = tuple(Member(a, m, tuple(first)) for a, m in zip(chosen, members, strict=True))
    return Selection(Ranked(UNKNOWN, tuple(first)), made, tuple(dropped), NOISE, first[0].error_before)


def verdict(
    *members: Scored, tests: int = 5, floor: float = 0.2, refined: Sequence[str] = (), **given: Any
) -> Judgement:
    """refined: names of the members that refine what is known."""
    return judge(
        of_tests(tests),
        selection(*members, **given),
        measure(floor=floor),
        lambda s: "it is kin" if s.candidate.effect.name in refined else None,
    )


def names(judged: Sequence[Any]) -> list[str]:
    return [j.scored.candidate.effect.name for j in judged]


@pytest.mark.parametrize(("tests", "expected"), [(1, "not_testable"), (2, "effect")])
def test_two_tests_are_needed(tests: int, expected: str) -> None:
    found = verdict(scored("a"), tests=tests)
    assert (found.verdict, bool(found.claims)) == (expected, expected == "effect")


@pytest.mark.parametrize(("evidence", "likely"), [(25.1, ""), (25.4, "a"), (73.5, "a"), (74.0, "")])
def test_what_is_two_in_five_probable_is_likely_and_no_claim(evidence: float, likely: str) -> None:
    """From 40 to 65 %: the locked tests may make it a claim."""
    found = verdict(scored("a", evidence=evidence, before=3.0, after=1.2))
    assert "".join(names(found.likely)) == likely
    assert (found.verdict == "effect") is (evidence > 73.7)


@pytest.mark.parametrize(("evidence", "likely"), [(25.1, []), (40.0, ["a"])])
def test_what_is_likely_is_asked_of_the_locked_tests_though_the_error_is_at_the_floor(
    evidence: float, likely: list[str]
) -> None:
    found = verdict(scored("a", after=0.6, evidence=evidence), floor=1.01)
    assert (found.verdict, names(found.likely)) == ("none", likely)


@pytest.mark.parametrize(("evidence", "expected"), [(48.4, "none"), (48.8, "unknown")])
def test_nobody_says_that_nothing_is_missing_beside_what_is_rather_the_cause_than_not(
    evidence: float, expected: str
) -> None:
    """However near to the floor the error is: half of the cases."""
    dull = scored("a", after=0.6, evidence=evidence)
    assert verdict(dull, floor=1.01).verdict == expected


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        ({}, True),
        ({"family": "feed_y"}, False),  # another axis says nothing of it
        ({"spread": 0.6, "after": 0.55}, False),  # nor what breaks a rule
        ({"before": 0.0, "after": 0.0, "evidence": 0.0}, False),
    ],
)
def test_a_sound_twin_is_of_the_same_family_and_keeps_the_rules(other: dict[str, Any], expected: bool) -> None:
    warm = scored("motor", before=1.0, after=0.3, evidence=300.0)
    twin = scored("screw", **{"channels": ("v",), "before": 1.0, "after": 0.4, "evidence": 200.0, **other})
    found = sound_twins(selection(warm, first=[warm, twin]), measure(), "um")
    assert found == {id(warm.columns): [twin] if expected else []}


def test_what_the_locked_tests_refute_does_not_say_that_something_is_missing() -> None:
    same = Foretold(1.0, 1.0, 1.0)
    one = scored("a", after=0.6, evidence=900.0)
    told = replace(one, looked=Looked(same, same, 0.01))
    found = concluded(of_tests(5), selection(one), measure(floor=1.01), (Judged(told, one, None, ()),))
    assert (found.verdict, probability(told) > 0.8) == ("none", True)


def test_what_is_likely_is_no_refinement_and_as_many_as_may_be_claimed_the_likeliest_first() -> None:
    sure = {"a": 40, "b": 70, "c": 60, "d": 50}
    few = [scored(n, evidence=e, before=3.0, after=1.2, channels=(f"T_{n}",)) for n, e in sure.items()]
    assert names(verdict(*few).likely) == ["b", "c", "d"]
    assert names(verdict(*few, refined=["b"]).likely) == ["c", "d", "a"]
    beside = verdict(scored("x", evidence=900.0, before=3.0, after=1.2), *few)
    assert (names(beside.claims), names(beside.likely)) == (["x"], ["b", "c"])


FEW: dict[str, Any] = {"before": 3.0, "after": 1.2, "evidence": 200.0}  # 83 % probable


@pytest.mark.parametrize(
    ("of", "likely"),
    [
        ({**FEW, "after": 2.61, "evidence": 100.0}, True),  # its error falls by 13 % alone
        ({**FEW, "spread": 0.6, "after": 1.8}, True),  # its gain differs
        ({**FEW, "size": [1.0] + 9 * [0.0]}, True),  # it acts in one test
        ({**FEW, "gained": 3 * [50.0] + 7 * [-50.0]}, False),  # the tests go against it
        (
            {**FEW, "evidence": 50.0, "gained": [50.0, -50.0] + 8 * [0.0], "size": [1.0, 1.0] + 8 * [0.0]},
            True,
        ),  # one of two does
        (
            {**FEW, "evidence": 50.0, "gained": [50.0, -50.0, -50.0] + 7 * [0.0], "size": 3 * [1.0] + 7 * [0.0]},
            False,
        ),  # two of three
        ({**FEW, "spread": 0.6, "after": 1.8, "size": [1.0] + 9 * [0.0]}, False),  # two rules
        ({**FEW, "evidence": 20.0, "size": [1.0] + 9 * [0.0]}, False),  # it is improbable
    ],
)
def test_what_one_rule_of_size_or_likeness_forbids_may_be_outweighed_by_the_locked_tests(
    of: dict[str, Any], likely: bool
) -> None:
    one = scored("d", **of)
    found = verdict(dropped=[one], first=[scored(before=3.0, after=2.9)])
    assert (found.verdict, names(found.likely)) == ("unknown", ["d"] if likely else [])
    if likely:
        assert verdict(scored("a", before=3.0, after=1.2, evidence=40.0), dropped=[one]).likely[0].scored is not one
        as_a_mode = judge(
            of_tests(5),
            selection(dropped=[one], first=[scored(before=3.0, after=2.9)]),
            measure(),
            lambda s: "it is kin",
        )
        assert as_a_mode.likely == ()


def test_what_one_rule_forbids_is_asked_where_nothing_seems_to_be_missing_too() -> None:
    one = scored("d", **{**FEW, "size": [1.0] + 9 * [0.0]})
    found = verdict(dropped=[one], first=[scored(before=3.0, after=2.9)], floor=1.25)
    assert (found.verdict, names(found.likely)) == ("none", ["d"])


def test_the_likeliest_of_what_was_dropped_is_asked_alone() -> None:
    two = [scored(n, **{**FEW, "evidence": e, "spread": 0.6, "after": 1.8}) for n, e in (("a", 150.0), ("b", 250.0))]
    assert names(verdict(dropped=two, first=[scored(before=3.0, after=2.9)]).likely) == ["b"]


def test_once_the_lock_is_open_what_it_says_decides_of_the_verdict() -> None:
    """A member that is half as probable as it was speaks against 'none' no more."""
    one = scored("a", evidence=24.0, before=0.5, after=0.3)
    chosen = selection(one, first=[scored(before=0.5, after=0.3)])
    given = measure(floor=0.25)

    def judged(looked: Looked | None) -> str:
        told = replace(one, looked=looked)
        return concluded(of_tests(5), chosen, given, (Judged(told, one, None, ()),)).verdict

    rises = Foretold(1.0, 1.3, 1.0)
    assert (judged(None), judged(Looked(rises, rises, 0.0))) == ("unknown", "none")


def test_without_a_candidate_nothing_is_testable() -> None:
    found = judge(of_tests(5), None, measure(), lambda s: None)
    assert (found.verdict, found.claims) == ("not_testable", ())
    assert "no effect of the library fits" in found.reason


def test_a_member_is_claimed_as_it_is_beside_the_others_and_as_it_was_chosen() -> None:
    chosen, beside = scored("a", after=0.7), scored("a", after=0.3)
    found = verdict(beside, alone=[chosen])
    (claim,) = found.claims
    assert claim.scored is beside
    assert claim.alone is chosen
    assert claim.beside == (HOPELESS,)
    assert found.judged == found.claims


@pytest.mark.parametrize(("evidence", "claimed"), [(486.0, ["a", "b"]), (484.0, ["a"])])
@pytest.mark.parametrize("family", ["feed_y", "generic"])
def test_the_air_beside_a_sharper_cause_is_no_claim_whatever_its_name(
    evidence: float, claimed: list[str], family: str
) -> None:
    """49 hundredths a sample, of a thousand, where 8 would do alone: it may be what the sharper one leaves, for
    that is slow. What else is dull is as likely beside it as alone."""
    sharp, second = scored("a", evidence=900.0), scored("b", evidence=evidence, family=family, around=True)
    for order in ((sharp, second), (second, sharp)):
        found = verdict(*order)
        assert sorted(names(found.claims)) == claimed
        assert {j.scored.candidate.effect.name: j.scored.beaten for j in found.judged} == {"a": False, "b": True}
    assert names(verdict(sharp, scored("b", evidence=75.0, family=family)).claims) == ["a", "b"]
    dull = scored("b", evidence=75.0, around=True)
    assert names(verdict(dull).claims) == ["b"]
    bed = scored("bed", family="generic", passive=True)
    assert names(verdict(dull, bed).claims) == ["b"], "what makes no heat is no rival"
    assert names(verdict(dull, scored("mode"), refined=["mode"]).claims) == ["b"]


@pytest.mark.parametrize(
    ("second", "claimed"),
    [
        ({"family": "feed_x", "channels": ("T_a", "T_b")}, ["a"]),
        ({"family": "feed_x", "channels": ("T_b",)}, ["a", "b"]),
        ({"family": "feed_y", "channels": ("T_a",)}, ["a", "b"]),
    ],
)
def test_a_family_on_the_same_channels_is_one_cause(second: dict[str, Any], claimed: list[str]) -> None:
    sharper, duller = scored("a", evidence=900.0, family="feed_x"), scored("b", evidence=800.0, **second)
    for order in ((sharper, duller), (duller, sharper)):
        assert sorted(names(verdict(*order).claims)) == claimed


@pytest.mark.parametrize("evidence", [800.0, 900.0])
@pytest.mark.parametrize("family", ["feed_x", "generic"])
def test_two_members_that_gave_way_to_one_candidate_are_one_claim(family: str, evidence: float) -> None:
    sharper, duller = scored("a", evidence=900.0, family=family), scored("a", evidence=evidence, family=family)
    for order in ((sharper, duller), (duller, sharper)):
        (claim,) = verdict(*order).claims
        assert claim.scored.evidence == 900.0


@pytest.mark.parametrize("family", ["generic", "control"])
def test_what_has_no_name_is_of_no_family(family: str) -> None:
    both = scored("a", evidence=900.0, family=family), scored("b", evidence=800.0, family=family)
    assert names(verdict(*both).claims) == ["a", "b"]


def test_three_are_claimed_at_once() -> None:
    assert names(verdict(*(scored(n) for n in "abcd")).claims) == ["a", "b", "c"]


def test_what_refines_is_no_claim_and_is_told_beside_one() -> None:
    found = verdict(scored("mode"), scored("a"), refined=["mode"])
    assert (found.verdict, names(found.claims), names(found.refinements)) == ("effect", ["a"], ["mode"])
    assert found.refinements[0].refines == "it is kin"
    assert names(found.judged) == ["mode", "a"]


@pytest.mark.parametrize(("floor", "expected"), [(0.99, "refine"), (1.01, "none")])
def test_where_all_refines_nothing_is_missing_and_at_the_floor_nothing_is_refined(floor: float, expected: str) -> None:
    """Of an error of 1."""
    found = verdict(scored("mode", after=0.6), refined=["mode"], floor=floor)
    assert (found.verdict, found.claims) == (expected, ())
    assert names(found.refinements) == (["mode"] if expected == "refine" else [])


@pytest.mark.parametrize(("after", "expected"), [(0.8, "refine"), (1.1, "unknown")])
def test_what_lessens_no_error_excuses_none(after: float, expected: str) -> None:
    """An error of 1 is a third of the response: so much may be left where something refines the model, and less where
    nothing does. What refines it without being of use to the tests left out is told all the same."""
    found = verdict(scored("mode", after=after), refined=["mode"], floor=0.3)
    assert (found.verdict, names(found.refinements)) == (expected, ["mode"])


@pytest.mark.parametrize(
    ("changed", "asked"),
    [
        ({}, True),
        ({"kin": "heat", "of_motion": True}, True),
        ({"kin": "heat"}, False),  # the temperature of a bearing whose speed the model has
        ({"kin": "same"}, False),
        ({"evidence": 50.0}, False),
    ],
)
def test_the_lock_is_opened_for_what_refines_and_is_as_probable_as_a_claim(
    changed: dict[str, Any], asked: bool
) -> None:
    """Whether nothing of the model can do what it does; another mode of the same effect is none, however it does."""
    some = [scored("a", before=3.0, after=0.3, **changed)]
    found = verdict(*some, refined=["a"])
    assert (found.verdict, names(found.likely)) == ("refine", ["a"] if asked else [])
    beside = verdict(scored("x", channels=("T_x",), family="feed_y", before=3.0, after=0.3), *some, refined=["a"])
    assert (names(beside.claims), names(beside.likely)) == (["x"], ["a"] if asked else [])


ALIKE, APART = (1.0, 0.0), (0.0, 1.0)


@pytest.mark.parametrize(
    ("family", "after", "kin", "shape", "expected"),
    [
        ("generic", 0.45, "same", ALIKE, "refine"),
        ("control", 0.45, "same", ALIKE, "refine"),
        ("feed_x", 0.45, "same", ALIKE, "effect"),  # a name says which physics it is
        ("generic", 0.45, "near", ALIKE, "effect"),
        ("generic", 0.45, "same", APART, "effect"),  # the tests tell it from that
        ("generic", 0.39, "same", ALIKE, "effect"),  # what takes off six tenths is surely missing
    ],
)
def test_a_lag_that_the_tests_cannot_tell_from_a_mode_of_the_model_is_no_cause(
    family: str, after: float, kin: Any, shape: Sequence[float], expected: str
) -> None:
    mode = scored("mode", kin=kin, shape=shape, after=0.5, channels=("T_b",))
    own = scored("a", family=family, after=after, shape=ALIKE)
    found = verdict(own, first=[mode], refined=["mode"])
    assert found.verdict == expected
    told = "it is kin; nor do they tell it from mode:T_b, which is one"
    assert [j.refines for j in found.refinements] == ([] if found.claims else [told])
    assert found.likely == (), "another mode of the model is none, however it does on the locked tests"


def test_a_blunt_cause_is_not_claimed_and_is_no_refinement_either() -> None:
    blunt = scored("blunt", evidence=60.0)
    found = verdict(blunt)
    assert (found.verdict, found.claims, names(found.judged)) == ("unknown", (), ["blunt"])
    assert (
        "the best, blunt:T_a, fails because causes like it were right in 60 % of cases only (limit 65 %)"
        in found.reason
    )
    beside = verdict(blunt, scored("mode"), refined=["mode"])
    assert (beside.verdict, names(beside.refinements)) == ("unknown", ["mode"]), (
        "offered where something is missing too"
    )


@pytest.mark.parametrize(
    ("before", "expected", "words"),
    [
        (0.199, "none", "is at the floor of 0.2 um"),
        (0.201, "none", "is 10 % of the response, as lags leave of a machine that lacks nothing (limit 25 %)"),
        (0.499, "none", "is 25 % of the response"),
        (0.501, "unknown", "0.5 um remain on left-out tests"),
    ],
)
def test_an_error_at_the_floor_or_of_a_good_model_is_left_alone(before: float, expected: str, words: str) -> None:
    """Of a response of 2."""
    found = verdict(first=[scored("h", before=before, after=0.95 * before)], floor=0.2)
    assert found.verdict == expected
    assert words in found.reason


@pytest.mark.parametrize(
    ("after", "expected", "words"), [(0.79, "refine", "is 40 % of the"), (0.81, "unknown", "1 um")]
)
def test_nothing_is_missing_where_what_refines_the_model_leaves_little(after: float, expected: str, words: str) -> None:
    """Of a response of 2, with what refines it: else a cause is missing too."""
    found = verdict(scored("mode", after=after), scored("rear", after=0.9), refined=["mode", "rear"])
    assert (found.verdict, names(found.refinements)) == (expected, ["mode", "rear"])
    assert words in found.reason


@pytest.mark.parametrize(("evidence", "expected"), [(23.6, "none"), (24.0, "unknown")])
@pytest.mark.parametrize("refined", [False, True])
def test_nothing_is_not_missing_beside_a_plausible_cause(evidence: float, expected: str, refined: bool) -> None:
    """Of a probability of 30 % though it may not be claimed, which is 0.0238 a sample of a thousand, where the error
    falls by a quarter."""
    dull = scored("dull", before=0.4, after=0.3, evidence=evidence)
    mode = [scored("mode", before=0.4, after=0.39)] if refined else []
    found = verdict(dull, *mode, first=[scored("h", before=0.4, after=0.39)], refined=["mode"])
    assert found.verdict == ("refine" if refined and expected == "none" else expected)


@pytest.mark.parametrize(("after", "expected"), [(0.19, "unknown"), (0.21, "none")])
def test_nothing_is_not_missing_beside_what_halves_the_error(after: float, expected: str) -> None:
    """Of 0.4, however little it is believed."""
    dull = scored("dull", before=0.4, after=after, evidence=1.0)
    assert verdict(dull, first=[scored("h", before=0.4, after=0.39)]).verdict == expected


@pytest.mark.parametrize(
    ("evidence", "kin", "expected"),
    [(249.0, None, "none"), (251.0, None, "unknown"), (251.0, "same", "none"), (251.0, "heat", "none")],
)
@pytest.mark.parametrize("floor", [0.2, 0.41])
def test_nothing_is_not_missing_beside_what_is_plain_though_a_rule_forbids_it(
    evidence: float, kin: Any, expected: str, floor: float
) -> None:
    """A quarter a sample, of a thousand: a known effect has taken what it explains, so the error falls no more."""
    dropped = scored("taken", before=0.4, after=0.4, evidence=evidence, kin=kin)
    first = [scored("h", before=0.4, after=0.39, evidence=1.0)]
    assert verdict(first=first, dropped=[dropped], floor=floor).verdict == expected


def test_noise_is_plain_of_nothing() -> None:
    dropped, first = scored("taken", before=0.4, after=0.4, evidence=900.0), [scored("h", before=0.4, after=0.39)]
    for noise, expected in ((0.079, "unknown"), (0.081, "none")):
        given = measure(floor=0.41, noise=noise)
        found = judge(of_tests(5), selection(first=first, dropped=[dropped]), given, lambda s: None)
        assert found.verdict == expected


@pytest.mark.parametrize(("after", "expected"), [(0.49, "refine"), (0.51, "none")])
def test_what_halves_the_error_is_told_though_that_is_at_the_floor(after: float, expected: str) -> None:
    """A test at rest may be all wrong beside others in which much moves."""
    assert verdict(scored("mode", after=after), refined=["mode"], floor=1.01).verdict == expected


def test_what_halves_the_error_and_is_not_sure_is_unknown_and_the_reason_says_where_the_floor_is() -> None:
    dull = verdict(scored("dull", after=0.4, evidence=50.0), floor=1.01)
    assert dull.verdict == "unknown"
    assert "1 um remain on left-out tests, no more than the floor of 1, but much of them goes with" in dull.reason


@pytest.mark.parametrize(("noise", "expected"), [(0.19, "refine"), (0.21, "none")])
def test_noise_is_halved_by_nothing(noise: float, expected: str) -> None:
    """Five times the noise, of an error of 1."""
    found = judge(
        of_tests(5), selection(scored("mode", after=0.4)), measure(floor=1.01, noise=noise), lambda s: "it is kin"
    )
    assert found.verdict == expected


def test_a_claim_is_made_though_the_error_is_at_the_floor() -> None:
    assert verdict(scored("a", before=0.4, after=0.1, size=0.4), first=[scored(before=0.1)]).verdict == "effect"


def test_the_unknown_says_why_the_best_was_refused() -> None:
    found = verdict()
    assert found.verdict == "unknown"
    assert "the best, hopeless:T_a, fails because in the 10 tests in which it acts" in found.reason
    assert "1 um remain on left-out tests" in found.reason


@pytest.mark.parametrize(
    ("kin", "after", "expected", "offered"),
    [
        ("part", 0.25, "refine", ["air"]),  # with it a good model is left
        ("part", 0.75, "unknown", ["air"]),
        ("near", 0.25, "unknown", []),
    ],
)
def test_what_the_model_reads_with_others_is_offered_where_nothing_can_be_named(
    kin: Any, after: float, expected: str, offered: list[str]
) -> None:
    """Sharp enough to be no refinement, and too little for a claim: in between it was neither."""
    made = selection(scored("air", kin=kin, evidence=60.0, before=1.6, after=1.6 * after))
    size = measure(spread=2.0, floor=0.1)
    open_still = judge(of_tests(5), made, size, lambda s: None)
    assert (open_still.verdict, names(open_still.refinements)) == ("unknown", [])
    found = parts_offered(open_still, lambda judged: concluded(of_tests(5), made, size, judged))
    assert (found.verdict, names(found.refinements)) == (expected, offered)
    assert all(j.refines == PART for j in found.refinements)
    refused = replace(open_still, refused=open_still.judged)
    assert parts_offered(refused, lambda judged: open_still) is refused, "the locked tests do not bear it out"
    rises = Foretold(1.0, 1.3, 1.0)
    looked = [replace(j, scored=replace(j.scored, looked=Looked(rises, rises, 0.0))) for j in open_still.judged]
    asked = replace(open_still, judged=tuple(looked))
    assert parts_offered(asked, lambda judged: open_still) is asked, "nor what was only likely"
