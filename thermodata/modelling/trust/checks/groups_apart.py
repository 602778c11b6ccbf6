"""Whether the groups of `gain_by`, which share an effect's time constants, would each have another one: two machines of
one kind may warm at rates of their own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.modelling.least_squares.design import Design
from thermodata.modelling.terms.bound import each_group_its_own
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.trust.checks.sensitivity import STEP, sensitivity
from thermodata.modelling.trust.memory import effective_count
from thermodata.plugin import Float1D, Param
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import TestData

RATIO = 1.5  # of the largest time constant to the smallest, as one step of the search has them
SURE = 4.0  # standard deviations of their difference, of as many samples as the residual is worth


def groups_apart(response: FittedResponse, term: FittedTerm, tests: Sequence[TestData]) -> list[Check]:
    """The shared time constants of an effect that its groups would have far apart, surely: told by one step of least
    squares from where they were found, in which each group has its own and all else stays free."""
    shared = [p for p in term.effect.params if _is_time(p) and _is_shared(term, p)]
    if term.held or len(term.groups) < 2 or not shared:
        return []
    known = sensitivity(response, tests)
    rows = []
    for param in shared:
        own = _of_each_group(response, term, param, tests)
        others = [known.columns[:, k] for k, name in enumerate(known.names) if name != (term.id, param.name)]
        found = _step(np.column_stack([*own.values(), *others]), known.residual, list(known.parts))
        if len(own) > 1 and found is not None and (check := _check(term, param, list(own), *found)) is not None:
            rows.append(check)
    return rows


def _is_time(param: Param) -> bool:
    return param.unit == "min" and param.name.startswith("tau") and param.lower > 0


def _is_shared(term: FittedTerm, param: Param) -> bool:
    silent = next(iter(term.groups.values())).silent if term.groups else frozenset()
    return term.bound.spec.shares(param.name) and param.name not in {*term.bound.spec.fixed, *silent}


def _of_each_group(
    response: FittedResponse, term: FittedTerm, param: Param, tests: Sequence[TestData]
) -> dict[str, Float1D]:
    """Group -> what its prediction changes with the logarithm of a parameter, shape (n,)."""
    design = Design(response.bound, [each_group_its_own(t.bound) for t in response.terms], tests, response.phases)
    found: dict[str, Float1D] = {}
    for s, slot in enumerate(design.slots):
        values = term.groups.get(slot.group)
        if response.terms[slot.term] is not term or values is None:
            continue
        gains = np.array([values.gains[g.name] for g in term.effect.gains])
        moved = {**values.params, param.name: values.params[param.name] * float(np.exp(STEP))}
        change = (design.columns(s, moved) - design.columns(s, values.params)) @ gains / STEP
        if change.any():
            found[slot.group] = found.get(slot.group, 0.0) + change
    return found


def _step(columns: Float1D, residual: Float1D, parts: list[slice]) -> tuple[Float1D, Float1D] | None:
    """(least squares of the residual, shape (k,); its covariance, shape (k, k)); None where too little is left."""
    free = len(residual) - columns.shape[1]
    if free < 1 or not columns.any():
        return None
    step, *_ = np.linalg.lstsq(columns, residual, rcond=None)
    left = residual - columns @ step
    worth = max(effective_count(left, parts), 1.0) / len(residual)
    cover = np.linalg.pinv(columns.T @ columns) * float(left @ left) / free / worth
    return step.astype(np.float64), cover.astype(np.float64)


def _check(term: FittedTerm, param: Param, groups: Sequence[str], step: Float1D, cover: Float1D) -> Check | None:
    """The row of the two groups that are farthest apart; None where they are not, or not surely."""
    logs = step[: len(groups)]
    low, high = int(np.argmin(logs)), int(np.argmax(logs))
    apart = float(logs[high] - logs[low])
    sd = float(np.sqrt(max(cover[low, low] + cover[high, high] - 2 * cover[low, high], 0.0)))
    if apart <= np.log(RATIO) or apart <= SURE * sd:
        return None
    value = term.params[param.name]
    slow, fast = (value * float(np.exp(np.clip(logs[k], -3.0, 3.0))) for k in (high, low))
    return Check(
        name=f"groups_apart:{term.id}.{param.name}",
        value=slow / fast,
        threshold=RATIO,
        passed=False,
        advice=f"shared by all groups it is {value:.3g} min; {groups[high]} would have about {slow:.2g} min and "
        f"{groups[low]} {fast:.2g} min: shared: none gives each group a function of its own",
    )
