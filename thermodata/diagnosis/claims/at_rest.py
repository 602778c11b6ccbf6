"""What no open test moves and another test does: an effect of it can't be missed by the open tests, nor be found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.detection import has_a_name
from thermodata.effect.places import holds
from thermodata.view.grid.dataset import ChannelInfo, TestData

MOVING = ("rotational_speed", "feed", "flow", "state", "position")
STANDS = 0.05  # of what it does in the tests that move it: less is rest


@dataclass(frozen=True, slots=True)
class AtRest:
    """channel: a command that rests in all open tests. warms: temperatures at its place, which nothing of it heats
    there. effects: with a name, that one of them drives. moves_in: the other tests that move it."""

    channel: str
    warms: tuple[str, ...]
    effects: tuple[str, ...]
    moves_in: tuple[TestData, ...]


def at_rest(
    pool: Sequence[CandidateEffect],
    open_tests: Sequence[TestData],
    others: Sequence[TestData],
    channels: Mapping[str, ChannelInfo],
) -> list[AtRest]:
    """pool: what could be missing. others: tests that take no part in the choice; their drivers are read, and no
    response."""
    found = []
    named = [one for one in pool if one.kin in (None, "near", "related") and has_a_name(one)]
    for name, info in channels.items():
        if info.quantity not in MOVING or info.is_mask:
            continue
        sizes = [does(t, name, info.quantity) for t in others]
        most = max(sizes, default=0.0)
        if most <= 0 or max((does(t, name, info.quantity) for t in open_tests), default=0.0) > STANDS * most:
            continue
        heats = info.quantity != "position"
        warms = tuple(n for n, c in channels.items() if heats and c.quantity == "temperature" and _is_of(info.at, c.at))
        effects = [o.effect.name for o in named if {name, *warms}.intersection(o.channels)]
        moves_in = tuple(t for t, size in zip(others, sizes, strict=True) if size > STANDS * most)
        if effects:
            found.append(AtRest(name, warms, tuple(dict.fromkeys(effects)), moves_in))
    return found


def does(test: TestData, name: str, quantity: str) -> float:
    """How far it goes from rest, in its own unit; a position has none, and goes from end to end."""
    values = test.values.get(name)
    seen = values[np.isfinite(values)] if values is not None else np.empty(0)
    if not len(seen):
        return 0.0
    return float(np.ptp(seen) if quantity == "position" else np.abs(seen).max())


def _is_of(part: str | None, at: str | None) -> bool:
    return part is not None and at is not None and holds(part, at)
