"""Whether one model's error differs from another's, by an interval: samples of a thermal test hang together.

The difference of two root mean squares is, near where it stands, a mean over samples (the delta method); that mean is
worth as many samples as the memory of what is averaged leaves [bartlett1946], and over several tests it is how the
tests differ that spreads it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.terms.rms import rms
from thermodata.modelling.trust.memory import memory
from thermodata.plugin import Float1D

FEWEST = 4  # independent samples, or tests, that an interval needs
LEVEL = 0.95


@dataclass(frozen=True)
class Difference:
    """error - that of the pinned model, in the response's unit, with its interval of 95 %; None where there are too few
    independent samples. worth: as many of them there are."""

    value: float
    low: float | None
    high: float | None
    worth: float

    @property
    def sure(self) -> bool:
        """Whether the interval leaves out that they are alike."""
        return self.low is not None and self.high is not None and (self.low > 0 or self.high < 0)


def difference(pinned: Float1D, other: Float1D) -> Difference | None:
    """Of one test. pinned, other: residuals, shape (n,), NaN where none counts; only samples that both have count. None
    where there is none."""
    both = np.isfinite(pinned) & np.isfinite(other)
    a, b = pinned[both], other[both]
    if not len(a):
        return None
    course = _course(a, b, rms([a]), rms([b]))
    value, centred = rms([b]) - rms([a]), course - course.mean()
    if not np.any(centred):
        return Difference(value, value, value, float(len(a)))
    span = memory(centred, [slice(0, len(centred))])
    worth = len(a) / span
    if worth < FEWEST:
        return Difference(value, None, None, worth)
    sd = float(np.sqrt(centred @ centred / len(a) / (worth - 1)))
    return _interval(value, sd, worth)


def difference_of_tests(pairs: Sequence[tuple[Float1D, Float1D]]) -> Difference | None:
    """Of several tests together, each sample counted once. With fewer than four tests there is no interval: how tests
    differ from each other is what makes it."""
    kept = []
    for pinned, other in pairs:
        both = np.isfinite(pinned) & np.isfinite(other)
        if both.any():
            kept.append((pinned[both], other[both]))
    if not kept:
        return None
    size_a, size_b = rms([a for a, _ in kept]), rms([b for _, b in kept])
    value, n, count = size_b - size_a, sum(len(a) for a, _ in kept), len(kept)
    if count < FEWEST:
        return Difference(value, None, None, float(count))
    sums = np.array([float(_course(a, b, size_a, size_b).sum()) for a, b in kept])
    shares = np.array([len(a) / n for a, _ in kept])
    off = sums / n - shares * (sums.sum() / n)
    sd = float(np.sqrt(off @ off * count / (count - 1)))
    return _interval(value, sd, float(count))


def _course(a: Float1D, b: Float1D, size_a: float, size_b: float) -> Float1D:
    """What the samples give to the difference: its mean moves as the difference of the root mean squares does."""
    own = b**2 / (2 * size_b) if size_b > 0 else np.zeros(len(b))
    return own - (a**2 / (2 * size_a) if size_a > 0 else np.zeros(len(a)))


def _interval(value: float, sd: float, worth: float) -> Difference:
    from scipy.special import stdtrit

    reach = float(stdtrit(worth - 1, 0.5 + LEVEL / 2)) * sd
    return Difference(value, value - reach, value + reach, worth)
