"""Lags of one function, the fastest first.

A sum (or product) of lags is the same whichever is called the first, and a search ends in either order. What is said of
`tau_1` holds only where it is known which one that is: intervals, printed tables, and models beside each other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.least_squares.search import Problem
from thermodata.modelling.terms.bound import BoundTerm
from thermodata.plugin import Float1D


@dataclass(frozen=True)
class SwappableLags:
    """Lags that could change places. places: among the searched parameters; columns: of the last one's gain, one a slot
    (none where no gain belongs to a lag)."""

    places: tuple[int, ...]
    columns: tuple[int, ...]


def fastest_first(problem: Problem, x: Float1D) -> Float1D:
    """The same point of the search with like lags in order; shape (free parameters,). Lags that the model file tells
    apart by name (fixed, bounds, start) stay."""
    out = x.copy()
    for found in swappable_lags(problem):
        out[list(found.places)] = np.sort(x[list(found.places)])
    return out


def swappable_lags(problem: Problem) -> list[SwappableLags]:
    """All lags of a problem that could change places, by function."""
    by_function = dict[tuple[int, tuple[int, ...]], list[int]]()
    for i, free in enumerate(problem.free):
        at = problem.design.slots[free.slots[0]].term
        if free.param.name in _interchangeable(problem.design.terms[at]):
            by_function.setdefault((at, free.slots), []).append(i)
    found = []
    for (at, slots), places in by_function.items():
        term = problem.design.terms[at]
        gain_of = _interchangeable(term)
        if len(places) == len(gain_of) > 1:
            gains = [g.name for g in term.effect.gains]
            last = gain_of[problem.free[places[-1]].param.name]
            columns = tuple(int(problem.starts[s]) + gains.index(last) for s in slots) if last else ()
            found.append(SwappableLags(tuple(places), columns))
    return found


def _interchangeable(term: BoundTerm) -> Mapping[str, str]:
    gain_of: Mapping[str, str] = getattr(term.effect, "interchangeable", {})
    gains = [g.name for g in term.effect.gains]
    told = {*term.spec.fixed, *term.spec.bounds, *term.spec.start}
    return {} if told & {*gain_of, *gains} else gain_of
