"""Whether the tests can tell two time constants apart, and what they lack for it.

Two lags of one driver differ most while it is at rest again: what one of them keeps, the other has lost. So the tests'
shortest way out is a longer cooling. How long is found on the model itself: a test is followed by hours in which its
heat is off, with the noise that the fit has, until the ratio of the two time constants is known.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import numpy as np

from thermodata.modelling.inputs.drivers import ZERO_AT_REST, names_of, start_value, step_s
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, bounds_of
from thermodata.modelling.trust.checks.sensitivity import Name, Sensitivity, sensitivity
from thermodata.modelling.trust.intervals.slow_noise import Noise, make_noise
from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import TestData

HOURS = (0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 36, 48)
WARM = 0.1  # of the driver's largest move: a test that ends below is cold, and cools from its warmest moment instead
LOOK_S = 600.0  # between two looks at a driver that cools: more than its noise
FALLING = 0.2  # of its largest move: where a driver's own cooling can be read


@dataclass(frozen=True)
class Pair:
    """Two time constants [min] of one driver, the shorter first."""

    short: Name
    long: Name
    values: tuple[float, float]
    driver: str

    def said(self) -> str:
        first, second = (f"{term}.{name}" for term, name in (self.short, self.long))
        return f"{first} ({self.values[0]:.3g} min) and {second} ({self.values[1]:.3g} min)"


def told_apart(response: FittedResponse, tests: Sequence[TestData]) -> list[Check]:
    """One row for each two time constants of one effect, and of two effects of one driver. value: the lower end of the
    interval of 95 % of their ratio."""
    pairs = list(_pairs(response))
    if not pairs:
        return []
    found = sensitivity(response, tests)
    noise = make_noise(found.columns, found.residual, found.parts)
    if noise is None:
        return []
    return [_row(response, tests, pair, _least_ratio(pair, found, noise), noise) for pair in pairs]


def _row(response: FittedResponse, tests: Sequence[TestData], pair: Pair, least: float, noise: Noise) -> Check:
    passed = least > 1.0
    advice = f"{pair.said()} are apart"
    if not passed:
        lack = _missing(response, tests, pair, noise)
        advice = f"these tests can't tell the two time constants apart, {pair.said()}: {lack}"
    names = ":".join(".".join(name) for name in (pair.short, pair.long))
    return Check(name=f"told_apart:{names}", value=least, threshold=1.0, passed=passed, advice=advice)


def _missing(response: FittedResponse, tests: Sequence[TestData], pair: Pair, noise: Noise) -> str:
    """Hours of cooling after which they could be told apart."""
    warm = _warmest(tests, pair.driver)
    if warm is None:
        return f"nothing moves {pair.driver}"
    k, test = warm

    def enough(hours: float) -> bool:
        longer = [*tests[:k], cooled(test, pair.driver, hours), *tests[k + 1 :]]
        return _least_ratio(pair, sensitivity(response, longer), noise) > 1.0

    low, high = -1, len(HOURS) - 1
    if not enough(HOURS[high]):
        return f"{HOURS[high]:g} h of cooling would not do it; one lag may be all there is"
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if enough(HOURS[middle]) else (middle, high)
    return f"about {HOURS[high]:g} h of cooling are missing, after '{test.test}' for one"


def _least_ratio(pair: Pair, found: Sensitivity, noise: Noise) -> float:
    """Lower end of the ratio's interval."""
    places = [found.names.index(name) for name in (pair.short, pair.long) if name in found.names]
    if len(places) < 2:
        return 0.0
    a, b = places
    # what both do together is one parameter, the logarithm of their ratio the other
    columns = found.columns.copy()
    columns[:, a] += columns[:, b]
    half = float(noise.scatter(columns, found.parts).half[b])
    ratio = pair.values[1] / pair.values[0]
    return float(ratio * np.exp(-min(half, 50.0))) if np.isfinite(half) else 0.0


def _pairs(response: FittedResponse) -> Iterator[Pair]:
    alone: dict[str, list[tuple[float, Name]]] = {}
    for term in response.terms:
        taus = sorted(_free_lags(term))
        driver = next(iter(term.binding.values()), "")
        if term.family != "ambient":  # its two lags are bounded apart
            for (a, first), (b, second) in pairwise(taus):
                yield Pair(first, second, (a, b), driver)
        if len(taus) == 1:
            alone.setdefault(driver, []).append(taus[0])
    for driver, lags in alone.items():
        for (a, first), (b, second) in combinations(sorted(lags), 2):
            yield Pair(first, second, (a, b), driver)


