"""When a source's commands act, by what the displacement does at once: whether its clock is early or late.

What is slow cannot tell: heat that lags looks like a clock that is off. What a command moves between two samples can,
whether the model has it or not, so the displacement itself is asked, in its jumps beyond the slopes around them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermodata.diagnosis.commanded import COMMANDS, POWERS
from thermodata.diagnosis.problem import Block, Problem
from thermodata.plugin import Float1D, Float2D, Int1D
from thermodata.schema.diagnosis import Artefact
from thermodata.view.dataset import ChannelInfo, Dataset, TestData

MOST_S = 1800.0  # shifts that are asked, either way,
MOST_SAMPLES = 60  # and no more than these;
HOURS, ABOUT_S = (1, 2), 300.0  # and whole hours, give or take: a time zone, or daylight saving
AROUND = 5  # samples on either side of a jump that its slope is taken over
RIDGE = 0.1  # of a column's squares: what hardly changes in the other tests must not foretell a large jump
LEAST_SHARE = 0.1  # of the squared jumps, which the other tests foretell at the best shift
BEATS = 2.0  # times what they foretell unmoved
LEAST_S = 150.0  # quick heat is late by up to 2 min where clocks are right
GIVE_OR_TAKE = 2  # samples between the shift found and the right one, at most


@dataclass(frozen=True, slots=True)
class Timing:
    """shift_s: by which a source's commands foretell most when moved later. share: of the squared jumps, foretold by
    the other tests at that shift. unmoved: the most within a sample of none."""

    source: str
    shift_s: float
    share: float
    unmoved: float

    @property
    def tells(self) -> bool:
        """Whether anything at all acts at once."""
        return self.share >= LEAST_SHARE


def timings(problem: Problem, channels: Mapping[str, ChannelInfo]) -> list[Timing]:
    """Of each source beside the response's own that logged commands."""
    if len(problem.blocks) < 2:
        return []
    home = channels[problem.response].source
    sources = sorted({c.source for c in channels.values() if c.source and c.source != home})
    found = [_timing(problem, s, [n for n, c in commands_of(s, channels)]) for s in sources]
    return [t for t in found if t is not None]


def commands_of(source: str, channels: Mapping[str, ChannelInfo]) -> list[tuple[str, ChannelInfo]]:
    return [(n, c) for n, c in sorted(channels.items()) if c.source == source and c.quantity in COMMANDS]


def clock_is_off(timing: Timing, step_s: float) -> bool:
    """step_s: between two samples, nearer than two of which nothing is known."""
    late = abs(timing.shift_s) >= max(LEAST_S, (GIVE_OR_TAKE + 0.5) * step_s)
    return late and timing.tells and timing.share >= BEATS * timing.unmoved


def with_clocks_right(data: Dataset, late: Mapping[str, float]) -> Dataset:
    """The same with all that sources logged later by so many seconds. late: source -> s."""
    shift_s = {n: late[c.source] for n, c in data.channels.items() if c.source is not None and c.source in late}
    return replace(data, tests=tuple(moved(t, shift_s) for t in data.tests)) if shift_s else data


def moved(test: TestData, shift_s: Mapping[str, float]) -> TestData:
    """The test with some channels later by shift_s; ends hold their value."""
    values = {
        name: np.interp(test.t_s - shift_s[name], test.t_s, v) if name in shift_s else v
        for name, v in test.values.items()
    }
    return replace(test, values=values)


def as_artefact(timing: Timing, problem: Problem) -> Artefact:
    minutes, known_to = timing.shift_s / 60, GIVE_OR_TAKE * problem.step_s / 60
    return Artefact(
        kind="clock_offset",
        campaign=problem.blocks[0].test.campaign,
        test="",
        at_s=None,
        size_um=None,
        why=f"with the clock of source '{timing.source}' moved by {minutes:+.0f} min (give or take {known_to:.0f}) its "
        f"commands foretell {timing.share:.0%} of the squared jumps of the displacement in tests left out, unmoved "
        f"{max(timing.unmoved, 0.0):.0%}. The choice is made with it moved; check the time zone and the "
        "clocks, or declare clock: {offset: ...}",
    )


def _timing(problem: Problem, source: str, names: list[str]) -> Timing | None:
    most = min(int(MOST_S / problem.step_s), MOST_SAMPLES)
    held = [_powers(b.test, names) for b in problem.blocks]
    if not names or most < 1:
        return None
    size = np.sqrt(sum(np.var(h, axis=0) for h in held))
    acts = size > 0
    if not acts.any():
        return None
    held = [h[:, acts] / size[acts] for h in held]
    jumps = [beyond_trend(b.response[:, None], b.t_s)[:, 0] for b in problem.blocks]
    shifts = _shifts(most, problem.step_s)
    shares = np.array([_foretold(problem.blocks, held, jumps, k * problem.step_s) for k in shifts])
    best = int(np.argmax(shares))
    unmoved = float(shares[np.abs(shifts) <= 1].max())
    return Timing(source, float(shifts[best] * problem.step_s), float(shares[best]), unmoved)


def _shifts(most: int, step_s: float) -> Int1D:
    """In samples, in order."""
    about = np.arange(-int(ABOUT_S / step_s), int(ABOUT_S / step_s) + 1)
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


def _foretold(blocks: tuple[Block, ...], held: list[Float2D], jumps: list[Float1D], shift_s: float) -> float:
    """Share of the squared jumps of each test that commands, later by shift_s, foretell as they act in the others."""
    gram, cross, energy = [], [], []
    for b, columns, jump in zip(blocks, held, jumps, strict=True):
        row = np.round(np.interp(b.t_s - shift_s, b.test.t_s, np.arange(len(b.test.t_s)))).astype(np.int64)
        x = beyond_trend(columns[row], b.t_s)
        used = np.isfinite(jump)
        x, y = x[used], jump[used]
        gram.append(x.T @ x)
        cross.append(x.T @ y)
        energy.append(float(y @ y))
    whole, of_all = np.sum(gram, axis=0), np.sum(cross, axis=0)
    diagonal = np.diag(whole)
    ridge = np.diag(RIDGE * diagonal + 1e-12 * diagonal.sum() + 1e-300)
    left = 0.0
    for g, c, e in zip(gram, cross, energy, strict=True):
        gains = np.linalg.solve(whole - g + ridge, of_all - c)
        left += e - 2 * float(gains @ c) + float(gains @ g @ gains)
    return 1 - left / max(sum(energy), 1e-300)


def beyond_trend(x: Float2D, t_s: Float1D) -> Float2D:
    """What x, shape (m, k), changes by over the two intervals around each sample, beyond the mean slope around it: NaN
    at ends and where a hole is."""
    jump = np.full(x.shape, np.nan)
    if len(x) > 2 * AROUND:
        wide = t_s[2 * AROUND :] - t_s[: -2 * AROUND]
        whole = np.abs(wide - 2 * AROUND * np.median(np.diff(t_s))) < 0.6 * np.median(np.diff(t_s))
        near = x[AROUND + 1 : len(x) - AROUND + 1] - x[AROUND - 1 : len(x) - AROUND - 1]
        jump[AROUND:-AROUND] = np.where(whole[:, None], near - (x[2 * AROUND :] - x[: -2 * AROUND]) / AROUND, np.nan)
    return jump
