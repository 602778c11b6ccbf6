"""What of an error is more than noise, which no model takes away."""

from __future__ import annotations

import math


def beyond(error: float, white: float, rows: float) -> float:
    """An RMS without the white noise in it, and no less than what so many rows tell of that: the variance of noise is
    known to sqrt(2 / rows) of itself. 0 where there is no error. white: RMS of the noise, in the unit of the error."""
    if white <= 0 or error <= 0:
        return error
    least = white * (2.0 / max(rows, 2.0)) ** 0.25
    return math.sqrt(max(error**2 - white**2, least**2))


def fall_beyond(before: float, after: float, white: float, rows: float) -> float:
    """Fall of an error, as a share of what is more than noise; a rise as a share of the error, for beside a noise that
    is all there is any rise would be large."""
    if after >= before:
        return 1.0 - after / before if before > 0 else 0.0
    left = beyond(before, white, rows)
    return 1.0 - beyond(after, white, rows) / left if left > 0 else 0.0
