"""The first-order lag with unit gain, exact for inputs that run straight between samples.

    tau dx/dt + x = u        u a ramp from u[k] to u[k+1]
    x[k+1] = a x[k] + (1 - a) u[k] + (1 - tau/h (1 - a)) (u[k+1] - u[k]),   a = exp(-h/tau)

A zero-order hold in its place shifts the answer by half a step, which a fit then hides in the time constant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np

from thermodata.plugin import Drivers, Float1D, Float2D

FEW = 2  # lags that one after the other cost less than the preparation of all at once
WIDE = 160  # columns from which on a row of all at once costs less than one column after the other
TOGETHER = 1024  # columns of which a row is made at once: more leave the processor's cache
SHORT = 10_000  # samples up to which the recursion is a banded system of equations, for the import's sake


def step_of(drivers: Drivers) -> float:
    """The grid's step [s]; 1 where there is only one sample."""
    return step_between(drivers.t_s)


def step_between(t_s: Float1D) -> float:
    """The step of a grid, shape (n,) [s]; 1 where there is only one sample."""
    return float((t_s[-1] - t_s[0]) / (len(t_s) - 1)) if len(t_s) > 1 else 1.0


def ramp_coefficients(tau_s: float, step_s: float) -> tuple[float, float, float]:
    """(a, b_new, b_old) of x[k+1] = a x[k] + b_new u[k+1] + b_old u[k]."""
    r = step_s / tau_s
    a = math.exp(-r)
    held = -math.expm1(-r) / r if r > 1e-12 else 1.0
    return a, 1.0 - held, held - a


def lag(u: Float1D, tau_s: float, step_s: float, start: float = 0.0) -> Float1D:
    """F_tau{u}: shape (n,) like u, same unit. tau_s, step_s [s]; start: the state at the first sample.

    start = 0 is balance where u counts from the start of the test (temperatures) or is zero at rest (speed,
    power, state). tau_s <= 0 is no lag at all.
    """
    if tau_s <= 0 or len(u) == 0:
        return np.array(u, dtype=np.float64)
    a, new, old = ramp_coefficients(tau_s, step_s)
    if len(u) <= SHORT:
        band = np.empty((2, len(u)), order="F")
        band.fill(-a)
        return _banded(u, band, new, old, start)
    from scipy.signal import lfilter

    x, _ = lfilter([new, old], [1.0, -a], u, zi=[start - new * u[0]])
    return np.asarray(x, dtype=np.float64)


