"""Whitening by a common AR(3) model, and surrogates that keep a residual's spectrum but not its story."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.plugin import Float1D, Float2D

ORDER = 3


def fit_ar(residuals: Sequence[Float1D], order: int = ORDER) -> Float1D:
    """Coefficients a, shape (order,), of x[i] = sum a[j] x[i-1-j] + e, common to all tests (least squares)."""
    rows, goals = [], []
    for x in residuals:
        if len(x) <= 2 * order:
            continue
        rows.append(np.column_stack([x[order - 1 - j : len(x) - 1 - j] for j in range(order)]))
        goals.append(x[order:])
    if not rows:
        return np.zeros(order)
    X, y = np.vstack(rows), np.concatenate(goals)
    gram = X.T @ X
    gram[np.diag_indices_from(gram)] *= 1 + 1e-9
    return np.asarray(np.linalg.lstsq(gram, X.T @ y, rcond=None)[0], dtype=np.float64)


def whiten(columns: Float2D, ar: Float1D) -> Float2D:
    """Columns, shape (m, ...), filtered by 1 - sum a z^-j; the first len(ar) rows, whose past is unknown, are 0."""
    past = len(ar)
    result = np.array(columns, dtype=np.float64)
    for j, a in enumerate(ar, start=1):
        result[past:] -= a * columns[past - j : len(columns) - j]
    result[:past] = 0.0
    return result


def surrogates(residual: Float1D, count: int, rng: np.random.Generator) -> Float2D:
    """Shape (m, count): the residual's amplitude spectrum with random phases.

    The series is mirrored first: phase surrogates need ends that meet, or the wrap-around makes a line.
    Source: [theiler1992].
    """
    m = len(residual)
    mirrored = np.concatenate([residual, residual[::-1]])
    spectrum = np.abs(np.fft.rfft(mirrored))
    # a mirrored series has its energy in cosines of fixed phase; random phases spread it, so amplitudes are kept
    phases = rng.uniform(0, 2 * np.pi, (len(spectrum), count))
    shuffled = np.fft.irfft(spectrum[:, None] * np.exp(1j * phases), n=2 * m, axis=0)[:m]
    shuffled -= shuffled.mean(axis=0)
    # the half that is kept may by chance hold less than half of the energy: every surrogate is as large as the residual
    size = np.sqrt(np.mean(shuffled**2, axis=0))
    target = np.sqrt(np.mean((residual - residual.mean()) ** 2))
    result: Float2D = shuffled * (target / np.where(size > 0, size, 1.0))
    return result
