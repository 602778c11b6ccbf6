"""One joint fit: some terms of a response over some tests, with other terms held."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.modelling.inputs.counted_samples import refuse_too_few
from thermodata.modelling.least_squares.coarse import rough, search_from_coarse
from thermodata.modelling.least_squares.design import GRID, MOMENTS, Design, Nonlinear, factor
from thermodata.modelling.least_squares.labels import fastest_first
from thermodata.modelling.least_squares.search import Problem, along_whole_range, search
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm, each_group_its_own
from thermodata.modelling.terms.fitted_response import FACTOR, Ends, FittedResponse, FittedTerm, Together, Values
from thermodata.modelling.trust.intervals.uncertainty import Cover, Rough, Spread, spreads
from thermodata.plugin import Float1D, Param
from thermodata.view.grid.dataset import TestData

FACTORS = (0.02, 50.0)  # of one group's gains to another's


@dataclass(frozen=True, slots=True)
class FitSettings:
    """How a response is fitted. wanted: the phases whose samples count, None for all. uncertainty: whether intervals
    are asked for; profiled: and looked at by their profiles, of the terms of these ids (`of`), None for all. near: the
    terms as they were found on nearly the same data, where the search starts without a look over the whole range.
    loose: see `search`."""

    wanted: tuple[str, ...] | None
    uncertainty: bool
    near: Mapping[int, FittedTerm] | None = None
    loose: bool = False
    profiled: bool = True
    of: frozenset[str] | None = None


def fit_jointly(
    bound: BoundResponse,
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    how: FitSettings,
) -> dict[int, FittedTerm]:
    """Fit some terms of a response together, with others held."""
    order = [*members, *held]
    terms = [bound.terms[i] if i in members else each_group_its_own(bound.terms[i]) for i in order]
    design = Design(bound, terms, tests, how.wanted)
    refuse_too_few(bound.name, tests, design.counts)
    fixed = {order.index(i): term for i, term in held.items()}
    problem = make_problem(design, fixed)

    def on(some: Sequence[TestData]) -> Problem:
        return make_problem(Design(bound, design.terms, some, how.wanted), fixed)

    def look() -> Problem | None:
        return rough(problem, tests, how.wanted, on)

    if how.near is None and not how.loose:
        x = search_from_coarse(problem, tests, on)
    elif how.near is None:
        x = search(problem, None, how.loose)
    else:
        x = search(
            problem, _start_near(problem, {order.index(i): how.near[i] for i in members if i in how.near}), how.loose
        )
    x = fastest_first(problem, x)
    gains = problem.gains(problem.matrix(x))
    none: tuple[list[Spread], frozenset[str], Cover | None] = ([Spread() for _ in design.slots], frozenset(), None)
    if how.uncertainty:
        asked = None if how.of is None else [s for s, slot in enumerate(design.slots) if terms[slot.term].id in how.of]
        spread, logs, cover = spreads(problem, x, gains, look if how.profiled else None, asked)
    else:
        spread, logs, cover = none
    together = None if cover is None else _owners_together(design, cover, logs)
    by_member: dict[int, dict[str, Values]] = {i: {} for i in members}
    for s, (slot, params) in enumerate(zip(design.slots, problem.params(x), strict=True)):
        if order[slot.term] in by_member:
            names = [g.name for g in bound.terms[order[slot.term]].effect.gains]
            values = gains[problem.starts[s] : problem.starts[s + 1]]
            known = dict(zip(names, map(float, values), strict=True))
            found = Values(params, known, spread[s].sd, spread[s].half, spread[s].ends, logs, problem.silent[s])
            by_member[order[slot.term]] |= _by_group(design, s, found)
    return {
        i: FittedTerm(bound.terms[i], groups or {"": _at_start(bound.terms[i])}, spread=together if groups else None)
        for i, groups in by_member.items()
    }


def _owners_together(design: Design, cover: Cover, logs: frozenset[str]) -> Together | None:
    """None where groups differ by a factor: what spreads then is a product."""
    if any(slot.factors for slot in design.slots):
        return None
    owners = tuple(
        (tuple((design.terms[design.slots[s].term].id, design.slots[s].group) for s in slots), name)
        for slots, name in cover.owners
    )
    return Together(owners, cover.matrix, logs)


def fitted_problem(response: FittedResponse, tests: Sequence[TestData]) -> tuple[Problem, Float1D, Rough]:
    """What was fitted, as a problem at its point: all terms that were not held; what makes the same on fewer samples
    (None where there are few)."""
    held = {i: term for i, term in enumerate(response.terms) if term.held}
    order = [*(i for i in range(len(response.terms)) if i not in held), *held]
    terms = [each_group_its_own(t.bound) if t.held else t.bound for t in (response.terms[i] for i in order)]
    fixed = {order.index(i): term for i, term in held.items()}

    def on(some: Sequence[TestData]) -> Problem:
        return make_problem(Design(response.bound, terms, some, response.phases), fixed)

    problem = on(tests)
    x = _point_where_terms_stood(problem, {k: response.terms[i] for k, i in enumerate(order)})
    return problem, x, lambda: rough(problem, tests, response.phases, on)


def _by_group(design: Design, s: int, found: Values) -> dict[str, Values]:
    """What a slot found, for each of its groups; where they differ by a factor, with the factor in the gains."""
    slot = design.slots[s]
    if not slot.factors:
        return {slot.group: found}
    own = {p.name for p in design.terms[slot.term].effect.params}
    params = {name: value for name, value in found.params.items() if name in own}
    groups = {}
    for group in dict.fromkeys(slot.factors):
        g = found.params.get(factor(group), 1.0)
        sd, half = (_of_group(spread, group, g, own) for spread in (found.sd, found.half))
        ends = {n: e if n in own else _times(e, g) for n, e in found.ends.items() if not n.startswith("g[")}
        logs = found.log_names | {FACTOR}
        gains = {n: g * v for n, v in found.gains.items()}
        groups[group] = Values(params, gains, sd, half, ends, logs, found.silent, g)
    return groups


def _of_group(spread: Mapping[str, float], group: str, g: float, own: set[str]) -> dict[str, float]:
    """Deviations of gains grow with the group's factor, whose own stands beside them."""
    found = {n: value * (1.0 if n in own else g) for n, value in spread.items() if not n.startswith("g[")}
    return found | ({FACTOR: spread[factor(group)]} if factor(group) in spread else {})


