"""Which tests a response can be fitted to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted_response import has_response
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.view.dataset import TestData


def usable_tests(bound: BoundResponse, tests: Sequence[TestData]) -> tuple[list[TestData], list[str]]:
    """Tests with the response and all drivers; and of the others, what they lack."""
    usable, why = [], []
    for test in tests:
        missing = [t for t in bound.terms if not t.has(test)]
        if not has_response(bound, test):
            why.append(f"{test.campaign}/{test.test}: no '{bound.channel_of(test)}'")
        elif missing:
            said = ", ".join(t.id for t in missing)
            why.append(f"{test.campaign}/{test.test}: no driver for {said}{_ruled_out(missing, test)}")
        else:
            usable.append(test)
    return usable, why


def _ruled_out(terms: Sequence[BoundTerm], test: TestData) -> str:
    """Which channel is logged there and is ruled out by which flag, and what to do; '' where it was not logged."""
    read = {
        n for t in terms if not isinstance(t.effect, OfTests) for x in t.binding_of(test).values() for n in names_of(x)
    }
    flags = {n: info.faulty or "offset" for n in sorted(read) if (info := test.channels.get(n)) and _is_out(test, n)}
    if not flags:
        return ""
    told = " and ".join(f"'{name}' is flagged '{flag}'" for name, flag in flags.items())
    return (
        f": {told} there, so the fit lost this test; look at thermodata quality, and overrule the flag if it is sound"
    )


def _is_out(test: TestData, name: str) -> bool:
    info = test.channels[name]
    return info.shifted or (info.faulty is not None and not np.isfinite(test.values.get(name, np.empty(0))).any())
