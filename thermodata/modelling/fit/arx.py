"""ARX: one-step regression for the coefficients, free run for everything that is said about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import cast

import numpy as np

from thermodata.errors import SpecError, UsageError
from thermodata.modelling.inputs.drivers import step_s
from thermodata.modelling.inputs.phases import runs
from thermodata.modelling.model_file.transfer.as_effect import FreeFunction, GivenFunction
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted_response import FittedTerm, fit_mask
from thermodata.modelling.terms.identified import Identified
from thermodata.plugin import Bool1D, Effect, Float1D
from thermodata.schema.words.sentences import in_percent
from thermodata.view.grid.dataset import TestData

FEWEST_IN_A_ROW = 0.5  # of the time between first and last sample
FEWEST_WINDOWS = 4  # fewer are gaps of a record


class ArxFunction(GivenFunction):
    """A function as ARX found it."""

    def __init__(self, a: Sequence[float], b: Sequence[float], sample_s: float, where: str) -> None:
        super().__init__(a, b, sample_s, where=where)
        self.identified = Identified(tuple(map(float, a)), tuple(map(float, b)), sample_s)


def placeholder(term: BoundTerm) -> BoundTerm:
    """One lag in the place of the ARX function, while the other effects are found."""
    return replace(term, effect=cast(Effect, FreeFunction("varpro", (1, 1))), _drivers={})


def identify_arx(
    bound: BoundResponse,
    i: int,
    fitted: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
) -> BoundResponse:
    """The response with term i as an ARX function of what the other effects leave. orders: numerator, denominator.

    y(k) = -b1 y(k-1) - ... + a0 u(k-d) + a1 u(k-d-1) + ..., d the delay; least squares over all tests, y from the
    first samples of each. A constant would take what the slow poles should say; only a test that began warm has one.
    UsageError where the function is not stable.
    """
    term = bound.terms[i]
    na, nb = term.spec.orders or (2, 2)
    delay = term.spec.delay or 0
    rows, targets = [], []
    warm = [m for m, test in enumerate(tests) if test.start_state == "warm"]
    for j, test in enumerate(tests):
        if not term.covers(test):
            continue
        rest = test.values[bound.channel_of(test)].copy()
        for k, other in fitted.items():
            if k != i:
                rest = rest - other.contribution(test)
        mask = fit_mask(bound, list(bound.terms), wanted, test)
        u, span = term.drivers(test).values["u"], max(delay + na - 1, nb)
        rest = rest - _at_rest(rest, test, bound.channel_of(test))
        past = [np.roll(rest, k) for k in range(1, nb + 1)] + [np.roll(u, k) for k in range(delay, delay + na)]
        constants = [np.full(len(u), float(j == m)) for m in warm]
        good = np.logical_and.reduce([np.roll(mask, k) for k in range(nb + 1)]) & np.isfinite(rest)
        good[:span] = False
        _refuse_windows(term.id, test, mask, good)
        rows.append(np.column_stack([*past, *constants])[good])
        targets.append(rest[good])
    x, y = np.concatenate(rows), np.concatenate(targets)
    if len(y) < 4 * (na + nb):
        raise UsageError(
            "too few consecutive samples for an ARX function",
            where=term.id,
            expected=f"at least {4 * (na + nb)}",
            got=str(len(y)),
            hint="method: oe",
        )
    coefficients = np.linalg.lstsq(x, y, rcond=None)[0]
    try:
        function = ArxFunction(
            [*np.zeros(delay), *coefficients[nb : nb + na]], [1.0, *-coefficients[:nb]], step_s(tests[0]), term.id
        )
    except SpecError as error:
        raise UsageError(
            "the ARX function is not stable",
            where=term.id,
            got=error.got,
            hint="method: oe, other orders, or a longer step",
        ) from None
    spec = term.spec.model_copy(update={"fixed": {"gain": 1.0}})
    identified = replace(term, effect=cast(Effect, function), spec=spec, _drivers={})
    return replace(bound, terms=tuple(identified if k == i else t for k, t in enumerate(bound.terms)))


def _at_rest(rest: Float1D, test: TestData, channel: str) -> float:
    """Mean of the first valid samples, whatever phases count: from there the drivers count as well."""
    counted = test.in_window & np.isfinite(rest) & test.valid.get(channel, np.ones(len(rest), bool))
    if not counted.any():
        return 0.0
    first = counted & (test.t_s < test.t_s[np.argmax(counted)] + max(test.zero_s, 1e-9))
    return float(rest[first].mean())


def _refuse_windows(where: str, test: TestData, mask: Bool1D, good: Bool1D) -> None:
    """A sample is predicted from the samples just before it. A response that is measured in windows has these only
    inside of a window, where nothing moves but noise: the function found is one of the noise (FIT -57 in free run)."""
    rows = np.flatnonzero(mask)
    if len(rows) < 2:
        return
    share = float(good.sum()) / (rows[-1] - rows[0] + 1)
    windows = runs(mask)
    if share >= FEWEST_IN_A_ROW or len(windows) < FEWEST_WINDOWS:
        return
    step = step_s(test)
    measured = float(np.median([b - a for a, b in windows])) * step
    pause = float(np.median([b - a for (_, a), (b, _) in pairwise(windows)])) * step
    raise UsageError(
        "ARX needs the response sample after sample, and it was measured in windows",
        where=f"{where}, test {test.campaign}/{test.test}",
        expected=f"at least {in_percent(FEWEST_IN_A_ROW)} of the samples with the ones before them",
        got=f"{in_percent(share)}: {len(windows)} windows of about {measured:g} s with pauses of about {pause:g} s",
        hint="method: oe or varpro, which run freely between the windows",
    )
