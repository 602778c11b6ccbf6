"""Fitting: all calibration tests together, each with its own offset; effects with tests of their own come first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.arx import identify_arx, placeholder
from thermodata.modelling.bound import BoundResponse, BoundTerm
from thermodata.modelling.checks import checks
from thermodata.modelling.coarse import search_from_coarse
from thermodata.modelling.design import GRID, MOMENTS, Design, Nonlinear
from thermodata.modelling.fitted import FittedModel
from thermodata.modelling.fitted_response import FittedResponse, FittedTerm, Values, has_response
from thermodata.modelling.orders import choose_orders, open_orders
from thermodata.modelling.resolve import resolve
from thermodata.modelling.roles import Key
from thermodata.modelling.search import Problem
from thermodata.modelling.uncertainty import deviations
from thermodata.plugin import Param
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
    for i in open_orders(bound):
        bound = choose_orders(bound, i, tests, lambda b: fit_response(b, tests, wanted, data))
    bound, arx = _with_placeholders(bound)
    held: dict[int, FittedTerm] = {}
    for own, members in _stages(bound.terms):
        pool = tests if data is None else data.tests
        first, _ = _usable(
            replace(bound, terms=tuple(bound.terms[i] for i in members)), [t for t in pool if t.key in own]
        )
        if not first:
            raise UsageError(
                "no usable test for an effect that is identified first",
                where=", ".join(bound.terms[i].id for i in members),
                expected="the response and the drivers in " + ", ".join("/".join(k) for k in own),
            )
        part = _fit(bound, members, {}, first, wanted, uncertainty)
        held |= {i: replace(part[i], held=True) for i in members}
    rest = [i for i in range(len(bound.terms)) if i not in held]
    fitted = {**held, **_fit(bound, rest, held, tests, wanted, uncertainty and not arx)}
    for i in arx:
        bound = identify_arx(bound, i, fitted, tests, wanted)
    if arx:
        rest = [i for i in range(len(bound.terms)) if i not in held]
        fitted = {**held, **_fit(bound, rest, held, tests, wanted, uncertainty)}
    terms = tuple(fitted[i] for i in range(len(bound.terms)))
    response = FittedResponse(bound, terms, wanted, frozenset(t.key for t in tests))
    return replace(response, **checks(response, tests)) if uncertainty else response


def _with_placeholders(bound: BoundResponse) -> tuple[BoundResponse, list[int]]:
    arx = [i for i, t in enumerate(bound.terms) if t.spec.method == "arx" and t.effect.params]
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


def _fit(
    bound: BoundResponse,
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
    uncertainty: bool,
) -> dict[int, FittedTerm]:
    """Fit some terms of a response together, with others held."""
    order = [*members, *held]
    design = Design(bound, [bound.terms[i] for i in order], tests, wanted)
    if not design.n:
        raise UsageError(
            "no sample counts in the calibration tests",
            where=f"response '{bound.name}'",
            got=", ".join(f"{t.campaign}/{t.test}" for t in tests) or "no test",
            hint="look at the response's flags (thermodata quality) and at 'phases'",
        )
    fixed = {order.index(i): term for i, term in held.items()}
    problem = make_problem(design, fixed)
    x = search_from_coarse(problem, tests, lambda some: make_problem(Design(bound, design.terms, some, wanted), fixed))
    gains = problem.gains(problem.matrix(x))
    sds, logs = deviations(problem, x, gains) if uncertainty else ([{} for _ in design.slots], frozenset[str]())
    by_member: dict[int, dict[str, Values]] = {i: {} for i in members}
    for s, (slot, params) in enumerate(zip(design.slots, problem.params(x), strict=True)):
        if order[slot.term] in by_member:
            names = [g.name for g in bound.terms[order[slot.term]].effect.gains]
            values = gains[problem.starts[s] : problem.starts[s + 1]]
            by_member[order[slot.term]][slot.group] = Values(
                params, dict(zip(names, map(float, values), strict=True)), sds[s], logs, problem.silent[s]
            )
    return {i: FittedTerm(bound.terms[i], groups or {"": _at_start(bound.terms[i])}) for i, groups in by_member.items()}


def _at_start(term: BoundTerm) -> Values:
    """A term that none of the tests covers: at its start, with no gain."""
    return Values(
        {p.name: p.start for p in term.effect.params},
        {g.name: term.spec.fixed.get(g.name, 0.0) for g in term.effect.gains},
    )


def make_problem(design: Design, held: Mapping[int, FittedTerm]) -> Problem:
    """What the spec leaves free. held: place of a term in the design -> the term as identified before."""
    free: list[Nonlinear] = []
    fixed: list[dict[str, float]] = [{} for _ in design.slots]
    low: list[float] = []
    high: list[float] = []
    for s, slot in enumerate(design.slots):
        term = design.terms[slot.term]
        old = held.get(slot.term)
        values = None if old is None else old.groups.get(slot.group)
        for gain in term.effect.gains:
            if old is not None:
                bounds = (0.0, 0.0) if values is None else (values.gains[gain.name],) * 2
            elif gain.name in term.spec.fixed:
                bounds = (term.spec.fixed[gain.name],) * 2
            else:
                signs = {"+": (0.0, np.inf), "-": (-np.inf, 0.0), "any": (-np.inf, np.inf)}[gain.sign]
                bounds = term.spec.bounds.get(gain.name, signs)
            low.append(bounds[0])
            high.append(bounds[1])
        for param in term.effect.params:
            if old is not None:
                fixed[s][param.name] = (old.params if values is None else values.params)[param.name]
            elif param.name in term.spec.fixed:
                fixed[s][param.name] = term.spec.fixed[param.name]
    for i, term in enumerate(design.terms):
        slots = [s for s, slot in enumerate(design.slots) if slot.term == i]
        if i in held or not slots:
            continue
        for param in term.effect.params:
            if param.name in term.spec.fixed:
                continue
            together = not term.spec.shared or param.name in term.spec.shared
            for group in [tuple(slots)] if together else [(s,) for s in slots]:
                _add(design, term, param, group, free, fixed)
    silent = [
        frozenset(set(p) - set(design.terms[slot.term].spec.fixed)) if slot.term not in held else frozenset[str]()
        for slot, p in zip(design.slots, fixed, strict=True)
    ]
    return Problem(design, free, fixed, np.array(low), np.array(high), silent)


def _add(
    design: Design,
    term: BoundTerm,
    param: Param,
    slots: tuple[int, ...],
    free: list[Nonlinear],
    fixed: list[dict[str, float]],
) -> None:
    lower, upper = term.spec.bounds.get(param.name, (param.lower, param.upper))
    moment = param.unit == "min" and param.lower <= 0
    if moment and param.name not in term.spec.bounds:
        ends = [design.tests[j].t_s[-1] / 60.0 for s in slots for j in design.slots[s].tests]
        upper = min(upper, max(ends))
    start = term.spec.start.get(param.name, min(max(param.start, lower), upper))
    if _matters(design, term, param, slots, (lower, upper)):
        log = lower > 0 and upper / lower > 5
        free.append(Nonlinear(param, slots, lower, upper, start, log, MOMENTS if moment else GRID))
    else:
        for s in slots:
            fixed[s][param.name] = start


def _matters(design: Design, term: BoundTerm, param: Param, slots: tuple[int, ...], ends: tuple[float, float]) -> bool:
    """An exponent of a speed means nothing where a temperature drives the effect."""
    if not design.slots or len(term.effect.params) == 1:
        return True
    start = {p.name: term.spec.start.get(p.name, p.start) for p in term.effect.params}
    test = design.tests[design.slots[slots[0]].tests[0]]
    low, high = (term.columns(test, {**start, param.name: end}) for end in ends)
    return not np.allclose(low, high) or not np.any(low)
