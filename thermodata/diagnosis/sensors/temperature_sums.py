"""Temperatures of a machine beside what foretells them: what it was told to do, and its other temperatures.

What goes with the air around is taken out of both before, so is a constant in each test: how warm the hall is tells
nothing of a sensor.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from thermodata.diagnosis.clocks.beside_air import beside_air
from thermodata.diagnosis.clocks.logs_compared import is_around
from thermodata.diagnosis.clocks.sides import in_order
from thermodata.diagnosis.steps.commanded import is_command
from thermodata.effect.lag import lag
from thermodata.plugin import Bool1D, Float1D, Float2D
from thermodata.view.grid.dataset import Dataset, TestData

EVERY_S = 300.0  # means over so much: bodies are slower
LAGS_S = (600.0, 2400.0, 9600.0)  # of commands: of a bearing, of a housing, of a bed
POWERS = {"rotational_speed": (1, 2)}  # what a bearing loses goes with its speed by a power between
AIR_LAG_S = 3600.0
MEASURED = 0.5  # of a test's samples at least
RIDGE = 0.01  # of a column's squares
LEAST_SIZE = 1e-9  # of a column, in its unit: below is what rounding leaves of one that stands


def machines(data: Dataset) -> Iterator[list[TestData]]:
    """The tests of each campaign and machine by itself, in order of time."""
    rank = {key: i for i, key in enumerate(in_order(data.tests))}
    found: dict[tuple[str, str], list[TestData]] = {}
    for test in sorted(data.tests, key=lambda t: rank[t.key]):
        found.setdefault((test.campaign, test.machine), []).append(test)
    yield from found.values()


class TemperatureSums:
    """Sums of squares and products of all temperatures, and of what foretells them, in each test of a machine. The
    response is not looked at.

    names: of the temperatures of bodies. commands: how many columns they have, the first ones. gram: shape (tests, k,
    k), commands first. seen: shape (tests, temperatures), which were measured. rows: shape (tests,).
    """

    def __init__(self, data: Dataset, tests: Sequence[TestData], response: str) -> None:
        every = sorted(
            n
            for n, c in data.channels.items()
            if c.quantity == "temperature" and c.source and c.faulty is None and n != response
        )
        air = [n for n in every if is_around(data.channels[n])]
        drives = [
            (n, power)
            for n, c in sorted(data.channels.items())
            if is_command(c)
            for power in POWERS.get(c.quantity, (1,))
        ]
        self.tests = tests
        self.names = [n for n in every if n not in air]
        self.commands = len(drives) * len(LAGS_S)
        parts = [_columns(t, drives, self.names, air, data.step_s) for t in tests]
        self.gram = np.stack([x.T @ x for x, _ in parts])
        self.seen = np.stack([seen for _, seen in parts])
        self.rows = np.array([len(x) for x, _ in parts])


def _columns(
    test: TestData, drives: Sequence[tuple[str, int]], names: Sequence[str], air: Sequence[str], step_s: float
) -> tuple[Float2D, Bool1D]:
    """(commands in their lags and temperatures, beside what air gives: shape (n, k); which of `names` was measured).
    drives: commands, and the power of each.
    """
    every = max(1, round(EVERY_S / step_s))
    commands = [lag(_command_held(test, n) ** power, tau, step_s) for n, power in drives for tau in LAGS_S]
    courses = [_temperature_evened(test, n) for n in names]
    around = [x for n in air if (x := _temperature_evened(test, n)) is not None]
    nothing = np.zeros(len(test.t_s))
    known = [x for a in around for x in (a, lag(a - a[0], AIR_LAG_S, step_s))]
    columns = _row_means([*commands, *(nothing if x is None else x for x in courses)], every, len(test.t_s))
    (own,) = beside_air([columns], _row_means(known, every, len(test.t_s)))
    return own, np.array([x is not None for x in courses])


def _command_held(test: TestData, name: str) -> Float1D:
    """The size of a command, each value held until the next; 0 where it was not logged."""
    values = test.values.get(name)
    known = np.flatnonzero(np.isfinite(values)) if values is not None else np.empty(0, np.int64)
    if values is None or not len(known):
        return np.zeros(len(test.t_s))
    last = np.searchsorted(known, np.arange(len(values)), side="right") - 1
    return np.asarray(np.abs(values[known[np.clip(last, 0, None)]]))


def _temperature_evened(test: TestData, name: str) -> Float1D | None:
    """Drawn straight over holes; None where too little was measured, or the sensor is judged faulty."""
    info = test.channels.get(name)
    if name not in test.values or (info is not None and info.faulty is not None):
        return None
    seen = np.flatnonzero(np.isfinite(test.values[name]) & test.valid[name])
    if len(seen) < max(2, MEASURED * len(test.t_s)):
        return None
    return np.asarray(np.interp(test.t_s, test.t_s[seen], test.values[name][seen]))


def _row_means(columns: Sequence[Float1D], every: int, rows: int) -> Float2D:
    whole = rows // every
    table = np.column_stack(columns) if columns else np.zeros((rows, 0))
    return np.asarray(table[: whole * every].reshape(whole, every, table.shape[1]).mean(axis=1))
