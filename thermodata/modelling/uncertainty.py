"""How sure the parameters are, with residuals that hang together (840 samples can be worth 14)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.modelling.search import Problem
from thermodata.plugin import Float1D, Float2D

_LONGEST = 0.25  # of a test; a longer memory cannot be told from a trend


@dataclass(frozen=True)
class Cover:
    """How the parameters of a fit spread together. owners: (slots, name), shape k; matrix: covariance, shape (k, k), of
    log(value) for names that are searched as logarithms."""

    owners: tuple[tuple[tuple[int, ...], str], ...]
    matrix: Float2D


def deviations(
    problem: Problem, x: Float1D, gains: Float1D
) -> tuple[list[dict[str, float]], frozenset[str], Cover | None]:
    """Standard deviations a slot by name, the names that are searched as logarithms (theirs is of log(value)), and all
    of them with their correlations; None where there is none.

    [newey1987] with a Bartlett window as long as twice the residual's own memory, a test by itself.
    Parameters at a bound and held gains have none.
    """
    design = problem.design
    matrix = problem.matrix(x)
    residual = design.y - matrix @ gains
    columns: list[Float1D] = []
    owners: list[tuple[tuple[int, ...], str]] = []
    for i, nonlinear in enumerate(problem.free):
        low, high = nonlinear.outside(nonlinear.lower), nonlinear.outside(nonlinear.upper)
        delta = 1e-4 * (high - low)
        if not low + 10 * delta < x[i] < high - 10 * delta:
            continue
        trial = x.copy()
        trial[i] += delta
        columns.append((problem.matrix(trial) - matrix) @ gains / delta)
        owners.append((nonlinear.slots, nonlinear.param.name))
    for s, slot in enumerate(design.slots):
        for j, gain in enumerate(design.terms[slot.term].effect.gains):
            k = problem.starts[s] + j
            if problem.low[k] < gains[k] < problem.high[k]:
                columns.append(matrix[:, k])
                owners.append(((s,), gain.name))
    by_slot: list[dict[str, float]] = [{} for _ in design.slots]
    logs = frozenset(f.param.name for f in problem.free if f.log)
    if not columns or design.n <= len(columns):
        return by_slot, logs, None
    cover = _robust(np.column_stack(columns), residual, design.parts)
    sds = np.sqrt(np.maximum(np.diag(cover), 0.0))
    for (slots, name), sd in zip(owners, sds, strict=True):
        if np.isfinite(sd):
            for s in slots:
                by_slot[s][name] = float(sd)
    known = bool(np.isfinite(cover).all())
    return by_slot, logs, Cover(tuple(owners), cover) if known else None


def memory(residual: Float1D, parts: list[slice]) -> float:
    """Integrated autocorrelation time in samples: 1 + 2 sum(rho), to the first rho below 0.05; all tests together."""
    return max(1.0, 1.0 + 2.0 * float(_correlations(residual, parts).sum()))


def effective_count(residual: Float1D, parts: list[slice]) -> float:
    """How many independent samples the residual is worth."""
    return len(residual) / memory(residual, parts) if len(residual) else 0.0


def _correlations(residual: Float1D, parts: list[slice]) -> Float1D:
    longest = max((p.stop - p.start for p in parts), default=0)
    if longest < 4:
        return np.zeros(0)
    size = int(2 ** np.ceil(np.log2(2 * longest)))
    spectrum = np.zeros(size // 2 + 1)
    for part in parts:
        spectrum += np.abs(np.fft.rfft(residual[part], size)) ** 2
    cover = np.fft.irfft(spectrum, size)[: int(longest * _LONGEST) + 1]
    if cover[0] <= 0:
        return np.zeros(0)
    rho = cover[1:] / cover[0]
    below = np.flatnonzero(rho < 0.05)
    return np.asarray(rho[: below[0]] if len(below) else rho)


def _robust(jacobian: Float2D, residual: Float1D, parts: list[slice]) -> Float2D:
    size = np.sqrt(np.sum(jacobian**2, axis=0))
    size[size == 0] = 1.0
    unit = jacobian / size
    bread = np.linalg.pinv(unit.T @ unit, rcond=1e-12)
    scores = unit * residual[:, None]
    span_of_memory = memory(residual, parts)
    width = int(np.ceil(2 * span_of_memory))
    meat = np.zeros((len(size), len(size)))
    for part in parts:
        own = scores[part]
        if len(own):
            # the Bartlett-weighted sum of lagged products is the mean product of moving sums
            span = max(1, min(width, len(own)))
            total = np.cumsum(
                np.concatenate([np.zeros((span, own.shape[1])), own, np.zeros((span - 1, own.shape[1]))]), axis=0
            )
            moving = total[span:] - total[:-span]
            meat += moving.T @ moving / span
    n, k = jacobian.shape
    # what the window cuts off (a quarter, were the correlation exponential), and what k parameters and a free mean
    # a test take out of n / memory independent samples; without these, 95 % intervals hold the truth in 80 %
    free = n / span_of_memory
    lost = 1.0 - span_of_memory / (2 * max(width, 1)) if span_of_memory > 1.5 else 1.0
    cover = bread @ meat @ bread / lost * free / max(0.25 * free, free - k - len(parts))
    return np.asarray(cover / np.outer(size, size), dtype=np.float64)
