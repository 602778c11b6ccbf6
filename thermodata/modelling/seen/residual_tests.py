"""What a residual still tells: how long it remembers itself, and whether it goes with a state of the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D

BINS = 12
FEWEST = 20  # samples of a bin's mean
BY_THE_FIT = "0 by the fit"
WHY_BY_THE_FIT = (
    "gains are solved by least squares, so no residual goes with the state of one that is free, whatever its time "
    "constant; that of one that is held, or has two lags, tells"
)


@dataclass(frozen=True)
class LjungBox:
    """Q = n (n + 2) sum r_k^2 / (n - k) over `lags` lags, chi2 distributed where the residual is white."""

    lags: int
    q: float
    p_value: float


@dataclass(frozen=True)
class Against:
    """A residual against a state. slope: [response's unit per unit of the state]; centres, means, sds: of bins."""

    state: str
    unit: str
    correlation: float
    slope: float
    centres: Float1D
    means: Float1D
    sds: Float1D


def autocorrelation(parts: Sequence[Float1D], lags: int) -> Float1D:
    """r_0 ... r_lags over several tests, shape (lags + 1,). parts: residuals, NaN where none counts, each centred by
    itself; pairs over a gap or over tests are left out."""
    found = np.zeros((4, lags + 1))  # x x', x x, x' x' over the pairs, and the pairs that no gap would leave
    pairs = np.zeros(lags + 1)
    for part in parts:
        good = np.isfinite(part)
        x = np.where(good, part - (part[good].mean() if good.any() else 0.0), 0.0)
        for k in range(min(lags, len(x) - 1) + 1):
            both = good[k:] & good[: len(x) - k]
            late, early = x[k:][both], x[: len(x) - k][both]
            found[:, k] += np.array([late @ early, late @ late, early @ early, max(0, int(good.sum()) - k)])
            pairs[k] += np.count_nonzero(both)
    if found[0, 0] == 0:
        return np.zeros(lags + 1)
    # a record without gaps as everybody has it; over gaps, the correlation of the pairs that there are
    size = np.sqrt(found[1] * found[2])
    over_gaps = np.divide(found[0], size, out=np.zeros(lags + 1), where=size > 0)
    return np.asarray(np.where(pairs == found[3], found[0] / found[0, 0], over_gaps))


def lags_told(parts: Sequence[Float1D], step_s: float, longest_s: float) -> int:
    """Up to which lag [samples] an autocorrelation is told: beyond half of the longest test too few pairs are left."""
    return max(0, min(int(longest_s / step_s), max((len(r) for r in parts), default=1) // 2))


def ljung_box(r: Float1D, n: int, lags: int) -> LjungBox:
    """[ljungbox1978]. r: autocorrelation from lag 0 on; n: samples that count."""
    from scipy.stats import chi2

    k = np.arange(1, lags + 1)
    q = float(n * (n + 2) * np.sum(r[1 : lags + 1] ** 2 / np.maximum(n - k, 1)))
    return LjungBox(lags, q, float(chi2.sf(q, lags)))


def against(name: str, unit: str, states: Sequence[Float1D], residuals: Sequence[Float1D]) -> Against:
    """A residual against one state, each centred a test; both NaN where nothing counts."""
    xs, ys = [], []
    for x, y in zip(states, residuals, strict=True):
        good = np.isfinite(x) & np.isfinite(y)
        if good.any():
            xs.append(x[good] - x[good].mean())
            ys.append(y[good] - y[good].mean())
    x, y = (np.concatenate(v) if v else np.zeros(0) for v in (xs, ys))
    size = float(np.sqrt((x @ x) * (y @ y))) if len(x) else 0.0
    both = float(x @ y) if len(x) else 0.0
    correlation = both / size if size > 0 else 0.0
    slope = both / float(x @ x) if size > 0 else 0.0
    centres, means, sds = _binned_means(x, y)
    return Against(name, unit, correlation, slope, centres, means, sds)


def _binned_means(x: Float1D, y: Float1D) -> tuple[Float1D, Float1D, Float1D]:
    if len(x) < FEWEST:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    edges = np.unique(np.quantile(x, np.linspace(0, 1, BINS + 1)))
    which = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, max(len(edges) - 2, 0))
    rows = [
        (float(x[which == i].mean()), float(y[which == i].mean()), float(y[which == i].std()))
        for i in range(len(edges) - 1)
        if np.count_nonzero(which == i) >= min(FEWEST, len(x) // BINS)
    ]
    found = np.array(rows).reshape(-1, 3)
    return found[:, 0], found[:, 1], found[:, 2]
