"""What every format of LabVIEW shares of time: its epoch, the years that seconds point to, and exact intervals."""

from __future__ import annotations

from fractions import Fraction

_BILLION = 1_000_000_000
LAST_NS = 8_900_000_000 * _BILLION  # the year 2252; int64 ends in 2262
EPOCH_1904_NS = -2_082_844_800 * 1_000_000_000
# seconds since 1904 of the years 1997 to 2040; since 1970 of 2001 to 2033
LABVIEW_SECONDS, UNIX_SECONDS = (2_934_748_800, 4_291_747_200), (978_307_200, 1_988_150_400)


def step_ns(increment_s: float) -> Fraction:
    """The sample interval in exact nanoseconds: the decimal that was meant, or one over a whole rate.

    0.1 is stored as a binary number slightly above a tenth; 51200 Hz as 1.953125e-05.
    """
    rate = round(1.0 / increment_s)
    if rate > 0 and abs(rate * increment_s - 1.0) < 1e-12:
        return Fraction(_BILLION, rate)
    return (Fraction(repr(increment_s)) * _BILLION).limit_denominator(1_000_000_000)
