"""Tests that begin with something on, which the model counts as switched on there though it may have run before.

A temperature counts from its first value. What is zero at rest (a speed, a power, a switch) has no such zero: before
the first sample it counts as at rest. Where it had run for long, what it does stands in the test's own zero already,
and the model does it once more: the whole test is off by one level.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.modelling.inputs.drivers import evaluate
from thermodata.modelling.inputs.lead import columns, with_lead
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.nuisance import WARM
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D
from thermodata.schema.agreed.begins_on import IF_SO, begins_on, values_of
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import Dataset, TestData

# of the test's error, had it run before. One that reached a share s of its rest before the test is off by s, and by
# 1 - s had it run for long: half of s at s = 2/3, which takes a lag 1.1 time constants
LEFT = 0.5
BEFORE_S = 24 * 3600.0  # as long as it is let run before: four of the longest time constants of what is switched
CLEARLY = 0.5  # of what is left had it run before: gains of its own that leave less say that it was switched on there
FADED = 0.05  # of what a start that is not known does, after three time constants


@dataclass(frozen=True, slots=True)
class StartedOn:
    """channels: drivers (or expressions) that are on at the first sample, and their values there, with units. rmse,
    left: error of the test as it is scored, and had they run before; in the response's unit. after_s: when what is
    not known of the start has faded; None where that takes half of the test. fitted: whether its level is fitted."""

    test: TestData
    channels: Mapping[str, str]
    rmse: float
    left: float
    after_s: float | None
    fitted: bool

    @property
    def on(self) -> str:
        """'Coolant at 1'."""
        return values_of(self.channels)


def started_on(response: FittedResponse, test: TestData) -> StartedOn | None:
    """None for a test that says how it began (warm, or by its history), and where it is not what the error comes of."""
    counts = response.mask(test)
    if test.start_state == WARM or not test.in_window.all() or not counts.any():
        return None
    terms = [t for t in response.terms if not isinstance(t.effect, OfTests) and t.bound.covers(test)]
    running = [(t, _running(t, test)) for t in terms if t.values(test) is not None]
    names = list(dict.fromkeys(text for _, texts in running for text in texts.values()))
    if not names:
        return None
    residual, zero = response.residual(test), response.offset_from(test)
    before, best = rms([residual[counts]]), None
    for some in dict.fromkeys([*((name,) for name in names), tuple(names)]):
        twice = np.zeros(len(test.t_s))
        for term, texts in running:
            roles = [role for role, text in texts.items() if text in some]
            twice += _had_run(term, test, roles) if roles else 0.0
        left = rms([(residual - twice + twice[zero].mean())[counts]])
        acting = [term for term, texts in running if any(text in some for text in texts.values())]
        if left < LEFT * before and (best is None or left < best.left) and not _acts_less(left, response, test, acting):
            values = {name: _first(test, name) for name in some}
            fitted = test.key in response.calibrate
            best = StartedOn(test, values, before, left, _faded_after(test, twice), fitted)
    return best


def started_on_checks(fitted: FittedModel, data: Dataset) -> list[Check]:
    """A row a test and response; nothing of locked tests."""
    return [
        Check(
            name="on_at_start:" + ("" if len(fitted.responses) == 1 else f"{response.name}/") + "/".join(test.key),
            value=found.left / found.rmse,
            threshold=LEFT,
            passed=False,
            advice=_advice(found, response.unit),
        )
        for response in fitted.responses
        for test in fitted.tests(data)
        if response.can_predict(test) and (found := started_on(response, test)) is not None
    ]


def _advice(found: StartedOn, unit: str) -> str:
    said = begins_on(found.test.test, found.channels, found.rmse, found.left, unit) + IF_SO
    if found.fitted:
        return f"{said}start_state: warm leaves the start of the test free in the fit"
    if found.after_s is None:
        return f"{said}give the test a recording, or a window, that begins before it was switched on"
    return (
        f"{said}a window of the test that begins {found.after_s / 60:.0f} min later, with history: recording, leaves "
        "out what is not known; start_state: warm frees the start in a fit, and not in this error"
    )


def _running(term: FittedTerm, test: TestData) -> dict[str, str]:
    """role -> driver, of those that are not at rest at the first sample; none where the term goes on in its cycle."""
    drivers = term.bound.drivers(test)
    roles = {
        role: text
        for role, text in term.bound.binding_of(test).items()
        if not evaluate(test, text)[2] and drivers.values[role][0] != 0
    }
    return {} if roles and with_lead(drivers)[1] else roles


def _had_run(term: FittedTerm, test: TestData, roles: Sequence[str]) -> Float1D:
    """What the contribution would be less by had these drivers been as at the first sample for a day; shape (n,)."""
    values = term.values(test)
    assert values is not None
    drivers = term.bound.drivers(test)
    step = float(drivers.t_s[1] - drivers.t_s[0]) if len(drivers.t_s) > 1 else 1.0
    rows = round(BEFORE_S / step)
    earlier = drivers.t_s[0] + step * np.arange(-rows, 0)
    led = replace(
        drivers,
        t_s=np.concatenate([earlier, drivers.t_s]),
        values={
            role: np.concatenate([np.full(rows, v[0] if role in roles else 0.0), v])
            for role, v in drivers.values.items()
        },
        valid={role: np.concatenate([np.ones(rows, bool), v]) for role, v in drivers.valid.items()},
    )
    found = term.bound.while_acting(test, columns(term.effect, (led, rows), values.params)) - term.columns(test)
    return np.asarray(found @ np.array([values.gains[g.name] for g in term.effect.gains]), dtype=np.float64)


def _acts_less(left: float, response: FittedResponse, test: TestData, terms: Sequence[FittedTerm]) -> bool:
    """Whether gains of the test's own, switched on where it begins, leave clearly less than it had it run before."""
    counts, zero = response.mask(test), response.offset_from(test)
    basis = np.column_stack([term.columns(test) for term in terms])
    basis = (basis - basis[zero].mean(axis=0))[counts]
    residual = response.residual(test)[counts]
    gains = np.linalg.lstsq(basis, residual, rcond=None)[0]
    return rms([residual - basis @ gains]) < CLEARLY * left


def _faded_after(test: TestData, twice: Float1D) -> float | None:
    """When what ran before the test has left it [s]."""
    acts = np.flatnonzero(np.abs(twice) > FADED * np.abs(twice).max())
    last = int(acts[-1]) if len(acts) else 0
    return float(test.t_s[last] - test.t_s[0]) if 2 * last < len(twice) else None


def _first(test: TestData, text: str) -> str:
    raw, good, _ = evaluate(test, text)
    info = test.channels.get(text)
    unit = f" {info.unit}" if info is not None and info.unit not in ("", "1") else ""
    return f"{raw[good][0]:.4g}{unit}"
