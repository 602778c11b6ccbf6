"""The rules of a claim: what is measured of a candidate, its limit, and why who breaks a rule is no cause."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.claims.broken import too_few, too_little, unlike
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import limit_of, probability, sharpness
from thermodata.diagnosis.question.present import CONTROL
from thermodata.diagnosis.weigh.figures import short
from thermodata.diagnosis.weigh.null import in_words as chance_in_words
from thermodata.diagnosis.weigh.null import p_value
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import beside, in_percent

P_LIMIT = 0.01
# so much evidence a sample outweighs what left-out tests say: how far their error falls, for the known effects take
# part of what is missing, and that the gain differs between them; and even how many they are
STRONG = 0.4
OVERWHELMING = 0.5
DROP_LIMIT = 0.15  # fall of the error on left-out tests in which it acts,
DOUBLES = -1.0  # but no cause doubles that error, however evident: then tests go against each other
STEADYING_DROP_LIMIT = 0.3  # and of any casting, or two temperatures: what is slow steadies a misfit a little
LEAST_TESTS = 2  # in which it acts: no other foretells what acts in one only
BETTER_LIMIT = 0.6  # share of these tests that it makes more probable,
SURE_BETTER_LIMIT = 0.4  # and of what is as probable as a claim asks: its few tests say much
SPREAD_LIMIT = 0.5  # of its gain between tests, as a share,
FORETOLD = 0.5  # unless left-out tests are foretold to this share of their error: few tests can't tell a spread
WORTH_SHARE = 0.1  # of the response: less is not worth a name,
# unless what is as probable as a claim asks does so much of the response, by a gain that differs so little between
# tests: then the known effects take for their own what it does, and the error hardly shows it
WORTH_SIZE, WORTH_SPREAD = 0.2, 0.2


@dataclass(frozen=True, slots=True)
class Rule:
    """One rule of a claim, asked of a candidate. value: held against the limit, at the `least` or at the `most`; beyond
    it the rule may hold, where it is not asked. asks: what it asks, in words. fails: why who breaks it is no cause."""

    name: str
    asks: str
    value: float
    limit: float
    at: Literal["least", "most"]
    holds: bool
    fails: str
    unit: str = "1"

    @property
    def asked(self) -> bool:
        """Whether it decides: what misses the limit and holds is outweighed."""
        return not self.holds or (self.value >= self.limit if self.at == "least" else self.value <= self.limit)


@dataclass(frozen=True, slots=True)
class _Asked:
    """A sound candidate as the rules ask of it. unit: of the response."""

    scored: Scored
    measure: Measure
    unit: str

    @property
    def strong(self) -> bool:
        """Whether its evidence outweighs how far left-out tests fall."""
        return sharpness(self.scored) >= STRONG

    @property
    def overwhelming(self) -> bool:
        """Whether its evidence outweighs how many tests there are."""
        return sharpness(self.scored) >= OVERWHELMING

    @property
    def sure(self) -> bool:
        """Whether it is as probable as a claim asks."""
        return probability(self.scored) >= limit_of(self.scored)

    @property
    def tests(self) -> str:
        """What its tests are called: 'tests', or 'parts' of one."""
        return self.measure.tests

    @property
    def count(self) -> int:
        """In how many tests it acts."""
        return int(self.scored.acts.sum())


_UNASKED = "; not asked where the evidence is {:g} a sample"


def _chance_seldom_does_as_well(of: _Asked) -> Rule:
    evidence, chance = of.scored.evidence, of.measure.chance
    p = p_value(evidence, chance)
    return Rule(
        "chance",
        asks="share of responses without a missing effect on which chance does as well",
        value=p,
        limit=P_LIMIT,
        at="most",
        holds=p <= P_LIMIT,
        fails=f"{chance_in_words(evidence, chance)} ({beside(p, P_LIMIT)})",
    )


def _the_error_falls_on_left_out_tests(of: _Asked) -> Rule:
    drop, limit = of.scored.drop, STEADYING_DROP_LIMIT if _follows_anything_slow(of.scored) else DROP_LIMIT
    return Rule(
        "fall",
        asks=f"fall of the error where it acts, its size from the other {of.tests}{_UNASKED.format(STRONG)}, or it is "
        "as probable as a claim asks",
        value=drop,
        limit=limit,
        at="least",
        holds=drop >= limit or ((of.strong or of.sure) and drop >= DOUBLES),
        fails=too_little(of.scored, limit, of.unit, of.tests, DOUBLES),
    )


def _most_tests_become_more_probable(of: _Asked) -> Rule:
    better, limit = of.scored.better, SURE_BETTER_LIMIT if of.sure else BETTER_LIMIT
    return Rule(
        "tests",
        asks=f"share of these {of.tests} that it makes more probable",
        value=better,
        limit=limit,
        at="least",
        holds=better >= limit,
        fails=too_few(round(better * of.count), of.count, limit, of.tests),
    )


def _its_gain_is_alike_in_all_tests(of: _Asked) -> Rule:
    spread = of.scored.spread
    return Rule(
        "gain",
        asks=f"how much its gain differs between {of.tests}; not asked where the error falls by "
        f"{in_percent(FORETOLD)}, or the evidence is {STRONG:g} a sample",
        value=spread,
        limit=SPREAD_LIMIT,
        at="most",
        holds=of.strong or spread <= SPREAD_LIMIT or of.scored.drop >= FORETOLD,
        fails=unlike(spread, SPREAD_LIMIT, of.count, of.tests),
    )


def _other_tests_foretell_it(of: _Asked) -> Rule:
    alone = of.overwhelming and of.scored.candidate.kin is None
    test = of.tests[:-1]
    return Rule(
        "others",
        asks=f"{of.tests} in which it acts{_UNASKED.format(OVERWHELMING)} and the model has nothing of its family",
        value=of.count,
        limit=LEAST_TESTS,
        at="least",
        holds=alone or of.count >= LEAST_TESTS,
        fails=f"it acts in one {test} only: no other foretells it" if of.count else f"it acts in no {test}",
    )


def _it_explains_what_is_worth_a_name(of: _Asked) -> Rule:
    told, spread = explained(of.scored), of.measure.spread
    worth = WORTH_SHARE * spread
    return Rule(
        "worth",
        asks=f"what it explains where it acts{_UNASKED.format(STRONG)}, or it is as probable as a claim asks and "
        f"does {in_percent(WORTH_SIZE)} of the response by a gain that is alike in all {of.tests}",
        value=told,
        limit=worth,
        at="least",
        holds=of.strong or told >= worth or (of.sure and _does_much(of.scored, of.measure)),
        fails=f"it explains {short(told)} {of.unit} where it acts, {_percent_of(told, spread)} of the response's "
        f"{short(spread)} {of.unit} ({beside(told / max(spread, 1e-12), WORTH_SHARE)})",
        unit=of.unit,
    )


def _a_difference_says_more_than_its_two_temperatures(of: _Asked) -> Rule | None:
    """Asked where it reads two: where each says as much by itself, what they share acts."""
    scored = of.scored
    if not scored.sides:
        return None
    less, each = min(scored.sides), " and ".join(f"{one:.0f}" for one in scored.sides)
    return Rule(
        "difference",
        asks="log evidence of that one of its two temperatures which says less by itself",
        value=less,
        limit=scored.evidence,
        at="most",
        holds=less < scored.evidence,
        fails=f"each of {' and '.join(scored.candidate.channels)} says as much by itself as their difference does (log "
        f"evidence {each}, and {scored.evidence:.0f}): what they share acts",
    )


_IN_THEIR_ORDER = (
    _chance_seldom_does_as_well,
    _the_error_falls_on_left_out_tests,
    _most_tests_become_more_probable,
    _its_gain_is_alike_in_all_tests,
    _other_tests_foretell_it,
    _it_explains_what_is_worth_a_name,
    _a_difference_says_more_than_its_two_temperatures,
)


def rules(scored: Scored, measure: Measure, unit: str) -> list[Rule]:
    """Every rule that a sound candidate keeps, in the order in which they are asked."""
    of = _Asked(scored, measure, unit)
    return [rule for rule in (ask(of) for ask in _IN_THEIR_ORDER) if rule is not None]


def _percent_of(part: float, whole: float) -> str:
    return in_percent(part / whole, 1) if whole > 0 else "none"


def _does_much(scored: Scored, measure: Measure) -> bool:
    """Whether it does much of the response, and surely so."""
    return scored.spread <= WORTH_SPREAD and acting_size(scored) >= WORTH_SIZE * measure.spread


def _follows_anything_slow(scored: Scored) -> bool:
    """Whether it may follow anything slow: a casting, or a difference of any two temperatures."""
    return scored.candidate.passive or scored.candidate.family == CONTROL


def explained(scored: Scored) -> float:
    """RMS of what it takes away in tests in which it acts, its size from the others."""
    return float(np.sqrt(max(0.0, scored.error_before**2 - scored.error_after**2)))


def acting_size(scored: Scored) -> float:
    """RMS of its contribution in the tests in which it acts."""
    acts = scored.acts
    return float(np.sqrt(np.mean(scored.size[acts] ** 2))) if acts.any() else 0.0