def lags_at(series: Sequence[Float1D], taus_s: Sequence[float], steps_s: Sequence[float]) -> list[Float2D]:
    """What `lag` gives from 0 of each of several series, shape (n,) each, at each time constant: shape (n, taus) each,
    to the last digit. Many lags cost a fraction of one after the other. taus_s, steps_s, of each series, [s]."""
    long = [len(u) > SHORT or not len(u) for u in series]
    if any(long) or min(taus_s, default=0.0) <= 0:
        return [
            np.stack([lag(u, tau_s, step_s) for tau_s in taus_s], axis=1) if len(taus_s) else np.empty((len(u), 0))
            for u, step_s in zip(series, steps_s, strict=True)
        ]
    found = dict[int, Float2D]()
    for some in _about_as_long(series, max(1, TOGETHER // max(1, len(taus_s)))):
        make = _in_a_row if len(some) * len(taus_s) < WIDE else _side_by_side
        made = make([series[i] for i in some], taus_s, [steps_s[i] for i in some])
        found.update(zip(some, made, strict=True))
    return [found[i] for i in range(len(series))]


def _about_as_long(series: Sequence[Float1D], most: int) -> list[list[int]]:
    """The places of the series, in groups of so many at most, of which none is more than twice as long as another."""
    groups: list[list[int]] = []
    for i in sorted(range(len(series)), key=lambda i: len(series[i])):
        if not groups or len(groups[-1]) >= most or len(series[i]) > 2 * len(series[groups[-1][0]]):
            groups.append([])
        groups[-1].append(i)
    return groups


def _in_a_row(series: Sequence[Float1D], taus_s: Sequence[float], steps_s: Sequence[float]) -> list[Float2D]:
    """All series as one, for each time constant: nothing goes on from one to the next."""
    whole, sizes = np.concatenate(series), [len(u) for u in series]
    ends = np.cumsum(sizes)
    found = np.empty((len(whole), len(taus_s)), order="F")
    for i, tau_s in enumerate(taus_s):
        by_step = {step_s: ramp_coefficients(tau_s, step_s) for step_s in set(steps_s)}
        a, new, old = np.repeat([by_step[step_s] for step_s in steps_s], sizes, axis=0).T
        new[ends[:-1]] = old[ends[:-1] - 1] = a[ends - 1] = 0.0
        band = np.empty((2, len(whole)), order="F")
        np.negative(a, out=band[1])
        found[:, i] = _banded(whole, band, new[1:], old[:-1], 0.0)
    ends = ends.tolist()
    return [found[first:last] for first, last in zip([0, *ends], ends, strict=False)]


def _side_by_side(series: Sequence[Float1D], taus_s: Sequence[float], steps_s: Sequence[float]) -> list[Float2D]:
    """One sample of all of them after the other: what follows the end of a series is not looked at."""
    by_step = {step_s: np.array([ramp_coefficients(tau_s, step_s) for tau_s in taus_s]) for step_s in set(steps_s)}
    a, new, old = np.stack([by_step[step_s] for step_s in steps_s]).transpose(2, 0, 1)
    whole = np.zeros((max(map(len, series)), len(series)))
    for i, u in enumerate(series):
        whole[: len(u), i] = u
    x = np.empty((*whole.shape, len(taus_s)))
    x[0] = 0.0
    np.multiply(whole[:-1, :, None], old, out=x[1:])
    x[1:] += whole[1:, :, None] * new
    rows, a, part = x.reshape(len(x), -1), a.ravel(), np.empty(a.size)
    before = rows[0]
    for row in rows[1:]:
        row += np.multiply(before, a, out=part)
        before = row
    return [np.ascontiguousarray(x[: len(u), i]) for i, u in enumerate(series)]


def lag_along(u: Float1D, taus_s: Float1D, step_s: float) -> Float1D:
    """The same from 0, with a time constant for each interval: taus_s [s], shape (n,), is that before each sample, all
    above 0; of the first nothing is read."""
    if len(u) == 0:
        return np.array(u, dtype=np.float64)
    r = step_s / taus_s[1:]
    a, held = np.exp(-r), -np.expm1(-r) / r
    band = np.zeros((2, len(u)), order="F")
    band[1, :-1] = -a
    return _banded(u, band, 1.0 - held, held - a, 0.0)


def _banded(u: Float1D, band: Float2D, new: float | Float1D, old: float | Float1D, start: float) -> Float1D:
    """The same by forward substitution: x[k+1] - a x[k] = new u[k+1] + old u[k]. band: shape (2, n), -a in the second
    row; of the diagonal, which is 1, nothing is read. As quick as a filter on a test of a day; and a filter's first use
    takes the third of a second that scipy.signal is imported in."""
    x = np.empty(len(u))
    x[0] = start
    later = np.multiply(u[:-1], old, out=x[1:])
    later += new * u[1:]
    solved: Float1D = _solver()(1, band, x, 1, 0, 1, 0, 1, 1)  # one by one from 0 on; lower, diagonal 1, in its place
    return solved


@cache
def _solver() -> Callable[..., Float1D]:
    """Imported where it is used: once."""
    from scipy.linalg.blas import dtbsv

    found: Callable[..., Float1D] = dtbsv
    return found


def lags(u: Float1D, taus_s: Sequence[float], step_s: float) -> Float1D:
    """F_tau1{F_tau2{...u}}, each as `lag` from 0, in one pass: shape (n,) like u. All taus_s [s] above 0."""
    if len(u) == 0 or not len(taus_s):
        return np.array(u, dtype=np.float64)
    if len(taus_s) <= FEW:
        x = u
        for tau_s in taus_s:
            x = lag(x, tau_s, step_s)
        return x
    from scipy.signal import sosfilt

    sections, state = np.zeros((len(taus_s), 6)), np.zeros((len(taus_s), 2))
    for section, tau_s in zip(sections, taus_s, strict=True):
        a, new, old = ramp_coefficients(tau_s, step_s)
        section[:] = (new, old, 0.0, 1.0, -a, 0.0)
    state[0, 0] = -sections[0, 0] * u[0]  # every later lag starts on a 0
    return np.asarray(sosfilt(sections, u, zi=state)[0], dtype=np.float64)
