"""Ranks the candidates: the fall of the error on left-out tests, as measured and whitened, against surrogates.

Source of the rule (docs/method.md#ranking): 36 simulated machines, where the sum of both ranks put the right effect
first in 86 % (correlation with the residual: 44 %). The p value is that of the largest statistic: [westfall1993].
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.basis import basis
from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.diagnosis.chance import chance
from thermodata.diagnosis.cross_validation import Engine, Priors
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.diagnosis.whiten import whiten
from thermodata.plugin import Float1D, Float2D
from thermodata.store.base.counting import counted

SURROGATES = 199
# autocorrelated residuals are worth far fewer samples than they have; the prior of a gain is scaled so
PRIOR_SAMPLES = 30.0
# how far a known effect may move from its fit where the tests of a fold say nothing (prior standard deviation, as a
# share): an effect that only the left-out test excites must not run away
BASE_SHARE = 1.0
# how much of a known effect may act with another time constant (prior standard deviation)
SLACK_SHARE = 0.5
# a contribution may be this many times as large as the response
LARGEST_TIMES = 3.0


def rank(problem: Problem, candidates: Sequence[CandidateEffect], seed: int = 0) -> list[Scored]:
    """Best first. Needs at least two tests; an empty list otherwise."""
    if len(problem.blocks) < 2 or not candidates:
        return []
    # thousands of small products: threads of the linear algebra library would wait for each other
    with threadpool_limits(1):
        return _rank(problem, candidates, seed)


def _rank(problem: Problem, candidates: Sequence[CandidateEffect], seed: int) -> list[Scored]:
    by_chance = chance(problem, SURROGATES, seed)
    ar, series, white_series = by_chance.ar, by_chance.series, by_chance.white
    noise_var = float(np.mean(np.concatenate([b.residual for b in problem.blocks]) ** 2)) * PRIOR_SAMPLES
    base = [np.hstack([b.base, b.slack]) for b in problem.blocks]
    first = problem.blocks[0]
    price = np.repeat([BASE_SHARE**-2, SLACK_SHARE**-2], [first.base.shape[1], first.slack.shape[1]])
    raw = Engine(base, series, noise_var, price)
    alone = raw.without_surrogates()
    white_var = float(np.mean(np.concatenate([w[:, 0] for w in white_series]) ** 2)) * PRIOR_SAMPLES
    white = Engine([whiten(b, ar) for b in base], white_series, white_var, price)

    largest = max(float(np.abs(y).max()) for y in problem.response_blocks)
    scored: list[Scored] = []
    top_raw = np.full(SURROGATES, -np.inf)
    top_white = np.full(SURROGATES, -np.inf)
    for candidate in counted(candidates, "candidates"):
        own = basis(problem, candidate)
        columns = own.plain
        if not any(np.ptp(c) > 0 for c in columns[own.middle]):
            continue
        priors = _no_larger_than(candidate.priors, columns, largest)
        if ways := len(candidate.slack_params(own.points[0])):
            rough = alone.score(columns, priors)
            columns, priors = own.extended(rough.gains), _with_slack(priors, ways)
        plain = raw.score(columns, priors)
        whitened = white.score([[whiten(c, ar) for c in point] for point in columns], priors)
        top_raw = np.maximum(top_raw, plain.relative[1:])
        top_white = np.maximum(top_white, whitened.relative[1:])
        shape, size = _shape(raw, columns[plain.best], plain.gain)
        scored.append(
            Scored(
                candidate,
                own.points[plain.best],
                plain.gain[: len(candidate.effect.gains)],
                float(plain.relative[0]),
                float(whitened.relative[0]),
                1.0,
                plain.before[:, 0],
                plain.after[:, 0],
                shape,
                size,
            )
        )
    return _order(scored, top_raw, top_white)


def _no_larger_than(priors: Priors, columns: list[list[Float2D]], largest: float) -> Priors:
    """Bounds that also keep a contribution from being larger than the whole response: huge terms that cancel are not
    physics, and a gain without a plausible magnitude of its own needs some bound."""
    reach = np.max([np.abs(np.vstack(point)).max(axis=0) for point in columns], axis=0)
    cap = LARGEST_TIMES * largest / np.maximum(reach, 1e-300)
    return Priors(np.minimum(priors.spread, cap), np.maximum(priors.lower, -cap), np.minimum(priors.upper, cap))


def _with_slack(priors: Priors, ways: int) -> Priors:
    """A candidate may act as distributed as the known effects may: by a share of what its gains alone explain."""
    share, free = np.full(ways, SLACK_SHARE), np.full(ways, np.inf)
    return Priors(
        np.concatenate([priors.spread, share]),
        np.concatenate([priors.lower, -free]),
        np.concatenate([priors.upper, free]),
    )


def _shape(engine: Engine, columns: Sequence[Float2D], gain: Float1D) -> tuple[Float1D, float]:
    whole = np.concatenate([c @ gain for c in columns])
    base = np.vstack(engine.base)
    u = engine.total.inverse @ (base.T @ whole)
    left = whole - base @ u
    length = float(np.linalg.norm(left))
    return left / length if length > 0 else left, float(np.sqrt(np.mean(whole**2)))


def _order(scored: list[Scored], top_raw: Float1D, top_white: Float1D) -> list[Scored]:
    from dataclasses import replace

    if not scored:
        return []
    by_raw = np.argsort(np.argsort([-s.drop for s in scored]))
    by_white = np.argsort(np.argsort([-s.white_drop for s in scored]))
    count = len(top_raw) + 1
    result = []
    for i, s in enumerate(scored):
        raw_p = (1 + np.sum(top_raw >= s.drop)) / count
        white_p = (1 + np.sum(top_white >= s.white_drop)) / count
        # two looks at one question: the better one counts, doubled
        p_value = float(min(1.0, 2 * min(raw_p, white_p)))
        result.append(replace(s, order=float(by_raw[i] + by_white[i] + 0.01 * by_raw[i]), p_value=p_value))
    return sorted(result, key=lambda s: s.order)
