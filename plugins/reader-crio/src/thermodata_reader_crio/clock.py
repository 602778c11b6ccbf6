"""The time of TDMS rows: start, offset and increment of a waveform, in integers, so that nothing drifts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata_reader_crio.metadata import Timestamp

_BILLION = 1_000_000_000


def step_ns(increment_s: float) -> Fraction:
    """The sample interval in exact nanoseconds: the decimal that was meant, or one over a whole rate.

    0.1 is stored as a binary number slightly above a tenth; 51200 Hz as 1.953125e-05.
    """
    rate = round(1.0 / increment_s)
    if rate > 0 and abs(rate * increment_s - 1.0) < 1e-12:
        return Fraction(_BILLION, rate)
    return (Fraction(repr(increment_s)) * _BILLION).limit_denominator(1_000_000_000)


@dataclass(frozen=True, slots=True)
class Waveform:
    """start_ns: since 1970 UTC, or None where the file names no date; the sample interval as a fraction."""

    start_ns: int | None
    offset_ns: int
    step: Fraction

    def times(self, first: int, last: int) -> Int1D:
        """Times of samples [first, last), shape (n,)."""
        whole, rest = divmod(self.step.numerator, self.step.denominator)
        i = np.arange(first, last, dtype=np.int64)
        t = i * whole + (i * rest) // self.step.denominator
        return t + ((self.start_ns or 0) + self.offset_ns)


def waveform(properties: Mapping[str, Any]) -> Waveform | None:
    """A channel's waveform clock, or None where it has no usable increment."""
    increment = properties.get("wf_increment")
    if not isinstance(increment, int | float) or not math.isfinite(increment) or not 1e-12 < increment < 1e9:
        return None
    start = properties.get("wf_start_time")
    start_ns = start.ns if isinstance(start, Timestamp) and start.seconds > 0 else None
    if start_ns is not None and not 0 < start_ns < 9_000_000_000 * _BILLION:
        start_ns = None
    offset = properties.get("wf_start_offset", 0.0)
    usable = isinstance(offset, int | float) and math.isfinite(offset) and abs(offset) < 1e9
    offset_ns = round(Fraction(repr(float(offset))) * _BILLION) if usable else 0
    return Waveform(start_ns, offset_ns, step_ns(float(increment)))
