"""The profiles of a fitted model's time constants, and which of them its tests can tell apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from thermodata.modelling.fit.joint import fitted_problem
from thermodata.modelling.inputs.roles import fitted_keys
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.usable import usable_tests
from thermodata.modelling.trust.checks.apart import told_apart
from thermodata.modelling.trust.intervals.uncertainty import profiles
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True)
class Curve:
    """Of one searched parameter. low, high: of the interval of 95 % by the quadratic rule (of the logarithm where that
    is searched), profile_low, profile_high: by the profile, None where these tests set no end within the bounds;
    quadratic: whether both are the same; curve: (value, root mean square of the residual) with all else fitted anew."""

    response: str
    parameter: str
    unit: str
    value: float
    low: float
    high: float
    profile_low: float | None
    profile_high: float | None
    quadratic: bool
    curve: tuple[tuple[float, float], ...]

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True)
class Profiles:
    """said: what the tests can't tell apart, and what they lack for it."""

    curves: tuple[Curve, ...]
    said: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        return {"parameters": [c.to_json() for c in self.curves], "not_told_apart": list(self.said)}


def profiles_of(fitted: FittedModel, data: Dataset) -> Profiles:
    """Of every response, on the tests that it was fitted to: verification tests that took part in the choice too."""
    curves, said = list[Curve](), list[str]()
    keys = fitted_keys(fitted.spec, fitted.roles)
    known = {t.key: t for t in data.tests}
    open_tests = [known[key] for key in keys if key in known]
    for response in fitted.responses:
        tests, _ = usable_tests(response.bound, open_tests)
        curves += _curves(response, tests)
        said += [check.advice for check in told_apart(response, tests) if not check.passed]
    return Profiles(tuple(curves), tuple(said))


def _curves(response: FittedResponse, tests: Sequence[TestData]) -> list[Curve]:
    problem, x, rough = fitted_problem(response, tests)
    gains = problem.gains(problem.matrix(x))
    rows = []
    for seen in profiles(problem, x, gains, rough):
        profile, half, quadratic, i, free = seen.profile, seen.half, seen.quadratic, seen.of.place, seen.of.free
        slot = problem.design.slots[free.slots[0]]
        tag = f"[{slot.group}]" if slot.group and len(free.slots) == 1 and not free.param.name.startswith("g[") else ""
        low, high = (free.inside(float(x[i]) + side * half) for side in (-1.0, 1.0))
        ends = (low, high) if quadratic else profile.ends(half)
        name = f"{problem.design.terms[slot.term].id}.{free.param.name}{tag}"
        curve = tuple(profile.curve(half))
        value = free.inside(float(x[i]))
        rows.append(Curve(response.name, name, free.param.unit, value, low, high, *ends, quadratic, curve))
    return rows
