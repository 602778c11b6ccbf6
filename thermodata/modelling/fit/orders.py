"""Orders of a transfer function that the model file leaves open: by FIT on left-out tests, the fewest that do as well.

FIT on the tests that were fitted rises with every coefficient, and says nothing of an unseen test.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from typing import Any, cast

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.least_squares.coarse import coarse_tests
from thermodata.modelling.model_file.transfer.as_effect import MOST, NAME, FreeFunction
from thermodata.modelling.predictions.left_out import Fold, folds, left_out_fit
from thermodata.modelling.predictions.score import fit_percent
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, fit_mask
from thermodata.plugin import Effect
from thermodata.schema.files.model import EffectSpec
from thermodata.view.grid.dataset import TestData

AS_GOOD = 0.5  # points of FIT
DELAY = 2  # steps of an ARX: what a grid shifts; a longer one is a part's own, and `also: [dead_time]` searches it
APART = 1.5  # ratio of two time constants
SURE = 0.7  # standard deviation of log(tau)
Near = Mapping[int, FittedTerm] | None
Identify = Callable[[BoundResponse, Sequence[TestData], Near, bool], FittedResponse]


@dataclass(frozen=True)
class Tried:
    """Orders that were tried. fit_left_out, fit_worst: FIT [%] on tests (or parts of the one test) left out, all
    together and the worst; fit_calibration: on those that were fitted. why: what speaks against them, or None. delay:
    of an ARX's driver, in steps."""

    response: str
    effect: str
    method: str
    numerator: int
    denominator: int
    fit_left_out: float | None
    fit_worst: float | None
    fit_calibration: float | None
    chosen: bool = False
    why: str | None = None
    delay: int = 0

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True)
class Choice:
    """bound: with the orders set; near: where a search may start; table: every order that was tried."""

    bound: BoundResponse
    near: Near
    table: tuple[Tried, ...]


def open_orders(bound: BoundResponse) -> list[int]:
    """Places of the terms whose orders, or whose delay, the file leaves open."""
    return [i for i, t in enumerate(bound.terms) if isinstance(t.effect, FreeFunction) and leaves_open(t.spec)]


def leaves_open(spec: EffectSpec) -> bool:
    """Whether an effect is a transfer function of which the file does not say all orders, or the delay of an ARX."""
    return spec.effect == NAME and (spec.orders is None or (spec.method == "arx" and spec.delay is None))


def choose_orders(
    bound: BoundResponse,
    i: int,
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
    identify: Identify,
) -> Choice:
    """Set the orders of term i. identify: fits a response to some tests (near a point, with uncertainty or without).

    varpro: 1 to 4 lags, alone and with a direct term, as long as all are apart, inside their bounds and known (a third
    lag that the data can't identify is refused). oe and arx: 1-4 x 1-4, unstable functions left out; for the chosen
    orders of an arx the driver is tried a step or two late as well. Lags need no sample after sample, so that oe and
    varpro are tried on means of neighbours where there are many samples.
    """
    spec = bound.terms[i].spec
    search = _Search.of(bound, i, tests, wanted, identify)
    trials: list[_Trial] = []
    for orders in _pairs(search.method) if spec.orders is None else [spec.orders]:
        trials.append(search.tried(orders, spec.delay, trials))
        if search.method == "varpro" and orders[0] > orders[1] and trials[-1].row.why and trials[-2].row.why:
            break
    good = [r for r in trials if r.row.why is None]
    if not good and spec.orders is None:
        raise next(r.failed for r in trials if r.failed is not None)
    best = _fewest(good) if good else trials[0]
    if search.method == "arx" and spec.delay is None:
        late = [search.tried((best.row.numerator, best.row.denominator), d, trials) for d in range(1, DELAY + 1)]
        trials += late
        # a delay costs no coefficient
        best = max([best, *(r for r in late if r.row.why is None)], key=lambda r: _number(r.row.fit_left_out))
    if best.full is None:  # too little to leave any out: orders that are given need no choice
        return Choice(best.bound, None, tuple(r.row for r in trials))
    table = tuple(replace(r.row, chosen=r is best) for r in trials)
    return Choice(best.bound, None if search.method == "arx" else _terms_near(best.bound, best.full), table)


@dataclass(frozen=True)
class _Trial:
    """found: fitted to all tests; failed: why it could not be, there or without some of them."""

    row: Tried
    bound: BoundResponse
    found: FittedResponse | None
    failed: UsageError | None = None

    @property
    def orders(self) -> tuple[int, int]:
        return self.row.numerator, self.row.denominator

    @property
    def full(self) -> FittedResponse | None:
        """Fitted to all tests, and without some of them too."""
        return None if self.failed is not None else self.found