def _times(ends: Ends, g: float) -> Ends:
    low, high = (None if end is None else g * end for end in ends)
    return low, high


def _point_where_terms_stood(problem: Problem, known: Mapping[int, FittedTerm]) -> Float1D:
    """The point of the search where the terms stood; shape (free parameters,)."""
    x = problem.start()
    for i, free in enumerate(problem.free):
        slot = problem.design.slots[free.slots[0]]
        term = known.get(slot.term)
        values = None if term is None else term.groups.get(slot.group, next(iter(term.groups.values())))
        if values is not None and free.param.name in values.params:
            x[i] = free.outside(values.params[free.param.name])
        elif term is not None:
            factors = {factor(group): found.factor for group, found in term.groups.items()}
            x[i] = free.outside(factors.get(free.param.name, free.start))
    return x


def _start_near(problem: Problem, known: Mapping[int, FittedTerm]) -> Float1D:
    """Where the terms stood, and parameters that they did not have there looked for over their whole range."""
    start = _point_where_terms_stood(problem, known)
    for place in _new_parameters(problem, known):
        start = along_whole_range(problem, start, place)
    return start


def _new_parameters(problem: Problem, known: Mapping[int, FittedTerm]) -> list[int]:
    """Searched parameters of a known term that it did not have where it was found."""
    found = []
    for i, free in enumerate(problem.free):
        slot = problem.design.slots[free.slots[0]]
        term = known.get(slot.term)
        if term is not None and free.param.name not in {*term.params, *map(factor, term.groups)}:
            found.append(i)
    return found


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
            together = term.spec.shares(param.name)
            by_place = list(dict.fromkeys(design.slots[s].place for s in slots))
            shared = [tuple(s for s in slots if design.slots[s].place == place) for place in by_place]
            for group in shared if together else [(s,) for s in slots]:
                _add(design, term, param, group, free, fixed)
        for s in slots:
            for other in design.other_groups(s):
                g = Param(factor(other), "1", 1.0, *FACTORS, "factor on all gains")
                free.append(Nonlinear(g, (s,), *FACTORS, 1.0, True))
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
