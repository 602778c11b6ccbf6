"""What the campaign file says of clocks is somebody's word, and stays: no diagnosis moves such a clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.diagnosis.clocks.logs_compared import Late
from thermodata.view.grid.dataset import ChannelInfo, Dataset


@dataclass(frozen=True, slots=True)
class Declared:
    """of_all: sources whose clock is declared in all tests; in_one: the same by test; home: the source of the
    response."""

    of_all: frozenset[str]
    in_one: Mapping[tuple[str, str], frozenset[str]]
    home: str | None

    @classmethod
    def of(cls, data: Dataset, response: str) -> Declared:
        """Of the data of a model."""

        def sources(channels: Mapping[str, ChannelInfo]) -> frozenset[str]:
            return frozenset(c.source for c in channels.values() if c.clock_declared and c.source)

        in_one = {t.key: sources(t.channels) for t in data.tests}
        return cls(sources(data.channels), in_one, data.channels[response].source)

    def of_clock(self, campaign: str, test: str) -> frozenset[str]:
        """Sources whose clock is declared there; test '': in all tests."""
        return self.of_all if not test else self.of_all | self.in_one.get((campaign, test), frozenset())

    def settles(self, late: Late) -> bool:
        """Whether it would move a clock that is declared, or one beside the response's, which the others go by."""
        declared = self.of_clock(late.of.campaign, late.of.test)
        both = {late.of.warmed, late.of.by}
        return late.source in declared or (bool(declared) and both <= declared | {self.home})
