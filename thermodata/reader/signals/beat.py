"""Signals that a log writes at a steady beat, whether they change or not: where one is silent, nobody measured it.

A server that writes on change may write what rests again now and then, to show that it lives: such heartbeats are the
beat of the rest, however short the steps of what moves are.
"""

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
_HEARTBEATS = 3  # equal rests that end with the value that they began with are more than chance


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
    limit = _MISSED * usual
    again = np.array([a == b for a, b in pairwise(texts)]) & (steps > 0)
    if (heartbeat := _heartbeat(steps, again, texts, limit)) is not None:
        return Beat(_MISSED * heartbeat, rests=False)
    sooner = steps[again & (steps <= limit)]
    if sooner.size >= max(3, _AGAIN * len(texts)):
        return Beat(_MISSED * int(np.median(sooner)), rests=False)
    noisy = _turns_back_often(numbers) and int((forward > limit).sum()) <= _PAUSES
    return Beat(limit, rests=True) if noisy else None


def _heartbeat(steps: Int1D, again: Bool1D, texts: Sequence[str], limit_ns: int) -> int | None:
    """The time [ns] after which a value that rests is written again, None where none is: one that is written again
    sooner, too, was lost meanwhile. steps, again: shape (n - 1,), those between the n texts, and where a value comes
    again."""
    late = again & (steps > limit_ns)
    if late.sum() < _HEARTBEATS:
        return None
    heartbeat = int(np.median(steps[late]))
    resting = {texts[k] for k in np.flatnonzero(late).tolist()}
    sooner = sum(texts[k] in resting for k in np.flatnonzero(again & ~late).tolist())
    equal = np.abs(steps[late] - heartbeat) <= heartbeat / _MISSED
    return heartbeat if equal.mean() >= _STEADY and late.sum() > sooner else None


def _turns_back_often(numbers: Float1D) -> bool:
    steps = np.diff(numbers[np.isfinite(numbers)])
    return bool(steps.size > 1 and (steps[1:] * steps[:-1] < 0).mean() >= _TURNS)
