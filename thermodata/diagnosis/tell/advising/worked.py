"""Which sources of heat the tests work by themselves: the spindle in one, an axis in another, nothing in a third."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from thermodata.diagnosis.claims.at_rest import STANDS, does
from thermodata.effect.places import holds
from thermodata.schema.words.places import is_around
from thermodata.view.grid.dataset import ChannelInfo, TestData

AIR = "hall air"
_OF_PARTS = ("rotational_speed", "feed")


@dataclass(frozen=True, slots=True)
class Worked:
    """alone: source -> the tests that work no other one, by its place, `AIR` where all rest; acts: in how many tests
    it works at all, `AIR` in every one."""

    alone: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    acts: Mapping[str, int] = field(default_factory=dict)

    def lacking(self) -> list[str]:
        """The sources that no test works alone, or that work in one test at most."""
        return [s for s in self.acts if not self.alone.get(s) or self.acts[s] < 2]

    def tests_of(self, channels: Sequence[ChannelInfo]) -> tuple[str, ...]:
        """The tests that work alone what all of these channels are of; none where they are of several sources."""
        found = {self._source(c.at) for c in channels}
        source = found.pop() if len(found) == 1 else None
        return self.alone.get(source, ()) if source is not None else ()

    def _source(self, at: str | None) -> str | None:
        if is_around(at):
            return AIR
        return next((s for s in self.acts if at is not None and s != AIR and (holds(s, at) or holds(at, s))), None)


def worked(tests: Sequence[TestData], channels: Mapping[str, ChannelInfo]) -> Worked:
    """Of the tests that took part."""
    commands = [c for c in channels.values() if c.quantity in _OF_PARTS and c.at is not None and not c.is_mask]
    most = {c.name: max((does(t, c.name, c.quantity) for t in tests), default=0.0) for c in commands}
    works = {
        t.key: {str(c.at) for c in commands if most[c.name] > 0 and does(t, c.name, c.quantity) > STANDS * most[c.name]}
        for t in tests
    }
    sources = list(dict.fromkeys(str(c.at) for c in commands if most[c.name] > 0))
    if not sources:
        return Worked()
    alone = {s: tuple(t.test for t in tests if works[t.key] == {s}) for s in sources}
    acts = {s: sum(s in own for own in works.values()) for s in sources}
    alone[AIR] = tuple(t.test for t in tests if not works[t.key])
    return Worked(alone, {**acts, AIR: len(tests)})
