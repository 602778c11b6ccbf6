"""Steps that the model has: no other test says how large a slip of one was, so there a level is free after it."""

from __future__ import annotations

from thermodata.diagnosis.question.problem import Problem
from thermodata.modelling.terms.fitted_response import FittedResponse

_MOMENT = "at"  # parameter of a step [min]


def steps_of_model(fitted: FittedResponse, problem: Problem) -> dict[tuple[str, str], list[float]]:
    """(campaign, test) -> the moments of the steps that the model has there [s]."""
    found: dict[tuple[str, str], list[float]] = {}
    steps = [t for t in fitted.terms if t.effect.family == "artefact" and _MOMENT in {p.name for p in t.effect.params}]
    for test in {b.test.key: b.test for b in problem.blocks}.values():
        values = [term.values(test) for term in steps if term.bound.covers(test)]
        moments = sorted(60.0 * one.params[_MOMENT] for one in values if one is not None)
        if moments:
            found[test.key] = moments
    return found
