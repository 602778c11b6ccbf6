"""Two temperatures whose cables, or names, are exchanged in a test: each does what foretells the other.

Two Pt100s were put back the other way round, or an export has its columns in another order. Both channels go on reading
sound temperatures, so nothing in themselves is wrong, and the model takes one body's heat for the other's. So in each
test both are foretold, by gains of the other tests, from what the machine was told to do and from its other
temperatures: as they are named, and exchanged. Which way round is right the logs can't say: what most tests have is
taken for it. It is told, and nothing is moved.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.question.known import FloatND
from thermodata.diagnosis.sensors.temperature_sums import LEAST_SIZE, RIDGE, TemperatureSums, machines
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.schema.words.sentences import counted
from thermodata.view.grid.dataset import Dataset, TestData

LEAST_TELLING = 2  # other tests that tell both apart the other way round
DROP = 0.8  # of the squared error of both in the test, by exchanging them,
EACH = 0.5  # and of each by itself: two that are alike fit one another's course, and one that failed fits none
LEFT = 0.3  # of both in the test that is left at most once they are exchanged: what nothing foretells tells nothing
# of what exchanging would leave in another test so much is left at most as they are named, or it tells nothing
APART = 0.5
LEAST_K = 0.5  # RMS that is left of both in the test as they are named: less is no other body


@dataclass(frozen=True, slots=True)
class Exchange:
    """Two temperatures that are exchanged in a test. straight, turned: RMS [K] that is left of both in all tests in
    which they are, as they are named and exchanged. telling: other tests, which have them the other way round."""

    test: TestData
    names: tuple[str, str]
    straight: float
    turned: float
    telling: int


def exchanged_sensors(data: Dataset, response: str) -> list[Artefact]:
    """Of each campaign and machine by itself. Of the tests temperatures and commands are read, never the response."""
    with threadpool_limits(1):
        return [as_artefact(one) for tests in machines(data) for one in exchanges(data, tests, response)]


def as_artefact(one: Exchange) -> Artefact:
    """How it is told: which two, how plainly, and what to write if it is so."""
    first, second = one.names
    return Artefact(
        kind="exchanged",
        campaign=one.test.campaign,
        test=one.test.test,
        at_s=None,
        size_um=None,
        why=f"there '{first}' does what commands and other temperatures foretell of '{second}', by the gains of the "
        f"other tests, and '{second}' what they foretell of '{first}': as they are named {one.straight:.2g} K are left "
        f"of them, exchanged {one.turned:.2g} K, and {counted(one.telling, 'test', 'has', 'have')} them the other "
        "way round: look whether their cables were exchanged, there or in those, or their columns; where they were, "
        f"give each the other's signal (in the campaign file, at the test: channels: {{{first}: {{signal: ...}}, "
        f"{second}: {{signal: ...}}}})",
    )


def exchanges(data: Dataset, tests: Sequence[TestData], response: str = "") -> list[Exchange]:
    """tests: of one machine. The plainest first, each temperature of a test at most once. What most tests have is taken
    for right: of them are the gains."""
    if len(tests) <= LEAST_TELLING:
        return []
    sums = TemperatureSums(data, tests, response)
    found = sorted((e for a, b in _suspects(sums) for e in _of_pair(sums, a, b)), key=lambda e: e.turned / e.straight)
    kept: list[Exchange] = []
    for one in found:
        of_test = {n for e in kept if e.test.key == one.test.key for n in e.names}
        if of_test.isdisjoint(one.names):
            kept.append(one)
    return kept


def _suspects(sums: TemperatureSums) -> Iterator[tuple[int, int]]:
    """The pairs, by their places among the names, of which a test looks exchanged before any is put right. All pairs
    at once: gains on all columns but two follow from the inverse of the products of all of them, by its blocks."""
    of_tests: dict[tuple[int, ...], list[tuple[int, int]]] = {}
    for a, b in combinations(range(len(sums.names)), 2):
        of_tests.setdefault(tuple(np.flatnonzero(sums.seen[:, a] & sums.seen[:, b]).tolist()), []).append((a, b))
    for used, pairs in of_tests.items():
        if len(used) <= LEAST_TELLING:
            continue
        places = np.flatnonzero(sums.seen[list(used)].all(axis=0))
        columns = np.array([*range(sums.commands), *(sums.commands + places)], dtype=np.int64)
        gram = sums.gram[np.ix_(np.array(used), columns, columns)]
        size = np.sqrt(np.einsum("tkk->k", gram))
        moves = size > LEAST_SIZE
        gram = gram[:, moves][:, :, moves] / size[moves, None] / size[moves]
        where = {int(c): k for k, c in enumerate(columns[moves])}
        kept = [(a, b) for a, b in pairs if sums.commands + a in where and sums.commands + b in where]
        if not kept:
            continue
        both = np.array([[where[sums.commands + a], where[sums.commands + b]] for a, b in kept])
        looks = _look_exchanged(gram, size[moves], both, sums.rows[list(used)])
        yield from (pair for pair, so in zip(kept, looks.tolist(), strict=True) if so)


def _look_exchanged(gram: FloatND, size: Float1D, both: NDArray[np.int64], rows: Int1D) -> Bool1D:
    """Of pairs of columns, shape (pairs, 2), whether any test looks exchanged, shape (pairs,). gram: of columns of unit
    size, shape (tests, k, k); size: theirs before, shape (k,)."""
    a, b = both.T
    own, other = size[both], size[both[:, ::-1]]
    looks = np.zeros(len(both), dtype=np.bool_)
    whole = gram.sum(axis=0) + RIDGE * np.eye(len(size))
    for test, of in enumerate(gram):
        inverse = np.linalg.inv(whole - of)
        across, twice = of @ inverse, inverse @ of @ inverse
        block = inverse[both[:, :, None], both[:, None, :]]
        turn = np.linalg.inv(block)
        # what is left of each: a combination of all columns, its own once and the other of the pair not at all
        square = np.einsum("pij,pik,pkl->pjl", turn, twice[both[:, :, None], both[:, None, :]], turn)
        left = np.einsum("pii->pi", square)
        seen = across[both[:, :, None], both[:, None, :]] @ turn  # row: a column that is measured; column: what is left
        energy = of[both, both]
        between = of[a, b][:, None]
        straight = own**2 * left
        # the same with the other's reading in place of its own
        told = own**2 * (left - 2 * np.einsum("pii->pi", seen) + energy)
        with_other = np.stack([seen[:, 1, 0], seen[:, 0, 1]], axis=1) - between
        turned = told + 2 * own * other * with_other + other**2 * energy[:, ::-1]
        looks |= [
            is_exchanged(*of_pair, int(rows[test]))
            for of_pair in zip(np.maximum(straight, 0), np.maximum(turned, 0), own**2 * energy, strict=True)
        ]
    return looks


def _of_pair(sums: TemperatureSums, a: int, b: int) -> list[Exchange]:
    """Of two temperatures, by their places among the names."""
    used = np.flatnonzero(sums.seen[:, a] & sums.seen[:, b])
    if len(used) <= LEAST_TELLING:
        return []
    by = [i for i in range(len(sums.names)) if i not in (a, b) and sums.seen[used, i].all()]
    columns = np.array([*range(sums.commands), *(sums.commands + i for i in by)], dtype=np.int64)
    both = sums.commands + np.array([a, b])
    gram = sums.gram[np.ix_(used, columns, columns)]
    size = np.sqrt(np.einsum("tkk->k", gram))
    moves = size > LEAST_SIZE
    if not moves.any():
        return []
    size = size[moves]
    gram = gram[:, moves][:, :, moves] / size[:, None] / size
    cross = sums.gram[np.ix_(used, columns[moves], both)] / size[:, None]
    energy = sums.gram[used[:, None], both, both]
    found, telling = _turned(gram, cross, energy, sums.rows[used])
    if not found:
        return []
    rows = 2 * sums.rows[used[list(found)]].sum()
    straight, turned = (float(np.sqrt(sum(each) / rows)) for each in zip(*found.values(), strict=True))
    names = sums.names[a], sums.names[b]
    return [Exchange(sums.tests[used[t]], names, straight, turned, telling) for t in found]


def _turned(gram: FloatND, cross: FloatND, energy: Float2D, rows: Int1D) -> tuple[dict[int, tuple[float, float]], int]:
    """(test -> squared error as named and exchanged, of each in which two are exchanged; other tests that tell). The
    plainest is put right before others are asked. cross: shape (tests, k, 2); energy: shape (tests, 2)."""
    found: dict[int, tuple[float, float]] = {}
    cross, energy = cross.copy(), energy.copy()
    while True:
        straight, turned = _errors(gram, cross, energy)
        # those that were put right are among them
        telling = int((straight.sum(axis=1) <= APART * turned.sum(axis=1)).sum()) - len(found)
        plain = [
            t
            for t in range(len(gram))
            if t not in found and is_exchanged(straight[t], turned[t], energy[t], int(rows[t]))
        ]
        if not plain or telling < LEAST_TELLING:
            break
        best = min(plain, key=lambda t: float(turned[t].sum() / straight[t].sum()))
        found[best] = float(straight[best].sum()), float(turned[best].sum())
        cross[best], energy[best] = cross[best][:, ::-1].copy(), energy[best][::-1].copy()
    return found, telling


def is_exchanged(straight: Float1D, turned: Float1D, energy: Float1D, rows: int) -> bool:
    """Of one test. straight, turned: squared error of what each foretelling leaves, as named and of the other one;
    energy: of each as it is named; shape (2,) each."""
    falls = turned.sum() <= (1 - DROP) * straight.sum() and bool((turned <= (1 - EACH) * straight).all())
    return falls and bool(turned.sum() <= LEFT * energy.sum()) and bool(straight.sum() >= 2 * rows * LEAST_K**2)


def _errors(gram: FloatND, cross: FloatND, energy: Float2D) -> tuple[Float2D, Float2D]:
    """What the gains of the other tests leave of each test, squared: (of the two as named, and exchanged), shape
    (tests, 2) each; exchanged, the first is what foretells the first, held against the second."""
    others = gram.sum(axis=0) - gram + RIDGE * np.eye(gram.shape[-1])
    gains = np.linalg.solve(others, cross.sum(axis=0) - cross)
    power = np.einsum("tki,tkl,tli->ti", gains, gram, gains)
    along = np.einsum("tki,tkj->tij", gains, cross)  # i foretells, j is measured
    own = energy - 2 * np.einsum("tii->ti", along) + power
    other = energy[:, ::-1] - 2 * along[:, [0, 1], [1, 0]] + power
    return np.maximum(own, 0.0), np.maximum(other, 0.0)
