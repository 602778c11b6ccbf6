"""When a source's commands act, by what the displacement does at once: whether its clock is early or late, in all tests
or in one.

What is slow cannot tell: heat that lags looks like a clock that is off. What a command moves between two samples can,
whether the model has it or not, so the displacement itself is asked, in its jumps beyond the slopes around them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.clocks.timings import ABOUT_S, HOURS, MOST_S, Timing, Timings, clock_is_off
from thermodata.diagnosis.question.known import FloatND
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.steps.changes import POWERS
from thermodata.diagnosis.steps.commanded import is_command
from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D
from thermodata.view.grid.dataset import ChannelInfo, TestData

MOST_SAMPLES = 60  # and no more than these;
RIM = 2.0  # asked for so many times as far: what is best beyond is no whole hour
AROUND = 5  # samples on either side of a jump that its slope is taken over
LEAST_LEFT = 0.45  # of what is foretold of a test, where commands are moved by a shift: less of it is another test
RIDGE = 0.1  # of a column's squares: what hardly changes in the other tests must not foretell a large jump


def timings(problem: Problem, channels: Mapping[str, ChannelInfo]) -> Timings:
    """Of each source beside the response's own that logged commands; kept with the problem."""
    kept = problem.kept.setdefault("timings", {})
    if "found" not in kept:
        kept["found"] = _timings(problem, channels)
    found: Timings = kept["found"]
    return found


def _timings(problem: Problem, channels: Mapping[str, ChannelInfo]) -> Timings:
    home = channels[problem.response].source
    sources = sorted({c.source for c in channels.values() if c.source and c.source != home})
    in_all: list[Timing] = []
    in_one: list[Timing] = []
    for source in sources:
        sums = _sums(problem, [n for n, c in commands_of(source, channels)])
        if sums is not None and len(sums.tests) > 1:
            of_all = sums.in_all(source)
            in_all.append(of_all)
            at_s = of_all.shift_s if clock_is_off(of_all, problem.step_s) else 0.0
            in_one += [sums.in_one(source, i, at_s) for i in range(len(sums.tests))]
    return Timings(tuple(in_all), tuple(in_one), problem.step_s)


def commands_of(source: str, channels: Mapping[str, ChannelInfo]) -> list[tuple[str, ChannelInfo]]:
    """The commands of a source, by name, in order."""
    return [(n, c) for n, c in sorted(channels.items()) if c.source == source and is_command(c)]


