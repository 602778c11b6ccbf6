"""What a diagnosis can't exclude: how large each effect of the library would have to be before it were claimed.

What moves with a known effect is taken for it, however large it is. Beside what is known, a contribution a c leaves

    log evidence = a^2 c'P c / 2 - what the choice among points and sizes costs,

where P takes out of the whitened c what the known effects can do. The least a that the rules of a claim ask, evidence a
sample and what it explains, is its limit of detection [currie1968]. It is one of the open tests and of the noise that
they have: a better test lowers it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.kin import refines
from thermodata.diagnosis.claims.probability import sharpness_asked
from thermodata.diagnosis.claims.rules import STRONG, WORTH_SHARE, WORTH_SIZE
from thermodata.diagnosis.question.known import Known
from thermodata.diagnosis.question.present import CONTROL, GENERIC
from thermodata.diagnosis.weigh.evidence import Columns, beyond_known, each_of_all
from thermodata.diagnosis.weigh.scored import ACTS
from thermodata.plugin import Int1D

CHOICE = 6.0  # log evidence that the choice among 50 points and sizes costs, and the width of the gain
LEAST_BEYOND = 1e-4  # of its energy: less beyond the known effects, and no size shows
LARGE = 1 / 3  # of the response: an effect that would have to be larger to be seen is worth a word
SELECTED = -1  # the owner of what is none of the model's
HIDES = 0.5  # of its energy, at most, is left beyond the known effects of what they hide


@dataclass(frozen=True, slots=True)
class Limit:
    """least: RMS where it acts, in the response's unit; inf where no size would show. beyond: share of its energy,
    whitened, that the known effects can't do. like: number of the known effect that is most like it."""

    candidate: CandidateEffect
    least: float
    beyond: float
    like: int | None

    @property
    def hides(self) -> bool:
        """Whether a known effect takes it for its own; else slow noise covers it."""
        return self.like is not None and self.beyond < HIDES


def limits(known: Known, pool: Sequence[Columns], spread: float, owners: Int1D) -> list[Limit]:
    """Of each effect with a name that the model lacks, the median over its time constants, the largest first. known:
    beside all that was selected, in the noise that is left. spread: RMS of the response. owners: of each known column,
    the number of its effect (-1: none of the model's). What was selected, or is most like it, is told by that."""
    found = [
        limit
        for one in pool
        if one.candidate.kin in (None, "near", "related") and has_a_name(one.candidate)
        if (limit := _limit(known, one, spread, owners)) is not None
    ]
    return sorted(found, key=lambda one: -one.least)


def of_each_effect(limits: Sequence[Limit]) -> list[Limit]:
    """Of each effect and family the sensor that shows it best, as the answer tells them; the largest first."""
    best = {
        (one.candidate.effect.name, one.candidate.family): one for one in sorted(limits, key=lambda one: -one.least)
    }
    return sorted(best.values(), key=lambda one: -one.least)


def has_a_name(candidate: CandidateEffect) -> bool:
    """A cause of the library, and no mode of another one."""
    return candidate.family not in (GENERIC, CONTROL) and not refines(candidate.effect) and not candidate.within


def _limit(known: Known, one: Columns, spread: float, owners: Int1D) -> Limit | None:
    (products,) = each_of_all(known, [one])
    left, _ = beyond_known(known, products, known.every)
    gains = one.gains
    own = np.einsum("pcc->pc", products.own)[:, :gains].mean(axis=1)
    beyond = np.clip(np.einsum("pcc->pc", left)[:, :gains].mean(axis=1), 0.0, None)
    squares = [np.mean(one.whole[rows, :, :gains] ** 2, axis=(0, 2)) for rows in known.space.parts]
    sizes = np.sqrt(squares)  # (tests, points)
    moved = (own > 0) & (sizes.max(axis=0) > 0)
    if not moved.any():
        return None
    found: list[tuple[float, float]] = []
    rows = known.problem.rows
    for point in np.flatnonzero(moved):
        acts = sizes[:, point] >= ACTS * sizes[:, point].max()
        size = float(np.sqrt(np.mean(sizes[acts, point] ** 2)))
        share = float(beyond[point] / own[point])
        if share < LEAST_BEYOND:
            found.append((np.inf, share))
            continue
        sure = np.sqrt(2 * (sharpness_asked(0.0, one.candidate) * rows + CHOICE) / beyond[point])
        plain = np.sqrt(2 * (STRONG * rows + CHOICE) / beyond[point])
        worth = WORTH_SHARE * spread / (size * np.sqrt(share))
        found.append((max(size * sure, min(size * worth, size * plain, WORTH_SIZE * spread)), share))
    found.sort()
    least, share = found[len(found) // 2]
    middle = int(np.flatnonzero(moved)[np.argsort(beyond[moved] / own[moved])[moved.sum() // 2]])
    like = _most_like(known, one, middle, owners)
    if like == SELECTED:
        return None if share < HIDES else Limit(one.candidate, least, share, None)
    return Limit(one.candidate, least, share, like)


def _most_like(known: Known, one: Columns, point: int, owners: Int1D) -> int | None:
    """The known effect that alone can do most of it, or what was selected."""
    white = known.space.of(one.whole[:, point, :1])[:, 0]
    energy, cross_of_all = float(white @ white), known.white.T @ white
    best: tuple[float, int] | None = None
    for number in sorted({int(o) for o in owners}):
        mine = np.flatnonzero(owners == number)
        gram = known.gram[:, mine][:, :, mine].sum(axis=0) + np.diag(known.precision[mine])
        cross = cross_of_all[mine]
        does = float(cross @ np.linalg.solve(gram, cross)) / max(energy, 1e-300)
        if best is None or does > best[0]:
            best = does, number
    return None if best is None else best[1]
