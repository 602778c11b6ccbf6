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

from thermodata.diagnosis.question.known import FloatND
from thermodata.diagnosis.sensors.cooled import cooled_otherwise
from thermodata.diagnosis.sensors.temperature_sums import LEAST_SIZE, RIDGE, TemperatureSums, machines
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.schema.words.places import is_fluid
from thermodata.schema.words.sentences import counted
from thermodata.view.grid.dataset import Dataset, TestData

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
    with threadpool_limits(1):
        return [as_artefact(fall) for tests in machines(data) for fall in falls(data, tests, response)]


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
    sums = TemperatureSums(data, tests, response)
    # what stands in a fluid came off no body: how much of it there is, and whether it flows, is another factor
    asked = {n for n in sums.names if not is_fluid(data.channels[n].at)}
    plain = [f for f in _each_fall(sums, asked) if f.plain]
    if not plain:
        return []
    fall = max(plain, key=lambda f: f.drop)
    # what a loose sensor foretells of the others is wrong
    others = [f for f in _each_fall(sums, asked, without=[fall.name]) if f.name != fall.name]
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


def _each_fall(sums: TemperatureSums, asked: Collection[str], without: Collection[str] = ()) -> Iterator[Fall]:
    """Of each temperature where it falls most plainly. asked: which. without: temperatures that foretell no other."""
    for j, name in enumerate(sums.names):
        if name not in asked:
            continue
        used = np.flatnonzero(sums.seen[:, j])
        if len(used) < 2 * LEAST_TELLING:
            continue
        by = [i for i, n in enumerate(sums.names) if i != j and n not in without and sums.seen[used, i].all()]
        columns = np.array([*range(sums.commands), *(sums.commands + i for i in by)], dtype=np.int64)
        fall = _fall(sums, name, used, columns, sums.commands + j)
        if fall is not None:
            yield fall


def _fall(sums: TemperatureSums, name: str, used: Int1D, columns: Int1D, own: int) -> Fall | None:
    gram = sums.gram[np.ix_(used, columns, columns)]
    cross, energy = sums.gram[np.ix_(used, columns, np.array([own]))][..., 0], sums.gram[used, own, own]
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
    foretold = np.sqrt(power / sums.rows[used])
    tells = telling(foretold)
    sides = [np.flatnonzero(tells[:at]), at + np.flatnonzero(tells[at:])]
    if not all(len(side) for side in sides):
        return None
    answers = along / np.maximum(power, 1e-300)
    (lowest, before), (highest, after) = (
        (edge(answers[side]), float(along[side].sum() / power[side].sum()))
        for edge, side in zip((np.min, np.max), sides, strict=True)
    )
    before_, after_ = (tuple(sums.tests[used[i]] for i in side) for side in sides)
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
