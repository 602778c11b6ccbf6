"""Residuals beside what chance makes of them: the surrogates of a ranking, as measured and whitened."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.whiten import fit_ar, surrogates, whiten
from thermodata.plugin import Float1D, Float2D


@dataclass(frozen=True, slots=True)
class Chance:
    """ar: shape (order,), common to all tests. series, white: a block each, shape (m, 1 + surrogates), the residual
    first."""

    ar: Float1D
    series: list[Float2D]
    white: list[Float2D]


def chance(problem: Problem, count: int, seed: int) -> Chance:
    """From what the problem keeps, or made: beside a first effect the residuals are the same, and so is chance."""
    kept = problem.kept.setdefault("chance", {})
    if (key := (seed, count)) not in kept:
        rng = np.random.default_rng(seed)
        ar = fit_ar([b.residual for b in problem.blocks])
        series = [np.column_stack([b.residual, surrogates(b.residual, count, rng)]) for b in problem.blocks]
        kept[key] = Chance(ar, series, [whiten(s, ar) for s in series])
    found: Chance = kept[key]
    return found
