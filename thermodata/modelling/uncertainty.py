"""How sure the parameters are, with residuals that hang together (840 samples can be worth 14)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermodata.modelling.search import Problem
from thermodata.modelling.slow_noise import scatter
from thermodata.modelling.start_unknown import disturbances
from thermodata.plugin import Float1D

_LONGEST = 0.25  # of a test; a longer memory cannot be told from a trend


@dataclass(frozen=True)
class Spread:
    """Of a slot's parameters and gains, by name. sd: standard deviation; half: half of the interval of 95 %. What is
    searched as a logarithm has those of log(value). Parameters at a bound and held gains have none."""

    sd: dict[str, float] = field(default_factory=dict)
    half: dict[str, float] = field(default_factory=dict)


def spreads(problem: Problem, x: Float1D, gains: Float1D) -> tuple[list[Spread], frozenset[str]]:
    """One a slot, and the names that are searched as logarithms."""
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
    by_slot = [Spread() for _ in design.slots]
    logs = frozenset(f.param.name for f in problem.free if f.log)
    if not columns or design.n <= len(columns):
        return by_slot, logs
    unknown = disturbances(design, problem.params(x), gains, problem.starts)
    found = scatter(np.column_stack(columns), residual, design.parts, unknown)
    for (slots, name), sd, half in zip(owners, found.sd, found.half, strict=True):
        if np.isfinite(sd) and np.isfinite(half):
            for s in slots:
                by_slot[s].sd[name], by_slot[s].half[name] = float(sd), float(half)
    return by_slot, logs


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
