"""One candidate with its evidence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.weigh.beyond_noise import fall_beyond
from thermodata.diagnosis.weigh.foretold import Looked
from thermodata.plugin import Bool1D, Float1D

if TYPE_CHECKING:
    from thermodata.diagnosis.weigh.evidence import Columns, Weighed

ACTS = 0.2  # of its largest test: less, and a contribution does little there


@dataclass(frozen=True, slots=True)
class Scored:
    """One candidate beside some known effects. evidence: log Bayes factor against these alone. gained: shape (tests,),
    log probability of each test, given the others, that the candidate adds. rows: of each test. sse_before, sse_after:
    squared error of each test, left out whole. own_before, own_after: the same with only the candidate left out: its
    size and times from the other tests, what is known fitted beside it to all. size: RMS of the contribution in each
    test. spread: of its gain between tests. shape: whitened contribution without what the known effects can do, unit
    length. credit: of a member, its log evidence beside the likelier members alone; None for all else. beaten: whether
    another cause that was selected has more evidence a sample. looked: of what might be claimed, what the locked tests
    say; None where they were not opened for it. also_on: (channel, probability there) of each other axis on which it is
    missing too, where that was asked. others: ids of the candidates that it was weighed beside. sides: of a difference,
    the log evidence of each of its two temperatures by itself, in its place; empty for all else. as_modelled: whether
    the known effects acted as the model has them, and were not free to act otherwise. white: RMS of the white noise in
    which it was weighed."""

    candidate: CandidateEffect
    columns: Columns
    weighed: Weighed
    evidence: float
    gained: Float1D
    rows: Float1D
    sse_before: Float1D
    sse_after: Float1D
    own_before: Float1D
    own_after: Float1D
    size: Float1D
    spread: float
    shape: Float1D
    credit: float | None = None
    beaten: bool = False
    looked: Looked | None = None
    also_on: tuple[tuple[str, float], ...] = ()
    others: tuple[str, ...] = ()
    sides: tuple[float, ...] = ()
    as_modelled: bool = False
    white: float = 0.0

    @property
    def acts(self) -> Bool1D:
        """The tests in which it does something, shape (tests,)."""
        return acting(self.size)

    @property
    def error_before(self) -> float:
        """RMS of the tests in which it acts, each alike, its size from the others. A rule of a claim goes by this:
        what a model foretells badly without a test, for no other excites it, says nothing of a candidate."""
        return self._error(self.own_before)

    @property
    def error_after(self) -> float:
        """The same with the candidate."""
        return self._error(self.own_after)

    @property
    def error_of_all(self) -> float:
        """RMS of all tests with it, each left out whole, each alike."""
        return float(np.sqrt(np.mean(self.sse_after / self.rows)))

    @property
    def drop(self) -> float:
        """Fall of that error, as a share of what is more than noise."""
        rows = float(self.rows[self.acts].sum()) if len(self.rows) else 0.0
        return fall_beyond(self.error_before, self.error_after, self.white, rows)

    @property
    def better(self) -> float:
        """Share of the tests in which it acts that it makes more probable."""
        return float(np.mean(self.gained[self.acts] > 0)) if len(self.gained) else 0.0

    def _error(self, sse: Float1D) -> float:
        acts = self.acts
        return float(np.sqrt(np.mean(sse[acts] / self.rows[acts]))) if len(sse) and acts.any() else 0.0


def acting(size: Float1D) -> Bool1D:
    """Where a contribution does something, shape (tests,). size: its RMS in each test."""
    return np.asarray(size >= ACTS * size.max(initial=0.0))
