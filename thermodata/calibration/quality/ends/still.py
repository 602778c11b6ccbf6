"""A displacement that the logger held for most of a test: only its other tests tell how finely it reads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.quality.value import RunStats

_LEAST_MOVING = 200  # differences, or a test does not tell how a channel reads
_LEAST_STOOD_S = 60.0
_NOISY, _SELDOM = 0.2, 0.2  # least share of turns, most of equal neighbours by chance
_COARSER = 3.0  # than usual: it was logged otherwise
Shown = tuple[float, float, int, int]


@dataclass(frozen=True, slots=True)
class Reading:
    """How a channel read in a test, as in `RunStats`. moving: differences that it rests on. stood_s: the longest
    stretch of exactly one value [s]. low, high: its extremes, None where it has no value; low_n, high_n: readings
    that stand there, each one however often it is logged. plateau: (level, noise, -1 for its lowest or 1 for its
    highest, times) where it stands on its extreme within its noise, for long or that many times."""

    step: float
    finest: float
    chance: float
    alternates: float
    moving: int
    stood_s: float
    low: float | None = None
    low_n: int = 0
    high: float | None = None
    high_n: int = 0
    plateau: Shown | None = None

    @property
    def has_moved(self) -> bool:
        """Whether it took more than one value."""
        return self.low != self.high

    @property
    def is_fine(self) -> bool:
        """Whether it shows how finely the channel reads."""
        return (
            self.moving >= _LEAST_MOVING
            and self.finest > 0
            and self.step >= 2.5 * self.finest
            and self.chance < _SELDOM
            and self.alternates >= _NOISY
        )

    @property
    def jumps_to_one_reading(self) -> bool:
        """Whether it jumps to its extreme again and again, and stands there to the last digit, though it flickers."""
        return self.plateau is not None and self.plateau[1] == 0

    def stats(self) -> RunStats:
        """Without any runs."""
        none = np.empty(0, np.int64)
        return RunStats(none, none, self.step, self.finest, self.chance, self.alternates)


def read_elsewhere(readings: Mapping[tuple[str, str], Reading]) -> dict[tuple[str, str], Reading]:
    """(test, channel) -> how the channel reads in its other tests, for tests in which it stood for a minute and more
    and that do not tell it themselves. readings: by test and channel."""
    found: dict[tuple[str, str], Reading] = {}
    for channel in dict.fromkeys(c for _, c in readings):
        own = {t: r for (t, c), r in readings.items() if c == channel}
        fine = [r for r in own.values() if r.is_fine]
        if not fine:
            continue
        usual = Reading(
            step=float(np.median([r.step for r in fine])),
            finest=float(np.median([r.finest for r in fine])),
            chance=float(np.median([r.chance for r in fine])),
            alternates=float(np.median([r.alternates for r in fine])),
            moving=min(r.moving for r in fine),
            stood_s=0.0,
        )
        for test, r in own.items():
            coarser = r.moving > 0 and r.finest > _COARSER * usual.step
            if not r.is_fine and r.stood_s >= _LEAST_STOOD_S and not coarser:
                found[test, channel] = usual
    return found
