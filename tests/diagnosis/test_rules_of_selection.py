"""Which effects are selected, and which of two is preferred (verdict/selection.py)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.verdict import context as contexts
from thermodata.diagnosis.verdict import selection as selecting
from thermodata.diagnosis.verdict.preference import (
    better_twin,
    gives_way,
    its_name,
    preferred,
    read_alone,
    what_warms_it,
)
from thermodata.diagnosis.verdict.selection import Selection, first_ranking, select
from thermodata.diagnosis.weigh import beside as besides
from thermodata.diagnosis.weigh import in_noise_of_best as noises
from thermodata.diagnosis.weigh.beside import extended
from thermodata.diagnosis.weigh.evidence import Columns, columns
from thermodata.diagnosis.weigh.ranking import Ranked, rank_in
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Param

from .hand_made import Parts, PlainEffect, of_tests, problem, scored
from .lagged import Lagged

NOISE = Noise(0.3, 0.3, 900.0, 0.5)
ERRORS = ("sse_before", "sse_after", "own_before", "own_after")
TAU = Param("tau", "min", 5, 1, 30, "")


def name(found: Scored | None) -> str | None:
    return None if found is None else found.candidate.effect.name


# ---- which of two is preferred


def test_the_most_likely_is_preferred() -> None:
    assert preferred([]) is None
    assert name(preferred([scored("a", evidence=100.0), scored("b", evidence=99.9)])) == "a"


@pytest.mark.parametrize(("evidence", "taken"), [(95.1, "named"), (94.9, "lag")])
def test_a_name_on_the_same_channel_is_worth_a_twentieth(evidence: float, taken: str) -> None:
    lag = scored("lag", family="generic", evidence=100.0)
    assert name(preferred([lag, scored("named", evidence=evidence, shape=(0.0, 1.0))])) == taken


@pytest.mark.parametrize(
    ("evidence", "cosine", "taken"),
    [(80.1, 0.81, "named"), (79.9, 0.81, "lag"), (80.1, 0.79, "lag"), (80.1, -0.81, "named")],
)
def test_a_name_on_another_channel_that_acts_alike_is_worth_a_fifth(evidence: float, cosine: float, taken: str) -> None:
    lag = scored("lag", family="generic", evidence=100.0)
    shape = (cosine, (1 - cosine**2) ** 0.5)
    assert name(preferred([lag, scored("named", channels=("T_b",), evidence=evidence, shape=shape)])) == taken
    same = scored("named", evidence=evidence, shape=shape)
    assert name(preferred([lag, same])) == taken, "nor is one on the same channel worth less"
    two = scored("named", channels=("T_b", "T_c"), evidence=evidence, shape=shape)
    assert name(preferred([lag, two])) == "lag", "two channels may do anything"
    passive = scored("lag", family="generic", evidence=100.0, passive=True)
    assert name(preferred([passive, two])) == taken, "but what makes no heat is no cause"


@pytest.mark.parametrize(("evidence", "taken"), [(80.1, "screw"), (79.9, "growth")])
def test_what_it_refines_is_preferred_by_fewer_of_its_channels(evidence: float, taken: str) -> None:
    growth = scored("growth", channels=("T_a", "x"), refines=("screw",), evidence=100.0)
    screw = scored("screw", evidence=evidence)
    assert name(preferred([growth, screw])) == taken
    assert name(preferred([growth, scored("other", evidence=evidence)])) == "growth", "refined by nothing"
    assert name(preferred([growth, scored("screw", channels=("T_b",), evidence=evidence)])) == "growth"


def test_between_names_or_between_lags_the_evidence_decides() -> None:
    for family in ("feed_x", "generic"):
        first = scored("first", family=family, evidence=100.0)
        other = scored("other", family=family, channels=("T_b",), evidence=99.0)
        assert name(preferred([first, other])) == "first"


@pytest.mark.parametrize(("family", "given"), [("generic", True), ("control", True), ("feed_x", False)])
@pytest.mark.parametrize(("evidence", "enough"), [(80.1, True), (79.9, False)])
def test_fewer_of_its_channels_are_worth_a_fifth(family: str, given: bool, evidence: float, enough: bool) -> None:
    """Where a difference of any two temperatures could have been asked for."""
    both = scored("both", family=family, channels=("T_a", "T_b"), evidence=100.0)
    one = scored("one", family=family, evidence=evidence, shape=(0.0, 1.0))
    assert name(preferred([both, one])) == ("one" if given and enough else "both")
    apart = scored("one", family=family, channels=("T_c",), evidence=evidence, shape=(0.0, 1.0))
    assert name(preferred([both, apart])) == "both"


def test_what_needs_fewer_channels_is_asked_for_a_name_in_turn() -> None:
    both = scored("both", family="generic", channels=("T_a", "T_b"), evidence=100.0)
    one = scored("one", family="generic", evidence=90.0)
    named = scored("named", evidence=86.0, shape=(0.0, 1.0))
    assert name(preferred([both, one, named])) == "named", "95 % of the 90"
    assert name(preferred([both, one, replace(named, evidence=85.0)])) == "one"


def lagged(evidence: float, *, quickest: bool, params: tuple[Param, ...] = (TAU,)) -> Scored:
    """One with two time constants to choose from: the quicker is the likelier, or the slower."""
    found = scored("friction", channels=("n",), evidence=evidence)
    asked = replace(found.candidate, effect=replace(found.candidate.effect, params=params))  # type: ignore[type-var]
    made = replace(found.columns, candidate=asked, points=[{"tau": 1.0}, {"tau": 5.0}])
    likely, other = np.array([[evidence]]), np.array([[evidence - 50]])
    weighed = replace(found.weighed, log_bf=np.vstack([likely, other] if quickest else [other, likely]))
    return replace(found, candidate=asked, columns=made, weighed=weighed)


@pytest.mark.parametrize(
    ("evidence", "quickest", "channel", "taken"),
    [
        (90.1, True, "n", "shift"),
        (89.9, True, "n", "friction"),
        (90.1, False, "n", "friction"),
        (90.1, True, "T_b", "friction"),
    ],
)
def test_what_acts_at_once_is_preferred_to_the_quickest_heat(
    evidence: float, quickest: bool, channel: str, taken: str
) -> None:
    friction, shift = lagged(100.0, quickest=quickest), scored("shift", channels=(channel,), evidence=evidence)
    assert name(preferred([friction, shift])) == taken
    ranked = Ranked(None, (friction, shift))  # type: ignore[arg-type]
    assert gives_way(friction, shift, ranked) is (taken == "shift"), "nor does heat that drove it out stay"


def test_what_was_not_scored_is_not_preferred() -> None:
    lag = scored("lag", family="generic", evidence=100.0)
    assert name(preferred([lag, scored("named", evidence=99.0, shape=())])) == "lag"


# ---- forward, and back


def everywhere(monkeypatch: pytest.MonkeyPatch, name: str, made: Any) -> None:
    """In each module that chooses."""
    for module in (selecting, besides, noises, contexts):
        if hasattr(module, name):
            monkeypatch.setattr(module, name, made)


class Worlds:
    """Evidence given by hand: `evidence` says that of a name beside the chosen names, 0 where nothing is said."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, evidence: Callable[[str, frozenset[str]], float]) -> None:
        self.evidence = evidence
        self.made: dict[int, Scored] = {}
        by_hand: dict[str, Any] = {
            "beside": self._beside,
            "rank": lambda problem, pool, noise, **of: self._rank(problem, pool, **of),
            "rank_in": lambda problem, pool, noise, **of: self._rank(problem, pool, **of),
            "likeliest": lambda problem, noise: noise,
            "likeliest_beside": lambda problem, some, start: [
                selecting.likeliest(self._beside(problem, [s]), start) for s in some
            ],
            "known": lambda problem, noise: self._known(problem),
            "score": lambda known, one, *of: self._scored(known.problem, one),
        }
        for name_, made in by_hand.items():
            everywhere(monkeypatch, name_, made)

    def _beside(self, problem: Problem, chosen: Sequence[Scored]) -> Problem:
        known = filter(None, problem.response.split(","))
        return replace(problem, response=",".join([*known, *(s.candidate.effect.name for s in chosen)]))

    def _known(self, problem: Problem) -> Any:
        """Its log evidence: that of each name beside those before it."""
        names = [*filter(None, problem.response.split(","))]
        total = sum(self.evidence(n, frozenset(names[:i])) for i, n in enumerate(names))
        noise = SimpleNamespace(noise=NOISE)
        return SimpleNamespace(problem=problem, space=noise, left_out=1.0, log_evidence=total)

    def _rank(self, problem: Problem, pool: Sequence[Columns], *, left_out: bool = True) -> Ranked:
        found = [self._scored(problem, one) for one in pool]
        if not left_out:
            found = [replace(s, rows=np.zeros(0), **dict.fromkeys(ERRORS, np.zeros(0))) for s in found]
        return Ranked(self._known(problem), tuple(sorted(found, key=lambda s: -s.evidence)))

    def _scored(self, problem: Problem, one: Columns) -> Scored:
        known = frozenset(filter(None, problem.response.split(",")))
        return replace(self.made[id(one)], columns=one, evidence=self.evidence(one.candidate.effect.name, known))

    def select(
        self,
        names: Sequence[str],
        sound: Callable[[Scored], bool] = lambda s: True,
        among: str = "",
        channel: str = "T_{}",
        good: float = 0.0,
        **of: Any,
    ) -> Selection:
        """among: the names that may be chosen, all by default. channel: of each, by its number."""
        pool = []
        for i, n in enumerate(names):
            one = scored(n, channels=(channel.format(i),), shape=np.eye(len(names))[i].tolist(), **of)
            self.made[id(one.columns)] = one
            pool.append(one.columns)
        start = replace(of_tests(4), response="")
        some = [c for c in pool if not among or c.candidate.effect.name in among]
        return select(start, self._rank(start, pool), sound, among=some, good=good)


