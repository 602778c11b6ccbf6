"""The linear half of a fit: masked columns of every term over all tests, kept by time constant.

Each test is freed by itself of what nobody knows (its offset; see `nuisance`), and the state of every lag restarts at
each test.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermodata.modelling.terms.bound import PLACE, BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted_response import fit_mask
from thermodata.modelling.terms.nuisance import Nuisance
from thermodata.plugin import Bool1D, Effect, Float1D, Float2D, Param
from thermodata.view.grid.dataset import TestData

KEPT_BYTES = 256 * 2**20  # of columns, before they all go
GRID = 9  # first look at a time constant or an exponent
MOMENTS = 145  # first look at a moment: its error has no slope to follow


@dataclass(frozen=True)
class Slot:
    """A term in one group of tests: what has gains of its own. tests: places in Design.tests. place: of the response,
    where the term has parameters of its own at each. factors: the group of each test, where groups differ by one
    factor over all gains and so are one slot."""

    term: int
    group: str
    tests: tuple[int, ...]
    place: str = ""
    factors: tuple[str, ...] = ()


@dataclass
class Nonlinear:
    """A parameter that the search moves, in the slots that share it. Searched as log(value) where log is set."""

    param: Param
    slots: tuple[int, ...]
    lower: float
    upper: float
    start: float
    log: bool
    points: int = GRID

    def inside(self, x: float) -> float:
        value = float(np.exp(x)) if self.log else float(x)
        return min(max(value, self.lower), self.upper)

    def outside(self, value: float) -> float:
        return float(np.log(value)) if self.log else float(value)


class Design:
    """What stays the same while a fit searches: tests, masks, centred response, slots."""

    def __init__(
        self,
        bound: BoundResponse,
        terms: Sequence[BoundTerm],
        tests: Sequence[TestData],
        wanted: tuple[str, ...] | None,
    ) -> None:
        self.bound, self.terms, self.tests = bound, tuple(terms), tuple(tests)
        self.masks: list[Bool1D] = [fit_mask(bound, list(terms), wanted, t) for t in tests]
        self.counts = [int(m.sum()) for m in self.masks]
        edges = np.concatenate([[0], np.cumsum(self.counts)])
        self.parts = [slice(int(a), int(b)) for a, b in pairwise(edges)]
        self.n = int(edges[-1])
        self._counted = [slice(None) if m.all() else np.flatnonzero(m) for m in self.masks]
        self.nuisance = [Nuisance(t, m, bound) for t, m in zip(tests, self.masks, strict=True)]
        self.y: Float1D = np.concatenate(
            [
                free.without(t.values[bound.channel_of(t)][m])
                for t, m, free in zip(tests, self.masks, self.nuisance, strict=True)
            ]
            or [np.zeros(0)]
        )
        self.slots = tuple(self._slots())
        self._kept = self._columns_kept()

    def _columns_kept(self) -> dict[Hashable, tuple[Effect, Float2D]]:
        """Kept with the tests until others are fitted: a further fit to the same samples looks at many of the same
        points. With their effects, for an id is one's own as long as one lives."""
        if not self.tests:
            return {}
        weights = (self.bound.name, *self.bound.weights.items()) if self.bound.weights else ()
        key = tuple(map(id, self.tests)), b"".join(m.tobytes() for m in self.masks), weights
        kept = self.tests[0].kept
        if key not in kept.get("columns", {}):
            kept["columns"] = {key: (self.tests, {})}
        found: dict[Hashable, tuple[Effect, Float2D]] = kept["columns"][key][1]
        return found

    def _slots(self) -> list[Slot]:
        slots = []
        for i, term in enumerate(self.terms):
            groups: dict[tuple[str, str], list[int]] = {}
            for j, test in enumerate(self.tests):
                if term.covers(test) and self.counts[j]:
                    place = str(test.conditions.get(PLACE, "")) if term.apart else ""
                    group = "" if term.spec.one_gain else term.group(test)
                    groups.setdefault((group, place), []).append(j)
            for (group, place), js in groups.items():
                factors = tuple(term.group(self.tests[j]) for j in js) if term.spec.one_gain else ()
                slots.append(Slot(i, group, tuple(js), place, factors))
        return slots

    def names(self, slot: int) -> list[str]:
        own = [p.name for p in self.terms[self.slots[slot].term].effect.params]
        return own + [factor(group) for group in self.other_groups(slot)]

    def other_groups(self, slot: int) -> list[str]:
        """Groups whose factor is searched: all but the first, whose factor is 1."""
        return list(dict.fromkeys(self.slots[slot].factors))[1:]

    def columns(self, slot: int, params: Mapping[str, float]) -> Float2D:
        """shape (n, gains): masked, centred a test, zero in tests outside the slot."""
        term, of = self.terms[self.slots[slot].term], self.slots[slot]
        values = tuple(params[name] for name in self.names(slot))
        phases = tuple(term.spec.phases or ())
        key = id(term.effect), term.reading, phases, of.tests, of.factors, values
        if key not in self._kept:
            made = np.zeros((self.n, len(term.effect.gains)), order="F")
            found = term.columns_of_each([self.tests[j] for j in of.tests], params)
            for k, (j, whole) in enumerate(zip(of.tests, found, strict=True)):
                own = self.nuisance[j].without(whole[self._counted[j]])
                made[self.parts[j]] = own * params.get(factor(of.factors[k]), 1.0) if of.factors else own
            if (len(self._kept) + 1) * made.nbytes > KEPT_BYTES:
                self._kept.clear()
            self._kept[key] = term.effect, made
        return self._kept[key][1]


def factor(group: str) -> str:
    """The name of a group's factor among the parameters."""
    return f"g[{group}]"
