"""Quality flags of a sample: a bit mask, kept beside the value; flagged rows are never deleted."""

from __future__ import annotations

from enum import IntFlag


class Flag(IntFlag):
    OK = 0
    GAP = 1
    HELD = 2
    SATURATED = 4
    SPIKE = 8
    OUT_OF_RANGE = 16
    INTERPOLATED = 32
    CLOCK_SUSPECT = 64
    NOT_MEASURING = 128
    STUCK = 256
    OFFSET = 512
    DUPLICATE_TIME = 1024
    RATE_CHANGE = 2048


# A sample with any of these does not count in means, fits and scores. A gap marks the first sample after it
# (a good value), an interpolated value and a rate change are information only.
INVALID = (
    Flag.HELD
    | Flag.SATURATED
    | Flag.SPIKE
    | Flag.OUT_OF_RANGE
    | Flag.NOT_MEASURING
    | Flag.STUCK
    | Flag.OFFSET
    | Flag.DUPLICATE_TIME
)
