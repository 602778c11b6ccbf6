"""A fitted response and its terms: frozen values that predict, and can be asked for every part of the prediction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.modelling.inputs.phases import phases
from thermodata.modelling.inputs.roles import Key
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.plugin import Bool1D, Effect, Float1D, Float2D, Param
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import TestData

FACTOR = "g"
Ends = tuple[float | None, float | None]
"""Of an interval, as values; None: these tests set no end within the parameter's bounds."""


@dataclass(frozen=True)
class Values:
    """Parameters of a term in one group of tests. sd: standard deviation by name, half: half of the interval of 95 %
    (of log(value) for params in log_names); NaN-free: what was held or could not be told is absent. ends: of the
    interval by profile, where it reaches further to one side."""

    params: Mapping[str, float]
    gains: Mapping[str, float]
    sd: Mapping[str, float] = field(default_factory=dict)
    half: Mapping[str, float] = field(default_factory=dict)
    ends: Mapping[str, Ends] = field(default_factory=dict)
    log_names: frozenset[str] = frozenset()
    silent: frozenset[str] = frozenset()  # params that change nothing with these drivers
    factor: float = 1.0  # that the gains hold, where the groups differ by one factor


@dataclass(frozen=True, eq=False)
class Together:
    """How parameters that were fitted together spread together. owners: ((term's id, group), ...) that share one, and
    its name; matrix: covariance, of log(value) for names in `logs`."""

    owners: tuple[tuple[tuple[tuple[str, str], ...], str], ...]
    matrix: Float2D
    logs: frozenset[str]


@dataclass(frozen=True)
class FittedTerm:
    """groups: value of gain_by -> Values; one group '' where one gain serves all tests. spread: of all that was fitted
    with it; None where that is not known."""

    bound: BoundTerm
    groups: Mapping[str, Values]
    held: bool = False  # identified first, then held
    alone: Mapping[str, Values] | None = None  # groups as found on its own tests, before all were refined together
    spread: Together | None = field(default=None, repr=False, compare=False)

    @property
    def id(self) -> str:
        return self.bound.id

    @property
    def effect(self) -> Effect:
        return self.bound.effect

    @property
    def binding(self) -> Mapping[str, str]:
        return self.bound.binding

    @property
    def family(self) -> str:
        return self.bound.family

    @property
    def params(self) -> Mapping[str, float]:
        """Of the first group (all groups share them unless the spec says otherwise)."""
        return next(iter(self.groups.values())).params

    @property
    def gains(self) -> Mapping[str, float]:
        return next(iter(self.groups.values())).gains

    @property
    def sd(self) -> Mapping[str, float]:
        return next(iter(self.groups.values())).sd

    def values(self, test: TestData) -> Values | None:
        """What applies to a test; None where it does not act in it, or its group was in no calibration test."""
        return self.groups.get(self.bound.group(test)) if self.bound.covers(test) else None

    def columns(self, test: TestData) -> Float2D:
        """The effect's basis at the fitted parameters, shape (n, gains), not centred, not masked."""
        values = self.values(test)
        return self.bound.columns(test, self.params if values is None else values.params)

    def contribution(self, test: TestData) -> Float1D:
        """shape (n,), in the response's unit."""
        values = self.values(test)
        if values is None:
            return np.zeros(len(test.t_s))
        gains = np.array([values.gains[g.name] for g in self.effect.gains])
        return np.asarray(self.columns(test) @ gains, dtype=np.float64)

    def can_predict(self, test: TestData) -> bool:
        """Whether every driver is there, and a gain for the test's group."""
        return self.why_not(test) is None

    def why_not(self, test: TestData) -> str | None:
        """What the term lacks to predict a test; None where it can."""
        if not self.bound.covers(test):
            return None
        if not self.bound.has(test):
            needs = ", ".join(self.bound.binding_of(test).values()) or self.bound.lacks(test)
            return f"no driver for {self.id}" + (f" ({needs})" if needs else "")
        if self.values(test) is not None or self._is_of_the_test_itself():
            return None
        return f"no calibration test gave {self.id} a gain for '{self.bound.group(test)}'"

    def _is_of_the_test_itself(self) -> bool:
        """Whether each test has its own (gain_by: test) of what nothing logged drives: a slip, a drift, a warm start.
        Another test is foretold without it; what is driven moves every test, by a gain that is not known there."""
        driven = bool(self.effect.needs) or isinstance(self.effect, OfTests)
        return self.bound.spec.gains_by == ("test",) and not driven