def members(found: Selection) -> list[str | None]:
    return [name(m.scored) for m in found.members]


@pytest.mark.parametrize(("evidence", "chosen"), [(10.1, ["a", "b"]), (9.9, ["a"])])
def test_a_further_effect_brings_ten(monkeypatch: pytest.MonkeyPatch, evidence: float, chosen: list[str]) -> None:
    world = Worlds(monkeypatch, lambda n, known: {"a": 100.0, "b": evidence}[n])
    assert members(world.select("ab")) == chosen


def test_what_may_not_be_chosen_is_ranked_and_takes_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """a does better than b, in left-out tests too, and would be swapped for it."""
    world = Worlds(monkeypatch, lambda n, known: {"a": 200.0, "b": 100.0, "c": 50.0}[n])
    original = world._scored

    def as_left_out(problem: Problem, one: Columns) -> Scored:
        made = original(problem, one)
        return replace(made, own_after=0.1**2 * made.rows) if name(made) == "a" else made

    monkeypatch.setattr(world, "_scored", as_left_out)
    found = world.select("abc", among="bc")
    assert members(found) == ["b", "c"]
    assert [name(s) for s in found.first.ranked] == ["a", "b", "c"]
    assert [name(s) for s in found.members[0].beside] == ["a", "b"]


