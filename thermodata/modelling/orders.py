"""Orders of a transfer function that the model file leaves open: by free-run FIT, the fewest that do as well."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import cast

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.bound import BoundResponse, BoundTerm
from thermodata.modelling.fitted_response import FittedResponse
from thermodata.modelling.score import fit_percent
from thermodata.modelling.transfer import MOST, NAME, FreeFunction
from thermodata.plugin import Effect
from thermodata.view.dataset import TestData

AS_GOOD = 0.5  # points of FIT
APART = 1.5  # ratio of two time constants
SURE = 0.7  # standard deviation of log(tau)
Fit = Callable[[BoundResponse], FittedResponse]


def open_orders(bound: BoundResponse) -> list[int]:
    """Places of the terms whose orders the file leaves open."""
    return [
        i
        for i, t in enumerate(bound.terms)
        if t.spec.effect == NAME and t.spec.orders is None and isinstance(t.effect, FreeFunction)
    ]


def choose_orders(bound: BoundResponse, i: int, tests: Sequence[TestData], fit: Fit) -> BoundResponse:
    """The response with the orders of term i set. fit: fits a response with uncertainty.

    varpro: one lag more only while all lags are apart, inside their bounds and known (a third lag that the data
    can't identify is refused). oe and arx: 1-4 x 1-4, unstable functions left out.
    """
    if (bound.terms[i].spec.method or "varpro") == "varpro":
        best = bound
        for count in range(1, MOST + 1):
            trial = with_orders(bound, i, (count, count))
            if count > 1 and not _identified(fit(trial), i):
                break
            best = trial
        return best
    tried: list[tuple[float, int, BoundResponse]] = []
    for orders in _pairs():
        trial = with_orders(bound, i, orders)
        try:
            tried.append((free_run_fit(fit(trial), tests), sum(orders), trial))
        except UsageError:  # not stable
            continue
    if not tried:
        raise UsageError("no order from 1 to 4 gives a stable function", where=bound.terms[i].id, hint="method: varpro")
    top = max(score for score, _, _ in tried)
    return min((t for t in tried if t[0] >= top - AS_GOOD), key=lambda t: (t[1], -t[0]))[2]


def with_orders(bound: BoundResponse, i: int, orders: tuple[int, int]) -> BoundResponse:
    term = bound.terms[i]
    spec = term.spec.model_copy(update={"orders": orders})
    effect = cast(Effect, FreeFunction(term.spec.method or "varpro", orders))
    made: BoundTerm = replace(term, spec=spec, effect=effect)
    return replace(bound, terms=tuple(made if k == i else t for k, t in enumerate(bound.terms)))


def free_run_fit(response: FittedResponse, tests: Sequence[TestData]) -> float:
    """FIT [%] over some tests together, each with its own free offset."""
    measured, residual = [], []
    for test in tests:
        mask = response.mask(test)
        y, r = response.measured(test)[mask], (response.measured(test) - response.predict(test))[mask]
        if len(y):
            measured.append(y - y.mean())
            residual.append(r - r.mean())
    if not measured:
        return -np.inf
    fit = fit_percent(np.concatenate(measured), np.concatenate(residual))
    return -np.inf if fit is None else fit


def _pairs() -> Iterator[tuple[int, int]]:
    for numerator in range(1, MOST + 1):
        for denominator in range(1, MOST + 1):
            yield numerator, denominator


def _identified(response: FittedResponse, i: int) -> bool:
    term = response.terms[i]
    taus = sorted((term.params[p.name], p.name) for p in term.effect.params)
    apart = all(b[0] > APART * a[0] for a, b in pairwise(taus))
    # a time constant at its bound has no deviation
    sure = all(term.sd.get(name, np.inf) < SURE for _, name in taus)
    weighty = all(abs(term.gains[g.name]) > 2 * term.sd.get(g.name, np.inf) for g in term.effect.gains)
    return apart and sure and weighty
