"""Temperatures that are read in coarse steps, as the smooth course that passes within them.

A control writes its temperatures in whole degrees. As a driver such a staircase makes the prediction jump, by the gain
times a step, where the machine does not: what has the right course then fits worse than a speed that has no steps. A
body's temperature has no steps either, so it is drawn as a smooth course that is nowhere further from what was read
than half a step, which is all that the reading said. The store keeps what was read.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.calibration.tread import exact_tread_of
from thermodata.modelling.inputs.drivers import step_s
from thermodata.plugin import Bool1D, Float1D, Float2D
from thermodata.view.grid.dataset import Dataset, TestData

TEMPERATURE = "temperature"
COARSE_K = 0.45  # finer steps are no larger than what noise and bins smooth by themselves
SMOOTH_S = 150.0  # to the fourth power against the grid's, the price of a squared bend
MOST_PRICE = 1e10  # more, as on grids finer than 0.5 s, and float64 no longer solves it
FEWEST = 5  # samples that have a bend


def drawn(data: Dataset) -> Dataset:
    """The same with coarse temperatures drawn through their steps, and `drawn_k` saying which and how coarse."""
    coarse: dict[str, float] = {}
    tests = []
    by_campaign = {t.campaign: [o for o in data.tests if o.campaign == t.campaign] for t in data.tests}
    treads = {campaign: treads_of(some) for campaign, some in by_campaign.items()}
    for test in data.tests:
        here = {n: tread for n, tread in treads[test.campaign].items() if n in test.values}
        tests.append(_drawn_smooth(test, here))
        coarse |= {n: max(tread, coarse.get(n, 0.0)) for n, tread in here.items()}
    return replace(data, tests=tuple(tests), drawn_k=coarse) if coarse else data


def treads_of(tests: Sequence[TestData]) -> dict[str, float]:
    """The step of each temperature that is read in coarse ones [K]: the resolution of its sensor where the campaign
    file declares one, else what the values tell."""
    names = {n for t in tests for n, c in t.channels.items() if c.quantity == TEMPERATURE and n in t.values}
    found = {n: _step([t for t in tests if n in t.values], n) for n in sorted(names)}
    return {n: tread for n, tread in found.items() if tread >= COARSE_K}


def _step(tests: Sequence[TestData], name: str) -> float:
    declared = [t.channels[name].resolution for t in tests if name in t.channels]
    known = [r for r in declared if r]
    return max(known) if known else exact_tread_of([_without_ends(t.values[name][_is_read(t, name)]) for t in tests])


def _drawn_smooth(test: TestData, treads: Mapping[str, float]) -> TestData:
    known = {n: _is_read(test, n) for n in treads}
    names = [n for n in treads if known[n].sum() >= FEWEST]
    if not names:
        return test
    index = np.arange(len(test.t_s))
    read = np.column_stack([np.interp(index, index[known[n]], test.values[n][known[n]]) for n in names])
    # where nothing was read there is nothing to stay near to
    half = np.column_stack([np.where(known[n], treads[n] / 2, np.inf) for n in names])
    courses = smoothest(read, half, step_s(test))
    values = {n: np.where(known[n], courses[:, i], test.values[n]) for i, n in enumerate(names)}
    return replace(test, values={**test.values, **values})


def _is_read(test: TestData, name: str) -> Bool1D:
    """Where a channel was read, shape (n,)."""
    return np.isfinite(test.values[name]) & test.valid.get(name, np.ones(len(test.t_s), dtype=np.bool_))


def _without_ends(x: Float1D) -> Float1D:
    """Without what stands at both ends: where a log begins later than the test, its first value stands before it."""
    moved = np.flatnonzero(np.diff(x))
    return x[moved[0] : moved[-1] + 2] if len(moved) else x


def said(data: Dataset, names: Collection[str]) -> list[str]:
    """What was drawn of some channels, in a sentence a step."""
    steps = sorted({tread for n, tread in data.drawn_k.items() if n in names})
    return [_in_words([n for n in sorted(names) if data.drawn_k.get(n) == tread], tread) for tread in steps]


def _in_words(names: Sequence[str], tread: float) -> str:
    verb, it = ("is", "it is") if len(names) == 1 else ("are", "they are")
    return (
        f"{', '.join(names)} {verb} read in steps of {tread:.3g} K: as a driver {it} drawn smoothly through the steps, "
        "nowhere further than half of one from what was read, which the store keeps"
    )


def smoothest(read: Float2D, half: Float2D, step: float) -> Float2D:
    """Courses, shape (n, k), that are smooth and nowhere further than half from what was read, both of that shape.

    step: of the grid [s]. The course with the least sum of squared distances and squared bends (Whittaker's smoother),
    brought back between the limits."""
    from scipy.linalg import solveh_banded

    price = min((SMOOTH_S / step) ** 4, MOST_PRICE)
    smooth = solveh_banded(_bends(len(read), price), read)
    return np.asarray(np.clip(smooth, read - half, read + half), dtype=np.float64)


def _bends(n: int, price: float) -> Float2D:
    """One plus price times the sum of squared second differences, as its upper bands, shape (3, n)."""
    bands = np.zeros((3, n))
    bends: Float1D = np.full(n - 2, price)
    bands[2] = 1.0
    for at, times in ((0, 1.0), (1, 4.0), (2, 1.0)):
        bands[2, at : n - 2 + at] += times * bends
    bands[1, 1 : n - 1] -= 2 * bends
    bands[1, 2:] -= 2 * bends
    bands[0, 2:] += bends
    return bands