def test_five_are_added_at_most(monkeypatch: pytest.MonkeyPatch) -> None:
    world = Worlds(monkeypatch, lambda n, known: 100.0 - ord(n) / 10)
    assert members(world.select("abcdefg")) == list("abcde")


def test_each_is_weighed_beside_all_others_and_kept_as_it_was_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    alone = {"a": 100.0, "b": 50.0, "c": 5.0}
    world = Worlds(monkeypatch, lambda n, known: alone[n] + 20.0 * len(known) if n != "c" else 5.0)
    found = world.select("abc")
    assert [(name(m.alone), m.alone.evidence, m.scored.evidence) for m in found.members] == [
        ("a", 100.0, 120.0),
        ("b", 70.0, 70.0),
    ]
    assert [[name(s) for s in m.beside] for m in found.members] == [["a", "c"], ["b", "c"]]
    assert [name(s) for s in found.first.ranked] == ["a", "b", "c"], "beside the model alone"
    assert all(len(m.alone.rows) == len(m.scored.rows) == 10 for m in found.members), "left-out tests are asked"


def test_the_least_likely_unsound_one_goes_first_and_may_clear_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """b is unsound only beside c, which goes first."""
    world = Worlds(monkeypatch, lambda n, known: {"a": 100.0, "b": 60.0, "c": 30.0}[n] + ("c" in known))
    found = world.select("abc", lambda s: s.candidate.effect.name == "a" or s.evidence == 60.0)
    assert members(found) == ["a", "b"]
    assert [name(s) for s in found.dropped] == ["c"]


def test_what_was_chosen_first_may_go_and_the_later_one_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first one was chosen for what the second one did."""
    world = Worlds(monkeypatch, lambda n, known: 60.0 if n == "b" else 20.0 if known else 100.0)
    found = world.select("ab", lambda s: s.candidate.effect.name == "b")
    assert (members(found), [name(s) for s in found.dropped]) == (["b"], ["a"])
    assert found.dropped[0].evidence == 20.0, "as it was judged beside the other"


def test_what_an_unsound_one_stood_in_the_way_of_is_asked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    def evidence(n: str, known: frozenset[str]) -> float:
        return {"proxy": 0.0, "p": 100.0, "q": 1.0 if "p" in known else 50.0}[n]

    world = Worlds(monkeypatch, evidence)
    found = world.select("pq", lambda s: s.candidate.effect.name != "p")
    assert (members(found), [name(s) for s in found.dropped]) == (["q"], ["p"])
    assert found.noise is NOISE


def test_it_is_asked_again_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each pass finds one more that is unsound; the fifth would be sound."""

    def evidence(n: str, known: frozenset[str]) -> float:
        return 1.0 if known else 100.0 - ord(n) / 10

    world = Worlds(monkeypatch, evidence)
    found = world.select("abcde", lambda s: s.candidate.effect.name == "e")
    assert [name(s) for s in found.dropped] == ["a", "b", "c"]
    assert found.members == ()
    assert members(world.select("abe", lambda s: s.candidate.effect.name == "e")) == ["e"]


@pytest.mark.parametrize(
    ("evidence", "ends", "kept"), [(80.9, True, "abc"), (81.1, True, "av"), (10.1, False, "abc"), (81.1, False, "abc")]
)
def test_what_a_pass_drives_out_stands_where_it_is_likelier_by_a_further_effect(
    monkeypatch: pytest.MonkeyPatch, evidence: float, ends: bool, kept: str
) -> None:
    """a, b and c are worth 191 together, b and c sound only beside each other. u, which the first pass drops, hid v;
    v drives out b, and with it c, and then stays, or goes itself (ends)."""

    def said(n: str, known: frozenset[str]) -> float:
        if n == "v":
            return 5.0 if "u" in known or "a" not in known else 20.0 if "b" in known else evidence
        if n == "b" and "v" in known:
            return 13.0
        return {"u": 200.0, "a": 100.0, "b": 50.0 + ("c" in known), "c": 40.0 + ("b" in known)}[n]

    def sound(s: Scored) -> bool:
        least = {"u": 300.0, "a": 0.0, "b": 51.0, "c": 41.0, "v": 0.0 if ends else 20.0}[str(name(s))]
        return s.evidence >= least and (ends or name(s) != "v" or s.evidence == 20.0)

    world = Worlds(monkeypatch, said)
    found = world.select("abcuv", sound, good=1.0)
    assert members(found) == list(kept)
    assert {name(s) for s in found.dropped} == set("abcuv") - set(kept) - ({"v"} if ends and kept == "abc" else set())


