"""Quality flags of a sample: a bit mask, kept beside the value; flagged rows are never deleted."""

from __future__ import annotations

from enum import IntFlag


class Flag(IntFlag):
    """One bit a defect; a sample's flag is their sum (uint16). `INVALID` tells which of them keep it out of a fit."""

    OK = 0
    GAP = 1  # the first sample after a gap
    HELD = 2  # the logger repeats a value that it no longer measures
    SATURATED = 4  # at the end of the sensor's range
    SPIKE = 8  # one reading far from both neighbours
    OUT_OF_RANGE = 16  # no sensor of the kind reads that
    INTERPOLATED = 32  # drawn between neighbours
    CLOCK_SUSPECT = 64  # its time is estimated, or stood backwards
    NOT_MEASURING = 128  # outside of the test's `measuring`
    STUCK = 256  # a sensor that does not move any more
    OFFSET = 512  # a sensor that reads many kelvin more, or less, from one moment on
    DUPLICATE_TIME = 1024  # a second sample at one time
    RATE_CHANGE = 2048  # the first sample at another rate
    FOREIGN = 4096  # of another recording: after a pause nearly every channel lies elsewhere

    @property
    def word(self) -> str:
        """As events, tables and answers name it: 'out_of_range'."""
        return str(self.name).lower()


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
    | Flag.FOREIGN
)
NOT_FLAGGED = "not flagged"  # begins the detail of an event of which no sample has the flag
OVERRULED = "overruled: "  # begins the detail of an event that was; its reason follows
CONSTANT = "; by a constant, so what counts from the test's start is sound"  # ends the detail of such an offset
