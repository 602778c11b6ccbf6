"""Tables that are as warm where nothing turns them: what warms them is not their bearing."""

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
    motions = [n for n, c in channels.items() if turns(c)]
    does = np.array([[_most(t, n) for n in motions] for t in tests]).reshape(len(tests), len(motions))
    moved = (does > STANDS * does.max(axis=0, initial=0.0)).any(axis=1)
    return frozenset(n for n, c in channels.items() if is_at_table(c) and _is_warm_at_rest(n, tests, moved.tolist()))


def _is_warm_at_rest(name: str, tests: Sequence[TestData], moved: Sequence[bool]) -> bool:
    of_each = [(_seen(t, name), turned) for t, turned in zip(tests, moved, strict=True)]
    turning = [float(v.std()) for v, turned in of_each if turned and len(v)]
    resting = [float(v.std()) for v, turned in of_each if not turned and len(v)]
    if not turning or not resting:
        return not turning and bool(resting)
    return float(np.median(resting)) >= AS_WARM * float(np.median(turning))


def _most(test: TestData, name: str) -> float:
    return float(np.abs(_seen(test, name)).max(initial=0.0))


def _seen(test: TestData, name: str) -> np.ndarray:
    values = np.asarray(test.values.get(name, np.empty(0)), dtype=np.float64)
    return values[np.isfinite(values)]