@dataclass(frozen=True)
class FittedResponse:
    """One response of the model. All arrays have the test's shape (n,). calibrate: whose offset is free; fitted_on: the
    tests that its parameters come from, which after `add` are verification tests too. scale: standard uncertainty of
    its probe's sensitivity in these, as a share, which all gains have in common."""

    bound: BoundResponse
    terms: tuple[FittedTerm, ...]
    phases: tuple[str, ...] | None
    calibrate: frozenset[Key]
    checks: tuple[Check, ...] = ()
    noise: float | None = None  # rms of the calibration residual
    tried: tuple[Any, ...] = ()  # orders.Tried: what was chosen from, where the file left orders open
    fitted_on: frozenset[Key] = frozenset()
    scale: float = 0.0

    @property
    def name(self) -> str:
        return self.bound.name

    @property
    def unit(self) -> str:
        return self.bound.unit

    def can_predict(self, test: TestData) -> bool:
        """Whether the test has the response, every driver, and a gain for its group."""
        return self.why_not(test) is None

    def why_not(self, test: TestData) -> str | None:
        """Why the test can't be predicted; None where it can."""
        if not has_response(self.bound, test):
            return f"no '{self.bound.channel_of(test)}'"
        return next((why for term in self.terms if (why := term.why_not(test)) is not None), None)

    def predict(self, test: TestData) -> Float1D:
        """Free-run simulation: the sum of the contributions, without an offset."""
        out = np.zeros(len(test.t_s))
        for term in self.terms:
            out = out + term.contribution(test)
        return out

    def measured(self, test: TestData) -> Float1D:
        """As measured; NaN where there is no value."""
        return test.values[self.bound.channel_of(test)]

    def mask(self, test: TestData) -> Bool1D:
        """Where samples count: response valid, in the window and the model's phases, drivers known."""
        return fit_mask(self.bound, [t.bound for t in self.terms], self.phases, test)

    def offset(self, test: TestData, how: str | None = None) -> float:
        """Measured minus predicted: 'free' over all that counts (calibration tests), 'zero' over the first zero_s
        of it (all others). 0 where nothing counts."""
        return _offset(
            self.measured(test) - self.predict(test),
            self.mask(test),
            test,
            how or ("free" if test.key in self.calibrate else "zero"),
        )

    def offset_from(self, test: TestData) -> Bool1D:
        """The samples whose mean is the offset."""
        gap = self.measured(test) - self.predict(test)
        return _samples_of_offset(gap, self.mask(test), test, "free" if test.key in self.calibrate else "zero")

    def residual(self, test: TestData) -> Float1D:
        """Measured minus predicted minus offset; NaN where there is no measurement."""
        gap = self.measured(test) - self.predict(test)
        how = "free" if test.key in self.calibrate else "zero"
        return gap - _offset(gap, self.mask(test), test, how)


def bounds_of(term: FittedTerm, param: Param) -> tuple[float, float]:
    """Between which a parameter is searched: the model file's, else the effect's."""
    return term.bound.spec.bounds.get(param.name, (param.lower, param.upper))


def has_response(bound: BoundResponse, test: TestData) -> bool:
    name = bound.channel_of(test)
    return name in test.values and bool(np.isfinite(test.values[name]).any())


def fit_mask(bound: BoundResponse, terms: list[BoundTerm], wanted: tuple[str, ...] | None, test: TestData) -> Bool1D:
    """See FittedResponse.mask."""
    name = bound.channel_of(test)
    mask = test.sampled(name)
    if not mask.any():
        return mask
    if wanted is not None:
        by_phase = phases(test, name)
        mask &= np.logical_or.reduce([by_phase[p] for p in wanted if p in by_phase] or [np.zeros(len(mask), bool)])
    for term in terms:
        known = term.known(test) if term.has(test) else None
        if known is not None:
            mask &= known
    return mask


def _offset(gap: Float1D, mask: Bool1D, test: TestData, how: str) -> float:
    counted = _samples_of_offset(gap, mask, test, how)
    return float(gap[counted].mean()) if counted.any() else 0.0


def _samples_of_offset(gap: Float1D, mask: Bool1D, test: TestData, how: str) -> Bool1D:
    counted = mask & np.isfinite(gap)
    if how == "zero" and counted.any():
        first = test.t_s[np.argmax(counted)]
        counted &= test.t_s < first + max(test.zero_s, 1e-9)
    return counted
