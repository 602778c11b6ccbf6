"""How probable it is that a sound candidate is what is missing, and how probable a claim has to be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.weigh.foretold import Looked
from thermodata.diagnosis.weigh.scored import Scored

# that a sound candidate is the cause: a logistic curve over the logarithm of its evidence a sample, the fall of the
# error where it acts, whether it is the air beside something sharper, whether it is passive, whether a part that
# another cause moves may be what it stands for, whether the model reads it already, together with others, whether it
# reads what holds the probes, whether it is a guideway whose screw, by no channel a candidate, may be it as well, and
# whether it reads a part that makes heat itself (docs/method.md#probability)
PROBABILITY = (2.45, 2.2, 1.1, -1.8, -2.65, -0.9, -2.6, -1.2, -2.3, 1.0)
# and, where another axis misses the same, this share of the odds that it is what is missing there; other axes are asked
# of what is so probable without them at least
BORNE_OUT, WORTH_ASKING = 0.5, 0.3
FALLS = (-0.2, 1.0)  # further, and a fall says nothing more
CLAIMED = 0.65  # a claim is this probable at least;
# where nobody declared any place it names a channel, not physics, and there is nothing that it could be taken for
PLACELESS_CLAIMED = 0.5
OPENED = 0.4  # the lock is opened for what is so probable, which the locked tests may make a claim
# what is so probable is told from other parts by its timing: they are not named beside it
TOLD_APART = 0.93


def probability(scored: Scored) -> float:
    """That a sound candidate is what is missing: the share that was right among those like it, on simulated machines
    (development seeds); once the lock is open, with what the locked tests say."""
    return _share(_on_open_tests(scored) + (0.0 if scored.looked is None else scored.looked.log_odds))


def may_be_borne_out(scored: Scored) -> bool:
    """Whether it is no claim, and would be one if another axis spoke for it."""
    return not scored.also_on and WORTH_ASKING <= probability(scored) < limit_of(scored)


def may_be_confirmed(scored: Scored) -> bool:
    """Whether the lock is opened for it: it may be claimed, or would be if the locked tests spoke for it."""
    return probability(scored) >= min(OPENED, limit_of(scored))


def is_made_a_claim(scored: Scored, looked: Looked) -> bool:
    """Whether what the locked tests say makes a claim of it."""
    told = replace(scored, looked=looked)
    return bool(looked.saying) and not looked.refuted and probability(told) >= limit_of(told)


def at_best(scored: Scored, samples: int) -> float:
    """Its probability if left-out tests were foretold without any error, and nothing beside it were sharper."""
    return _share(_log_odds(scored.evidence / max(samples, 1), FALLS[1], scored.candidate))


def of_either(scored: Scored) -> float:
    """That it is what is missing, or that another part is that it may be as well (`CandidateEffect.unread`)."""
    of = replace(scored.candidate, unread=(), lesser=False)
    return probability(replace(scored, candidate=of))


def _on_open_tests(scored: Scored, *, this_part: bool = False) -> float:
    """Its log odds before the lock is opened. this_part: that it is this part, not only this cause."""
    own = _log_odds(sharpness(scored), scored.drop, scored.candidate, beaten=scored.beaten, this_part=this_part)
    there = max((p for _, p in scored.also_on), default=0.0)
    return own + (BORNE_OUT * _logit(there) if there > 0.5 else 0.0)


def _log_odds(
    a_sample: float, drop: float, of: CandidateEffect, *, beaten: bool = False, this_part: bool = False
) -> float:
    level, sharp, fall, air_beaten, by_casting, by_another_part, by_one_of_several, by_holder, by_lesser, by_source = (
        PROBABILITY
    )
    odds = level + sharp * np.log10(max(a_sample, 1e-4)) + fall * float(np.clip(drop, *FALLS))
    another = bool(of.unread) if this_part else may_be_another_cause(of)
    odds += air_beaten * (beaten and of.around) + by_casting * of.passive + by_another_part * another
    odds += by_one_of_several * (of.kin == "part") + by_holder * of.of_holder + by_lesser * of.lesser
    return float(odds + by_source * (of.of_source and not another))


def may_be_another_cause(of: CandidateEffect) -> bool:
    """Whether another part that it may be as well is warmed by something else: what stands in the same air is moved by
    the same cause."""
    return bool(of.unread) and not of.around


def _share(log_odds: float) -> float:
    return float(1 / (1 + np.exp(-log_odds)))


def _logit(share: float) -> float:
    return float(np.log(share / (1 - share)))


def sharpness_asked(fall: float, of: CandidateEffect) -> float:
    """The evidence a sample that a claim asks of what stands alone. fall: of the error where it acts."""
    sharp = PROBABILITY[1]
    known = _log_odds(1.0, fall, of)  # a sharpness of 1 adds nothing
    return float(10 ** ((_logit(CLAIMED) - known) / sharp))


def elsewhere(scored: Scored) -> tuple[str, ...]:
    """Places of other parts that it may be as well, which run at the same hours in locked tests, too. A motion has the
    timing of no part, and which part it is, is no surer for its being the air."""
    told = _on_open_tests(scored, this_part=True) >= _logit(TOLD_APART) and not scored.candidate.of_motion
    return () if told else scored.candidate.unread


def limit_of(scored: Scored) -> float:
    """The least probability of a claim."""
    return PLACELESS_CLAIMED if scored.candidate.placeless else CLAIMED


def sharpness(scored: Scored) -> float:
    """Log evidence a sample."""
    return (scored.evidence if scored.credit is None else scored.credit) / max(float(scored.rows.sum()), 1.0)
