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
