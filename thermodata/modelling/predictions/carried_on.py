"""Drivers beyond the ends of their logs: how long a value that nothing measured any more counts as known."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.terms.bound import BoundTerm
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.words.sentences import with_count
from thermodata.view.grid.dataset import Dataset, TestData

LEAST_S = 300.0  # what is shorter is bridged like a gap
_NAMED = 4


@dataclass(frozen=True, slots=True)
class CarriedOn:
    """A channel whose value from from_s to to_s [s] is the nearest one that was measured, and counts. at_end: its last;
    else its first."""

    campaign: str
    test: str
    channel: str
    at_end: bool
    from_s: float
    to_s: float

    @property
    def lasts_s(self) -> float:
        return self.to_s - self.from_s


def carried_on(terms: Iterable[BoundTerm], test: TestData) -> list[CarriedOn]:
    """Of the channels that some terms read, in a test's window."""
    found: dict[tuple[str, bool], CarriedOn] = {}
    step = float(np.median(np.diff(test.t_s))) if len(test.t_s) > 1 else 0.0
    for term in terms:
        known = term.known(test) if term.covers(test) and term.has(test) else None
        if known is None:
            continue
        for name in term.reads(test):
            first, last = test.logged.get(name, (-np.inf, np.inf))
            for at_end, beyond in ((False, test.t_s < first), (True, test.t_s >= last)):
                where = test.t_s[beyond & known & test.in_window]
                if len(where) and len(where) * step >= LEAST_S:
                    one = CarriedOn(test.campaign, test.test, name, at_end, float(where[0]), float(where[-1]) + step)
                    found.setdefault((name, at_end), one)
    return list(found.values())


def said_of_fit(fitted: FittedModel, data: Dataset) -> list[str]:
    """Of the tests that are fitted or scored."""
    return said(
        one
        for test in fitted.tests(data)
        for response in fitted.responses
        if response.can_predict(test)
        for one in carried_on([t.bound for t in response.terms], test)
    )


def said(some: Iterable[CarriedOn]) -> list[str]:
    """A sentence for each channel and end."""
    by: dict[tuple[str, bool], list[str]] = {}
    for one in some:
        when = f"from {one.from_s / 3600:.3g} h on" if one.at_end else f"until {one.to_s / 3600:.3g} h"
        by.setdefault((one.channel, one.at_end), []).append(f"{one.test} ({one.lasts_s / 60:.0f} min, {when})")
    return [
        f"{channel} is held at its {'last' if at_end else 'first'} value where nothing measured it, and counts as "
        f"known: {with_count(dict.fromkeys(tests), _NAMED)}"
        for (channel, at_end), tests in by.items()
    ]
