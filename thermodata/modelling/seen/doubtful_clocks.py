"""Clocks that an ingest could not align: what hangs on them may lie minutes off, and count what was not measured."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.words.sentences import with_count
from thermodata.view.grid.dataset import Dataset, TestData

_NAMED = 4  # tests, and channels
MEASURING = "measuring"


@dataclass(frozen=True, slots=True)
class DoubtfulClock:
    """Of a source, in some tests. hangs: what comes from it: `measuring`, and channels that are read."""

    source: str
    tests: tuple[str, ...]
    hangs: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """'the clock of nc is doubtful in 01_night and 02_feed: measuring and feed_y come from it'."""
        comes = "comes" if len(self.hangs) == 1 else "come"
        tests = with_count(self.tests, _NAMED)
        return f"the clock of {self.source} is doubtful in {tests}: {with_count(self.hangs, _NAMED)} {comes} from it"


def doubtful_clocks(model: FittedModel, data: Dataset, drivers: Collection[str] = ()) -> list[DoubtfulClock]:
    """Of each source whose whole clock is doubtful in an open test of the model, and on which something hangs. drivers:
    channels that are read beside those of the model."""
    tests = model.tests(data)
    found = list[DoubtfulClock]()
    for source in dict.fromkeys(i.source for t in tests for i in t.channels.values() if i.clock_doubtful and i.source):
        own = [t for t in tests if any(i.clock_doubtful and i.source == source for i in t.channels.values())]
        hangs = dict.fromkeys(name for t in own for name in _hangs(model, t, source, drivers))
        if hangs:
            found.append(DoubtfulClock(source, tuple(t.test for t in own), tuple(hangs)))
    return found


def _hangs(model: FittedModel, test: TestData, source: str, drivers: Collection[str]) -> list[str]:
    of_it = [n for n, info in test.channels.items() if info.source == source and info.clock_doubtful]
    terms = [term.bound for response in model.responses for term in response.terms]
    read = {name for term in terms if term.covers(test) for name in term.reads(test)}
    read |= {response.bound.channel_of(test) for response in model.responses}
    masks = [MEASURING] if any(test.channels[n].in_measuring for n in of_it) else []
    return [*masks, *(n for n in of_it if n in read or n in drivers)]
