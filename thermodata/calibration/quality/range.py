"""The end of a range that nobody declared: a channel's tests come to the very same extreme, and none goes beyond."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.calibration.quality.still import Reading

_LEAST_AT = 10  # readings of a test at its extreme
_LEAST_TESTS = 2

Limits = tuple[float | None, float | None]  # lower and upper; None where none is known


def ends_of_ranges(readings: Mapping[tuple[str, str], Reading]) -> dict[tuple[str, str], Limits]:
    """(test, channel) -> the limits of its range that the test comes to. readings: by test and channel.

    A fine and noisy reading comes to its extreme once. Where two tests stand on the same one, to the last digit, it is
    where the sensor ends. A rest at zero is none, nor is what only a channel shows that stands throughout.
    """
    found: dict[tuple[str, str], Limits] = {}
    for channel in dict.fromkeys(c for _, c in readings):
        own = {t: r for (t, c), r in readings.items() if c == channel}
        if not any(r.is_fine for r in own.values()):
            continue
        lower = _end({t: (-r.low, r.low_n) for t, r in own.items() if r.low is not None}, own)
        upper = _end({t: (r.high, r.high_n) for t, r in own.items() if r.high is not None}, own)
        low = None if lower is None else -lower
        for test, r in own.items():
            limits = (low if low == r.low else None, upper if upper == r.high else None)
            if limits != (None, None):
                found[test, channel] = limits
    return found


def _end(extremes: Mapping[str, tuple[float, int]], readings: Mapping[str, Reading]) -> float | None:
    """The largest extreme of all tests, where enough of them stand on it. extremes: test -> (value, readings there)."""
    if not extremes:
        return None
    end = max(value for value, _ in extremes.values())
    shown = [t for t, (value, n) in extremes.items() if value == end and n >= _LEAST_AT and readings[t].has_moved]
    return end if len(shown) >= _LEAST_TESTS and end != 0.0 else None
