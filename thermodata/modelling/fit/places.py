"""Several responses in one fit: `gain_by: place` shares an effect's time constants between the places of a machine.

Each test stands once for every response, with that response under one name. Effects without `gain_by: place` keep
parameters and gains of their own at each place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from thermodata.errors import SpecError
from thermodata.modelling.terms.bound import PLACE, BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.schema.files.model import EffectSpec
from thermodata.view.grid.dataset import Dataset, TestData

RESPONSE = "response's value"  # no channel has such a name
FitResponse = Callable[..., FittedResponse]


def together(bounds: Sequence[BoundResponse]) -> bool:
    """Whether the responses share anything."""
    return len(bounds) > 1 and any("place" in term.spec.gains_by for bound in bounds for term in bound.terms)


def fit_together(
    bounds: Sequence[BoundResponse],
    tests: Sequence[Sequence[TestData]],
    wanted: tuple[str, ...] | None,
    data: Dataset,
    fit: FitResponse,
) -> list[FittedResponse]:
    """tests: the usable ones of each response. The responses as fitted, without checks."""
    if len({tuple(term.id for term in bound.terms) for bound in bounds}) > 1:
        raise SpecError(
            "an effect that acts on some responses only can't be in a model whose responses share time constants",
            where="acts_on",
            hint="leave 'gain_by: place' away, or fit these responses in another model",
        )
    for term in bounds[0].terms:
        if term.seen_at is not None:
            raise SpecError(
                "an effect identified on another response can't be in a model whose responses share time constants",
                where=f"effect '{term.id}'",
                hint="leave its 'response' away, or fit the places one by one",
            )
    copies = [[_at_place(bound, test) for test in own] for bound, own in zip(bounds, tests, strict=True)]
    pool = replace(
        data,
        tests=tuple(_at_place(bound, test) for bound in bounds for test in data.tests if _has_response(bound, test)),
    )
    whole = replace(
        bounds[0], name=RESPONSE, channels={}, terms=tuple(_at_each_place(term) for term in bounds[0].terms)
    )
    fitted = fit(whole, [test for own in copies for test in own], wanted, pool, uncertainty=True)
    return [_of_place(fitted, bound, pool) for bound in bounds]


def _has_response(bound: BoundResponse, test: TestData) -> bool:
    return bound.channel_of(test) in test.values


def _at_place(bound: BoundResponse, test: TestData) -> TestData:
    channel = bound.channel_of(test)
    valid = {**test.valid, RESPONSE: test.valid[channel]} if channel in test.valid else test.valid
    return replace(
        test,
        values={**test.values, RESPONSE: test.values[channel]},
        valid=valid,
        conditions={**test.conditions, PLACE: bound.name},
    )


def _at_each_place(term: BoundTerm) -> BoundTerm:
    if "place" in term.spec.gains_by:
        return replace(term, _drivers={})
    spec = term.spec.model_copy(update={"gain_by": [*term.spec.gains_by, "place"]})
    return replace(term, spec=spec, apart=True, _drivers={})


def _of_place(fitted: FittedResponse, bound: BoundResponse, pool: Dataset) -> FittedResponse:
    """What was found for one of the responses, in its own words."""
    terms = []
    for own, found in zip(bound.terms, fitted.terms, strict=True):
        plain = replace(own, effect=found.bound.effect, spec=_with_orders(own, found), _drivers={})
        groups = {
            plain.group(replace(test, conditions={k: v for k, v in test.conditions.items() if k != PLACE})): values
            for test in pool.tests
            if test.conditions[PLACE] == bound.name and (values := found.values(test)) is not None
        }
        terms.append(FittedTerm(plain, groups or {"": next(iter(found.groups.values()))}, found.held))
    response = replace(bound, terms=tuple(t.bound for t in terms))
    mine = tuple(replace(row, response=bound.name) for row in fitted.tried)
    return replace(fitted, bound=response, terms=tuple(terms), tried=mine)


def _with_orders(own: BoundTerm, found: FittedTerm) -> EffectSpec:
    return own.spec.model_copy(
        update={"orders": found.bound.spec.orders, "delay": found.bound.spec.delay, "fixed": found.bound.spec.fixed}
    )
