"""Parts that are as warm where nothing moves them: what warms them is no heat of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.diagnosis.candidates.unread import is_motion
from thermodata.effect.places import holds
from thermodata.view.grid.dataset import ChannelInfo, TestData

TABLE = "table"  # turning or not
TURNS = (TABLE, "rotary")
STANDS = 0.05  # of the most that a command does: less is rest
AS_WARM = 0.75  # of how far a table's temperature moves where it turns: it moves so far where it stands, too


def turns(channel: ChannelInfo) -> bool:
    """Whether it is what turns a table, or what that takes."""
    return is_motion(channel.quantity) and any(holds(place, channel.at) for place in TURNS)


def is_at_table(channel: ChannelInfo) -> bool:
    """Whether it reads the temperature of a table, and of no part of it in particular."""
    return channel.quantity == "temperature" and channel.at is not None and channel.at.lower() == TABLE


def warm_at_rest(channels: Mapping[str, ChannelInfo], tests: Sequence[TestData]) -> frozenset[str]:
    """The temperatures of tables that move about as far in tests in which nothing turns a table, by the median; and all
    of them where nothing turns one in any test."""
    moved = _moved(tests, [n for n, c in channels.items() if turns(c)])
    return frozenset(n for n, c in channels.items() if is_at_table(c) and _is_warm_at_rest(n, tests, moved))


def share_at_rest(name: str, tests: Sequence[TestData]) -> float | None:
    """How far a temperature moves in tests in which nothing at its part does, as a share of how far in the others;
    None where no motion of its part is logged, or it moves in all tests or in none."""
    channels = {n: c for t in tests for n, c in t.channels.items()}
    own = part_of(channels[name].at) if name in channels else None
    if own is None:
        return None
    roots = TURNS if own in TURNS else (own,)
    motions = [n for n, c in channels.items() if is_motion(c.quantity) and any(holds(r, c.at) for r in roots)]
    resting, moving = _spreads(name, tests, _moved(tests, motions))
    return float(np.median(resting) / np.median(moving)) if resting and moving and np.median(moving) > 0 else None


def part_of(place: str | None) -> str | None:
    """What moves as one: an axis, or the first word of a place."""
    words = (place or "").lower().split(".")
    return ".".join(words[: 2 if words[0] == "axis" else 1]) or None


def _is_warm_at_rest(name: str, tests: Sequence[TestData], moved: Sequence[bool]) -> bool:
    resting, turning = _spreads(name, tests, moved)
    if not turning or not resting:
        return not turning and bool(resting)
    return float(np.median(resting)) >= AS_WARM * float(np.median(turning))


def _spreads(name: str, tests: Sequence[TestData], moved: Sequence[bool]) -> tuple[list[float], list[float]]:
    """Standard deviations: of tests at rest, of the others."""
    of_each = [(_logged_values(t, name), so) for t, so in zip(tests, moved, strict=True)]
    resting, moving = ([float(v.std()) for v, so in of_each if so is wanted and len(v)] for wanted in (False, True))
    return resting, moving


def _moved(tests: Sequence[TestData], motions: Sequence[str]) -> list[bool]:
    """Whether something moved, a test each."""
    does = np.array([[_largest_size(t, n) for n in motions] for t in tests]).reshape(len(tests), len(motions))
    moved: list[bool] = (does > STANDS * does.max(axis=0, initial=0.0)).any(axis=1).tolist()
    return moved


def _largest_size(test: TestData, name: str) -> float:
    return float(np.abs(_logged_values(test, name)).max(initial=0.0))


def _logged_values(test: TestData, name: str) -> np.ndarray:
    values = np.asarray(test.values.get(name, np.empty(0)), dtype=np.float64)
    return values[np.isfinite(values)]
