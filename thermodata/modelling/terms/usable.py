"""Which tests a response can be fitted to."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.modelling.terms.bound import BoundResponse
from thermodata.modelling.terms.fitted_response import has_response
from thermodata.view.dataset import TestData


def usable_tests(bound: BoundResponse, tests: Sequence[TestData]) -> tuple[list[TestData], list[str]]:
    """Tests with the response and all drivers; and of the others, what they lack."""
    usable, why = [], []
    for test in tests:
        missing = [t.id for t in bound.terms if not t.has(test)]
        if not has_response(bound, test):
            why.append(f"{test.campaign}/{test.test}: no '{bound.channel_of(test)}'")
        elif missing:
            why.append(f"{test.campaign}/{test.test}: no driver for {', '.join(missing)}")
        else:
            usable.append(test)
    return usable, why
