"""What simple methods would name, on the same residuals: each ranks the logged channels, and its first one counts.

Plain numpy on means of 5 min. Lagged columns are first-order lags of a bank of time constants. References: Tibshirani
1996 (lasso), Schwarz 1978 (BIC), Brunton, Proctor and Kutz 2016 (SINDy, sequentially thresholded least squares).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.signal import lfilter

from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Float1D, Float2D, Int1D
from thermodata.schema.units.quantity import NOT_DRIVERS
from thermodata.view.grid.dataset import Dataset, TestData

STEP_S = 300.0
TAUS_S = (0.0, 600.0, 1800.0, 5400.0, 16200.0)
DELAYS_S = tuple(600.0 * k for k in range(19))  # 0 to 3 h


@dataclass(frozen=True, slots=True)
class Question:
    """All open tests in a row. residual: shape (n,), each test from its mean. raw: shape (n, channels), before the
    means are taken. test: shape (n,), number of the test."""

    names: tuple[str, ...]
    residual: Float1D
    raw: Float2D
    test: Int1D

    def centred(self, columns: Float2D) -> Float2D:
        out = np.array(columns, dtype=np.float64)
        for k in range(int(self.test[-1]) + 1):
            out[self.test == k] -= out[self.test == k].mean(axis=0)
        return out

    def each(self, change: Callable[[Float2D], Float2D]) -> Float2D:
        """A change within each test, of its channels, shape (n, channels)."""
        parts = [change(self.raw[self.test == k]) for k in range(int(self.test[-1]) + 1)]
        return self.centred(np.vstack(parts))

    def lagged(self) -> tuple[Float2D, Int1D]:
        """(columns of unit length, shape (n, channels * taus); channel of each)."""
        blocks = [self.each(partial(_lag, tau_s=tau)) for tau in TAUS_S]
        return _unit(np.hstack(blocks)), np.tile(np.arange(len(self.names)), len(TAUS_S))


def ask(fitted: FittedResponse, data: Dataset, tests: list[TestData]) -> Question:
    """What the rivals are given: the residual of a fitted response and all channels, in means over `STEP_S`, of the
    samples that count."""
    names = tuple(n for n, c in data.channels.items() if c.quantity not in NOT_DRIVERS)
    per = max(1, round(STEP_S / data.step_s))
    left: list[Float1D] = []
    raw: list[Float2D] = []
    number: list[Int1D] = []
    for test in tests:
        ok = fitted.mask(test)
        bins = np.arange(len(test.t_s)) // per
        count = np.bincount(bins, weights=ok)
        use = count > 0
        r = np.bincount(bins, weights=np.where(ok, np.nan_to_num(fitted.residual(test)), 0)) / np.maximum(count, 1)
        u = np.column_stack([_gaps_filled(test.values[n])[::per][: len(count)] for n in names])
        left.append(r[use])
        raw.append(u[use] - u[0])
        number.append(np.full(int(use.sum()), len(number)))
    blank = Question(names, np.concatenate(left), np.vstack(raw), np.concatenate(number))
    return Question(names, blank.centred(blank.residual[:, None])[:, 0], blank.raw, blank.test)


def _gaps_filled(x: Float1D) -> Float1D:
    ok = np.isfinite(x)
    return np.interp(np.arange(len(x)), np.flatnonzero(ok), x[ok]) if ok.any() else np.zeros(len(x))


def _lag(u: Float2D, tau_s: float) -> Float2D:
    if tau_s <= 0:
        return u
    a = float(np.exp(-STEP_S / tau_s))
    return np.asarray(lfilter([1 - a], [1, -a], u, axis=0))


def _delayed(u: Float2D, rows: int) -> Float2D:
    return u[np.maximum(np.arange(len(u)) - rows, 0)]


def _unit(columns: Float2D) -> Float2D:
    size = np.linalg.norm(columns, axis=0)
    return columns / np.where(size > 1e-9, size, np.inf)


def raw_correlation(q: Question) -> str:
    return q.names[int(np.argmax(np.abs(_unit(q.each(lambda u: u)).T @ q.residual)))]


def best_delay_correlation(q: Question) -> str:
    """The highest correlation over delays of 0 to 3 h."""
    best = np.zeros(len(q.names))
    for delay in DELAYS_S:
        k = round(delay / STEP_S)
        shifted = q.each(partial(_delayed, rows=k))
        best = np.maximum(best, np.abs(_unit(shifted).T @ q.residual))
    return q.names[int(np.argmax(best))]


def stepwise_bic(q: Question) -> str | None:
    """Forward over lagged columns while the BIC falls; of what is chosen, the channel whose loss would cost most."""
    columns, channel = q.lagged()
    n, y = len(q.residual), q.residual
    chosen: list[int] = []
    left, bic = y, n * np.log(np.sum(y**2) / n)
    while len(chosen) < 8:
        basis = np.linalg.qr(columns[:, chosen])[0] if chosen else np.zeros((n, 0))
        free = columns - basis @ (basis.T @ columns)
        size = np.linalg.norm(free, axis=0)
        gain = np.where(size > 0.03, (free.T @ left) / np.maximum(size, 0.03), 0.0)
        j = int(np.argmax(np.abs(gain)))
        trial = left - free[:, j] / size[j] * gain[j] if size[j] > 0.03 else left
        after = n * np.log(np.sum(trial**2) / n) + (len(chosen) + 1) * np.log(n)
        if after >= bic:
            break
        chosen.append(j)
        left, bic = trial, after
    if not chosen:
        return None

    def without(c: int) -> float:
        rest = [j for j in chosen if channel[j] != c]
        if not rest:
            return float(np.sum(y**2))
        return float(np.sum((y - columns[:, rest] @ np.linalg.lstsq(columns[:, rest], y, rcond=None)[0]) ** 2))

    return q.names[max({int(channel[j]) for j in chosen}, key=without)]


def lasso_cv(q: Question) -> str | None:
    """L1-penalised over lagged columns, its penalty by left-out tests; the channel with the largest weight."""
    columns, channel = q.lagged()
    folds = q.test % min(5, int(q.test[-1]) + 1)
    top = float(np.max(np.abs(columns.T @ q.residual)))
    path = top * np.geomspace(0.9, 0.01, 14)
    error = np.zeros(len(path))
    for k in range(int(folds.max()) + 1):
        rest = folds != k
        betas = _lasso(columns[rest], q.residual[rest], path * rest.mean())
        error += np.sum((q.residual[~rest][:, None] - columns[~rest] @ betas.T) ** 2, axis=0)
    beta = _lasso(columns, q.residual, path)[int(np.argmin(error))]
    weight = np.bincount(channel, weights=np.abs(beta), minlength=len(q.names))
    return q.names[int(np.argmax(weight))] if weight.any() else None


def _lasso(X: Float2D, y: Float1D, path: Float1D) -> Float2D:
    """Coordinate descent down a path of penalties, shape (penalties, columns)."""
    gram, toward = X.T @ X, X.T @ y
    size = np.maximum(np.diag(gram), 1e-12).tolist()
    beta = np.zeros(X.shape[1])
    out = []
    for penalty in path.tolist():
        # gram @ beta, kept up to date: most columns rest at zero, and cost a comparison
        slope = toward - gram @ beta
        for _ in range(60):
            before = beta.copy()
            for j, (own, old) in enumerate(zip(size, before.tolist(), strict=True)):
                pull = slope.item(j) + own * old
                if pull > penalty:
                    new = (pull - penalty) / own
                elif pull < -penalty:
                    new = (pull + penalty) / own
                elif old:
                    new = 0.0
                else:
                    continue
                beta[j] = new
                slope -= gram[j] * (new - old)
            if np.max(np.abs(beta - before)) <= 1e-3 * max(float(np.max(np.abs(beta))), 1e-12):
                break
        out.append(beta.copy())
    return np.array(out)


def thresholded_dynamics(q: Question) -> str | None:
    """dr/dt from r and all channels by sequentially thresholded least squares (SINDy's, with first-order terms)."""
    smooth = np.concatenate([_smooth(q.residual[q.test == k]) for k in range(int(q.test[-1]) + 1)])
    rate = np.concatenate([np.gradient(smooth[q.test == k]) for k in range(int(q.test[-1]) + 1)])
    theta = np.column_stack([smooth, q.each(lambda u: u)])
    spread = theta.std(axis=0)
    theta = theta / np.where(spread > 1e-9, spread, np.inf)
    active = np.ones(theta.shape[1], dtype=bool)
    weight = np.zeros(theta.shape[1])
    for _ in range(10):
        A = theta[:, active]
        ridge = 1e-3 * len(A) * np.eye(A.shape[1])
        weight[:] = 0
        weight[active] = np.linalg.solve(A.T @ A + ridge, A.T @ rate)
        keep = np.abs(weight) >= 0.15 * np.max(np.abs(weight[1:]))
        keep[0] = True
        if np.array_equal(keep, active):
            break
        active = keep
    best = int(np.argmax(np.abs(weight[1:])))
    return q.names[best] if weight[1 + best] != 0 else None


def _smooth(x: Float1D) -> Float1D:
    """Means of five samples, of what there is at both ends."""
    return np.convolve(np.pad(x, 2, mode="edge"), np.ones(5) / 5, mode="valid")


RIVALS: Mapping[str, Callable[[Question], str | None]] = {
    "raw correlation": raw_correlation,
    "best delay": best_delay_correlation,
    "stepwise BIC": stepwise_bic,
    "LASSO-CV": lasso_cv,
    "SINDy (STLSQ)": thresholded_dynamics,
}