def _free_lags(term: FittedTerm) -> Iterator[tuple[float, Name]]:
    if term.held:
        return
    silent = next(iter(term.groups.values())).silent
    for param in term.effect.params:
        searched = param.name not in term.bound.spec.fixed and param.name not in silent
        if searched and param.unit == "min" and param.name.startswith("tau") and bounds_of(term, param)[0] > 0:
            yield term.params[param.name], (term.id, param.name)


def _warmest(tests: Sequence[TestData], driver: str) -> tuple[int, TestData] | None:
    """The test that ends warmest and its place, cut at its warmest moment where all end cold."""
    names = names_of(driver) if driver else ()
    if not names:
        return None
    courses = {k: _course(t, names[0]) for k, t in enumerate(tests) if all(n in t.values for n in names)}
    top = max((float(np.max(np.abs(c))) for c in courses.values() if len(c)), default=0.0)
    if top <= 0:
        return None
    last = max(courses, key=lambda k: abs(float(courses[k][-1])))
    if abs(float(courses[last][-1])) >= WARM * top:
        return last, tests[last]
    best = max(courses, key=lambda k: float(np.max(np.abs(courses[k]))))
    stop = max(3, int(np.argmax(np.abs(courses[best]))) + 1)
    return best, _first_rows(tests[best], stop)


def _course(test: TestData, name: str) -> Float1D:
    """A channel from its start, gaps filled with the last value; shape (n,)."""
    values = np.asarray(test.values[name], dtype=np.float64)
    known = np.flatnonzero(np.isfinite(values))
    if not len(known):
        return np.zeros(len(values))
    filled = np.interp(np.arange(len(values)), known, values[known])
    info = test.channels.get(name)
    at_rest = info is not None and info.quantity in ZERO_AT_REST
    return filled if at_rest else filled - start_value(values[known], step_s(test))


def _first_rows(test: TestData, rows: int) -> TestData:
    return replace(
        test,
        t_s=test.t_s[:rows],
        values={n: v[:rows] for n, v in test.values.items()},
        valid={n: v[:rows] for n, v in test.valid.items()},
        in_window=test.in_window[:rows],
    )


def cooled(test: TestData, driver: str, hours: float) -> TestData:
    """The test, and hours after it in which nothing works and the driver goes back to its start as it did before.
    All other temperatures stay; the response counts (its values there mean nothing)."""
    step = step_s(test)
    rows = round(hours * 3600 / step)
    after = step * np.arange(1, rows + 1)
    mine = names_of(driver)

    def longer(name: str, values: Float1D) -> Float1D:
        course, last = _course(test, name), float(_last(values))
        info = test.channels.get(name)
        if info is not None and info.quantity in ZERO_AT_REST:
            tail = np.zeros(rows)
        elif name in mine:
            tail = last - course[-1] * (1.0 - np.exp(-after / _cools_in(course, step)))
        else:
            tail = np.full(rows, last)
        return np.concatenate([values, tail])

    def known(valid: Bool1D) -> Bool1D:
        return np.concatenate([valid, np.ones(rows, bool)])

    return replace(
        test,
        t_s=np.concatenate([test.t_s, test.t_s[-1] + after]),
        values={n: longer(n, v) for n, v in test.values.items()},
        valid={n: known(v) for n, v in test.valid.items()},
        in_window=known(test.in_window),
    )


def _last(values: Float1D) -> float:
    known = values[np.isfinite(values)]
    return float(known[-1]) if len(known) else 0.0


def _cools_in(course: Float1D, step: float) -> float:
    """The time constant [s] with which a driver falls towards its start, by the samples that do; else half an hour."""
    stride = max(1, round(LOOK_S / step))
    size = np.abs(course[::stride])
    top = float(size.max(initial=0.0))
    falling = (size[:-1] - size[1:] > 0.01 * top) & (size[:-1] > FALLING * top)
    before, after = size[:-1][falling], size[1:][falling]
    if not len(before):
        return 1800.0
    keep = float(np.median(after / before))  # the look in which the heat went off is no cooling yet
    keep = min(max(keep, 1e-6), 1.0 - 1e-6)
    return float(-stride * step / np.log(keep))
