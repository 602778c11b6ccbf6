"""Fitting: all calibration tests together, each with its own offset; effects with tests of their own come first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from thermodata.errors import UsageError
from thermodata.modelling.arx import identify_arx, placeholder
from thermodata.modelling.bound import BoundResponse, BoundTerm
from thermodata.modelling.checks import checks
from thermodata.modelling.fitted import FittedModel
from thermodata.modelling.fitted_response import FittedResponse, FittedTerm, has_response
from thermodata.modelling.joint import fit_jointly
from thermodata.modelling.orders import Near, Tried, choose_orders, open_orders
from thermodata.modelling.resolve import resolve
from thermodata.modelling.roles import Key
from thermodata.schema.model import Model
from thermodata.store.base.counting import counted
from thermodata.view.dataset import Dataset, TestData


def fit_model(spec: Model, data: Dataset, *, base: Path | None = None, uncertainty: bool = True) -> FittedModel:
    """Fit every response of a model. base: the folder that `file` of an effect is relative to (default: here).

    Tests that lack the response or a driver are skipped and named in `.skipped`. Raises SpecError where the spec does
    not fit the data, UsageError where no calibration test is left.
    """
    roles, bound = resolve(spec, data, base)
    wanted = None if spec.phases is None else tuple(spec.phases)
    responses, skipped = [], list[str]()
    keys = (*roles.calibrate, *roles.verify) if spec.in_sample else roles.calibrate
    for response in counted(bound, "responses"):
        usable, why = _usable(response, [data.test(*key) for key in keys])
        skipped += why
        fitted = fit_response(response, usable, wanted, data, uncertainty=uncertainty)
        responses.append(replace(fitted, calibrate=frozenset(roles.calibrate)))
    return FittedModel(spec, roles, tuple(responses), tuple(dict.fromkeys(skipped)))


def fit_response(
    bound: BoundResponse,
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
    data: Dataset | None = None,
    *,
    uncertainty: bool = True,
) -> FittedResponse:
    """Fit one response to some tests (all must have its drivers). data: where effects that are identified first
    find their own tests (default: among `tests`)."""
    tried: list[Tried] = []
    held: dict[int, FittedTerm] = {}
    for own, members in _stages(bound.terms):
        pool = tests if data is None else data.tests
        part = replace(bound, terms=tuple(bound.terms[i] for i in members))
        first, _ = _usable(part, [t for t in pool if t.key in own])
        if not first:
            raise UsageError(
                "no usable test for an effect that is identified first",
                where=", ".join(bound.terms[i].id for i in members),
                expected="the response and the drivers in " + ", ".join("/".join(k) for k in own),
            )
        bound, found = _identify(bound, members, {}, first, wanted, uncertainty, tried)
        held |= {i: replace(found[i], held=True) for i in members}
    rest = [i for i in range(len(bound.terms)) if i not in held]
    bound, found = _identify(bound, rest, held, tests, wanted, uncertainty, tried)
    fitted = {**held, **found}
    terms = tuple(fitted[i] for i in range(len(bound.terms)))
    response = FittedResponse(bound, terms, wanted, frozenset(t.key for t in tests))
    response = replace(response, tried=tuple(tried))
    return replace(response, **checks(response, tests)) if uncertainty else response


def _identify(
    bound: BoundResponse,
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
    uncertainty: bool,
    tried: list[Tried],
) -> tuple[BoundResponse, dict[int, FittedTerm]]:
    """Some terms together, with others held; the response with the orders that were open."""
    near: Near = None
    for i in (i for i in open_orders(bound) if i in members):
        choice = choose_orders(bound, i, tests, wanted, partial(_with_given_orders, members, held, wanted))
        bound, near = choice.bound, choice.near
        tried += choice.table
    return _given_orders(bound, members, held, tests, wanted, uncertainty, near)


def _with_given_orders(
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    wanted: tuple[str, ...] | None,
    bound: BoundResponse,
    tests: Sequence[TestData],
    near: Near,
    uncertainty: bool,
) -> FittedResponse:
    """The response of these terms alone, while orders are tried."""
    bound, found = _given_orders(bound, members, held, tests, wanted, uncertainty, near, loose=not uncertainty)
    terms = {**held, **found}
    part = replace(bound, terms=tuple(t for i, t in enumerate(bound.terms) if i in terms))
    return FittedResponse(part, tuple(terms[i] for i in sorted(terms)), wanted, frozenset(t.key for t in tests))


def _given_orders(
    bound: BoundResponse,
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
    uncertainty: bool,
    near: Near,
    *,
    loose: bool = False,
) -> tuple[BoundResponse, dict[int, FittedTerm]]:
    bound, arx = _with_placeholders(bound, members)
    found = fit_jointly(bound, members, held, tests, wanted, uncertainty and not arx, None if arx else near, loose)
    for i in arx:
        bound = identify_arx(bound, i, {**held, **found}, tests, wanted)
    if arx:
        found = fit_jointly(bound, members, held, tests, wanted, uncertainty, loose=loose)
    return bound, found


def _with_placeholders(bound: BoundResponse, members: Sequence[int]) -> tuple[BoundResponse, list[int]]:
    arx = [i for i, t in enumerate(bound.terms) if i in members and t.spec.method == "arx" and t.effect.params]
    terms = tuple(placeholder(t) if i in arx else t for i, t in enumerate(bound.terms))
    return replace(bound, terms=terms), arx


def _usable(bound: BoundResponse, tests: Sequence[TestData]) -> tuple[list[TestData], list[str]]:
    usable, why = [], []
    for test in tests:
        missing = [t.id for t in bound.terms if not t.has(test)]
        if not has_response(bound, test):
            why.append(f"{test.campaign}/{test.test}: no '{bound.name}'")
        elif missing:
            why.append(f"{test.campaign}/{test.test}: no driver for {', '.join(missing)}")
        else:
            usable.append(test)
    return usable, why


def _stages(terms: Sequence[BoundTerm]) -> list[tuple[frozenset[Key], list[int]]]:
    """Effects that share their own tests are identified together, in the order of the file."""
    stages: dict[frozenset[Key], list[int]] = {}
    for i, term in enumerate(terms):
        if term.calibrate is not None:
            stages.setdefault(term.calibrate, []).append(i)
    return list(stages.items())
