"""The samples that two tests of one recording have in common."""

from __future__ import annotations

from thermodata.view.grid.dataset import TestData


def shared_samples(
    one: TestData, other: TestData, channel: str, theirs: str | None = None
) -> tuple[float, float] | None:
    """From when to when [s from the start of `one`] both tests have the same samples of a channel (`theirs`: its name
    in the other), in the first recording that they share; None where they share one at most, as windows do that meet at
    an edge."""
    return next(iter(shared_spans(one, other, channel, theirs)), None)


def shared_spans(one: TestData, other: TestData, channel: str, theirs: str | None) -> list[tuple[float, float]]:
    """The same for each recording that they share: a test may be read from several files. Another signal of a file is
    another measurement."""
    mine, its = one.recorded.get(channel), other.recorded.get(theirs or channel)
    if mine is None or its is None or mine.signal != its.signal:
        return []
    spans = []
    for name in mine.parts.keys() & its.parts.keys():
        low, high = (pick(mine.parts[name][i], its.parts[name][i]) for i, pick in enumerate((max, min)))
        if high - low >= max(mine.step_ns, 1):
            spans.append(((low - mine.zero_ns) / 1e9, (high - mine.zero_ns) / 1e9))
    return sorted(spans)
