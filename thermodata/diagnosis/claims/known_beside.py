"""What each known effect of a model is worth, what it does, and how alike a candidate acts: what a refinement is told
by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.question.discrepancy import Noise
from thermodata.diagnosis.question.known import known
from thermodata.diagnosis.question.known_effects import owners
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D, Int1D

ALONE = 1e-4  # a column that the others make but for this share says nothing of its own


class KnownEffects:
    """Of a response, in the noise beside all members of a selection. term: the place of an effect in its model."""

    def __init__(self, fitted: FittedResponse, problem: Problem, noise: Noise) -> None:
        self.fitted, self.problem, self.noise = fitted, problem, noise
        self.owners = tuple(np.array(o, dtype=np.int64) for o in owners(fitted))
        self._worth: dict[int, float] = {}

    def worth(self, term: int) -> float:
        """Log evidence of a known effect beside the others alone."""
        if term not in self._worth:
            self._worth[term] = self.cost(self.problem, term)
        return self._worth[term]

    def cost(self, problem: Problem, term: int) -> float:
        """Log evidence that dropping a known effect costs."""
        return known(problem, self.noise).log_evidence - known(self.without(problem, term), self.noise).log_evidence

    def without(self, problem: Problem, term: int) -> Problem:
        """A problem without the columns of a known effect; what was added to it stays."""
        base, spare = (_columns_of_others(o, term) for o in self.owners)
        blocks = []
        for b in problem.blocks:
            added = np.arange(len(self.owners[0]), b.base.shape[1]), np.arange(len(self.owners[1]), b.slack.shape[1])
            blocks.append(
                replace(
                    b,
                    base=b.base[:, np.concatenate([base, added[0]])],
                    slack=b.slack[:, np.concatenate([spare, added[1]])],
                )
            )
        return replace(problem, blocks=tuple(blocks))

    def likeness(self, scored: Scored, term: int) -> float:
        """Cosine, without sign, of what the candidate and a known effect do."""
        own = scored.columns.does(scored.weighed)
        theirs = np.concatenate([self.contribution(b, term) for b in self.problem.blocks])
        size = float(np.linalg.norm(own) * np.linalg.norm(theirs))
        return abs(float(own @ theirs)) / size if size > 0 else 0.0

    def share_of(self, scored: Scored, term: int) -> float:
        """How much of the square of what a candidate does the columns of a known effect make, one gain each: 0 to 1."""
        does, own, theirs = scored.columns.does(scored.weighed), [], []
        for block, rows in zip(self.problem.blocks, self.problem.parts, strict=True):
            if not does[rows].any():  # where its channel is not logged nothing is known of it
                continue
            known_to_act = [
                c[:, : len(o)][:, o == term] for c, o in zip((block.base, block.slack), self.owners, strict=True)
            ]
            columns = np.column_stack(known_to_act)
            own.append(does[rows] - does[rows].mean())
            theirs.append(columns - columns.mean(axis=0))
        if not own:
            return 0.0
        y, x = np.concatenate(own), np.concatenate(theirs)
        size = np.linalg.norm(x, axis=0)
        x = x[:, size > 0] / size[size > 0]
        left = y - x @ np.linalg.lstsq(x, y, rcond=ALONE)[0]
        return 1.0 - float(left @ left) / float(y @ y)

    def contribution(self, block: Block, term: int) -> Float1D:
        """What a known effect does in a test, as fitted, in the response's unit, shape (m,)."""
        gains = len(self.fitted.terms[term].effect.gains)
        own = np.flatnonzero(self.owners[0] == term)[:gains]
        return np.asarray(block.base[:, own].sum(axis=1))

    def size(self, term: int) -> float:
        """RMS of what a known effect does, as fitted, in its largest test, in the response's unit."""
        return max(rms([self.contribution(b, term)]) for b in self.problem.blocks)


def _columns_of_others(owned: Int1D, term: int) -> Int1D:
    return np.flatnonzero(owned != term)