def test_no_pass_is_likelier_for_its_noise_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both passes end with a; the second one finds a noise that is less likely by 50."""
    world = Worlds(monkeypatch, lambda n, known: {"a": 100.0, "u": 50.0}[n])
    worse, found_now = replace(NOISE, white=1.0), [NOISE]
    ranked = selecting.rank

    def rank(*given: Any, **of: Any) -> Ranked:
        found_now[0] = worse
        return ranked(*given, **of)

    def known(problem: Problem, noise: Noise) -> Any:
        made = world._known(problem)
        return SimpleNamespace(**{**vars(made), "log_evidence": made.log_evidence - 50.0 * (noise == worse)})

    everywhere(monkeypatch, "rank", rank)
    everywhere(monkeypatch, "likeliest", lambda problem, noise: found_now[0])
    everywhere(monkeypatch, "known", known)
    found = world.select("au", lambda s: name(s) == "a", good=1.0)
    assert (members(found), found.noise) == (["a"], worse)


@pytest.mark.parametrize(("beside_c", "kept"), [(10.1, ["c", "a"]), (9.9, ["c"])])
def test_what_went_beside_one_that_went_later_is_asked_again(
    monkeypatch: pytest.MonkeyPatch, beside_c: float, kept: list[str]
) -> None:
    """a is unsound beside b only, and the least likely of both."""

    def evidence(n: str, known: frozenset[str]) -> float:
        if n == "a":
            return 90.0 if not known else 20.0 if "b" in known else beside_c
        return {"b": 40.0, "c": 100.0}[n]

    def sound(s: Scored) -> bool:
        return name(s) == "c" or (name(s) == "a" and s.evidence != 20.0)

    world = Worlds(monkeypatch, evidence)
    found = world.select("abc", sound)
    assert sorted(str(n) for n in members(found)) == sorted(kept)
    assert {name(s) for s in found.dropped} == set("abc") - set(kept)


def test_it_comes_back_only_where_all_are_sound_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """c is sound while a is out."""

    def evidence(n: str, known: frozenset[str]) -> float:
        return {"a": 31.0 if known else 30.0, "c": 50.0 if "a" in known else 100.0}[n]

    world = Worlds(monkeypatch, evidence)
    found = world.select("ac", lambda s: s.evidence not in (50.0, 30.0))
    assert (members(found), [name(s) for s in found.dropped]) == (["c"], ["a"])


@pytest.mark.parametrize(("other", "after", "taken"), [(106.0, 0.3, "b"), (105.0, 0.3, "a"), (106.0, 0.5, "a")])
def test_a_member_is_swapped_for_what_does_clearly_better_beside_the_others(
    monkeypatch: pytest.MonkeyPatch, other: float, after: float, taken: str
) -> None:
    """Its own evidence, 100, is under 95 % of the other's, and left-out tests are foretold better too."""

    def evidence(n: str, known: frozenset[str]) -> float:
        if "c" not in known:
            return {"a": 100.0, "b": 90.0, "c": 40.0}[n] if not known else {"b": 1.0, "a": 1.0, "c": 40.0}[n]
        return {"a": 100.0, "b": 1.0 if "a" in known else other, "c": 40.0}[n]

    world = Worlds(monkeypatch, evidence)
    original = world._scored

    def as_left_out(problem: Problem, one: Columns) -> Scored:
        made = original(problem, one)
        return replace(made, own_after=after**2 * made.rows) if name(made) == "b" else made

    monkeypatch.setattr(world, "_scored", as_left_out)
    found = world.select("abc")
    assert members(found) == [taken, "c"]
    assert name(found.members[0].alone) == "a"
    assert members(world.select("abc", lambda s: name(s) != "b")) == ["a", "c"], "never for an unsound one"


@pytest.mark.parametrize(
    ("after", "passive", "taken"),
    [(0.39, False, "named"), (0.41, False, "lag"), (0.429, True, "named"), (0.431, True, "lag")],
)
def test_a_lag_that_drove_out_the_name_that_is_preferred_to_it_gives_way_to_it(
    monkeypatch: pytest.MonkeyPatch, after: float, passive: bool, taken: str
) -> None:
    """Chosen first by its name, the name explains little beside the lag that was added to it, and is dropped. after:
    the error that it leaves alone, where the lag leaves 0.4; of a fall of 0.6, 95 % are enough beside a passive one."""

    def evidence(n: str, known: frozenset[str]) -> float:
        return {"named": 1.0, "lag": 40.0}[n] if known else {"named": 90.0, "lag": 100.0}[n]

    def preferring(ranked: Sequence[Scored]) -> Scored | None:
        return next((s for s in ranked if name(s) == "named" and s.evidence > 80.0), ranked[0] if ranked else None)

    world = Worlds(monkeypatch, evidence)
    original = world._scored

    def as_left_out(problem: Problem, one: Columns) -> Scored:
        made = original(problem, one)
        return replace(made, own_after=after**2 * made.rows) if name(made) == "named" else made

    monkeypatch.setattr(world, "_scored", as_left_out)
    everywhere(monkeypatch, "preferred", preferring)

    def sound(one: Scored) -> bool:
        return name(one) == "lag" or one.evidence > 80.0

    found = world.select(["named", "lag"], sound, family="generic", passive=passive)
    assert members(found) == [taken]
    assert members(world.select(["named", "lag"], sound, family="feed_x")) == ["lag"], "between names evidence decides"
    assert [name(s) for s in found.dropped] == ["named"]
    assert name(found.members[0].alone) == "lag"
    assert found.members[0].scored.credit == (90.0 if taken == "named" else 100.0)


