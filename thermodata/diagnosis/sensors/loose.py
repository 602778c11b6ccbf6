"""Temperatures whose sensor came loose: from one test on they answer by one smaller factor than before.

A magnet or the glue came off: the sensor reads a half or a quarter of what its body does, and the air for the rest. So
each temperature is foretold by what the machine was told to do and by its other temperatures, with gains that are the
same in all tests but for one factor from some test on; each test by the others. What goes with the air around is taken
out of both before. It is told, and nothing is moved or left out.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.clocks.beside_air import beside_air
from thermodata.diagnosis.clocks.logs_compared import is_around
from thermodata.diagnosis.clocks.sides import in_order
from thermodata.diagnosis.question.known import FloatND
from thermodata.diagnosis.sensors.cooled import cooled_otherwise
from thermodata.diagnosis.steps.commanded import is_command
from thermodata.effect.lag import lag
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.schema.words.places import is_fluid
from thermodata.schema.words.sentences import counted
from thermodata.view.grid.dataset import Dataset, TestData

EVERY_S = 300.0  # means over so much: bodies are slower
LAGS_S = (600.0, 2400.0, 9600.0)  # of commands: of a bearing, of a housing, of a bed
POWERS = {"rotational_speed": (1, 2)}  # what a bearing loses goes with its speed by a power between
AIR_LAG_S = 3600.0
MEASURED = 0.5  # of a test's samples at least
RIDGE = 0.01  # of a column's squares
LEAST_SIZE = 1e-9  # of a column, in its unit: below is what rounding leaves of one that stands
FACTORS = (0.75, 0.65, 0.55, 0.45, 0.35, 0.25, 0.15)
TELLS = 0.25  # of what is foretold in the test in which it is most: less of it says nothing of a factor,
LEAST_K = 0.5  # nor does less than this, anywhere
LEAST_TELLING = 2  # tests, before and after
DROP = 0.55  # of the squared error of tests left out, by the factor,
LEFT = 0.25  # and of the temperature itself that is left at most: what nothing foretells has no gain
LOWER = 0.65  # what comes loose loses a third and more
PARTED = 0.85  # highest of the tests after, in shares of the lowest before
# what comes loose answers all that it followed by one factor, so tests part by so much of the fall (in logarithms),
# unless that one factor says so much more than none
WHOLE = 0.7
EVIDENT = 0.65  # of the squared error
TOO = 0.25  # fall of the error by which another temperature did the same: then it is the machine that changed


@dataclass(frozen=True, slots=True)
class Fall:
    """A temperature that answers less from a test on. before, after: the tests that tell. ratio: of the answer after to
    that before. drop: of the squared error of left-out tests, by it; left: what remains, in shares of the temperature.
    parted: the highest test after, in shares of the lowest before; infinite where one before goes the other way.
    between: tests between the two sides, which tell neither."""

    name: str
    before: tuple[TestData, ...]
    after: tuple[TestData, ...]
    ratio: float
    drop: float
    left: float
    parted: float
    between: int = 0

    @property
    def plain(self) -> bool:
        enough = min(len(self.before), len(self.after)) >= LEAST_TELLING
        small = self.ratio <= LOWER and self.parted <= PARTED
        return enough and self.drop >= DROP and self.left <= LEFT and small and self.is_one_factor

    @property
    def is_one_factor(self) -> bool:
        """Whether one factor is what changed: what coolant wets, or what another programme drives, answers by another
        one in each test."""
        apart = self.ratio > 0 and self.parted <= self.ratio**WHOLE
        return apart or self.drop >= EVIDENT


def loose_sensors(data: Dataset, response: str) -> list[Artefact]:
    """Of each campaign and machine by itself. Of the tests temperatures and commands are read, never the response."""
    rank = {key: i for i, key in enumerate(in_order(data.tests))}
    machines: dict[tuple[str, str], list[TestData]] = {}
    for test in sorted(data.tests, key=lambda t: rank[t.key]):
        machines.setdefault((test.campaign, test.machine), []).append(test)
    with threadpool_limits(1):
        return [as_artefact(fall) for tests in machines.values() for fall in falls(data, tests, response)]


def as_artefact(fall: Fall) -> Artefact:
    """How it is told: from which test on the sensor stands out less, and what bears that out."""
    first, last = fall.after[0], fall.before[-1]
    told = f"{counted(len(fall.after), 'test', 'bears it out', 'bear it out')}, {len(fall.before)} before"
    told += f"; {fall.between} between {'tells' if fall.between == 1 else 'tell'} neither" if fall.between else ""
    return Artefact(
        kind="sensor_gain",
        campaign=first.campaign,
        test=first.test,
        at_s=None,
        size_um=None,
        why=f"from this test on '{fall.name}' answers {fall.ratio:.2f} times what it did up to '{last.test}', by what "
        f"commands and other temperatures foretell ({told}), and no other temperature does: look whether the sensor "
        "came loose, something cools its place since, or what heats it ran otherwise (another gear, a lighter "
        "load); only if it is loose, declare "
        f"channels: {{{fall.name}: {{absent: true}}}} at these tests",
    )


def falls(data: Dataset, tests: Sequence[TestData], response: str = "") -> list[Fall]:
    """tests: of one machine, in order. Nothing where several fall: one sensor comes loose, and a machine changes."""
    if len(tests) < 2 * LEAST_TELLING:
        return []
    sums = _Sums(data, tests, response)
    plain = [f for f in sums.falls() if f.plain]
    if not plain:
        return []
    fall = max(plain, key=lambda f: f.drop)
    # what a loose sensor foretells of the others is wrong
    others = [f for f in sums.falls(without=[fall.name]) if f.name != fall.name]
    changed = any(f.plain or between_the_same_tests(f, fall) for f in others) or conditions_changed(fall)
    return [] if changed or cooled_otherwise(fall.before, fall.after) else [fall]


def between_the_same_tests(other: Fall, fall: Fall) -> bool:
    """Whether another temperature fell by as much as tells of the machine, where this one did."""
    before, after = ({t.key for t in side} for side in (fall.before, fall.after))
    together = after.isdisjoint(t.key for t in other.before) and before.isdisjoint(t.key for t in other.after)
    return together and other.drop >= TOO


def conditions_changed(fall: Fall) -> bool:
    """Whether a condition is one before, and another one after."""
    before, after = ([t.conditions for t in side] for side in (fall.before, fall.after))
    names = set.intersection(*(set(c) for c in [*before, *after]))
    values = [({str(c[n]) for c in before}, {str(c[n]) for c in after}) for n in names]
    return any(len(b) == len(a) == 1 and a != b for b, a in values)


class _Sums:
    """Sums of squares and products of all temperatures, and of what foretells them, in each test.

    gram: shape (tests, k, k), commands first. seen: shape (tests, temperatures). rows: shape (tests,).
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
        # what stands in a fluid came off no body: how much of it there is, and whether it flows, is another factor
        self.asked = {n for n in self.names if not is_fluid(data.channels[n].at)}
        self.commands = len(drives) * len(LAGS_S)
        parts = [_columns(t, drives, self.names, air, data.step_s) for t in tests]
        self.gram = np.stack([x.T @ x for x, _ in parts])
        self.seen = np.stack([seen for _, seen in parts])
        self.rows = np.array([len(x) for x, _ in parts])

    def falls(self, without: Collection[str] = ()) -> Iterator[Fall]:
        """Of each temperature where it falls most plainly. without: temperatures that foretell no other."""
        for j, name in enumerate(self.names):
            if name not in self.asked:
                continue
            used = np.flatnonzero(self.seen[:, j])
            if len(used) < 2 * LEAST_TELLING:
                continue
            by = [i for i, n in enumerate(self.names) if i != j and n not in without and self.seen[used, i].all()]
            columns = np.array([*range(self.commands), *(self.commands + i for i in by)], dtype=np.int64)
            fall = self._fall(name, used, columns, self.commands + j)
            if fall is not None:
                yield fall

    def _fall(self, name: str, used: Int1D, columns: Int1D, own: int) -> Fall | None:
        gram = self.gram[np.ix_(used, columns, columns)]
        cross, energy = self.gram[np.ix_(used, columns, np.array([own]))][..., 0], self.gram[used, own, own]
        size = np.sqrt(np.einsum("tkk->k", gram))
        moves = size > LEAST_SIZE
        if not moves.any() or not energy.sum() > 0:
            return None
        size = size[moves]
        gram, cross = gram[:, moves][:, :, moves] / size[:, None] / size, cross[:, moves] / size
        at, factor = _best_break(gram, cross)
        plain, *_ = left_out(gram, cross, energy, np.ones(len(used)))
        scale = np.where(np.arange(len(used)) < at, 1.0, factor)
        left, along, power = left_out(gram, cross, energy, scale)
        foretold = np.sqrt(power / self.rows[used])
        tells = telling(foretold)
        sides = [np.flatnonzero(tells[:at]), at + np.flatnonzero(tells[at:])]
        if not all(len(side) for side in sides):
            return None
        answers = along / np.maximum(power, 1e-300)
        (lowest, before), (highest, after) = (
            (edge(answers[side]), float(along[side].sum() / power[side].sum()))
            for edge, side in zip((np.min, np.max), sides, strict=True)
        )
        before_, after_ = (tuple(self.tests[used[i]] for i in side) for side in sides)
        parted = float(highest / lowest) if lowest > 0 else np.inf
        ratio = after / before if before > 0 else np.inf
        drop = 1 - left / max(plain, 1e-300)
        between = int(sides[1][0] - sides[0][-1]) - 1
        return Fall(name, before_, after_, ratio, drop, left / float(energy.sum()), parted, between)


