"""Four rules set by hand in place of evidence: information, a rich base, invariance, and two kinds of chance.

1. Each test counts alike, in as many samples as are apart by twice the memory of what is left. A candidate's tests are
   those in which it does half of what is left, and a fifth of its most.
2. Known effects have a bank of six time constants under a ridge; gains and time constants of candidates have a prior.
   Candidates, plain lags of every channel among them, are ordered by the error that they leave on left-out tests.
3. The gain of a cause agrees between tests, and locked tests keep half of the fall that left-out tests promise. A fall
   beyond 2.8 times what a candidate does is an extrapolation that it steadies.
4. What dropping a member of the set costs is held against the largest fall of any candidate where nothing is missing.

What the text does not say was chosen on development seeds 40000 and 40001 as what names most there: the geometric mean
of the errors of all tests beside their mean square; a spread of the gain as it is, without what noise makes of it;
samples as they are, not whitened by the slow noise. Other modes of what the base has are no candidates, and
temperatures of castings are rivals that name no cause, as in the diagnosis by evidence.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.question.present import CONTROL
from thermodata.plugin import Bool1D, Float1D

from .asked import Asked
from .beside import STANDS_OUT, Beside, acting, beside, near
from .chance import of_kernels, slow_noise
from .exchanged import derangements, pairs, without_offsets
from .left_out import Fit, Products, Series, joined, likeliest, products, series

# by the text
GAIN_SPREAD = 0.4
STEADIES = 2.8
KEPT = 0.5
P_LIMIT = 0.01
# chosen on development seeds 40000 and 40001
LEAST = 0.05  # a member takes at least this share off the error of left-out tests
SWAPS = 0.01  # another one takes its place that leaves so much less
MOST = 4


@dataclass(frozen=True, slots=True)
class Member:
    """One of the set. number: of the candidate. point: of its grid. cost: share of the left-out error that dropping it
    adds. spread: of its gain between the tests in which it acts; promised: the fall there, in multiples of the square
    of what it does. p_kernels, p_exchanged: None where nothing was drawn. kept: share of the promised fall that the
    locked tests keep; None where it acts in none."""

    number: int
    point: int
    cost: float
    acts: Bool1D
    spread: float
    promised: float
    fell: float
    p_kernels: float | None = None
    p_exchanged: float | None = None
    kept: float | None = None

    @property
    def sound(self) -> bool:
        """Whether rule 3 holds on the open tests."""
        return self.spread <= GAIN_SPREAD and self.promised <= STEADIES and self.cost > 0


@dataclass(frozen=True, slots=True)
class Found:
    """first: numbers of the candidates by the error that they leave beside the base. members: of the set."""

    first: NDArray[np.int64]
    members: tuple[Member, ...]


def claimable(one: CandidateEffect) -> bool:
    """Whether it may be a cause: what a casting's temperature, or the control, goes with is a rival, and names none."""
    return not one.passive and one.family != CONTROL


def found_by_hand(asked: Asked, seed: int = 0) -> Found:
    """What the rules make of the open tests, with chance and the locked tests asked of each member that is sound."""
    alone = beside(asked, [])
    first = np.argsort(-alone.shares(alone.left_out())[:, 0], kind="stable")
    chosen = _selected(asked, alone)
    members = _members(asked, chosen)
    while any(not m.sound for m in members):
        worst = min((i for i, m in enumerate(members) if not m.sound), key=lambda i: members[i].cost)
        chosen.pop(worst)
        members = _members(asked, chosen)
    members = _kept_by_locked(asked, members)
    return Found(first, tuple(_with_chance(asked, m, chosen, seed) for m in members))


def _left(asked: Asked, chosen: Sequence[tuple[int, int]]) -> Float1D:
    """What the base leaves beside what is chosen, shape (rows,)."""
    state = beside(asked, chosen)
    return asked.response - state.base @ state.whole().base[:, 0]


def _selected(asked: Asked, alone: Beside) -> list[tuple[int, int]]:
    """Forward, while the mean square of left-out tests falls too, and after each step it is asked whether another one
    does better in a place."""
    chosen: list[tuple[int, int]] = []
    state, error = alone, float(alone.left_out().before.sum())
    while len(chosen) < MOST:
        best, share = _best(state)
        if share < LEAST:
            break
        more = beside(asked, [*chosen, best])
        left = float(more.left_out().before.sum())
        if left > (1 - LEAST) * error:
            break
        chosen, state, error = _swapped(asked, [*chosen, best], more, left)
    return chosen


def _best(state: Beside) -> tuple[tuple[int, int], float]:
    """((number, point), share of the error that it takes off) of the best candidate."""
    shares = state.shares(state.left_out())[:, 0]
    number = int(shares.argmax())
    point = int(likeliest(state.whole().worth, state.asked.candidates)[number, 0])
    return (number, point), float(shares[number])


def _swapped(
    asked: Asked, chosen: list[tuple[int, int]], state: Beside, error: float
) -> tuple[list[tuple[int, int]], Beside, float]:
    for place in range(len(chosen) - 1):
        best, _ = _best(beside(asked, [*chosen[:place], *chosen[place + 1 :]]))
        if best[0] in {n for n, _ in chosen}:
            continue
        other = [*chosen[:place], best, *chosen[place + 1 :]]
        tried = beside(asked, other)
        left = float(tried.left_out().before.sum())
        if left < (1 - SWAPS) * error:
            chosen, state, error = other, tried, left
    return chosen, state, error