@pytest.mark.parametrize(
    ("lag", "named", "channel", "evidence", "after", "gives"),
    [
        ("generic", "cutting", "n", 100.0, 0.429, True),
        ("generic", "cutting", "n", 95.1, 0.429, True),  # the same equation on another grid
        ("generic", "cutting", "n", 94.9, 0.429, False),  # less likely
        ("generic", "cutting", "n", 100.0, 0.431, False),  # of a fall of 0.6, less than 95 %
        ("generic", "cutting", "T_b", 100.0, 0.4, False),  # of another channel
        ("generic", "generic", "n", 100.0, 0.4, False),
        ("cutting", "cutting", "n", 100.0, 0.4, False),
    ],
)
def test_a_lag_gives_way_to_a_name_that_is_as_likely_on_its_channel(
    lag: str, named: str, channel: str, evidence: float, after: float, gives: bool
) -> None:
    """Though neither is clearly better, and the name was never chosen before. The lag leaves 0.4 of the error."""
    own = scored("lag", family=lag, channels=("n",), evidence=100.0)
    best = scored("load", family=named, channels=(channel,), evidence=evidence, after=after)
    ranking: Any = SimpleNamespace(ranked=(best, own))
    assert gives_way(own, best, ranking) is gives
    preferred_to_both = scored("screw", family="feed_x", channels=("T_nut",), evidence=200.0)
    assert (its_name(own, (preferred_to_both, best, own)) is best) is gives


def test_a_member_is_told_by_its_name_where_that_is_sound(monkeypatch: pytest.MonkeyPatch) -> None:
    world = Worlds(monkeypatch, lambda n, known: 1.0 if known else {"lag": 100.0, "load": 97.0}[n])
    monkeypatch.setattr(selecting, "its_name", lambda own, ranked: next(s for s in ranked if name(s) == "load"))
    assert members(world.select(["lag", "load"])) == ["load"]
    assert members(world.select(["lag", "load"], lambda s: name(s) == "lag")) == ["lag"]


@pytest.mark.parametrize(
    ("changed", "gives"),
    [
        ({}, True),
        ({"evidence": 95.1, "after": 0.1}, True),
        ({"evidence": 94.9, "after": 0.1}, False),
        ({"after": 0.321}, False),
        ({"passive": True, "family": "feed_y"}, False),  # it is less probable
        ({"around": True}, False),  # the air, beside what is sharper
        ({"after": 0.319}, True),
        ({"shape": (0.91, (1 - 0.91**2) ** 0.5)}, True),
        ({"shape": (0.89, (1 - 0.89**2) ** 0.5)}, False),
        ({"family": "generic"}, False),  # it has no name
        ({"kin": "same"}, False),  # it refines the model
    ],
)
def test_a_twin_that_foretells_left_out_tests_much_better_is_taken(changed: dict[str, Any], gives: bool) -> None:
    """A feed and the temperature of the motor that it warms."""
    own = scored("feed", channels=("v",), evidence=100.0, after=0.4)
    twin = scored("motor", **{"channels": ("T_b",), "evidence": 99.0, "after": 0.2, **changed})
    assert (better_twin(own, (own, twin)) is twin) is gives
    best = scored("guide", channels=("T_c",), evidence=98.0, after=0.05)
    assert better_twin(own, (own, twin, best)) is best


@pytest.mark.parametrize(
    ("mode", "cause", "gives"),
    [
        ({}, {}, True),
        ({}, {"kin": None}, True),
        ({}, {"evidence": 640.1}, True),
        ({}, {"evidence": 639.9}, False),
        ({}, {"shape": (0.81, (1 - 0.81**2) ** 0.5)}, True),
        ({}, {"shape": (0.79, (1 - 0.79**2) ** 0.5)}, False),
        ({}, {"channels": ("T_low", "T_down")}, False),  # it reads something else
        ({}, {"family": "generic"}, False),  # it has no name
        ({}, {"kin": "same"}, False),  # it is another mode itself
        ({"kin": "near"}, {}, False),  # a cause of its own, by fewer channels
        ({}, {"after": 0.39}, True),
        ({}, {"after": 0.41}, False),  # it does not take most away
        ({}, {"passive": True}, False),  # nor is it sure
    ],
)
def test_a_mode_of_the_model_gives_way_to_a_cause_that_reads_it_too(
    mode: dict[str, Any], cause: dict[str, Any], gives: bool
) -> None:
    """The air up there, beside the air down here in the model, is the layers between both."""
    air = scored("air", **{"family": "ambient", "channels": ("T_up",), "kin": "same", "evidence": 800.0, **mode})
    layers = {"family": "ambient", "channels": ("T_up", "T_down"), "kin": "near", "evidence": 790.0, **cause}
    layers = {"after": 0.2, **layers}
    other = scored("layers", **layers)
    assert name(preferred([air, other])) == ("layers" if gives else "air")
    assert gives_way(air, other, Ranked(None, (air, other))) is gives  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("own", "other", "gives"),
    [
        ({}, {}, True),
        ({"of_holder": False, "passive": True}, {}, True),
        ({"of_holder": False}, {}, False),  # it makes heat itself
        ({}, {"evidence": 99.9}, False),
        ({}, {"shape": (0.91, (1 - 0.91**2) ** 0.5)}, True),
        ({}, {"shape": (0.89, (1 - 0.89**2) ** 0.5)}, False),
        ({}, {"family": "generic"}, False),
        ({}, {"kin": "same"}, False),
        ({}, {"of_holder": True}, False),
        ({}, {"passive": True}, False),
        ({}, {"around": True}, False),  # the air warms all
    ],
)
def test_what_warms_a_holder_is_taken_for_it(own: dict[str, Any], other: dict[str, Any], gives: bool) -> None:
    """What holds the probes is warm for the cut beside it."""
    holder = scored(**{"name": "lag", "family": "generic", "evidence": 100.0, "of_holder": True, **own})
    cut = scored(**{"name": "cut", "family": "cutting", "channels": ("P",), "evidence": 100.1, **other})
    better = scored("better", family="cutting", channels=("F",), evidence=120.0)
    assert (what_warms_it(holder, (holder, cut)) is cut) is gives
    assert not gives or what_warms_it(holder, (better, cut, holder)) is better


