"""What a driver's start value, which is known only so well, does to a prediction.

Temperatures count from the start of their test, and a lag begins there in balance. A start that is read wrong by d is a
step of d that never was: it fades with the lag's time constant, as a test's own offset does not. The interval of a
parameter holds this beside the noise of the response.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.effect.guard import guarded_basis
from thermodata.modelling.inputs.drivers import evaluate, start_deviation, step_s
from thermodata.modelling.least_squares.design import Design
from thermodata.modelling.terms.bound import BoundTerm
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.plugin import Array, Float1D, Float2D
from thermodata.view.grid.dataset import TestData

Disturbance = tuple[slice, Float1D]
"""Rows of the design, and what one standard deviation does there, in the response's unit."""


def disturbances(
    design: Design, params: Sequence[Mapping[str, float]], gains: Float1D, starts: Array
) -> list[Disturbance]:
    """One a driver and test. params: of each slot; starts: the first column of each slot among the gains."""
    found: dict[tuple[int, str], Float1D] = {}
    for s, slot in enumerate(design.slots):
        term = design.terms[slot.term]
        own = gains[starts[s] : starts[s + 1]]
        if isinstance(term.effect, OfTests) or not np.any(own):
            continue
        for j in slot.tests:
            test = design.tests[j]
            for role, text in term.binding_of(test).items():
                size = _start_deviation(term, role, text, test)
                if size > 0:
                    moved = _moved(term, test, role, size, params[s])[design.masks[j]]
                    step = design.nuisance[j].without(moved) @ own
                    # one channel that drives two effects is read wrong once
                    found[j, text] = found.get((j, text), 0.0) + step
    return [(design.parts[j], step) for (j, _), step in found.items()]


def _start_deviation(term: BoundTerm, role: str, text: str, test: TestData) -> float:
    need = next(n for n in term.effect.needs if n.role == role)
    raw, good, relative = evaluate(test, text)
    if not relative or need.quantity == "position" or not good.any():
        return 0.0
    return start_deviation(raw[good], step_s(test))


def _moved(term: BoundTerm, test: TestData, role: str, size: float, params: Mapping[str, float]) -> Float2D:
    """By how much the effect's columns move, shape (n, gains)."""
    drivers = term.drivers(test)
    other = replace(drivers, values={**drivers.values, role: drivers.values[role] + size})
    found = np.asarray(guarded_basis(term.effect, other, params) - guarded_basis(term.effect, drivers, params))
    return term.while_acting(test, found)
