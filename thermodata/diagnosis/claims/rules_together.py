"""What all rules of a claim say of a candidate: which it fails, whether it may be claimed, and whether it contradicts
that nothing is missing."""

from __future__ import annotations

from thermodata.diagnosis.claims.in_words import in_short
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import limit_of, may_be_confirmed, probability, sharpness
from thermodata.diagnosis.claims.rules import Rule, rules
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.agreed.limits import PLAUSIBLE
from thermodata.schema.words.sentences import apart, beside

PLAIN = 0.25  # evidence a sample: something is so plainly missing that no rule which it breaks says otherwise
HALVES = 0.5  # what leaves no more than this share of the error contradicts that nothing is missing


def surely(scored: Scored) -> Rule:
    """Whether a sound candidate is a cause: it has the timing of what is missing and leaves little noise; what stands
    in for it has its slow shape alone."""
    sure, limit = probability(scored), limit_of(scored)
    return Rule(
        "probability",
        "that it is what is missing, by its log evidence a sample, the fall of the error, whether it is the air "
        "beside something sharper, whether it reads a body that makes no heat, the tool, what holds the probes, "
        "or what the model reads with others, or a part that makes heat itself, whether another part may be it, "
        "whether another axis misses it as well, and what the locked tests say",
        sure,
        limit,
        "least",
        sure >= limit,
        f"causes like it were right in {apart(sure, limit)} of cases only ({beside(sure, limit)}): {in_short(scored)}",
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