def _members(asked: Asked, chosen: Sequence[tuple[int, int]]) -> list[Member]:
    """Each beside the others."""
    found = []
    for place, (number, _) in enumerate(chosen):
        state = beside(asked, [*chosen[:place], *chosen[place + 1 :]])
        out, whole = state.left_out(), state.whole()
        point = int(likeliest(whole.worth, asked.candidates)[number, 0])
        does, acts = out.does[:, number, 0], acting(out.does[:, number], state.noise)[:, 0]
        fell = (out.before[:, 0] - out.after[:, number, 0])[acts].sum()
        found.append(
            Member(
                number,
                point,
                float(state.shares(out)[number, 0]),
                acts,
                _spread(state, whole, point, acts),
                float(fell / max(does[acts].sum(), 1e-12)),
                float(fell / max(out.before[acts, 0].sum(), 1e-12)),
            )
        )
    return found


def _spread(state: Beside, whole: Fit, point: int, acts: Bool1D) -> float:
    """Standard deviation of the gain between the tests in which a candidate acts, as a share of its mean: each test has
    a factor of its own, the base is fitted beside all, and what noise makes of the factors is taken off."""
    if acts.sum() < 2:
        return 0.0
    a, made, w = whole.own[point, :, 0], state.made, state.weight
    cross = np.einsum("t,c,tck->tk", w, a, made.cross[:, point])
    own = w * np.einsum("c,tcd,d->t", a, made.own[:, point], a)
    right = w * np.einsum("c,tc->t", a, state.own.own[:, point, :, 0])
    sure = np.linalg.inv(np.tensordot(w, made.base, 1) + np.diag(state.ridge))
    left = np.diag(own) - cross @ sure @ cross.T + 1e-9 * np.diag(own + 1e-12) + 1e-12 * np.eye(len(own))
    factor = np.linalg.solve(left, right - cross @ sure @ np.tensordot(w, state.own.base[:, :, 0], 1))
    noise = np.diag(np.linalg.inv(left))[acts]
    some, told = factor[acts], 1 / noise
    mean = float(np.average(some, weights=told))
    between = float(np.average((some - mean) ** 2, weights=told))
    return float(np.sqrt(max(between, 0.0))) / max(abs(mean), 1e-9)


def _kept_by_locked(asked: Asked, members: Sequence[Member]) -> list[Member]:
    """What the locked tests keep of the promised fall of each, beside the others."""
    if not asked.locked:
        return list(members)
    ends = np.cumsum([0, *(b.size for b in asked.locked)])
    parts = [slice(a, b) for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)]
    response = np.concatenate([b.response for b in asked.locked])
    found = []
    for member in members:
        others = [(m.number, m.point) for m in members if m is not member]
        state = beside(asked, others)
        whole = state.whole()
        points = [p for c in others for p in range(near(asked, *c).start, near(asked, *c).stop)]
        base = np.hstack([asked.base_locked, *(asked.in_locked(p) for p in points)])
        own, a = asked.in_locked(member.point), whole.own[member.point, :, 0]
        alone = response - base @ whole.base[:, 0]
        with_it = alone + base @ (a @ whole.pulled[member.point]) - own @ a
        means = [np.array([np.mean(x[r] ** 2) for r in parts]) for x in (alone, with_it, own @ a)]
        acts = means[2] >= (STANDS_OUT * state.noise) ** 2
        if not acts.any():
            found.append(member)
            continue
        fell = 1 - float(means[1][acts].sum() / means[0][acts].sum())
        found.append(replace(member, kept=fell / max(member.fell, 1e-9)))
    return found


def _with_chance(asked: Asked, member: Member, chosen: Sequence[tuple[int, int]], seed: int) -> Member:
    """The largest fall of any candidate where nothing is missing beside the others."""
    rng = np.random.default_rng(seed)
    state = beside(asked, [c for c in chosen if c[0] != member.number])
    drawn = of_kernels(asked, slow_noise(asked.problem.blocks, _left(asked, chosen)), rng)
    by_others = state.whole().base[asked.base.shape[1] :, 0]
    drawn += (state.base[:, asked.base.shape[1] :] @ by_others)[:, None]
    bank = asked.candidates.bank
    chance = state.shares(state.left_out(of=series(state.base, bank, drawn, asked.problem.parts))).max(axis=0)
    mixed = np.array([state.shares(state.left_out(*one))[:, 0].max() for one in _exchanged(state, rng)])
    return replace(member, p_kernels=_p(member.cost, chance), p_exchanged=_p(member.cost, mixed))


def _exchanged(state: Beside, rng: np.random.Generator) -> Iterator[tuple[Products, Series]]:
    """What is left of one test, put into another: each order of the tests as products."""
    bank = state.asked.candidates.bank
    k, shape = state.base.shape[1], bank.shape[1:]
    problem, explained = state.asked.problem, state.base @ state.whole().base[:, 0]
    columns = np.hstack([state.base, bank.reshape(len(bank), -1)])
    pair = pairs(problem, columns, explained, without_offsets(problem.blocks))

    @cache
    def of(test: int, other: int) -> tuple[Products, Series]:
        both, response = pair(test, other)
        base, own, rows = both[:, :k], both[:, k:].reshape(len(both), *shape), [slice(0, len(both))]
        return products(base, own, rows), series(base, own, response[:, None], rows)

    for order in derangements(len(problem.blocks), rng):
        made, drawn = zip(*(of(i, j) for i, j in enumerate(order.tolist())), strict=True)
        yield joined(made), joined(drawn)


def _p(cost: float, chance: Float1D) -> float:
    return float((1 + np.sum(chance >= cost)) / (len(chance) + 1))