# ---- rankings


def driven(seed: int, n: int = 80, gain: float = 2.0) -> Parts:
    rng = np.random.default_rng(seed)
    u = np.cumsum(rng.normal(size=n))
    y = gain * (u - u.mean()) + 0.3 * rng.normal(size=n)
    return Parts(y - y.mean(), values={"T_a": u, "T_b": rng.normal(size=n), "T_still": np.ones(n)})


def asked(effect: PlainEffect, channel: str = "T_a") -> CandidateEffect:
    return CandidateEffect(effect, {"u": channel}, "feed_x")


def test_two_tests_and_a_driver_that_moves_are_needed() -> None:
    pool = [asked(PlainEffect("a")), asked(PlainEffect("still"), "T_still")]
    assert first_ranking(problem(driven(0)), pool) is None
    found = first_ranking(problem(driven(0), driven(1)), pool)
    assert found is not None
    assert [name(s) for s in found.ranked] == ["a"]
    assert first_ranking(problem(driven(0), driven(1)), pool[1:]) is None


def test_left_out_tests_are_computed_for_the_first_fifteen() -> None:
    one = problem(driven(0), driven(1))
    effects = [asked(PlainEffect("a"))] + [asked(PlainEffect(f"b{i}"), "T_b") for i in range(16)]
    pool = [c for c in (columns(one, e) for e in effects) if c is not None]
    found = rank_in(one, pool[::-1], NOISE)
    assert [len(s.rows) for s in found.ranked] == [2] * 15 + [0] * 2
    assert name(found.ranked[0]) == "a"
    by_evidence = rank_in(one, pool[::-1], NOISE, left_out=False)
    assert [s.evidence for s in by_evidence.ranked] == [s.evidence for s in found.ranked]
    assert [len(s.rows) for s in by_evidence.ranked] == [0] * 17
    for seen, full in zip(by_evidence.ranked, found.ranked, strict=True):
        np.testing.assert_array_equal(seen.shape, full.shape)
    totals = [s.weighed.total for s in found.ranked]
    assert totals == sorted(totals, reverse=True)


def test_an_effect_among_what_is_known_may_grow_and_move_its_time_constant_at_a_price() -> None:
    one = problem(driven(0), driven(1))
    made = columns(one, asked(Lagged(params=(TAU,))))
    assert made is not None
    best = rank_in(one, [made], NOISE).ranked[0]
    point = best.weighed.best[0]
    assert point == 0, "the driver acts at once"
    more = extended(one, [(made, best.weighed)])
    for old, new, rows in zip(one.blocks, more.blocks, one.parts, strict=True):
        full = made.whole[rows]
        own = full[:, point, :1] * best.weighed.coefficients[:1]
        np.testing.assert_allclose(new.base, np.hstack([old.base, own]))
        otherwise = full[:, point, 1:] * best.weighed.coefficients[0]
        slower = (full[:, point + 1, :1] - full[:, point, :1]) * best.weighed.coefficients[0]
        np.testing.assert_allclose(new.slack, np.hstack([otherwise, slower]))
    again = rank_in(more, [made], NOISE).ranked[0]
    assert again.evidence < 1.0 < 50.0 < best.evidence


# ---- what the noise hides, and what two share


def test_what_the_noise_hides_is_found_in_the_noise_beside_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """b is what is missing: beside it little noise is left, and there it stands out; in the noise of all that is
    missing it is behind a."""
    evidence = {"a": 40.0, "b": 30.0}
    clear = replace(NOISE, slow=0.01)
    world = Worlds(monkeypatch, lambda n, known: evidence[n] if not known else 0.0)
    everywhere(monkeypatch, "likeliest", lambda problem, noise: clear if "b" in problem.response else NOISE)

    def rank_in(problem: Problem, pool: Sequence[Columns], noise: Noise, **of: Any) -> Ranked:
        evidence["b"] = 90.0 if noise is clear else 30.0
        ranked = world._rank(problem, pool, **of)
        return replace(ranked, known=known(problem, noise))

    def known(problem: Problem, noise: Noise) -> Any:
        evidence["b"] = 90.0 if noise is clear else 30.0
        made = world._known(problem)
        made.space.noise = noise
        return made

    everywhere(monkeypatch, "rank_in", rank_in)
    everywhere(monkeypatch, "known", known)
    assert members(world.select("ab")) == ["b"]


@pytest.mark.parametrize(("evidence", "rankings"), [(9.9, 0), (10.1, 1)])
def test_nothing_is_ranked_in_the_noise_of_what_is_worth_too_little(
    monkeypatch: pytest.MonkeyPatch, evidence: float, rankings: int
) -> None:
    world = Worlds(monkeypatch, lambda n, known: 0.0 if known else evidence)
    asked: list[int] = []
    monkeypatch.setattr(noises, "rank_in", lambda *words, **of: [asked.append(1), world._rank(*words[:2], **of)][1])
    world.select("ab")
    assert len(asked) == rankings


