"""Signals that a log writes at a steady beat, whether they change or not: where one is silent, nobody measured it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermodata.plugin import Array, Bool1D, Float1D, Int1D

_FEWEST = 30  # rows by which a beat is known
_STEADY = 0.95  # of the steps are as long as the usual one, by half of it
_AGAIN = 0.01  # of the rows write the value that stands: a log of changes writes none, but for the first of a session
_TURNS = 0.25  # of the steps turn back, as noise does and no axis that moves
_PAUSES = 2  # of a noisy signal: more are the rests of something that stands
_MISSED = 10  # steps without a row end a value


@dataclass(frozen=True, slots=True)
class Beat:
    """limit_ns: how long a value stands; rests: it may rest at 0 for longer, as a spindle does, for nothing shows that
    it is written without a change."""

    limit_ns: int
    rests: bool

    def ended(self, values: Array, age_ns: Int1D) -> Bool1D:
        """Where a value has stood for too long; values, age_ns: shape (n,)."""
        old: Bool1D = age_ns > self.limit_ns
        return old & (values != 0) if self.rests else old


def beat_of(t_ns: Int1D, texts: Sequence[str], numbers: Float1D) -> Beat | None:
    """The beat of a signal by its rows; None where it may be written on change. t_ns: shape (n,), in the order of the
    log; texts: its values; numbers: shape (n,), the same, NaN where one is none."""
    steps = np.diff(t_ns)
    forward = steps[steps > 0]
    if forward.size < _FEWEST - 1 or forward.size < _STEADY * steps.size:
        return None
    usual = int(np.median(forward))
    if (np.abs(forward - usual) <= usual / 2).mean() < _STEADY:
        return None
    again = sum(a == b for a, b in pairwise(texts))
    if again >= max(3, _AGAIN * len(texts)):
        return Beat(_MISSED * usual, rests=False)
    noisy = _turns(numbers) and int((forward > _MISSED * usual).sum()) <= _PAUSES
    return Beat(_MISSED * usual, rests=True) if noisy else None


def _turns(numbers: Float1D) -> bool:
    steps = np.diff(numbers[np.isfinite(numbers)])
    return bool(steps.size > 1 and (steps[1:] * steps[:-1] < 0).mean() >= _TURNS)
