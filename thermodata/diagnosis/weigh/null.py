"""What chance makes of the same question: responses in which nothing is missing, and the best candidate of each.

A null response is what the known effects do, each through a response drawn at random from its prior (other time
constants, the air), plus slow noise and white noise as they were estimated. On each the *best* of all candidates is
kept, so that the p value is against the maximum over everything that was tried [westfall1993].
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.question.known import Known
from thermodata.diagnosis.weigh.evidence import Columns, explained, of_each_series
from thermodata.plugin import Float1D, Float2D

DRAWS = 199  # the smallest p is 0.5 %


def best_of_chance(known: Known, pool: Sequence[Columns], seed: int = 0) -> Float1D:
    """The largest evidence of any candidate on each null response, sorted, shape (`DRAWS`,)."""
    series = _drawn_responses(known, np.random.default_rng(seed))
    already, best = explained(known, series), np.full(DRAWS, -np.inf)
    for one in pool:
        np.maximum(best, of_each_series(known, one, series, already) - one.candidate.log_prior, out=best)
    return np.sort(best)


def p_value(evidence: float, chance: Float1D) -> float:
    """Share of null responses on which chance does as well, the response itself counted among them."""
    return float((1 + np.sum(chance >= evidence)) / (len(chance) + 1))


def in_words(evidence: float, chance: Float1D) -> str:
    """That share, in words; where chance never did as well it is no more than the smallest share that so many tell."""
    share = f"{100 * p_value(evidence, chance):.1f} %"
    none = not np.any(chance >= evidence)
    return f"chance does as well in {'at most ' if none else ''}{share} of responses in which nothing is missing"


def _drawn_responses(known: Known, rng: np.random.Generator) -> Float2D:
    """Whitened, of all tests, shape (rows, DRAWS)."""
    mean = known.mean(known.every)
    # gains as fitted: what is free would be fitted again; how the effects act otherwise, drawn
    loose = np.where(known.precision >= 1.0, known.precision, np.inf)
    drawn = mean[:, None] + rng.standard_normal((len(mean), DRAWS)) / np.sqrt(loose)[:, None]
    return np.asarray(known.white @ drawn + known.space.projected(rng.standard_normal((len(known.white), DRAWS))))
