"""Where a clock is off by the same shift in some tests and right in others: from one day on, up to one, or here and
there.

Heat acts at once wherever clocks are right, so of each test two times are asked: commands as they were logged, and
moved by the shift, with the gains of the other tests, each of them at the time that suits it. What tells neither way
belongs to the tests around it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermodata.diagnosis.clocks.heat_balance import LEAST_TELLING, MOST_OWN, RIDGE, TELLS, UNMOVED_S, Pair
from thermodata.diagnosis.question.known import FloatND
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.view.grid.dataset import TestData

APART = 0.15  # of the squared rises, that one time foretells beyond the other at least, or a test tells neither
ROUNDS = 10  # each test moves to its better time: two or three suffice

Key = tuple[str, str]


@dataclass(frozen=True, slots=True)
class ShiftedPart:
    """off: tests that a shift is taken to hold in. right: those that tell that it does not. plain: whether that can be
    said. since, until: the first and the last of them, where the clock changed once."""

    off: tuple[Key, ...]
    right: tuple[Key, ...]
    plain: bool = True
    since: Key | None = None
    until: Key | None = None


def in_order(tests: Sequence[TestData]) -> list[Key]:
    """By their clocks; as they stand where one has none."""
    if any(t.start_unix_s is None for t in tests):
        return [t.key for t in tests]
    return [t.key for t in sorted(tests, key=lambda t: t.start_unix_s or 0.0)]


def part_of(order: Sequence[Key], off: Collection[Key], right: Collection[Key]) -> ShiftedPart:
    """Which tests of all, in their order, a shift holds in, if it does so in some and not in others.

    A test that tells neither goes with those before and behind it, if these agree. A clock that changes once may be
    off in any number of tests; one that is off here and there is so in fewer than half, else nobody can say which of
    the two is what it does as a rule.
    """
    told = [(i, key in off) for i, key in enumerate(order) if key in off or key in right]
    changes = sum(a[1] != b[1] for a, b in pairwise(told))
    where = np.array([i for i, _ in told])
    is_off = np.array([o for _, o in told], dtype=bool)

    def holds(i: int) -> bool:
        before, behind = is_off[where <= i], is_off[where >= i]
        return bool((not len(before) or before[-1]) and (not len(behind) or behind[0]))

    taken = tuple(key for i, key in enumerate(order) if len(told) and holds(i))
    kept = tuple(key for key in order if key in right)
    once = changes == 1
    return ShiftedPart(
        taken,
        kept,
        plain=changes <= 1 or 2 * int(is_off.sum()) < len(told),
        since=taken[0] if once and is_off[-1] else None,
        until=taken[-1] if once and is_off[0] else None,
    )


def in_words(part: ShiftedPart | None) -> str:
    """' from run06 on (run06 and run07), while in run05 they agree as they were logged'; '' for no part."""
    if part is None:
        return ""
    begins = f" from {part.since[1]} on" if part.since else f" up to {part.until[1]}" if part.until else ""
    tests = f"{begins} ({_tests_in_words(part.off)})" if begins else f" in {_tests_in_words(part.off)}"
    if not part.right:
        return tests
    doubt = "" if part.plain else ", and nothing tells which of the two is the rule"
    return f"{tests}, while in {_tests_in_words(part.right)} they agree as they were logged{doubt}"


def _tests_in_words(tests: Sequence[Key]) -> str:
    names = [test for _, test in tests]
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


@dataclass(frozen=True, slots=True)
class Sides:
    """What is foretold of each test at each shift of its commands, in shares of the squared rises: shape (tests, s);
    zeros where too few temperatures tell. keys: of the tests. shift_s: that is asked of."""

    keys: tuple[Key, ...]
    shift_s: float
    shifts_s: Float1D
    shares: Float2D

    @property
    def off(self) -> frozenset[Key]:
        """Tests of which more is foretold with the commands moved."""
        return self._tests_that_tell(self._shares_moved, self._shares_unmoved)

    @property
    def right(self) -> frozenset[Key]:
        """Tests of which more is foretold with the commands as they were logged."""
        return self._tests_that_tell(self._shares_unmoved, self._shares_moved)

    @property
    def foretold(self) -> float:
        """Sum of the shares of all tests, each where more is."""
        return float(np.maximum(self._shares_unmoved, self._shares_moved).sum())

    def of_off(self) -> tuple[float, float]:
        """Of the tests that are off: what is foretold unmoved, and moved."""
        here = self._rows(self.off)
        return float(self._shares_unmoved[here].mean()), float(self._shares_moved[here].mean())

    def apart_s(self) -> float:
        """By which [s] clocks differ from what they are in tests that are right, where bodies are as late as here."""
        return self._best_shift_s(self.off, self.shift_s) - self._best_shift_s(self.right, 0.0)

    @property
    def _shares_unmoved(self) -> Float1D:
        return np.asarray(self.shares[:, _shifts_near(self.shifts_s, 0.0)].max(axis=1))

    @property
    def _shares_moved(self) -> Float1D:
        return np.asarray(self.shares[:, _shifts_near(self.shifts_s, self.shift_s)].max(axis=1))

    def _best_shift_s(self, tests: Collection[Key], about_s: float) -> float:
        if not tests:
            return about_s
        near = _shifts_near(self.shifts_s, about_s)
        return float(self.shifts_s[near][self.shares[self._rows(tests)][:, near].mean(axis=0).argmax()])

    def _rows(self, tests: Collection[Key]) -> Bool1D:
        return np.array([key in tests for key in self.keys])

    def _tests_that_tell(self, more: Float1D, less: Float1D) -> frozenset[Key]:
        tells = (more >= TELLS) & (more - less >= APART)
        return frozenset(key for key, t in zip(self.keys, tells.tolist(), strict=True) if t)


def sides(pair: Pair, shift_s: float) -> Sides:
    """In which tests the commands are off by a shift: of two beginnings, all of them and none, the one that foretells
    most in the end."""
    ends = [_settle_sides(pair, shift_s, np.full(len(pair.tests), start)) for start in (False, True)]
    return max(ends, key=lambda e: e.foretold)


def _settle_sides(pair: Pair, shift_s: float, is_off: Bool1D) -> Sides:
    """Once each test lies where more of it is foretold."""
    none, at = (int(np.argmin(np.abs(pair.shifts_s - s))) for s in (0.0, shift_s))
    keys = tuple(t.key for t in pair.tests)
    for _ in range(ROUNDS):
        shares = [_mean_shares(pair, i, np.where(is_off, at, none), shift_s) for i in range(len(keys))]
        found = Sides(keys, shift_s, pair.shifts_s, np.array(shares))
        now = found._shares_moved > found._shares_unmoved
        if (now == is_off).all():
            break
        is_off = now
    return found


def own_shifts(pair: Pair) -> list[float]:
    """At which most is foretold of single tests by gains of their own, if that is by much; each once."""
    found: list[float] = []
    for i in range(len(pair.tests)):
        shares = pair.by_its_own(i)
        telling = shares[shares.max(axis=1) >= TELLS]
        if len(telling) >= LEAST_TELLING:
            left = 1 - telling.mean(axis=0)
            best_s = float(pair.shifts_s[left.argmin()])
            halves = float(left.min()) <= MOST_OWN * float(left[_shifts_near(pair.shifts_s, 0.0)].min())
            if halves and not any(abs(best_s - s) <= UNMOVED_S for s in found):
                found.append(best_s)
    return found


def either(pair: Pair, shift_s: float, off: Collection[Key]) -> tuple[float, float]:
    """What is foretold of tests that are off if the commands are right in them, and if they are moved: means, the gains
    from all others as if that held."""
    none, at = (int(np.argmin(np.abs(pair.shifts_s - s))) for s in (0.0, shift_s))
    is_off = np.array([t.key in off for t in pair.tests])
    if not is_off.any():
        return 0.0, 0.0
    means = []
    for about_s, lie in ((0.0, np.full(len(is_off), none)), (shift_s, np.where(is_off, at, none))):
        near = _shifts_near(pair.shifts_s, about_s)
        told = [pair.told(int(i), _gains_by_others(pair, int(i), lie)[:, None]) for i in np.flatnonzero(is_off)]
        means.append(float(np.mean([shares[:, near].max(axis=1).mean() for shares in told])))
    return means[0], means[1]


def _mean_shares(pair: Pair, i: int, lie: Int1D, shift_s: float) -> Float1D:
    """Mean share at each shift of the temperatures that tell in a test unmoved or moved; zeros where fewer than two
    do. lie: of each test, at which shift its commands are taken."""
    shares = pair.told(i, _gains_by_others(pair, i, lie)[:, None])
    asked = _shifts_near(pair.shifts_s, 0.0) | _shifts_near(pair.shifts_s, shift_s)
    tell = shares[:, asked].max(axis=1) >= TELLS
    return np.asarray(shares[tell].mean(axis=0)) if int(tell.sum()) >= LEAST_TELLING else np.zeros(len(pair.shifts_s))


def _gains_by_others(pair: Pair, i: int, lie: Int1D) -> FloatND:
    """At which commands act in all tests but one, each where it lies: shape (channels, k)."""
    others = [t for t in range(len(pair.tests)) if t != i]
    size = np.sqrt(np.einsum("tnskk->nk", pair.gram))
    size[size == 0] = 1.0
    gram = np.sum([pair.gram[t][:, lie[t]] for t in others], axis=0) / (size[:, :, None] * size[:, None, :])
    cross = np.sum([pair.cross[t][:, lie[t]] for t in others], axis=0) / size
    return np.asarray(np.linalg.solve(gram + RIDGE * np.eye(size.shape[-1]), cross[..., None])[..., 0] / size)


def _shifts_near(shifts_s: Float1D, about_s: float) -> Bool1D:
    return np.asarray(np.abs(shifts_s - about_s) <= UNMOVED_S)
