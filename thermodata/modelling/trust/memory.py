"""How long a residual remembers, and how many independent samples it is worth (840 can be worth 14)."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Float1D

_LONGEST = 0.25  # of a test; a longer memory cannot be told from a trend


def memory(residual: Float1D, parts: list[slice]) -> float:
    """Integrated autocorrelation time in samples: 1 + 2 sum(rho), to the first rho below 0.05; all tests together."""
    return max(1.0, 1.0 + 2.0 * float(_correlations(residual, parts).sum()))


def effective_count(residual: Float1D, parts: list[slice]) -> float:
    """How many independent samples the residual is worth."""
    return len(residual) / memory(residual, parts) if len(residual) else 0.0


def _correlations(residual: Float1D, parts: list[slice]) -> Float1D:
    longest = max((p.stop - p.start for p in parts), default=0)
    if longest < 4:
        return np.zeros(0)
    size = int(2 ** np.ceil(np.log2(2 * longest)))
    spectrum = np.zeros(size // 2 + 1)
    for part in parts:
        spectrum += np.abs(np.fft.rfft(residual[part], size)) ** 2
    cover = np.fft.irfft(spectrum, size)[: int(longest * _LONGEST) + 1]
    if cover[0] <= 0:
        return np.zeros(0)
    rho = cover[1:] / cover[0]
    below = np.flatnonzero(rho < 0.05)
    return np.asarray(rho[: below[0]] if len(below) else rho)
