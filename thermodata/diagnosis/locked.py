"""What the whole set foretells of the locked tests, and what it would foretell without its claims.

The open tests alone choose and estimate; noise, time constants and gains come from them. Where several effects are
missing, one alone says little there, so the claims are asked beside all that was selected with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.discrepancy import Noise
from thermodata.diagnosis.evidence import columns, moments, weigh
from thermodata.diagnosis.known import Known, known
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.diagnosis.selection import extended
from thermodata.plugin import Float1D, Int1D

KEPT = 0.5  # share of what is added that must take away as much of the squared error as it is itself,
LEAST = 0.02  # and the least fall of the error: it never rises;
MUCH = 0.25  # a fall of the error that is enough by itself


@dataclass(frozen=True, slots=True)
class Foretold:
    """RMS on the locked tests, a free offset a test, in the response's unit. changed: of what the claims change."""

    before: float
    after: float
    changed: float

    @property
    def holds(self) -> bool:
        """Whether the error falls by what a cause would take away. What a cause adds is not to be found in what is left
        afterwards, so the squared error falls by the square of what is added; a proxy's falls by less."""
        keeps = self.before**2 - self.after**2 >= KEPT * self.changed**2
        return self.after < (1 - LEAST) * self.before and (keeps or self.after < (1 - MUCH) * self.before)


def foretell(problem: Problem, opened: int, noise: Noise, kept: Sequence[Scored], claims: Sequence[Scored]) -> Foretold:
    """problem: the first `opened` blocks are of open tests, the others of locked ones. kept: what is selected beside
    the claims."""
    tests, locked = np.arange(opened), range(opened, len(problem.blocks))
    without = _left(_with(problem, tests, noise, kept), tests, noise, locked)
    among = _left(_with(problem, tests, noise, [*kept, *claims]), tests, noise, locked)
    return Foretold(_rms(without), _rms(among), _rms([a - b for a, b in zip(without, among, strict=True)]))


def _with(problem: Problem, tests: Int1D, noise: Noise, chosen: Sequence[Scored]) -> Problem:
    """Each effect as the open tests have it, beside those before it."""
    for one in chosen:
        made = columns(problem, one.candidate)
        if made is None:
            continue
        base = known(problem, noise)
        weighed = weigh(base, made, moments(base, made), tests)
        problem = extended(problem, made, weighed)
    return problem


def _left(problem: Problem, tests: Int1D, noise: Noise, locked: Sequence[int]) -> list[Float1D]:
    base: Known = known(problem, noise)
    theta = base.mean(tests)
    return [_one(problem, i, theta) for i in locked]


def _one(problem: Problem, test: int, theta: Float1D) -> Float1D:
    block = problem.blocks[test]
    return np.asarray(block.response - np.hstack([block.base, block.slack]) @ theta)


def _rms(parts: Sequence[Float1D]) -> float:
    return float(np.sqrt(np.mean(np.concatenate([p - p.mean() for p in parts]) ** 2)))
