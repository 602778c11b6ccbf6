"""Transfer functions as laws: polynomials of z taken apart into a direct term, delays and modes.

A free function was identified at the step of its model. Its parts say the same at that step, and go on to any cycle:
a printed or identified polynomial does not.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.effect.lag import ramp_coefficients
from thermodata.effect.law import Filtered, Law, Symbol
from thermodata.effect.linear import Filter, lag_filter, partial_fractions, partial_fractions_of_s
from thermodata.plugin import Float1D

_U = Symbol("u")


def free_law(method: str, orders: tuple[int, int], taus_s: Sequence[float], step_s: float) -> tuple[Law, ...]:
    """varpro: a lag a gain, and last the driver itself where it has a direct term. oe: the chain of all lags, and from
    the second gain on its differences."""
    if method == "varpro":
        lagged = tuple(Filtered(_U, lag_filter(tau)) for tau in taus_s)
        return (*lagged, _U) if orders[0] > orders[1] else lagged
    num, den, poles = np.ones(1), np.ones(1), []
    for tau in taus_s:
        a, new, old = ramp_coefficients(tau, step_s)
        num, den = np.convolve(num, [new, old]), np.convolve(den, [1.0, -a])
        poles.append(a)
    made: list[Filter] = []
    for j in range(orders[0]):
        if j:
            num = np.convolve(num, [1.0, -1.0]) * taus_s[min(j, len(taus_s)) - 1] / step_s
        if len(taus_s) == 1 and not j:
            made.append(lag_filter(taus_s[0]))
        else:
            made.append(partial_fractions(num, den, step_s, poles=np.array(poles, complex)))
    return tuple(Filtered(_U, one) for one in made)


def given_law(num: Float1D, den: Float1D, sample_s: float | None, time_s: float) -> tuple[Law, ...]:
    """The printed function; sample_s None: of s."""
    if sample_s is None:
        return (Filtered(_U, partial_fractions_of_s(num, den, time_s)),)
    return (Filtered(_U, partial_fractions(num, den, sample_s)),)
