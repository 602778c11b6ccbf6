"""The clock of a test in which nothing happened that two sources both saw: what the other tests say of it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from statistics import median

from thermodata.store.tidy.clock.source_clock import Clock, is_relative
from thermodata.store.tidy.plan.plan import TestPlan

_FEWEST = 2  # tests that tell
_ALIKE_NS = 60_000_000_000  # between the largest and the smallest: the step that models are fitted at


def dated_sources(plan: TestPlan) -> list[str]:
    """The sources of a test whose clock others can tell: dated ones, of which nobody declared events."""
    return [
        name
        for name, source in plan.sources.items()
        if source.raws and not is_relative(source) and not source.spec.clock.events
    ]


def lent(
    clocks: Mapping[str, Mapping[str, Clock]], dated_in: Mapping[str, Collection[str]]
) -> dict[str, dict[str, Clock]]:
    """The clocks of all tests, those that their own test leaves open (an idle spindle tells nothing) by the others.

    clocks: test -> source -> clock, at least of those that were estimated. dated_in: test -> its `dated_sources`. A
    logger that counts from its own start is left alone: each start is another. So is one whose tests disagree by more
    than a minute: its clock runs away, or was set between them. Events that a person declared are not overruled: where
    they contradict each other, they are to be mended.
    """
    found = {test: dict(own) for test, own in clocks.items()}
    dated = {(test, name) for test, names in dated_in.items() for name in names}
    for source in {name for own in clocks.values() for name in own}:
        told = [
            c for t, own in clocks.items() if (c := own.get(source)) and (t, source) in dated and _is_own_estimate(c)
        ]
        offsets = [c.offset_ns for c in told]
        if len(offsets) < _FEWEST or max(offsets) - min(offsets) > _ALIKE_NS:
            continue
        apart_s = (max(offsets) - min(offsets)) / 1e9
        for test, own in clocks.items():
            clock = own.get(source)
            if clock is None or not (clock.key and clock.suspect) or (test, source) not in dated:
                continue
            offset_ns = round(median(offsets))
            note = (
                f"clock by {len(offsets)} other tests, whose offsets are {apart_s:.3g} s apart at most: "
                f"{offset_ns / 1e9:+.3f} s; by this test alone: {'; '.join(clock.notes)}"
            )
            # no key: what the others say is asked again at every ingest, for they may change
            found[test][source] = replace(clock, offset_ns=offset_ns, suspect=False, key="", notes=(note,))
    return found


def _is_own_estimate(clock: Clock) -> bool:
    """Whether it was estimated from its own test."""
    return bool(clock.key) and not clock.suspect