@dataclass(frozen=True, slots=True)
class _Sums:
    """Of each test and shift, what commands do between samples beside the jumps of the displacement. tests: their keys.
    shifts_s: shape (s,). gram: shape (tests, s, k, k). cross: shape (tests, s, k). energy: of the jumps, shape
    (tests,). loudest: gram, cross and energy at each test's largest jump, and around it."""

    tests: tuple[tuple[str, str], ...]
    step_s: float
    shifts_s: Float1D
    gram: FloatND
    cross: FloatND
    energy: Float1D
    loudest: tuple[FloatND, FloatND, Float1D]

    def in_all(self, source: str) -> Timing:
        left = np.array([self._squares_left(i, self._gains_by_others(i)) for i in range(len(self.tests))])
        shares = 1 - left.sum(axis=0) / max(float(self.energy.sum()), 1e-300)
        found, none = self._timing(source, shares, 0.0), self._nearest_shift(0.0)
        best = left[:, self._nearest_shift(found.shift_s)]
        if np.sum(best < left[:, none]) > np.sum(best > left[:, none]):
            return found
        # one test that is off by much pulls at what is best for all
        return replace(found, shift_s=0.0, share=float(shares[none]))

    def in_one(self, source: str, i: int, at_s: float) -> Timing:
        """at_s: by which all the others are moved."""
        gains = self._gains_by_others(i)[self._nearest_shift(at_s)]
        campaign, test = self.tests[i]
        shares, asked = self._shares_foretold(i, gains), self._shifts_inside(i, gains, at_s)
        best = self._timing(source, np.where(asked, shares, -np.inf), at_s)
        chance = self._chance(i, gains, best.shift_s + at_s, asked)
        found = replace(best, campaign=campaign, test=test, chance=chance, all_s=at_s)
        quiet = self._without_loudest()._shares_foretold(i, gains)
        near = float(quiet[self._shifts_near(at_s)].max())
        if clock_is_off(
            replace(found, share=float(quiet[self._nearest_shift(found.shift_s + at_s)]), unmoved=near), self.step_s
        ):
            return found
        # a probe that slips once is met by some command at some shift
        return replace(found, shift_s=0.0, share=float(shares[self._nearest_shift(at_s)]))

    def _without_loudest(self) -> _Sums:
        gram, cross, energy = self.loudest
        return replace(self, gram=self.gram - gram, cross=self.cross - cross, energy=self.energy - energy)

    def _shares_foretold(self, i: int, gains: FloatND) -> Float1D:
        return np.asarray(1 - self._squares_left(i, gains) / max(float(self.energy[i]), 1e-300))

    def _nearest_shift(self, shift_s: float) -> int:
        return int(np.argmin(np.abs(self.shifts_s - shift_s)))

    def _gains_by_others(self, i: int) -> Float2D:
        """At which commands act in the other tests, at each shift, shape (s, k)."""
        whole, of_all = self.gram.sum(axis=0), self.cross.sum(axis=0)
        diagonal = np.einsum("skk->sk", whole)
        held = RIDGE * diagonal + 1e-12 * diagonal.sum(axis=1, keepdims=True) + 1e-300
        ridge = held[:, :, None] * np.eye(held.shape[1])
        return np.asarray(np.linalg.solve(whole - self.gram[i] + ridge, (of_all - self.cross[i])[..., None])[..., 0])

    def _shifts_inside(self, i: int, gains: Float1D, at_s: float) -> Bool1D:
        """Shifts that leave enough of what the commands do within the test, shape (s,): where nothing changes, nothing
        is foretold wrongly, and what little is left meets some jump."""
        power = np.einsum("j,sjk,k->s", gains, self.gram[i], gains)
        whole = max(float(power[self._shifts_near(at_s)].max()), float(np.median(power)))
        return np.asarray(self._shifts_near(at_s) | (power >= LEAST_LEFT * whole))

    def _chance(self, i: int, gains: Float1D, shift_s: float, asked: Bool1D) -> float:
        """That one of all shifts that are asked goes with a test's jumps as this one does, where none is right: so far
        out of what the correlations at the others spread by, or beyond the largest of them (docs/artefacts.md)."""
        along, power = self.cross[i] @ gains, np.einsum("j,sjk,k->s", gains, self.gram[i], gains)
        goes_with = along / np.sqrt(np.maximum(power, 1e-300))  # as a correlation, but for the energy of the jumps
        others = asked & (np.abs(self.shifts_s - shift_s) > 1.01 * AROUND * self.step_s)
        here, many = float(goes_with[self._nearest_shift(shift_s)]), int(asked.sum())
        spread = float(np.sqrt(np.mean(goes_with[others] ** 2))) if int(others.sum()) >= AROUND else 0.0
        if here <= 0 or spread <= 0:
            return 1.0
        beyond = here / float(np.abs(goes_with[others]).max()) - 1
        return min(
            1.0, many * 0.5 * math.erfc(here / spread / math.sqrt(2.0)), float(many ** (-2.0 * max(beyond, 0.0)))
        )

    def _squares_left(self, i: int, gains: FloatND) -> Float1D:
        """Squared jumps of a test at each shift, less what gains, shape (s, k) or (k,), foretell of them."""
        gains = np.broadcast_to(gains, self.cross[i].shape)
        along = np.einsum("sk,sk->s", gains, self.cross[i])
        return np.asarray(self.energy[i] - 2 * along + np.einsum("sj,sjk,sk->s", gains, self.gram[i], gains))

    def _timing(self, source: str, shares: Float1D, all_s: float) -> Timing:
        best = int(np.argmax(shares))
        unmoved = float(shares[self._shifts_near(all_s)].max())
        return Timing(source, float(self.shifts_s[best] - all_s), float(shares[best]), unmoved)

    def _shifts_near(self, shift_s: float) -> Bool1D:
        return np.asarray(np.abs(self.shifts_s - shift_s) <= 1.01 * self.step_s)


