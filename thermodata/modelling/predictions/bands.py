"""Where a prediction lies by the uncertainty of its parameters: standard deviations over time.

The spread of the parameters, carried to the prediction by its slopes (the delta method). It says how well these tests
fix the parameters of this model, and nothing of effects that it lacks or of the scatter of measurements.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, Together
from thermodata.plugin import Float1D, Float2D
from thermodata.view.grid.dataset import TestData

STEP = 1e-4  # of a parameter, for its slope


@dataclass(frozen=True)
class Bands:
    """Standard deviations, shape (n,) each, in the response's unit. predicted: with the offset that the test gives,
    None where a term's is not known. contributions: of the terms whose is known."""

    predicted: Float1D | None
    contributions: Mapping[str, Float1D]


def bands(response: FittedResponse, test: TestData, *, from_start: bool = False) -> Bands:
    """Of one response in one test. from_start: of a prediction that counts from 0 at the start, without an offset."""
    slopes: dict[int, tuple[Together, Float2D]] = {}
    known: dict[str, Float1D] = {}
    complete = True
    for term in response.terms:
        if not term.bound.covers(test) or not _has_spread(term):
            continue
        if term.spread is None or (from_start and _is_open(term, term.spread, test)):
            complete = False
            continue
        own = _slopes(term, term.spread, test)
        known[term.id] = _deviation(own, term.spread)
        before = slopes.get(id(term.spread))
        slopes[id(term.spread)] = (term.spread, own if before is None else before[1] + own)
    if not complete or not (slopes or from_start):
        return Bands(None, known)
    start = np.zeros(len(test.t_s), bool) if from_start else response.offset_from(test)
    variance = np.zeros(len(test.t_s))
    for spread, total in slopes.values():  # fitted one after the other: independent of each other
        # the offset is a mean of measured minus predicted: it takes up what moves all samples alike
        centred = total - (total[start].mean(axis=0) if start.any() else 0.0)
        variance += _deviation(centred, spread) ** 2
    return Bands(np.sqrt(variance), known)


def _has_spread(term: FittedTerm) -> bool:
    """Whether anything of the term was fitted; what the file fixes has no spread."""
    names = [p.name for p in term.effect.params] + [g.name for g in term.effect.gains]
    return any(name not in term.bound.spec.fixed for name in names)


def _is_open(term: FittedTerm, spread: Together, test: TestData) -> bool:
    """Whether it acts in a test by a gain of which the fit knows nothing."""
    group, fixed = term.bound.group(test), term.bound.spec.fixed
    known = {name for owners, name in spread.owners if (term.id, group) in owners}
    unknown = [i for i, g in enumerate(term.effect.gains) if g.name not in known and g.name not in fixed]
    return bool(unknown) and bool(np.any(term.columns(test)[:, unknown]))


def _slopes(term: FittedTerm, spread: Together, test: TestData) -> Float2D:
    """shape (n, k): of the term's contribution along each parameter of the spread."""
    out = np.zeros((len(test.t_s), len(spread.matrix)))
    values = term.values(test)
    if values is None:
        return out
    group = term.bound.group(test)
    gains = [g.name for g in term.effect.gains]
    columns = term.columns(test)
    for k, (owners, name) in enumerate(spread.owners):
        if (term.id, group) not in owners:
            continue
        if name in gains:
            out[:, k] = columns[:, gains.index(name)]
        elif name in values.params:
            value = values.params[name]
            step = STEP * (abs(value) or 1.0)
            moved = replace(term, groups={group: replace(values, params={**values.params, name: value + step})})
            slope = (moved.contribution(test) - columns @ [values.gains[g] for g in gains]) / step
            out[:, k] = slope * (value if name in spread.logs else 1.0)
    return out


def _deviation(slopes: Float2D, spread: Together) -> Float1D:
    return np.asarray(np.sqrt(np.maximum(np.einsum("ij,ij->i", slopes @ spread.matrix, slopes), 0.0)))
