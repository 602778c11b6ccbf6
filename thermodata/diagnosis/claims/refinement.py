"""Whether a candidate is a cause of its own, or refines an effect that the model has.

Four ways to refine: it takes a known effect's place; it is kin (same family, channels or place) and small beside it;
it acts as a known effect would if its temperature counted from another one; or as the air of the model does by other
time constants.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.kin import cause, heat_of, refines, told_by
from thermodata.diagnosis.candidates.warm_at_rest import share_at_rest
from thermodata.diagnosis.claims.known_beside import KnownEffects
from thermodata.diagnosis.claims.probability import probability, sharpness
from thermodata.diagnosis.claims.refines import LITTLE, PART, elsewhere_of, mode_of
from thermodata.diagnosis.claims.rules import LEAST_TESTS, STRONG, acting_size
from thermodata.diagnosis.claims.rules_together import blunt
from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known_effects import from_other_zero, is_warm
from thermodata.diagnosis.question.present import GENERIC
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.weigh.beside import beside
from thermodata.diagnosis.weigh.changed import ChangedEffect
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D

AIR = "ambient"  # a temperature of the air counts from nothing else
# what a model leaves that is good already: more, and something is missing (share of the response)
GOOD = 0.4
# what takes away so much of what is left (as a share of the error), and is so probable, is missing, not another mode of
# what is there
MOST, SURE = 0.6, 0.85
# a known effect is replaced where, beside the candidate, it is worth this share of what it was worth alone
REPLACED = 0.1
WORTH = 20.0  # log evidence: an effect that was worth less was never there to be replaced
KEPT = 0.25  # and stands beside it where it is worth this share
LIKE = 0.9  # and both act alike (cosine)
AT_ALL_LIKE = 0.5  # another mode of a known part acts at all as it does
# the share of what a body's temperature does that the air of the model can do, by any of its time constants,
FOLLOWS = 0.8
# or half of it, of a body that moves half as far where nothing at its part does
HALF = 0.5
SMALL = 0.6  # of the known effect's size: kin that does less is another mode of it
OPPOSITE = -0.8  # cosine with the known effect driven by the candidate's temperature,
SHARE = (0.2, 1.5)  # and how much of it that takes away
EVIDENT = 1.0  # log evidence a sample: another zero changes little, and leaves no such trace
# nor does the machine move by this share of what the candidate does, in a quarter of the tests in which the known
# effect does less than the candidate
MOVES, QUARTER = 0.6, 0.25


class Refinement:
    """Asked for each member of a selection, in the noise beside all members. twins: by the identity of a member's
    columns the sound ones of its family that the tests can't tell from it."""

    def __init__(
        self,
        fitted: FittedResponse,
        problem: Problem,
        noise: Noise,
        twins: Mapping[int, Sequence[Scored]] | None = None,
    ) -> None:
        self.fitted, self.problem, self.twins = fitted, problem, twins or {}
        self.known = KnownEffects(fitted, problem, noise)
        self.tests = list({b.test.key: b.test for b in problem.blocks}.values())

    def __call__(self, scored: Scored) -> str | None:
        """What it refines of the model, in words."""
        if not self.fitted.terms:
            return None
        if isinstance(scored.candidate, ChangedEffect):
            return scored.candidate.in_words(scored)
        kin, most = scored.candidate.kin, scored.drop >= MOST
        effect = scored.candidate.effect
        if (refines(effect) and told_by(effect) is None) or kin == "same":
            return self._named_as_mode(scored)
        if kin == "part" and sharpness(scored) < STRONG:
            return PART
        if (air := self._air_that_warms_it(scored)) is not None:
            return mode_of([air])
        if kin == "heat" and not self._acts_beside(scored):
            return self._named_as_mode(scored)
        if scored.candidate.of_motion and kin in ("near", "related") and not most and self._like_its_family(scored):
            return self._named_as_mode(scored)
        good = scored.error_before <= GOOD * rms(self.problem.response_blocks)
        largest = max(self.known.size(i) for i in range(len(self.fitted.terms)))
        # what is surely a cause is one, however small beside its kin
        if good and kin is not None and not most and blunt(scored) and acting_size(scored) < SMALL * largest:
            return LITTLE if kin in ("near", "related") else self._named_as_mode(scored)
        # what reads the same heat elsewhere stands for the known effect, however much else is missing
        near = kin == "near" and not is_surely_missing(scored)
        may_replace = near or (good and not most and (kin is not None or scored.candidate.family == GENERIC))
        for number, term in enumerate(self.fitted.terms):
            if may_replace and self._replaces(scored, number):
                return f"it takes the place of {term.id}"
            if not good or sharpness(scored) >= EVIDENT:
                continue
            channel = self._other_zero(scored, number)
            if channel is not None:
                return f"it acts as {term.id} would if its temperature counted from {channel}"
        return None

    def _named_as_mode(self, scored: Scored) -> str:
        """With the effects of the model that it is taken for a mode of: what it refines, what stands for the same
        cause, what reads its channels, or what is of its family; the first of these that there is."""
        one = scored.candidate
        terms = self.fitted.terms
        same = [t.id for t in terms if t.effect.name == one.effect.name]
        if one.kin == "same" and same and not any(_read_by(t, one.channels) for t in terms):
            return elsewhere_of(same)
        alike: list[Callable[[FittedTerm], bool]] = [
            lambda term: term.effect.name in refines(one.effect),
            lambda term: heat_of(term.effect, term.family) == heat_of(one.effect, one.family),
            lambda term: _read_by(term, one.channels),
            lambda term: term.family == one.family,
        ]
        found = next((some for is_it in alike if (some := [t.id for t in terms if is_it(t)])), [])
        return mode_of(found, one.unmodelled)

    def _acts_beside(self, scored: Scored) -> bool:
        """Whether what is known as the cause of other effects is surely missing as it acts by these channels: what the
        model has of that cause is worth as much beside it."""
        if not is_surely_missing(scored):
            return False
        own = [n for n, term in enumerate(self.fitted.terms) if cause(term.effect) == cause(scored.candidate.effect)]
        return bool(own) and all(self._is_kept(scored, number) for number in own)

    def _is_kept(self, scored: Scored, term: int) -> bool:
        """Whether a known effect is worth as much beside it."""
        return self.known.cost(beside(self.problem, [scored]), term) >= KEPT * self.known.worth(term)

    def _replaces(self, scored: Scored, term: int) -> bool:
        alone = self.known.worth(term)
        if alone < WORTH or self.known.likeness(scored, term) < LIKE:
            return False
        return self.known.cost(beside(self.problem, [scored]), term) < REPLACED * alone

    def _like_its_family(self, scored: Scored) -> bool:
        """Whether it acts at all like a known effect of its family."""
        family = scored.candidate.family
        own = [number for number, term in enumerate(self.fitted.terms) if term.family == family]
        return any(self.known.likeness(scored, number) >= AT_ALL_LIKE for number in own)

    def _air_that_warms_it(self, scored: Scored) -> str | None:
        """The effect of the air that a single temperature follows. The air warms all that stands in it, each body in
        its own time, so that one of them has just the time that the effect of the air lacks; but none where a motion of
        its part, or another temperature there, does as much and follows no air."""
        if sharpness(scored) >= EVIDENT or scored.candidate.family == AIR:
            return None
        air = self._air_followed(scored)
        twins = self.twins.get(id(scored.columns), ()) if air is not None else ()
        return None if any(self._air_followed(twin) is None for twin in twins) else air

    def _air_followed(self, scored: Scored) -> str | None:
        channels = scored.candidate.channels
        if len(channels) != 1 or not self._is_warm(channels[0]):
            return None
        for number, term in enumerate(self.fitted.terms):
            if term.family != AIR:
                continue
            share = self.known.share_of(scored, number)
            at_rest = share_at_rest(channels[0], self.tests) if HALF <= share < FOLLOWS else None
            if share >= FOLLOWS or (at_rest is not None and at_rest >= HALF):
                return term.id
        return None

    def _is_warm(self, name: str) -> bool:
        """Whether it is a temperature, in whichever tests it is logged."""
        return any(is_warm(test, name) for test in self.tests)

    def _other_zero(self, scored: Scored, term: int) -> str | None:
        channels = scored.candidate.channels
        if self.fitted.terms[term].family == AIR or not _reads_surroundings(scored.candidate):
            return None
        if len(channels) != 1 or not self._is_warm(channels[0]):
            return None
        if acting_size(scored) >= SMALL * self.known.size(term):
            return None
        alike, does = [], scored.columns.does(scored.weighed)
        for block, rows in zip(self.problem.blocks, self.problem.parts, strict=True):
            other = from_other_zero(self.fitted, term, channels[0], block.test)
            if other is None:
                return None
            alike.append((does[rows], block.compress(other[:, None])[:, 0]))
        own, theirs = (np.concatenate(side) for side in zip(*alike, strict=True))
        if not _takes_away(own, theirs) or self._moves_by_itself(term, [own for own, _ in alike]):
            return None
        return channels[0]

    def _moves_by_itself(self, term: int, candidate: Sequence[Float1D]) -> bool:
        """Whether the machine moves where a known effect does less than the candidate: an effect that counts from
        another temperature is taken back there, and the machine rests. candidate: what it does, a test each."""
        others = [n for n in range(len(self.fitted.terms)) if n != term]
        shares = []
        for block, own in zip(self.problem.blocks, candidate, strict=True):
            does = self.known.contribution(block, term)
            if own.std() >= does.std() and own.any():
                left = block.response - sum((self.known.contribution(block, n) for n in others), np.zeros(len(own)))
                shares.append(float(left.std() / own.std()))
        return len(shares) >= LEAST_TESTS and float(np.quantile(shares, QUARTER)) >= MOVES


def is_surely_missing(scored: Scored) -> bool:
    """Whether it takes away most, and is sure. A motion has the timing of no part: what one lag of a known part leaves
    follows the same motion, but leaves less evidence."""
    timed = not scored.candidate.of_motion or sharpness(scored) >= EVIDENT
    return timed and scored.drop >= MOST and probability(scored) >= SURE


def _read_by(term: FittedTerm, channels: Sequence[str]) -> bool:
    return any(name in names_of(text) for text in term.binding.values() for name in channels)


def _reads_surroundings(candidate: CandidateEffect) -> bool:
    """Whether it reads what a warm part may count from: the air, a casting, or what nobody declared a place of."""
    body = candidate.passive or candidate.placeless
    return candidate.family == AIR or (candidate.family == GENERIC and body)


def _takes_away(own: Float1D, theirs: Float1D) -> bool:
    product, size = float(own @ theirs), float(theirs @ theirs)
    if size == 0 or not own.any():
        return False
    return product / np.sqrt(size * float(own @ own)) < OPPOSITE and SHARE[0] <= -product / size <= SHARE[1]
