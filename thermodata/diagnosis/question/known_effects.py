"""The columns of a fitted model's effects: what it does, what its parameters can still do, how it may act otherwise."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from thermodata.diagnosis.question.present import TIME_UNITS
from thermodata.diagnosis.question.problem import Base
from thermodata.modelling.inputs.drivers import has_drivers, names_of
from thermodata.modelling.inputs.lead import columns as led_columns
from thermodata.modelling.inputs.lead import led_drivers
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.plugin import Float1D, Float2D
from thermodata.view.grid.dataset import TestData

# half-width, in the logarithm, of the difference quotient that lets a known time constant move
TANGENT = 0.1
# the same heat also acts faster and slower than the fitted lag: together with it, a bank over four decades
BANK = (1 / 25, 1 / 5, 5.0, 25.0)


def remembered(fitted: FittedResponse) -> Base:
    """Test -> what the fitted model can still do in it, shape (n, k): its gains, and its time constants to first order.

    The known effects are refitted together with each candidate: a base model held fixed leaves residuals that any
    slow channel explains, which raises false claims to a third. Columns are kept: of a copy of a test in which some
    channels are changed, only the terms that read these are made anew.
    """
    kept: dict[tuple[int, tuple[str, str]], tuple[list[Float1D], list[Float2D]]] = {}

    def base(test: TestData) -> Float2D:
        columns: list[Float2D] = []
        for i, term in enumerate(fitted.terms):
            read = [test.values[n] for n in term.bound.reads(test) if n in test.values]
            before, made = kept.get((i, test.key), (None, []))
            if before is None or not all(a is b for a, b in zip(before, read, strict=True)):
                made = _term_columns(term, test)
                kept.setdefault((i, test.key), (read, made))
            columns += made
        return np.column_stack(columns) if columns else np.zeros((len(test.t_s), 0))

    return base


def _term_columns(term: FittedTerm, test: TestData) -> list[Float2D]:
    """Each in the response's unit: a coefficient of 1 doubles the effect, or moves a time constant by a factor of e."""
    values = term.values(test)
    size = len(test.t_s)
    moving = [p for p in term.effect.params if p.upper > p.lower]
    if values is None or not term.bound.covers(test):
        return [np.zeros((size, len(term.effect.gains) + len(moving)))]
    gains = np.array([values.gains[g.name] for g in term.effect.gains])
    columns = [term.columns(test) * np.where(gains == 0, 1.0, gains)]
    for param in moving:
        value = values.params[param.name]
        lower, upper = term.bound.spec.bounds.get(param.name, (param.lower, param.upper))
        up = {**values.params, param.name: min(value * np.exp(TANGENT), upper)}
        down = {**values.params, param.name: max(value * np.exp(-TANGENT), lower)}
        change = term.bound.columns(test, up) - term.bound.columns(test, down)
        width = np.log(up[param.name] / down[param.name]) if down[param.name] > 0 else 2 * TANGENT
        columns.append((change @ gains)[:, None] / max(float(width), 1e-9))
    return columns


def otherwise(fitted: FittedResponse, test: TestData) -> Float2D:
    """How a known effect may differ from its one time constant, shape (n, k), each column in the response's unit.

    A machine is distributed: the same heat also acts faster and slower than the fitted lag. That is no missing effect,
    so the known effects may do it, at a price (see `discrepancy.Noise.share`).
    """
    columns = [c for term in fitted.terms for c in _bank_of_lags(term, test)]
    return np.column_stack(columns) if columns else np.zeros((len(test.t_s), 0))


def owners(fitted: FittedResponse) -> tuple[list[int], list[int]]:
    """The number of the term that each column of a base, and of `otherwise`, belongs to."""
    base, spare = [], []
    for i, term in enumerate(fitted.terms):
        params = term.effect.params
        base += [i] * (len(term.effect.gains) + sum(p.upper > p.lower for p in params))
        spare += [i] * (len(BANK) * sum(p.unit in TIME_UNITS for p in params))
    return base, spare


def from_other_zero(fitted: FittedResponse, term: int, channel: str, test: TestData) -> Float1D | None:
    """A known effect as it would answer to another temperature in place of its own, shape (n,), in the response's unit.

    A temperature rises with its surroundings, which do not act as the heat that the effect means: what then seems to be
    missing is minus this. None where the effect is not driven by one temperature.
    """
    known = fitted.terms[term]
    warm = [role for role, text in known.binding.items() if all(is_warm(test, n) for n in names_of(text))]
    values = known.values(test)
    if len(known.binding) != 1 or not warm or values is None or not known.bound.covers(test):
        return None
    if not has_drivers(test, {warm[0]: channel}):
        return None
    gains = np.array([values.gains[g.name] for g in known.effect.gains])
    _, led = led_drivers(test, known.effect, {warm[0]: channel})
    columns = led_columns(known.effect, led, values.params)
    return np.asarray(known.bound.while_acting(test, columns) @ gains)


def _bank_of_lags(term: FittedTerm, test: TestData) -> Iterator[Float1D]:
    values = term.values(test)
    for param in term.effect.params:
        if param.unit not in TIME_UNITS:
            continue
        for factor in BANK:
            if values is None or not term.bound.covers(test):
                yield np.zeros(len(test.t_s))
                continue
            gains = np.array([values.gains[g.name] for g in term.effect.gains])
            other = {**values.params, param.name: values.params[param.name] * factor}
            yield (term.bound.columns(test, other) - term.columns(test)) @ gains


def is_warm(test: TestData, channel: str) -> bool:
    """Whether a channel is a temperature."""
    info = test.channels.get(channel)
    return info is not None and info.quantity == "temperature"
