"""A heat balance of what one source's temperatures do with another's commands, moved in time.

Over ten minutes a temperature rises by what works, less what it is warm already. How much of its rises the commands
foretell, in tests left out, is asked of each shift of the commands. What goes with the air around is taken out of
both before: a hall that warms in the morning is no drive that worked an hour ago.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.clocks.heat_sums import EVERY_S, channels_evened, commands_held, shifts_asked, sums_of_balance
from thermodata.diagnosis.question.known import FloatND
from thermodata.plugin import Bool1D, Float1D, Float2D
from thermodata.view.grid.dataset import TestData

OVER_S = 600.0  # that a temperature rises over
RIDGE = 0.02  # of a column's squares
TELLS = 0.2  # share of the squared rises of a temperature that is foretold at its best shift, else it says nothing,
LEAST_SHARE = 0.3  # and of all that tell, on average
LEAST_TELLING = 2  # temperatures: one alone may follow what nobody logged,
MOST_TELL = 0.25  # and of those that the commands foretell in the other tests so many: a clock moves all of a log alike
BEATS = 4.0  # times what is foretold unmoved
# of what a test's own gains leave unmoved, where its log is off: what the others say of a drive that hardly worked in
# them is wrong at any shift
MOST_OWN = 0.5
UNMOVED_S = 240.0  # a body warms so much later than its drive, or is logged so much apart
LEAST_S = 600.0  # quick bodies are late by up to 4 min, others by more
LEAST_TESTS = 3


@dataclass(frozen=True, slots=True)
class Disagreement:
    """warmed: the source of the temperatures. by: that of the commands. shift_s: by which commands, moved later,
    foretell most. share: of the squared rises, mean of the temperatures that tell; unmoved: the most near no shift.
    telling: how many temperatures tell. campaign, test: the one that is asked of; '' for all of them. own: of one test,
    what is left with the gains of its own at the shift, in shares of what they leave unmoved. rest: share that would be
    foretold there if no command worked, by what is warm already. tell: share of those that tell in the other tests
    which tell here, too."""

    warmed: str
    by: str
    shift_s: float
    share: float
    unmoved: float
    telling: int
    campaign: str = ""
    test: str = ""
    own: float = 0.0
    rest: float = 0.0
    tell: float = 1.0

    @property
    def key(self) -> tuple[str, str]:
        """Campaign and test."""
        return self.campaign, self.test

    @property
    def plain(self) -> bool:
        """Whether it is so plain that a clock may be moved for it."""
        if self.share - self.rest < TELLS:
            return False  # a test in which the machine waits: what cools foretells itself
        much = self.share >= max(LEAST_SHARE, BEATS * self.unmoved) and self.own <= MOST_OWN
        return much and self.telling >= LEAST_TELLING and self.tell >= MOST_TELL and abs(self.shift_s) >= LEAST_S


def pair_of(
    tests: Sequence[TestData],
    names: Sequence[str],
    drives: Sequence[str],
    step_s: float,
    *,
    warmed: str,
    by: str,
    air: Sequence[str] = (),
) -> Pair | None:
    """names: of the temperatures, or of what else heat moves; drives: of the commands. step_s: of the tests' common
    grid. air: temperatures of what is around the machine, on the clock of `names`. None where there is too little to
    tell."""
    if step_s > UNMOVED_S:
        return None  # one sample is as much as bodies are late by
    every = max(1, round(EVERY_S / step_s))
    over = max(1, round(OVER_S / (every * step_s)))
    long = [t for t in tests if len(t.t_s) // every > 2 * over]
    if len(long) < LEAST_TESTS:
        return None
    parts = [
        (commands_held(t, drives, every), channels_evened(t, names, every), channels_evened(t, air, every))
        for t in long
    ]
    shifts = shifts_asked(every * step_s)
    return Pair(
        warmed,
        by,
        tuple(long),
        np.asarray(shifts * (every * step_s), dtype=np.float64),
        *sums_of_balance(parts, shifts, over),
    )


@dataclass(frozen=True, slots=True)
class Pair:
    """A source of temperatures and one of commands: what the heat balance sums in each test. shifts_s: shape (s,).
    gram: shape (tests, channels, s, k, k). cross: shape (tests, channels, s, k). energy: of the rises, shape (tests,
    channels, s)."""

    warmed: str
    by: str
    tests: tuple[TestData, ...]
    shifts_s: Float1D
    gram: FloatND
    cross: FloatND
    energy: FloatND

    def of(self, tests: Sequence[TestData]) -> Pair | None:
        """The same of some of its tests; None where they are too few."""
        keys = {t.key for t in tests}
        asked = [i for i, t in enumerate(self.tests) if t.key in keys]
        if len(asked) < LEAST_TESTS:
            return None
        own = tuple(self.tests[i] for i in asked)
        return replace(self, tests=own, gram=self.gram[asked], cross=self.cross[asked], energy=self.energy[asked])

    def in_all(self) -> Disagreement | None:
        """In tests left out. None where nothing tells."""
        shares = self._shares_foretold()
        return self._disagreement(shares, shares.max(axis=1) >= TELLS)

    def in_one(self, i: int) -> Disagreement | None:
        """In one test, with commands that act as they do in the others unmoved. None where nothing tells."""
        shares, usual = self._shares_foretold(i), self._told_elsewhere(i) >= TELLS
        # what the commands foretell in no other test goes with them by chance here: a hall, at some shift of two hours
        telling = (shares.max(axis=1) >= TELLS) & usual
        found = self._disagreement(shares, telling)
        if found is None:
            return None
        left, at = 1 - self.by_its_own(i)[telling].mean(axis=0), self.shifts_s == found.shift_s
        rest = float(self._at_rest(i)[telling][:, at].mean())
        own = left[self._shifts_near(found.shift_s)].min() / max(float(left[self._shifts_near(0.0)].min()), 1e-300)
        tell = float(telling[usual].mean())
        return replace(
            found, campaign=self.tests[i].campaign, test=self.tests[i].test, own=float(own), rest=rest, tell=tell
        )

    def foretold(self, campaign: str, test: str, about_s: Sequence[float]) -> list[float]:
        """The largest share that is foretold near each of some shifts, mean of the channels; test '': in all of them.
        Zeros where a test is not among these."""
        i = next((i for i, t in enumerate(self.tests) if t.key == (campaign, test)), None)
        if test and i is None:
            return [0.0] * len(about_s)
        mean = self._shares_foretold(i).mean(axis=0)
        return [float(mean[self._shifts_near(at_s)].max()) for at_s in about_s]

    def told(self, i: int, gains: FloatND) -> Float2D:
        """Of a test's squared rises, what gains, shape (channels, 1 or s, k), foretell: shape (channels, s)."""
        return _share_foretold(self._squares_left([i], gains), self.energy[i])

    def _shifts_near(self, shift_s: float) -> Bool1D:
        return np.asarray(np.abs(self.shifts_s - shift_s) <= UNMOVED_S)

    def _shares_foretold(self, i: int | None = None) -> Float2D:
        """Of the squared rises, foretold: shape (channels, s). i: the test that is asked of, by the others unmoved."""
        if i is not None:
            return _share_foretold(
                self._squares_left([i], self._gains_unmoved(_all_but(self.tests, i))), self.energy[i]
            )
        left = sum(self._squares_left([t], self._gains(_all_but(self.tests, t))) for t in range(len(self.tests)))
        return _share_foretold(np.asarray(left), self.energy.sum(axis=0))

    def _told_elsewhere(self, i: int) -> Float1D:
        """The share that is foretold in all tests but one, unmoved, by their own gains: shape (channels,)."""
        others = _all_but(self.tests, i)
        shares = _share_foretold(
            self._squares_left(others, self._gains_unmoved(others)), self.energy[others].sum(axis=0)
        )
        return shares[:, self.shifts_s == 0][:, 0]

    def _at_rest(self, i: int) -> Float2D:
        """The same of a test as if no command worked in it."""
        gains = self._gains_unmoved(_all_but(self.tests, i))
        return _share_foretold(
            self._squares_left([i], gains * (np.arange(gains.shape[-1]) == gains.shape[-1] - 1)), self.energy[i]
        )

    def by_its_own(self, i: int) -> Float2D:
        """The same of a test with the gains that it gives itself, shape (channels, s)."""
        return _share_foretold(self._squares_left([i], self._gains([i])), self.energy[i])

    def _gains_unmoved(self, of: Sequence[int]) -> FloatND:
        """The gains at no shift: shape (channels, 1, k)."""
        at = self.shifts_s == 0
        return replace(self, gram=self.gram[:, :, at], cross=self.cross[:, :, at])._gains(of)

    def _gains(self, of: Sequence[int]) -> FloatND:
        """At which commands, and what is warm already, act in some tests: shape (channels, s, k)."""
        size = np.sqrt(np.einsum("tnskk->nsk", self.gram))
        size[size == 0] = 1.0
        gram = self.gram[of].sum(axis=0) / (size[..., :, None] * size[..., None, :])
        held = RIDGE * np.eye(size.shape[-1])
        return np.asarray(np.linalg.solve(gram + held, (self.cross[of].sum(axis=0) / size)[..., None])[..., 0] / size)

    def _squares_left(self, of: Sequence[int], gains: FloatND) -> Float2D:
        """Squared rises of some tests, less what gains foretell of them, shape (channels, s)."""
        energy, cross, gram = (each[of].sum(axis=0) for each in (self.energy, self.cross, self.gram))
        gains = np.broadcast_to(gains, cross.shape)
        along = np.einsum("nsk,nsk->ns", gains, cross)
        said = np.einsum("nsj,nsjk,nsk->ns", gains, gram, gains)
        return np.asarray(energy - 2 * along + said)

    def _disagreement(self, shares: Float2D, tell: Bool1D) -> Disagreement | None:
        """tell: which channels say something, shape (channels,)."""
        telling = shares[tell]
        if not len(telling):
            return None
        mean = telling.mean(axis=0)
        best = int(np.argmax(mean))
        unmoved = float(mean[self._shifts_near(0.0)].max())
        return Disagreement(self.warmed, self.by, float(self.shifts_s[best]), float(mean[best]), unmoved, len(telling))


def _share_foretold(left: Float2D, energy: Float2D) -> Float2D:
    return np.where(energy > 0, 1 - left / np.maximum(energy, 1e-300), 0.0)


def _all_but(tests: Sequence[TestData], i: int) -> list[int]:
    return [t for t in range(len(tests)) if t != i]
