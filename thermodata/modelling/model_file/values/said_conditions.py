"""The conditions that a gain differs by: every test that its effect is asked in has to say its own."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.errors import SpecError, unknown_name
from thermodata.modelling.terms.bound import BoundResponse, conditions_of, group_of
from thermodata.modelling.terms.fitted_response import has_response
from thermodata.view.grid.dataset import TestData

_LISTED = 8


def refuse_unsaid_of(response: BoundResponse, tests: Sequence[TestData]) -> None:
    """Of all that its effects' `gain_by` name. tests: that the model is fitted to or scored on; what can't be predicted
    for want of a channel is none of them."""
    measured = [t for t in tests if has_response(response, t)]
    for term in response.terms:
        asked = [t for t in measured if term.covers(t) and term.has(t)]
        for by in term.spec.gains_by:
            refuse_unsaid(by, asked, f"gain_by of effect '{term.id}'")


def refuse_unsaid(by: str, tests: Sequence[TestData], where: str) -> None:
    """SpecError where some tests have no such condition, UsageError where none has it."""
    said = {t.key: value for t in tests if (value := group_of(t, by)) is not None}
    without = [t for t in tests if t.key not in said]
    if not without:
        return
    if not said:
        known = dict.fromkeys(name for t in tests for name in conditions_of(t))
        raise unknown_name("condition", by, list(known), where=f"{where}, in any test")
    having = [t for t in tests if t.key in said]
    values = [f"{v} in {_tests_shown([t for t in having if said[t.key] == v])}" for v in dict.fromkeys(said.values())]
    raise SpecError(
        f"some tests have no condition '{by}', and so no gain",
        where=where,
        expected=f"'{by}' in every test that the effect is asked in",
        got=f"none in {_tests_shown(without)}; {'; '.join(values)}",
        hint="say it of them in the campaign file; where the effect does not act in them, name those in which it does "
        f"in the model file: tests: [{', '.join(_names(having, tests))}]",
    )


def _names(tests: Sequence[TestData], beside: Sequence[TestData]) -> list[str]:
    """All of them, as a model file takes them: with their campaign where the model is of several."""
    several = len({t.campaign for t in beside}) > 1
    return [f"{t.campaign}/{t.test}" if several else t.test for t in tests]


def _tests_shown(tests: Sequence[TestData]) -> str:
    more = ", ..." if len(tests) > _LISTED else ""
    return ", ".join(t.test for t in tests[:_LISTED]) + more
