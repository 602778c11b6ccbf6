"""How wide the estimates of a fit scatter, where its residual hangs together for an unknown time.

    residual = white noise + an Ornstein-Uhlenbeck process of unknown size and memory, each test by itself

A Bartlett window over the residual's own correlations reads a memory that is too short, for a fit has taken the slowest
part of the noise into its gains. Here the likelihood has the gains taken out (restricted, [patterson1971]), and what it
leaves open of size and memory goes into the interval: an average over all that the residual allows, and not its best
guess alone.

The discrete cosine transform takes correlated samples to coefficients that are nearly independent, whose variances are
the noise's spectrum; its first is the mean of the test, which is free. Coefficients of like frequency are gathered in
bands once, after which any noise costs microseconds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Float1D, Float2D

BAND = 1.1  # ratio of the frequencies in a band
MEMORIES = 14  # from one sample to twice the longest test
SHARES = 18  # slow over white noise at the lowest frequency
LEAST_SHARE, MOST_SHARE = 0.3, 3e6
OUTSIDE = 0.05  # of an interval of 95 %


@dataclass(frozen=True)
class Scatter:
    """sd: standard deviation of each estimate. half: half of its interval of 95 %. Shapes (k,). cover: how they scatter
    together, shape (k, k), with sd squared on its diagonal."""

    sd: Float1D
    half: Float1D
    cover: Float2D


def scatter(
    jacobian: Float2D,
    residual: Float1D,
    parts: Sequence[slice],
    unknown: Sequence[tuple[slice, Float1D]] = (),
) -> Scatter:
    """Of least squares. jacobian: shape (n, k); parts: the rows of each test; unknown: what else moves some rows by one
    standard deviation, each by itself. NaN where too little is left to tell."""
    noise = make_noise(jacobian, residual, parts)
    return nothing(jacobian.shape[1]) if noise is None else noise.scatter(jacobian, parts, unknown)


def nothing(count: int) -> Scatter:
    """Where nothing can be told."""
    return Scatter(np.full(count, np.nan), np.full(count, np.nan), np.full((count, count), np.nan))


@dataclass(frozen=True)
class Noise:
    """Every noise that the residual of a fit allows. Shapes (noises,): memory [samples]; slow: its power over that of
    the white noise at `lowest`; white: the variance of that, in the response's unit squared; share: how likely.
    left: degrees of freedom."""

    memory: Float1D
    slow: Float1D
    white: Float1D
    share: Float1D
    lowest: float
    left: float

    def scatter(
        self, jacobian: Float2D, parts: Sequence[slice], unknown: Sequence[tuple[slice, Float1D]] = ()
    ) -> Scatter:
        """Of least squares on these or on other tests; see the function `scatter`."""
        k = jacobian.shape[1]
        if not k:
            return nothing(0)
        size = _size(jacobian)
        bands = _Bands(jacobian / size, _long_enough(parts))
        if not bands.count.size:
            return nothing(k)
        plain = np.linalg.pinv(bands.products.sum(axis=0), rcond=1e-12, hermitian=True)
        power = _spectra(bands.frequency, self.memory, self.slow, self.lowest) * self.white[:, None]
        meat = np.einsum("gb,bij->gij", power, bands.products)
        variance = np.einsum("ij,gjk,ki->gi", plain, meat, plain)
        pulls = plain @ np.array([(jacobian[rows] / size).T @ moved for rows, moved in unknown]).reshape(-1, k).T
        variance += np.sum(pulls**2, axis=1)
        sd = np.sqrt(np.maximum(self.share @ variance, 0.0))
        half = np.array([_half(self.share, np.sqrt(np.maximum(v, 0.0)), self.left) for v in variance.T])
        cover = plain @ np.einsum("g,gij->ij", self.share, meat) @ plain + pulls @ pulls.T
        return Scatter(sd / size, half / size, cover / np.outer(size, size))


def make_noise(jacobian: Float2D, residual: Float1D, parts: Sequence[slice]) -> Noise | None:
    """See `scatter`; None where too little is left to tell."""
    k = jacobian.shape[1]
    bands = _Bands(np.column_stack([jacobian / _size(jacobian), residual]), _long_enough(parts))
    left = float(bands.count.sum()) - k
    if left < 2:
        return None
    lowest = np.pi / bands.longest
    memory, slow = (
        v.ravel()
        for v in np.meshgrid(
            np.geomspace(1.0, 2.0 * bands.longest, MEMORIES), np.geomspace(LEAST_SHARE, MOST_SHARE, SHARES)
        )
    )
    memory, slow = np.append(memory, 1.0), np.append(slow, 0.0)
    spectra = _spectra(bands.frequency, memory, slow, lowest)  # (noises, bands)
    weighted = np.einsum("gb,bij->gij", 1.0 / spectra, bands.products)
    bread = np.linalg.pinv(weighted[:, :k, :k], rcond=1e-12, hermitian=True)
    cross = weighted[:, :k, k]
    square = weighted[:, k, k] - np.einsum("gi,gij,gj->g", cross, bread, cross)
    _, information = np.linalg.slogdet(weighted[:, :k, :k] + 1e-12 * np.eye(k))
    likelihood = -0.5 * (np.log(spectra) @ bands.count + information + left * np.log(np.maximum(square, 1e-300)))
    share = np.exp(likelihood - likelihood.max())
    kept = share > 1e-6 * share.max()
    return Noise(memory[kept], slow[kept], square[kept] / left, share[kept] / share[kept].sum(), lowest, left)


def _size(columns: Float2D) -> Float1D:
    size = np.sqrt(np.sum(columns**2, axis=0))
    return np.asarray(np.where(size > 0, size, 1.0))


def _long_enough(parts: Sequence[slice]) -> list[slice]:
    return [p for p in parts if p.stop - p.start > 2]


class _Bands:
    """frequency: of each band [1/sample, in radians]; count: coefficients in it; products: shape (bands, m, m), the
    sums of the columns' products over its coefficients; longest: of a test, in samples."""

    def __init__(self, columns: Float2D, parts: Sequence[slice]) -> None:
        from scipy.fft import dct

        self.longest = max((p.stop - p.start for p in parts), default=1)
        m = columns.shape[1]
        coefficients = [dct(columns[p], axis=0, norm="ortho")[1:] for p in parts]
        all_of_them = np.concatenate(coefficients) if parts else np.zeros((0, m))
        omega = np.concatenate([np.pi * np.arange(1, p.stop - p.start) / (p.stop - p.start) for p in parts] or [[]])
        place = np.floor(np.log(np.pi / np.maximum(omega, 1e-12)) / np.log(BAND)).astype(int)
        order = np.argsort(place, kind="stable")
        starts = np.flatnonzero(np.diff(place[order], prepend=-1))
        ends = np.append(starts, len(order))[1:]
        rows = [order[a:b] for a, b in zip(starts, ends, strict=True)]
        self.count = np.array([len(r) for r in rows], dtype=np.float64)
        self.frequency = np.array([np.exp(np.mean(np.log(omega[r]))) for r in rows])
        self.products = np.array([all_of_them[r].T @ all_of_them[r] for r in rows]).reshape(len(rows), m, m)


def _spectra(frequency: Float1D, memory: Float1D, slow: Float1D, lowest: float) -> Float2D:
    """Variances of coefficients of these frequencies over those of the white noise; shape (noises, frequencies)."""
    keep = np.exp(-1.0 / memory)[:, None]

    def shape(omega: Array) -> Array:
        return np.asarray(1.0 / (1.0 + keep**2 - 2.0 * keep * np.cos(omega)))

    return np.asarray(1.0 + slow[:, None] * shape(frequency[None, :]) / shape(np.array(lowest)))


def _half(share: Float1D, sd: Float1D, left: float) -> float:
    """Half of the interval: the mixture of Student's distributions has OUTSIDE beyond it."""
    from scipy.optimize import brentq
    from scipy.special import stdtr, stdtrit

    sd = np.maximum(sd, 1e-300)
    top = float(sd.max())
    if not np.isfinite(top) or top <= 1e-299:
        return float("nan")
    unit = sd / top
    reach = -1.001 * float(stdtrit(left, OUTSIDE / 2))
    return top * float(brentq(lambda h: 2.0 * share @ stdtr(left, -h / unit) - OUTSIDE, 0.99 * unit.min(), reach))