@dataclass(frozen=True)
class _Search:
    """One term of a response, and the tests on which its orders are tried. left_out: folds of these."""

    bound: BoundResponse
    i: int
    tests: Sequence[TestData]
    left_out: Sequence[Fold]
    identify: Identify

    @classmethod
    def of(
        cls,
        bound: BoundResponse,
        i: int,
        tests: Sequence[TestData],
        wanted: tuple[str, ...] | None,
        identify: Identify,
    ) -> _Search:
        some = list(tests) if bound.terms[i].spec.method == "arx" else coarse_tests(tests, wanted)
        found = folds(some, bound.channel_of, lambda t: fit_mask(bound, list(bound.terms), wanted, t))
        return cls(bound, i, some, found, identify)

    @property
    def method(self) -> str:
        return self.bound.terms[self.i].spec.method or "varpro"

    def tried(self, orders: tuple[int, int], delay: int | None, before: Sequence[_Trial]) -> _Trial:
        """One pair of orders, from what those before it came to."""
        method, identity = self.method, self.bound.terms[self.i].id
        # a delay of none is chosen as well: what chose it does not ask again
        trial = with_orders(self.bound, self.i, orders, delay or 0 if method == "arx" else None)
        row = Tried(self.bound.name, identity, method, *orders, None, None, None, delay=delay or 0)
        found_at = {t.orders: t.found for t in before if t.found is not None}
        near = _start(self.bound, self.i, orders, found_at) if method == "oe" else None
        full: FittedResponse | None = None
        try:
            full = self.identify(trial, self.tests, near, method == "varpro")
            start = None if method == "arx" else _terms_near(trial, full)
            total, worst = left_out_fit(self.left_out, lambda train: self.identify(trial, train, start, False))
        except UsageError as error:
            return _Trial(replace(row, why=error.what), trial, full, error)
        row = replace(
            row,
            fit_left_out=_finite_or_none(total),
            fit_worst=_finite_or_none(worst),
            fit_calibration=_finite_or_none(free_run_fit(full, self.tests)),
            why=_unidentified(full, identity) if method == "varpro" and orders != (1, 1) else None,
        )
        return _Trial(row, trial, full)


def _fewest(good: Sequence[_Trial]) -> _Trial:
    """The fewest coefficients of those that do as well as the best."""
    scored = [r for r in good if r.row.fit_left_out is not None] or list(good[:1])
    top = max(_number(r.row.fit_left_out) for r in scored)
    return min(
        (r for r in scored if _number(r.row.fit_left_out) >= top - AS_GOOD),
        key=lambda r: (r.row.numerator + r.row.denominator, -_number(r.row.fit_left_out)),
    )


def with_orders(bound: BoundResponse, i: int, orders: tuple[int, int], delay: int | None = None) -> BoundResponse:
    term = bound.terms[i]
    spec = term.spec.model_copy(update={"orders": orders, "delay": delay})
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


def _pairs(method: str) -> Iterator[tuple[int, int]]:
    for denominator in range(1, MOST + 1):
        for numerator in range(1, MOST + 1) if method != "varpro" else (denominator, denominator + 1):
            yield numerator, denominator


def _start(
    bound: BoundResponse, i: int, orders: tuple[int, int], found_at: Mapping[tuple[int, int], FittedResponse]
) -> Near:
    """The lags that one coefficient less was found with; or those of one lag less, and one more that is looked for over
    its whole range. One coefficient over a lag is a lag, two are a lag with a direct term: their time constants lie
    apart, so that none starts from the other."""
    numerator, denominator = orders
    if numerator > 2:
        return _terms_near(bound, found_at.get((numerator - 1, denominator)))
    fewer = found_at.get((numerator, denominator - 1))
    near = _terms_near(bound, fewer)
    if near is None or denominator != 2:
        return near
    # the only lag has no number
    groups = {g: replace(v, params={"tau_1": v.params["tau"]}) for g, v in near[i].groups.items()}
    return {**near, i: replace(near[i], groups=groups)}


def _terms_near(bound: BoundResponse, full: FittedResponse | None) -> Near:
    """Terms by their place in the response; None where there is nothing to start from."""
    if full is None:
        return None
    places = {term.id: i for i, term in enumerate(bound.terms)}
    return {places[term.id]: term for term in full.terms}


def _unidentified(response: FittedResponse, identity: str) -> str | None:
    term = next(t for t in response.terms if t.id == identity)
    taus = sorted((term.params[p.name], p.name) for p in term.effect.params)
    if any(b[0] <= APART * a[0] for a, b in pairwise(taus)):
        return "two lags are one"
    # a time constant at its bound has no deviation
    if any(term.sd.get(name, np.inf) >= SURE for _, name in taus):
        return "a time constant that these tests do not tell"
    if any(abs(term.gains[g.name]) <= 2 * term.sd.get(g.name, np.inf) for g in term.effect.gains):
        return "a lag without a gain"
    return None


def _finite_or_none(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _number(value: float | None) -> float:
    return -np.inf if value is None else value
