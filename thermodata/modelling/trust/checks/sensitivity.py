"""What a fitted response does with each of its parameters, on any tests: the columns that intervals come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.least_squares.design import Design
from thermodata.modelling.terms.bound import each_group_its_own
from thermodata.modelling.terms.fitted_response import FittedResponse, bounds_of
from thermodata.plugin import Float1D, Float2D
from thermodata.view.grid.dataset import TestData

STEP = 1e-3  # of log(value), or of the range

Name = tuple[str, str]
"""A term's id and its parameter or gain ('name[group]' where each group has its own)."""


@dataclass(frozen=True)
class Sensitivity:
    """columns: shape (n, k), freed of each test's offset as the fit has it, to log(value) where that is
    searched; names: shape (k,); residual: shape (n,); parts: the rows of each test."""

    columns: Float2D
    names: tuple[Name, ...]
    residual: Float1D
    parts: tuple[slice, ...]


def sensitivity(response: FittedResponse, tests: Sequence[TestData]) -> Sensitivity:
    """Of everything that the fit left free."""
    terms = [each_group_its_own(t.bound) for t in response.terms]
    design = Design(response.bound, terms, tests, response.phases)
    found: dict[Name, Float1D] = {}
    residual = design.y.copy()
    for s, slot in enumerate(design.slots):
        term = response.terms[slot.term]
        values = term.groups.get(slot.group)
        if values is None:
            continue
        tag = f"[{slot.group}]" if slot.group else ""
        gains = np.array([values.gains[g.name] for g in term.effect.gains])
        base = design.columns(s, values.params)
        residual -= base @ gains
        if term.held:
            continue
        for param in term.effect.params:
            if param.name in term.bound.spec.fixed or param.name in values.silent:
                continue
            own = bool(term.bound.spec.shared) and param.name not in term.bound.spec.shared
            moved, step = _moved(values.params[param.name], bounds_of(term, param))
            change = (design.columns(s, {**values.params, param.name: moved}) - base) @ gains / step
            name = (term.id, f"{param.name}{tag if own else ''}")
            found[name] = found.get(name, 0.0) + change
        for j, gain in enumerate(term.effect.gains):
            if gain.name not in term.bound.spec.fixed:
                found[term.id, f"{gain.name}{tag}"] = base[:, j]
    columns = np.column_stack(list(found.values())) if found else np.zeros((design.n, 0))
    return Sensitivity(columns, tuple(found), residual, tuple(design.parts))


def _moved(value: float, bounds: tuple[float, float]) -> tuple[float, float]:
    """(another value, how far it is in the units of the search)."""
    low, high = bounds
    if low > 0:
        return value * float(np.exp(STEP)), STEP
    step = STEP * (high - low)
    return value + step, step