def _sums(problem: Problem, names: list[str]) -> _Sums | None:
    """None where no command ever changes."""
    most = min(int(MOST_S / problem.step_s), MOST_SAMPLES)
    held = [_powers(b.test, names) for b in problem.blocks]
    if not names or most < 1:
        return None
    size = np.sqrt(sum(np.var(h, axis=0) for h in held))
    acts = size > 0
    if not acts.any():
        return None
    tests = list(dict.fromkeys(b.test.key for b in problem.blocks))
    shifts_s = np.asarray(_shifts(most, problem.step_s) * problem.step_s, dtype=np.float64)
    many = int(acts.sum())
    gram, cross = np.zeros((len(tests), len(shifts_s), many, many)), np.zeros((len(tests), len(shifts_s), many))
    energy = np.zeros(len(tests))
    loudest = np.zeros_like(gram), np.zeros_like(cross), np.zeros_like(energy)
    most_of = _largest_jumps(problem)
    for k, (block, columns) in enumerate(zip(problem.blocks, held, strict=True)):
        i, jump = tests.index(block.test.key), beyond_trend(block.response[:, None], block.t_s, problem.step_s)[:, 0]
        used = np.isfinite(jump)
        y = jump[used]
        energy[i] += float(y @ y)
        near = np.abs(np.flatnonzero(used) - most_of.get(k, -len(jump))) <= AROUND
        loudest[2][i] += float(y[near] @ y[near])
        for s, shift_s in enumerate(shifts_s):
            logged = np.interp(block.t_s - shift_s, block.test.t_s, np.arange(len(block.test.t_s)))
            held_then = columns[np.round(logged).astype(np.int64)][:, acts] / size[acts]
            x = beyond_trend(held_then, block.t_s, problem.step_s)[used]
            gram[i, s] += x.T @ x
            cross[i, s] += x.T @ y
            loudest[0][i, s] += x[near].T @ x[near]
            loudest[1][i, s] += x[near].T @ y[near]
    return _Sums(tuple(tests), problem.step_s, shifts_s, gram, cross, energy, loudest)


def _largest_jumps(problem: Problem) -> dict[int, int]:
    """Number of a block -> its sample with the largest jump of the displacement in the whole test."""
    found: dict[tuple[str, str], tuple[float, int, int]] = {}
    for k, block in enumerate(problem.blocks):
        jump = np.abs(np.nan_to_num(beyond_trend(block.response[:, None], block.t_s, problem.step_s)[:, 0]))
        if len(jump) and (most := float(jump.max())) > found.get(block.test.key, (0.0, 0, 0))[0]:
            found[block.test.key] = most, k, int(jump.argmax())
    return {k: i for _, k, i in found.values()}


def _shifts(most: int, step_s: float) -> Int1D:
    """In samples, in order."""
    about = np.arange(-int(RIM * ABOUT_S / step_s), int(RIM * ABOUT_S / step_s) + 1)
    hours = [sign * round(h * 3600.0 / step_s) + about for h in HOURS for sign in (-1, 1)]
    return np.unique(np.concatenate([np.arange(-most, most + 1), *hours])).astype(np.int64)


def _powers(test: TestData, names: list[str]) -> Float2D:
    """Commands, and their squares, on the full grid, shape (n, 2 k): the last logged value; 0 where there is none."""
    columns = [np.zeros((len(test.t_s), 0))]
    for name in names:
        value = np.zeros(len(test.t_s))
        known = np.flatnonzero(np.isfinite(test.values[name])) if name in test.values else np.empty(0, np.int64)
        if len(known):
            last = np.searchsorted(known, np.arange(len(value)), side="right") - 1
            value = test.values[name][known[np.clip(last, 0, None)]]
        columns.append(np.column_stack([value**p for p in POWERS]))
    return np.column_stack(columns)


def beyond_trend(x: Float2D, t_s: Float1D, step_s: float) -> Float2D:
    """What x, shape (m, k), changes by over the two intervals around each sample, beyond the mean slope around it: NaN
    at ends, and where samples are further apart than step_s: in bursts of measuring, heat acts between two of them."""
    jump = np.full(x.shape, np.nan)
    if len(x) > 2 * AROUND:
        wide = t_s[2 * AROUND :] - t_s[: -2 * AROUND]
        whole = np.abs(wide - 2 * AROUND * step_s) < 0.6 * step_s
        near = x[AROUND + 1 : len(x) - AROUND + 1] - x[AROUND - 1 : len(x) - AROUND - 1]
        jump[AROUND:-AROUND] = np.where(whole[:, None], near - (x[2 * AROUND :] - x[: -2 * AROUND]) / AROUND, np.nan)
    return jump
