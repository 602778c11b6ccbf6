"""A law computed over arrays: what a control would compute sample by sample, from the same formula."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from thermodata.effect import law
from thermodata.effect.lag import lag
from thermodata.effect.linear import Filter
from thermodata.plugin import Float1D
from thermodata.schema.agreed.comparators import COMPARE

_ARITHMETIC = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "**": np.power}


def evaluate(node: law.Node, values: Mapping[str, Float1D], step_s: float) -> Float1D:
    """shape (n,). values: role -> shape (n,), on a grid of step_s [s]; every lag starts in balance."""
    size = max((len(v) for v in values.values()), default=0)
    return np.broadcast_to(_values_of(node, values, step_s), (size,)).astype(np.float64)


def _values_of(node: law.Node, values: Mapping[str, Float1D], step_s: float) -> Float1D:
    match node:
        case law.Number(value):
            return np.array(value)
        case law.Symbol(name):
            return values[name]
        case law.Absolute(of):
            return np.asarray(np.abs(_values_of(of, values, step_s)))
        case law.Binary(operator, left, right):
            return np.asarray(
                _ARITHMETIC[operator](_values_of(left, values, step_s), _values_of(right, values, step_s))
            )
        case law.Compare(operator, left, right):
            held = COMPARE[operator](_values_of(left, values, step_s), _values_of(right, values, step_s))
            return np.asarray(held, dtype=np.float64)
        case law.Logic("not", of):
            return np.asarray(_values_of(of[0], values, step_s) == 0, dtype=np.float64)
        case law.Logic(operator, of):
            parts = [_values_of(one, values, step_s) != 0 for one in of]
            joined = np.logical_and.reduce(parts) if operator == "and" else np.logical_or.reduce(parts)
            return np.asarray(joined, dtype=np.float64)
        case law.Where(condition, then, other):
            holds = _values_of(condition, values, step_s) != 0
            return np.asarray(np.where(holds, _values_of(then, values, step_s), _values_of(other, values, step_s)))
    return _with_memory(node, values, step_s)


def _with_memory(node: law.Node, values: Mapping[str, Float1D], step_s: float) -> Float1D:
    size = max(len(v) for v in values.values())
    if isinstance(node, law.Lag):
        u = np.broadcast_to(_values_of(node.of, values, step_s), (size,)).astype(np.float64)
        tau = _values_of(node.tau, values, step_s)
        if tau.ndim == 0:
            return lag(u, float(tau), step_s)
        return _switched(u, tau, step_s)
    if isinstance(node, law.Delay):
        u = np.broadcast_to(_values_of(node.of, values, step_s), (size,)).astype(np.float64)
        return delayed(u, float(_values_of(node.dead, values, step_s)), step_s)
    if isinstance(node, law.Filtered):
        return filtered(
            np.broadcast_to(_values_of(node.of, values, step_s), (size,)).astype(np.float64), node.by, step_s
        )
    raise TypeError(type(node))


def _switched(u: Float1D, tau: Float1D, step_s: float) -> Float1D:
    """A lag whose time constant is another from one sample on: that of the new sample counts."""
    edges = [0, *(np.flatnonzero(np.diff(tau)) + 1), len(u)]
    out = np.zeros(len(u))
    for a, b in pairwise(edges):
        first = max(a - 1, 0)
        out[a:b] = lag(u[first:b], float(tau[a]), step_s, float(out[first]) if a else 0.0)[a - first :]
    return out


def delayed(u: Float1D, dead_s: float, step_s: float) -> Float1D:
    """u(t - dead), shape (n,); straight between samples, and before the start what it started with."""
    at = np.arange(len(u)) - dead_s / step_s
    return np.asarray(np.interp(at, np.arange(len(u)), u), dtype=np.float64)


def filtered(u: Float1D, by: Filter, step_s: float) -> Float1D:
    """The filter's answer to u, shape (n,), from balance."""
    from scipy.signal import lfilter

    out = by.direct * u
    for dead, factor in by.late:
        out = out + factor * delayed(u, dead, step_s)
    for mode in by.modes:
        pole, forgotten, new = mode.stepped(step_s)
        if mode.is_real:
            pole, forgotten, new = pole.real, forgotten.real, new.real
        x, _ = lfilter([new, forgotten - new], [1.0, -pole], u, zi=np.array([-new * u[0]]))
        share = mode.weight * x
        out = out + (share.real if mode.is_real else 2.0 * share.real)
    return np.asarray(out, dtype=np.float64)