def test_credits_ask_no_left_out_tests(monkeypatch: pytest.MonkeyPatch) -> None:
    world = Worlds(monkeypatch, lambda n, known: {"a": 100.0, "b": 40.0}[n])
    asked: list[bool] = []
    monkeypatch.setattr(
        besides, "rank_in", lambda *words, left_out: [asked.append(left_out), world._rank(*words[:2])][1]
    )
    world.select("ab")
    assert asked.count(False) == 1, "of the likelier one, once the other is gone"


@pytest.mark.parametrize(("evidence", "asked"), [(5.9, False), (6.1, True)])
def test_beside_what_is_far_behind_no_noise_is_estimated(
    monkeypatch: pytest.MonkeyPatch, evidence: float, asked: bool
) -> None:
    """15 % of the first one's evidence."""
    world = Worlds(monkeypatch, lambda n, known: {"a": 40.0, "b": evidence}[n] if not known else 0.0)
    beside: list[str] = []
    everywhere(monkeypatch, "likeliest", lambda problem, noise: [noise, beside.append(problem.response)][0])
    world.select("ab")
    assert ("b" in beside) is asked


def test_a_change_of_an_effect_is_tried_beside_a_lag_on_its_channels() -> None:
    lag, change = scored("lag"), scored("changed")
    within = SimpleNamespace(channels=lag.candidate.channels, within="term")
    changed = replace(change, candidate=within)  # type: ignore[arg-type]
    twin = scored("twin")
    assert noises.different([lag, twin, changed, changed]) == [lag, changed]


def test_what_two_explain_alike_is_the_likelier_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    alone, beside = {"a": 100.0, "b": 90.0, "c": 40.0}, {"a": 20.0, "b": 15.0, "c": 40.0}
    world = Worlds(monkeypatch, lambda n, known: beside[n] if {"a", "b"} & known else alone[n])
    found = world.select("abc")
    assert members(found) == ["a", "c", "b"]
    assert [m.scored.evidence for m in found.members] == [20.0, 40.0, 15.0], "beside all others"
    assert [m.scored.credit for m in found.members] == [100.0, 40.0, 15.0]


def test_what_takes_a_members_place_keeps_its_credit(monkeypatch: pytest.MonkeyPatch) -> None:
    """And adds to it what it does better beside the others."""
    alone, beside_c = {"a": 100.0, "b": 90.0, "c": 40.0}, {"a": 20.0, "b": 25.0, "c": 0.0}

    def evidence(n: str, known: Any) -> float:
        if {"a", "b"} & known:
            return 15.0 if n == "c" else 0.0
        return beside_c[n] if "c" in known else alone[n]

    world = Worlds(monkeypatch, evidence)
    original = world._scored

    def as_left_out(problem: Problem, one: Columns) -> Scored:
        made = original(problem, one)
        return replace(made, own_after=0.09 * made.rows) if name(made) == "b" else made

    monkeypatch.setattr(world, "_scored", as_left_out)
    found = world.select("abc")
    assert members(found) == ["b", "c"]
    assert [m.scored.evidence for m in found.members] == [25.0, 15.0]
    assert [m.scored.credit for m in found.members] == [105.0, 15.0]


@pytest.mark.parametrize(
    ("alone", "beside", "limit", "stands"),
    [(50.0, 20.0, 49.0, True), (50.0, 20.0, 51.0, False), (20.0, 50.0, 49.0, True), (20.0, 50.0, 51.0, False)],
)
def test_one_stands_out_beside_the_model_alone_or_beside_the_members(
    monkeypatch: pytest.MonkeyPatch, alone: float, beside: float, limit: float, stands: bool
) -> None:
    """a was selected; of c, which is not among those asked for, nothing is heard."""
    world = Worlds(monkeypatch, lambda n, known: {"a": 100.0, "b": beside if "a" in known else alone, "c": 90.0}[n])
    found = world.select("abc", among="a")
    asked = [s.columns for s in found.first.ranked if s.candidate.effect.name == "b"]
    start = replace(of_tests(4), response="")

    def may(one: Scored) -> bool:
        return one.evidence > limit

    assert selecting.any_stands_out(start, found.first, found, asked, may) is stands
    assert not selecting.any_stands_out(start, found.first, found, [], lambda one: True)


# ---- what stands beside the chosen without a name


@pytest.fixture
def sure(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """A claim asks so much evidence."""
    return lambda least: monkeypatch.setattr(contexts, "probability", lambda s: float(s.evidence >= least))


def hidden(n: str, known: frozenset[str]) -> float:
    """b is little where u is not known, and a is the surer for it."""
    return {"a": 100.0 + 20.0 * ("u" in known), "u": 40.0, "b": 50.0 if "u" in known else 5.0}[n]


def unnamed(scored: Scored) -> bool:
    """A rule forbids u, and what is little."""
    return name(scored) != "u" and scored.evidence > 5.0


@pytest.mark.parametrize(("least", "stands"), [(50.0, True), (110.0, True), (90.0, False)])
def test_what_may_not_be_named_stands_beside_what_it_hides(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], least: float, stands: bool
) -> None:
    """Where more is sure for it: b, or a; where a is sure anyway and b is not, nothing is changed."""
    sure(least)
    found = Worlds(monkeypatch, hidden).select("abu", unnamed)
    if not stands:
        assert (members(found), found.context, found.members[0].scored.evidence) == (["a"], (), 100.0)
        return
    assert (members(found), [name(s) for s in found.context]) == (["a", "b"], ["u"])
    assert [m.scored.evidence for m in found.members] == [120.0, 50.0], "weighed beside it"
    assert [m.scored.credit for m in found.members] == [120.0, 50.0]
    assert [[name(s) for s in m.beside] for m in found.members] == [["a"], ["b"]]
    assert [name(s) for s in found.dropped] == ["u"], "once, as it was judged last"
    assert all(len(m.alone.rows) for m in found.members), "left-out tests are asked of all"