def telling(foretold: Float1D) -> Bool1D:
    """Which tests say by what factor a temperature answers, shape (tests,). foretold: of each, RMS [K]."""
    return np.asarray(foretold >= max(LEAST_K, TELLS * float(foretold.max())))


def _best_break(gram: FloatND, cross: Float2D) -> tuple[int, float]:
    """(first test, factor) with which the same gains foretell most of all tests."""
    best, most = (1, 1.0), -np.inf
    for factor in FACTORS:
        sums = [np.cumsum(x, axis=0) for x in (gram, cross)]
        grams, crosses = (x[:-1] + power * (x[-1] - x[:-1]) for x, power in zip(sums, (factor**2, factor), strict=True))
        gains = np.linalg.solve(grams + RIDGE * np.eye(gram.shape[-1]), crosses[..., None])[..., 0]
        told = 2 * np.einsum("ak,ak->a", gains, crosses) - np.einsum("ak,akl,al->a", gains, grams, gains)
        if told.max() > most:
            best, most = (int(np.argmax(told)) + 1, factor), float(told.max())
    return best


def left_out(gram: FloatND, cross: Float2D, energy: Float1D, scale: Float1D) -> tuple[float, Float1D, Float1D]:
    """Each test by the gains of the others: (squared error of all, product of what is measured with what is foretold at
    the factor 1, square of that; each of shape (tests,)). scale: how many times as much each answers, shape (tests,).
    """
    grams, crosses = scale[:, None, None] ** 2 * gram, scale[:, None] * cross
    others = grams.sum(axis=0) - grams + RIDGE * np.eye(gram.shape[-1])
    gains = np.linalg.solve(others, (crosses.sum(axis=0) - crosses)[..., None])[..., 0]
    along = np.einsum("tk,tk->t", gains, cross)
    power = np.maximum(np.einsum("tk,tkl,tl->t", gains, gram, gains), 0.0)
    return float(np.sum(energy - 2 * scale * along + scale**2 * power)), along, power


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
