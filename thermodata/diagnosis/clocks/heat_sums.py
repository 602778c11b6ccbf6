"""What a heat balance sums of a test, at each shift of its commands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.clocks.beside_air import beside_air
from thermodata.diagnosis.question.known import FloatND
from thermodata.plugin import Float2D, Int1D
from thermodata.view.grid.dataset import TestData

EVERY_S = 120.0  # between the shifts that are asked: up to these either way,
MOST_S = 3900.0
TWO_HOURS_S, ABOUT_S = 7200.0, 360.0  # and about two hours, as where a zone and daylight saving are wrong
LEAST_LEFT = 0.45  # of a test, where commands are moved by a shift: less of it is another test


def shifts_asked(step_s: float) -> Int1D:
    """By which commands are moved, in samples of step_s, in order, shape (s,)."""
    most, about = int(MOST_S / step_s), np.arange(-int(ABOUT_S / step_s), int(ABOUT_S / step_s) + 1)
    two_hours = [sign * round(TWO_HOURS_S / step_s) + about for sign in (-1, 1)]
    return np.unique(np.concatenate([np.arange(-most, most + 1), *two_hours])).astype(np.int64)


def commands_held(test: TestData, names: Sequence[str], every: int) -> Float2D:
    """Sizes of commands, each value held until the next; 0 where a command was not logged: means of `every` samples,
    shape (n, commands)."""
    columns = np.zeros((len(test.t_s), len(names)))
    for column, name in zip(columns.T, names, strict=True):
        known = np.flatnonzero(np.isfinite(test.values[name])) if name in test.values else np.empty(0, np.int64)
        if len(known):
            last = np.searchsorted(known, np.arange(len(column)), side="right") - 1
            column[:] = np.abs(test.values[name][known[np.clip(last, 0, None)]])
    return _row_means(columns, every)


def channels_evened(test: TestData, names: Sequence[str], every: int) -> Float2D:
    """Channels at even times, drawn straight over holes; zeros where one was not measured: means of `every` samples,
    shape (n, channels)."""
    columns = np.zeros((len(test.t_s), len(names)))
    for column, name in zip(columns.T, names, strict=True):
        if name in test.values:
            seen = np.flatnonzero(np.isfinite(test.values[name]) & test.valid[name])
            if len(seen) > 1:
                column[:] = np.interp(test.t_s, test.t_s[seen], test.values[name][seen])
    return _row_means(columns, every)


def _row_means(columns: Float2D, every: int) -> Float2D:
    whole = len(columns) // every
    return np.asarray(columns[: whole * every].reshape(whole, every, columns.shape[1]).mean(axis=1))


def sums_of_balance(
    parts: Sequence[tuple[Float2D, Float2D, Float2D]], shifts: Int1D, over: int
) -> tuple[FloatND, FloatND, FloatND]:
    """(gram, cross, energy) of a `Pair`. parts: commands, channels, and the air of each test. shifts: in
    samples, shape (s,). over: samples that a rise is taken over.

    Where commands are moved beyond the log's end nobody knows what worked: these rows are left out.
    """
    drives, channels = parts[0][0].shape[1], parts[0][1].shape[1]
    gram = np.zeros((len(parts), channels, len(shifts), drives + 1, drives + 1))
    cross = np.zeros((len(parts), channels, len(shifts), drives + 1))
    energy = np.zeros((len(parts), channels, len(shifts)))
    for i, (held, value, air) in enumerate(parts):
        n, works, around = len(value), _mean_over(held, over), _mean_over(air, over)
        rises, begins = value[over:] - value[:-over], value[:-over]
        for k, shift in enumerate(map(int, shifts)):
            if n - abs(shift) <= 2 * over or n - abs(shift) < LEAST_LEFT * n:
                continue
            then = slice(max(0, -shift), n - over - max(0, shift))
            rows = slice(max(0, shift), n - over - max(0, -shift))
            worked, rise, warm = beside_air([works[then], rises[rows], begins[rows]], around[rows])
            energy[i, :, k] = np.sum(rise**2, axis=0)
            seen = (energy[i, :, k] > 0).astype(np.float64)  # what was not measured says nothing of the commands
            gram[i, :, k, -1, -1] = np.sum(warm**2, axis=0)
            cross[i, :, k, -1] = np.sum(warm * rise, axis=0)
            gram[i, :, k, :-1, :-1] = seen[:, None, None] * (worked.T @ worked)
            gram[i, :, k, :-1, -1] = gram[i, :, k, -1, :-1] = (worked.T @ warm).T
            cross[i, :, k, :-1] = (worked.T @ rise).T
    return gram, cross, energy


def _mean_over(held: Float2D, over: int) -> Float2D:
    """Of the commands over each interval, shape (n - over, commands)."""
    total = np.vstack([np.zeros(held.shape[1]), np.cumsum(held, axis=0)])
    return np.asarray((total[over:-1] - total[: len(held) - over]) / over)
