"""Which tests a response can be fitted to."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.modelling.inputs.drivers import is_known, names_of, shifted_in
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted_response import has_response
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.view.grid.dataset import TestData


def usable_tests(bound: BoundResponse, tests: Sequence[TestData]) -> tuple[list[TestData], list[str]]:
    """Tests with the response and all drivers; and of the others, what they lack."""
    usable, why = [], []
    for test in tests:
        missing = [t for t in bound.terms if not t.has(test)]
        if not has_response(bound, test):
            why.append(f"{test.campaign}/{test.test}: no '{bound.channel_of(test)}'")
        elif missing:
            said = ", ".join(t.id for t in missing)
            of_tests = "".join(f": {lack}" for t in missing if (lack := t.lacks(test)))
            why.append(f"{test.campaign}/{test.test}: no driver for {said}{of_tests}{_ruled_out(missing, test)}")
        else:
            usable.append(test)
    return usable, why


def _ruled_out(terms: Sequence[BoundTerm], test: TestData) -> str:
    """Which channel is logged there and is ruled out by which flag, and what to do; '' where it was not logged."""
    texts = {x for t in terms if not isinstance(t.effect, OfTests) for x in t.binding_of(test).values()}
    out = sorted({name for text in texts for name in _channels_ruled_out(test, text)})
    flags = {name: test.channels[name].faulty or "offset" for name in out}
    if not flags:
        return ""
    told = " and ".join(f"'{name}' is flagged '{flag}'" for name, flag in flags.items())
    return (
        f": {told} there, so the fit lost this test; look at thermodata quality, and overrule the flag if it is sound"
    )


def _channels_ruled_out(test: TestData, text: str) -> list[str]:
    """The channels of a driver that flags rule out there. One that is off by a constant is ruled out where that does
    not go out with the start, and drives as ever elsewhere."""
    faulty = [
        name
        for name in names_of(text)
        if (info := test.channels.get(name)) and info.faulty is not None
        if not np.isfinite(test.values.get(name, np.empty(0))).any()
    ]
    logged = all(name in test.values for name in names_of(text))
    return [*faulty, *(shifted_in(test, text) if logged and not is_known(test, text) else ())]