@pytest.mark.parametrize(("good", "stands"), [(0.99, True), (1.0, False)])
def test_a_good_model_hides_nothing(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], good: float, stands: bool
) -> None:
    """It leaves 1 of left-out tests."""
    sure(50.0)
    assert bool(Worlds(monkeypatch, hidden).select("abu", unnamed, good=good).context) is stands


@pytest.mark.parametrize(("of_u", "stands"), [(49.9, True), (50.1, False)])
def test_nothing_is_named_for_what_is_more_evident_and_has_no_name(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], of_u: float, stands: bool
) -> None:
    sure(50.0)

    def evidence(n: str, known: frozenset[str]) -> float:
        return {"a": 100.0, "u": of_u, "b": 50.0 if "u" in known else 5.0}[n]

    found = Worlds(monkeypatch, evidence).select("abu", unnamed)
    assert (members(found), bool(found.context)) == ((["a", "b"], True) if stands else (["a"], False))


@pytest.mark.parametrize(("of_b", "stands"), [(60.0, True), (59.9, False)])
def test_what_takes_from_a_chosen_one_is_a_rival(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], of_b: float, stands: bool
) -> None:
    """However much another one gains by it."""
    sure(110.0)

    def evidence(n: str, known: frozenset[str]) -> float:
        beside = {"a": 120.0, "b": of_b} if "u" in known else {"a": 100.0, "b": 60.0}
        return {**beside, "u": 50.0}[n]

    found = Worlds(monkeypatch, evidence).select("abu", unnamed)
    assert (members(found), bool(found.context)) == (["a", "b"], stands)


def test_what_makes_a_chosen_one_unsound_is_a_rival(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None]
) -> None:
    sure(110.0)
    found = Worlds(monkeypatch, hidden).select("au", lambda s: unnamed(s) and s.evidence != 120.0)
    assert (members(found), found.context) == (["a"], ())


@pytest.mark.parametrize(("evidence", "stands"), [(10.1, True), (9.9, False)])
def test_a_context_brings_ten(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], evidence: float, stands: bool
) -> None:
    sure(110.0)
    world = Worlds(monkeypatch, lambda n, known: {"a": 100.0 + 20.0 * ("u" in known), "u": evidence}[n])
    assert bool(world.select("au", unnamed).context) is stands


@pytest.mark.parametrize(("channel", "stands"), [("T_{}", True), ("T", False)])
def test_another_mode_of_a_chosen_one_is_no_context(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], channel: str, stands: bool
) -> None:
    sure(110.0)
    assert bool(Worlds(monkeypatch, hidden).select("au", unnamed, channel=channel).context) is stands


@pytest.mark.parametrize(("rivals", "stands"), [("yz", True), ("xyz", False)])
def test_three_rivals_end_the_search(
    monkeypatch: pytest.MonkeyPatch, sure: Callable[[float], None], rivals: str, stands: bool
) -> None:
    """x, y and z take from a; u adds to it."""
    sure(101.0)

    def evidence(n: str, known: frozenset[str]) -> float:
        of_a = 100.0 - bool({*"xyz"} & known) + 2.0 * ("u" in known)
        return {"a": of_a, "u": 20.0}.get(n, 30.0 + ord(n) / 10)

    found = Worlds(monkeypatch, evidence).select("au" + rivals, lambda s: name(s) == "a")
    assert (members(found), bool(found.context)) == (["a"], stands)


AIR = {"kin": "part", "around": True, "evidence": 300.0, "family": "ambient", "shape": (1.0, 0.0)}


@pytest.mark.parametrize(
    ("own", "other", "taken"),
    [
        ({}, {}, True),
        ({"evidence": 5000.0}, {}, False),  # so sharp, it is a claim itself
        ({"kin": "near"}, {}, False),
        ({}, {"kin": "part"}, False),  # the model reads that one, too
        ({}, {"evidence": 60.0}, False),  # which may not be claimed either
        ({}, {"shape": (0.8, 0.6)}, False),  # and does not act alike
    ],
)
def test_a_sensor_that_the_model_does_not_read_stands_for_one_that_it_reads_with_others(
    own: dict[str, Any], other: dict[str, Any], taken: bool
) -> None:
    reads = scored("frame", channels=("T_low",), **{**AIR, **own})
    alone = scored("frame", channels=("T_mid",), **{**AIR, "kin": "near", "evidence": 200.0, **other})
    another = scored("sun", channels=("G",), **{**AIR, "kin": None, "evidence": 290.0})
    found = read_alone(reads, [reads, another, alone])
    assert (found is alone) is taken
    assert found in (alone, None)
