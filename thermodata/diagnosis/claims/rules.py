"""The rules of a claim: what is measured of a candidate, its limit, and why who breaks a rule is no cause."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.claims.broken import too_few, too_little, unlike
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import (
    limit_of,
    may_be_another_cause,
    may_be_confirmed,
    probability,
    sharpness,
)
from thermodata.diagnosis.question.present import CONTROL
from thermodata.diagnosis.weigh.figures import HARDLY, from_to, short, way
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.diagnosis.weigh.null import in_words as chance_in_words
from thermodata.diagnosis.weigh.null import p_value
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.agreed.limits import PLAUSIBLE
from thermodata.schema.words.places import heat_at
from thermodata.schema.words.sentences import apart, beside, in_percent

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
PLAIN = 0.25  # evidence a sample: something is so plainly missing that no rule which it breaks says otherwise
HALVES = 0.5  # what leaves no more than this share of the error contradicts that nothing is missing


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


def rules(scored: Scored, measure: Measure, unit: str) -> list[Rule]:
    """Every rule that a sound candidate keeps, in the order in which they are asked."""
    p, count = p_value(scored.evidence, measure.chance), int(scored.acts.sum())
    fall = STEADYING_DROP_LIMIT if _steadies(scored) else DROP_LIMIT
    told, worth, tests = explained(scored), WORTH_SHARE * measure.spread, measure.tests
    strong, overwhelming = sharpness(scored) >= STRONG, sharpness(scored) >= OVERWHELMING
    sure = probability(scored) >= limit_of(scored)
    better = SURE_BETTER_LIMIT if sure else BETTER_LIMIT
    unasked = "; not asked where the evidence is {:g} a sample"
    alone = overwhelming and scored.candidate.kin is None
    return [
        Rule(
            "chance",
            "share of responses without a missing effect on which chance does as well",
            p,
            P_LIMIT,
            "most",
            p <= P_LIMIT,
            f"{chance_in_words(scored.evidence, measure.chance)} ({beside(p, P_LIMIT)})",
        ),
        Rule(
            "fall",
            f"fall of the error where it acts, its size from the other {tests}{unasked.format(STRONG)}, or it is as "
            "probable as a claim asks",
            scored.drop,
            fall,
            "least",
            scored.drop >= fall or ((strong or sure) and scored.drop >= DOUBLES),
            too_little(scored, fall, unit, tests, DOUBLES),
        ),
        Rule(
            "tests",
            f"share of these {tests} that it makes more probable",
            scored.better,
            better,
            "least",
            scored.better >= better,
            too_few(round(scored.better * count), count, better, tests),
        ),
        Rule(
            "gain",
            f"how much its gain differs between {tests}; not asked where the error falls by "
            f"{in_percent(FORETOLD)}, or the "
            f"evidence is {STRONG:g} a sample",
            scored.spread,
            SPREAD_LIMIT,
            "most",
            strong or scored.spread <= SPREAD_LIMIT or scored.drop >= FORETOLD,
            unlike(scored.spread, SPREAD_LIMIT, count, tests),
        ),
        Rule(
            "others",
            f"{tests} in which it acts{unasked.format(OVERWHELMING)} and the model has nothing of its family",
            count,
            LEAST_TESTS,
            "least",
            alone or count >= LEAST_TESTS,
            f"it acts in one {tests[:-1]} only: no other foretells it" if count else f"it acts in no {tests[:-1]}",
        ),
        Rule(
            "worth",
            f"what it explains where it acts{unasked.format(STRONG)}, or it is as probable as a claim asks and "
            f"does {in_percent(WORTH_SIZE)} of the response by a gain that is alike in all {tests}",
            told,
            worth,
            "least",
            strong or told >= worth or (sure and _does_much(scored, measure)),
            f"it explains {short(told)} {unit} where it acts, {_share(told, measure.spread)} of the response's "
            f"{short(measure.spread)} {unit} ({beside(told / max(measure.spread, 1e-12), WORTH_SHARE)})",
            unit,
        ),
        *_of_a_difference(scored),
    ]


def _of_a_difference(scored: Scored) -> list[Rule]:
    """Of two temperatures that differ one says less by itself; where each says as much, what they share acts."""
    less, each = min(scored.sides, default=0.0), " and ".join(f"{one:.0f}" for one in scored.sides)
    told = "log evidence of that one of its two temperatures which says less by itself"
    why = (
        f"each of {' and '.join(scored.candidate.channels)} says as much by itself as their difference does (log "
        f"evidence {each}, and {scored.evidence:.0f}): what they share acts"
    )
    rule = Rule("difference", told, less, scored.evidence, "most", less < scored.evidence, why)
    return [rule] if scored.sides else []


def _share(part: float, whole: float) -> str:
    return in_percent(part / whole, 1) if whole > 0 else "none"


def _does_much(scored: Scored, measure: Measure) -> bool:
    """Whether it does much of the response, and surely so."""
    return scored.spread <= WORTH_SPREAD and acting_size(scored) >= WORTH_SIZE * measure.spread


def surely(scored: Scored) -> Rule:
    """Whether a sound candidate is a cause: it has the timing of what is missing and leaves little noise; what stands
    in for it has its slow shape alone."""
    sure, limit = probability(scored), limit_of(scored)
    return Rule(
        "probability",
        "that it is what is missing, by its log evidence a sample, the fall of the error, whether it is the air "
        "beside something sharper, whether it reads a body that makes no heat, the tool, what holds the probes, "
        "or what the model reads with others, whether another part may be it, "
        "whether another axis misses it as well, and what the locked tests say",
        sure,
        limit,
        "least",
        sure >= limit,
        f"causes like it were right in {apart(sure, limit)} of cases only ({beside(sure, limit)}): {_in_short(scored)}",
    )


def _in_short(scored: Scored) -> str:
    """What its probability hangs on."""
    by = f" by {in_percent(scored.drop)}" if scored.drop >= HARDLY else ""
    falls = f"where it acts the error {way(scored.error_before, scored.error_after)}{by}"
    beaten = scored.beaten and scored.candidate.around
    more = ["a sharper effect stands beside it, and leaves what is slow, as the air is"] if beaten else []
    if scored.candidate.passive:
        more.append("it reads a body that makes no heat, one beside the machine, or one whose place nobody declared")
    if scored.candidate.kin == "part":
        more.append("the model reads it already, together with others")
    if scored.candidate.of_holder:
        more.append("it reads the tool, or what holds the probes, which warms with all in the working space")
    if may_be_another_cause(scored.candidate):
        more.append(f"what it reads does not tell it from {heat_at(scored.candidate.unread, ' or ')}")
    more += [also_missing(scored)] if scored.also_on else []
    if scored.looked is not None and scored.looked.saying:
        more.append(on_locked(scored.looked))
    return "; ".join([f"its evidence is {sharpness(scored):.2f} a sample, and {falls}", *more])


def on_locked(looked: Looked) -> str:
    """'on the locked tests, with a free offset a test, the error falls by 60 % (1.00 -> 0.40 um)', or in each of two
    ways: this is not the error as tests are scored, from their first samples on."""
    first, added = looked.foretold, looked.added
    acts = "" if first.tests is None else " in which it acts"
    error = f"on the locked tests{acts}, with a free offset a test, the error"
    if len(looked.saying) < 2 or added is None:
        return f"{error} {in_words(looked.saying[0], looked.unit)}"
    return (
        f"{error} {in_words(added, looked.unit)} with it added as it stands, and {in_words(first, looked.unit)} where "
        "the effects of the model may act otherwise than by their fitted lags"
    )


def in_words(of: Foretold, unit: str) -> str:
    """'falls by 60 % (1.00 -> 0.40 um)', 'hardly changes (...)', 'rises by 20 % (...)'."""
    if of.falls:
        said = f"falls by {in_percent(of.fall)}"
    else:
        rises = of.after > 1.005 * of.before > 0
        said = f"rises by {in_percent(of.after / of.before - 1)}" if rises else "hardly changes"
    return f"{said} ({from_to(of.before, of.after, unit)})"


def also_missing(scored: Scored) -> str:
    """'dX misses it as well (97 %)', for each other axis; what is improbable there speaks for nothing."""
    return " and ".join(
        f"{channel} {'misses it as well' if p > 0.5 else 'hardly misses it'} ({in_percent(p)})"
        for channel, p in scored.also_on
    )


def failed_rules(scored: Scored, measure: Measure, unit: str) -> list[str]:
    """The rules that a candidate fails, as sentences; none where it is sound."""
    failed = [rule.fails for rule in rules(scored, measure, unit) if not rule.holds]
    return [why for why in [scored.candidate.unforetold] if why] + failed


def blunt(scored: Scored) -> str | None:
    """Why a sound candidate is still no cause; None where it may be claimed."""
    rule = surely(scored)
    return None if rule.holds else rule.fails


def halves(scored: Scored, left: float) -> bool:
    """Whether it leaves half of the error of left-out tests, each alike. left: that error without it."""
    return bool(len(scored.rows)) and scored.error_of_all <= HALVES * left


def contradicts(scored: Scored, alone: Scored, left: float) -> bool:
    """Whether nothing can't be said to be missing beside it. alone: as it was chosen. left: the error of left-out tests
    without it, where that is more than noise."""
    return probability(scored) >= PLAUSIBLE or halves(alone, left)


def is_plain(scored: Scored) -> bool:
    """Whether its evidence alone says that something is missing, though a rule forbids that it be named."""
    own = scored.candidate.kin not in ("same", "heat") and not scored.candidate.within
    return own and sharpness(scored) >= PLAIN


def may_be_claimed(scored: Scored, measure: Measure, unit: str) -> bool:
    """Whether it is sound, and likely; what it refines is another question."""
    return not failed_rules(scored, measure, unit) and may_be_confirmed(scored)


def _steadies(scored: Scored) -> bool:
    """Whether it may follow anything slow: a casting, or a difference of any two temperatures."""
    return scored.candidate.passive or scored.candidate.family == CONTROL


def explained(scored: Scored) -> float:
    """RMS of what it takes away in tests in which it acts, its size from the others."""
    return float(np.sqrt(max(0.0, scored.error_before**2 - scored.error_after**2)))


def acting_size(scored: Scored) -> float:
    """RMS of its contribution in the tests in which it acts."""
    acts = scored.acts
    return float(np.sqrt(np.mean(scored.size[acts] ** 2))) if acts.any() else 0.0
