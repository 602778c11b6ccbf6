"""A column that nobody's words explain, and whose values are the speeds that the tests are called by: the spindle's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.draft.campaign.parts import DraftChannel
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.words.said_by_names import said_by

_NEAR = 0.02  # of the speed that a name says


def with_told_speeds(channels: Sequence[DraftChannel], group: Group) -> list[DraftChannel]:
    """The channels of a source, with the spindle's speed where nothing else is one, and one column of no known quantity
    and unit reaches in each of two tests or more the speed that its name says, and these differ."""
    if any(c.said.quantity == "rotational_speed" for c in channels):
        return list(channels)
    named = {
        test: float(speed.split()[0]) for test in group.tests if (speed := said_by([test]).conditions.get("speed"))
    }
    if len(set(named.values())) < 2:
        return list(channels)
    fitting = [c for c in channels if c.said.quantity is None and c.said.unit is None and _reaches(c, group, named)]
    if len(fitting) != 1:
        return list(channels)
    said = Guess("rotational_speed", "rpm", "spindle", basis=("values", "names of the tests"))
    return [replace(c, said=said) if c is fitting[0] else c for c in channels]


def _reaches(channel: DraftChannel, group: Group, named: dict[str, float]) -> bool:
    for test, speed in named.items():
        seen = [
            values
            for f in group.tests[test]
            for (_, name), values in f.sample.values.items()
            if name == channel.signal and values.moves > 0
        ]
        if len(seen) != 1 or abs(max(abs(seen[0].low), abs(seen[0].high)) - speed) > _NEAR * speed:
            return False
    return True
