"""Spikes: one to three samples that stand out from their neighbours on both sides."""

from __future__ import annotations

import numpy as np

from thermodata.calibration.quality.sudden.edges import across_steps
from thermodata.calibration.quality.value import RunStats, true_runs
from thermodata.calibration.tread import tread_of
from thermodata.plugin import Bool1D, Float1D, Int1D

_SPIKE = 10.0  # of the noise of a difference
_REACH = 8
_TAIL, _TAIL_TIMES = 0.995, 5.0  # a spike is so many times what a channel does every two hundred samples
_MANY_SPIKES = 0.005
_FAR = 10.0  # times what all the rest reaches: no puff of air, but what a logger writes or a contact that is lost


def spikes(x: Float1D, own: RunStats) -> tuple[Bool1D, bool]:
    """(where 1 to 3 samples stand out from their neighbours on both sides, whether there are too many to be
    spikes). Only where a difference is far beyond the noise are neighbours looked at."""
    n = len(x)
    hit: Bool1D = np.zeros(n, dtype=bool)
    if own.step <= 0 or n < 2 * _REACH + 1:
        return hit, False
    noise = max(own.step, 2.0 * own.finest)
    if own.leap <= _SPIKE * noise:
        return hit, False
    rows, height = _stand_out(x, noise)
    if len(rows):
        # a flicker between two treads is no spike
        noise = max(noise, tread_of([x]))
        rows, height = rows[height > _SPIKE * noise], height[height > _SPIKE * noise]
    hit[rows] = True
    _without_long(hit)
    count = int(hit.sum())
    many = count > max(10, _MANY_SPIKES * n)
    if count:
        # air in a draught, a probe at high speed: what comes in all sizes is no spike
        others = _without_far(x, hit, rows, height)
        beyond = _runs_that_stand_out(hit, rows, height, _TAIL_TIMES * _tail(others, _SPIKE * noise))
        if beyond.any() or not many:
            return beyond, int(beyond.sum()) > max(10, _MANY_SPIKES * n)
    return hit, many


def _runs_that_stand_out(hit: Bool1D, rows: Int1D, height: Float1D, least: float) -> Bool1D:
    """The runs of `hit` that stand out by more than `least` somewhere. rows, height: shape (k,)."""
    top = np.zeros(len(hit))
    top[rows] = height
    beyond = np.zeros_like(hit)
    for a, b in zip(*true_runs(hit), strict=True):
        beyond[a:b] = top[a:b].max() > least
    return beyond


def _without_far(x: Float1D, hit: Bool1D, rows: Int1D, height: Float1D) -> Float1D:
    """x without the runs of `hit` that stand out by far more than all other samples reach: what a logger writes tells
    nothing of what the channel does, and a handful of it would make its own height usual. What comes in all sizes
    leaves no such gap between the heights. rows, height: shape (k,)."""
    rest = x[~hit & np.isfinite(x)]
    reach = float(np.ptp(rest)) if len(rest) else np.inf
    for one in np.sort(height[hit[rows]]).tolist():
        if one > _FAR * reach:
            break
        reach = max(reach, one)
    return np.where(_runs_that_stand_out(hit, rows, height, _FAR * reach), np.nan, x)


def _stand_out(x: Float1D, noise: float) -> tuple[Int1D, Float1D]:
    """(rows that stand out from what is around them by more than 10 times the noise, by how much)."""
    n = len(x)
    with np.errstate(invalid="ignore"):
        jumps = np.flatnonzero(np.abs(np.diff(x)) > _SPIKE * noise)
    near = np.unique(np.clip((jumps[:, None] + np.array([1, 2, 3, 0, -1, -2])).ravel(), 0, n - 1))
    if len(near) > 0.2 * n + 1000:
        near = near[:: int(len(near) / (0.2 * n + 1000)) + 1]
    offsets = np.concatenate([np.arange(-_REACH, -2), np.arange(3, _REACH + 1)])
    around = x[np.clip(near[:, None] + offsets, 0, n - 1)]
    half = len(offsets) // 2
    fine = np.isfinite(around)
    enough = (fine[:, :half].sum(axis=1) >= 3) & (fine[:, half:].sum(axis=1) >= 3)
    near, around = near[enough], around[enough]
    if not len(near):
        return near, np.empty(0)
    left, right = np.nanmedian(around[:, :half], axis=1), np.nanmedian(around[:, half:], axis=1)
    middle = (left + right) / 2
    spread = np.nanmedian(np.abs(around - np.where(np.arange(2 * half) < half, left[:, None], right[:, None])), axis=1)
    height = np.abs(x[near] - middle)
    with np.errstate(invalid="ignore", over="ignore"):
        out = (height > np.maximum(_SPIKE * noise, 10 * spread)) & (np.abs(left - right) < 0.3 * height)
    return near[out], height[out]


def _without_long(hit: Bool1D) -> None:
    for a, b in zip(*true_runs(hit), strict=True):
        if b - a > 3:
            hit[a:b] = False


def _tail(x: Float1D, leap: float) -> float:
    """How far a sample lies from the middle of what is 3 before and 3 after it, exceeded by one of two hundred (and
    by twelve in any case: two spikes of two samples shift so many). The ends of a dropout, which leaps and then stays,
    are no excursions: beside them no spike is usual."""
    off = np.abs(x[3:-3] - (x[:-6] + x[6:]) / 2)[~across_steps(x, leap)[3:-3]]
    off = off[np.isfinite(off)]
    if len(off) > 50_000:
        off = off[:: len(off) // 50_000 + 1]
    # the spikes themselves are among them, each with the two that it shifts
    share = max(1 - _TAIL, 12 / max(len(off), 1))
    return float(np.quantile(off, 1 - share)) / float(np.sqrt(1.5)) if share < 0.5 else 0.0
