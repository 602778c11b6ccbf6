"""What chance makes of a response in which nothing is missing: kernels drawn at random, and slow noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.question.problem import Block
from thermodata.plugin import Float1D, Float2D

from .asked import Asked

DRAWS = 99  # of each kind; the smallest p is 1 %
MEMORY_S = (600.0, 96 * 3600.0)
LAGS = 40  # over which the memory of what is left is looked for, in samples


@dataclass(frozen=True, slots=True)
class SlowNoise:
    """white, slow: standard deviations in the response's unit. tau_s: memory of the slow one."""

    white: float
    slow: float
    tau_s: float


def slow_noise(blocks: Sequence[Block], left: Float1D) -> SlowNoise:
    """Of what a fit leaves, shape (rows,): white is what neighbours do not share, and the memory is where the rest has
    fallen by e."""
    parts = np.split(left, np.cumsum([b.size for b in blocks])[:-1])
    step = float(np.median(np.concatenate([np.diff(b.t_s) for b in blocks])))
    total = float(np.mean(left**2))
    apart = np.array([_apart(parts, lag) for lag in range(1, LAGS + 1)])
    shared = np.maximum(total - apart / 2, 1e-3 * total)
    slow = float(np.clip(2 * shared[0] - shared[1], 1e-3 * total, total))
    below = np.flatnonzero(shared < slow / np.e)
    memory = step * (int(below[0]) + 1 if below.size else 2 * LAGS)
    return SlowNoise(np.sqrt(max(total - slow, 1e-3 * total)), np.sqrt(slow), float(np.clip(memory, *MEMORY_S)))


def _apart(parts: Sequence[Float1D], lag: int) -> float:
    """Mean square of the differences of samples so many apart."""
    found = np.concatenate([p[lag:] - p[:-lag] for p in parts])
    return float(np.mean(found**2)) if len(found) else 0.0


def of_kernels(asked: Asked, noise: SlowNoise, rng: np.random.Generator) -> Float2D:
    """The base's drivers through kernels drawn at random, and noise, shape (rows, DRAWS)."""
    total = np.zeros((len(asked.response), DRAWS))
    for one in asked.kernels:
        share = rng.gamma(0.5, size=(one.shape[1], DRAWS))
        total += one @ (share / share.sum(axis=0))
    drawn = np.concatenate([_drawn(b, noise, rng) for b in asked.problem.blocks])
    return total + drawn


def _drawn(block: Block, noise: SlowNoise, rng: np.random.Generator) -> Float2D:
    slow = noise.slow * rng.standard_normal((block.size, DRAWS))
    kept = np.exp(-np.diff(block.t_s) / noise.tau_s)
    for i, a in enumerate(kept.tolist(), 1):
        slow[i] = a * slow[i - 1] + np.sqrt(1 - a * a) * slow[i]
    return block.freed(slow + noise.white * rng.standard_normal(slow.shape))
