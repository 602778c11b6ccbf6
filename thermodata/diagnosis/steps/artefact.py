"""Artefacts of the measurement, looked for within a test: steps of a probe, and drift.

They do not transfer between tests, so leave-one-test-out cannot see them. A step that a command makes elsewhere too
(speed, feed, a switch) is no artefact: centrifugal shifts look like steps. Nor is one tread of a coarse reading, nor a
bend where heat begins or ends, nor what comes back, nor what only the model does.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from thermodata.calibration.tread import tread_of
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.steps.commanded import commands_of
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.steps.sudden import (
    beyond_slopes,
    comes_back,
    is_quick,
    most_sudden,
    over_three,
    size_of_step,
    smooth_but_for,
    suddenly,
    time_of_step,
)
from thermodata.diagnosis.steps.who_made import BODY, which
from thermodata.diagnosis.steps.windows import in_windows
from thermodata.plugin import Float1D
from thermodata.schema.answers.diagnosis import Artefact

SIDE_S = 1200.0
Z_LIMIT = 12.0
Z_ALONE = 5.0  # where it is so many times as sudden as all else in its test
ALONE = 2.0
MOST_ALONE = 10.0  # so many times and more, which nothing is to be told of
STAYS = 0.5  # of what such a one does at once, by which the levels differ at least
MOST_STEPS = 3
NOISES = 3.0  # a step is larger than this many times the noise,
LEAST_UM = 0.5  # and than this
SHARP = 0.4  # least share of a step that happens between two samples: halves where a mean parts it
WITHIN = 0.7  # and within three intervals, beyond what the steeper of the slopes beside it makes
SEEN = 0.3  # the same of the response, and its inverse at most: a model jumps, too, where its drivers do
# loads, powers and flows go with them
NOTHING_ELSEWHERE = "no speed, feed, position or switch does that elsewhere"


@dataclass(frozen=True, slots=True)
class BlockCommands:
    """The commands of one block. explain: whether one makes the step before a sample; change_at: which change there."""

    explain: Callable[[int], bool]
    change_at: Callable[[int], tuple[str, ...]]


def find_steps(problem: Problem) -> list[Step]:
    """Sudden offsets in the residual that no command explains, at most three a test. From window to window, too,
    where a test was measured in windows.

    The jump between neighbouring samples must exceed Z_LIMIT times the robust size of all jumps over the same
    span, and lines over SIDE_S before and after must lie as far apart; nor may it come back in that time. Where much is
    missing in the model, lines differ everywhere; then Z_ALONE suffices, if nothing else in the test is half as sudden.
    It must stand out from the slopes right beside it, and the response itself must make it.
    """
    steps = _steps(problem, tread_of_response(problem))
    windows = in_windows(problem)
    if windows is not None:
        known = {(s.test.key, s.at_s) for s in steps}
        for step in _steps(windows, tread_of_response(problem), through=False):
            if not any(step.test.key == key and abs(step.at_s - at) <= 2 * windows.step_s for key, at in known):
                steps.append(step)
    return sorted(steps, key=lambda s: -s.z)


def _steps(problem: Problem, tread: float, *, through: bool = True) -> list[Step]:
    """through: whether it was measured all the time, so that what nothing else is as sudden as stands out."""
    commands, steps = commands_of(problem), []
    for k, block in enumerate(problem.blocks):
        own = BlockCommands(partial(commands.explain, k), partial(commands.change_at, k))
        steps += _steps_in(block, problem, tread, own, through)
    return steps


def tread_of_response(problem: Problem) -> float:
    """Distance of the values that the response can read, in its unit; 0 where they are too fine to see."""
    name = problem.response
    tests = {b.test.key: b.test for b in problem.blocks if name in b.test.values}
    return tread_of([t.values[name][t.valid[name]] for t in tests.values()])


def noise_with_treads(problem: Problem) -> float:
    """What a reading is known to, in the response's unit: its noise, or where it stands on treads what rounding to them
    leaves, which is spread evenly over one."""
    return max(problem.noise, tread_of_response(problem) / float(np.sqrt(12)))


def _steps_in(block: Block, problem: Problem, tread: float, commands: BlockCommands, through: bool) -> list[Step]:
    r, y, t = block.residual, block.response, block.t_s
    side = max(4, int(SIDE_S / problem.step_s))
    if len(r) < 3 * side:
        return []
    steps: list[Step] = []
    looked = np.zeros(len(r), dtype=bool)
    while len(steps) < MOST_STEPS:
        score, size = _step_score(r, t, side)
        score[looked] = 0.0
        i, alone, bare = int(np.argmax(score)), 0.0, False
        if not is_a_step(float(score[i]), float(size[i]), problem.noise, tread):
            large = [is_a_step(z, s, problem.noise, tread, Z_ALONE) for z, s in zip(score, size, strict=True)]
            stays = np.abs(size) >= STAYS * suddenly(r, t, side)
            i, alone = most_sudden(r, t, np.array(large) & stays, side)
            if alone < ALONE and through:
                i, alone = _most_sudden_uncommanded(r, t, side, commands, least_step(problem.noise, tread))
                bare = True
            if alone < ALONE or not through or (bare and looked[i]):
                break
        # what happens there is judged where it stands out most: the shoulders of a bend are no slips
        looked[max(0, i - side // 2) : i + side // 2] = True
        by = size_of_step(r, t, i, side)
        about = by if bare else float(size[i])
        own, seen = (beyond_slopes(x, t, i, about, side) for x in (r, y))
        if not is_at_once(about, own, seen) or comes_back(r, t, i, side) or commands.explain(i):
            continue
        if bare and not smooth_but_for(r, t, i, by, side, Z_LIMIT):
            continue
        beside = commands.change_at(i)
        # what begins as a command changes and goes on for some minutes is its doing, whatever it does elsewhere: what
        # it cools may have been cold there. A reading that a logger smooths is slow as well, and begins anywhere
        if (bare or beside) and not is_quick(r, t, i, by, side, NOISES * problem.noise):
            continue
        at, within = float((t[i - 1] + t[i]) / 2), time_of_step(r, t, i, by)
        steps.append(Step(block.test, at, by, float(score[i]), alone, within, beside, bare))
        since = np.where(np.arange(len(r)) >= i, by, 0.0)
        r, y = r - since, y - since
    return steps


def _most_sudden_uncommanded(
    r: Float1D, t: Float1D, side: int, commands: BlockCommands, least: float
) -> tuple[int, float]:
    """(sample before which r changes most suddenly of what no command explains, how many times as suddenly as of that
    anything else does, ten at most); 0 times where all that is as large as `least` is explained.

    Where a quick cause is missing each of its commands is more sudden than a slip, and lines over 20 min lie apart.
    """
    sudden = suddenly(r, t, side)
    best, most = 0, 0.0
    for i in np.argsort(-sudden).tolist():
        if sudden[i] < max(least if most == 0.0 else 0.0, most / MOST_ALONE):
            break
        if (most == 0.0 or abs(i - best) > side // 2) and not commands.explain(i):
            if most > 0.0:
                return best, most / float(sudden[i])
            best, most = i, float(sudden[i])
    return best, MOST_ALONE if most > 0.0 else 0.0


def is_a_step(z: float, size: float, noise: float, tread: float = 0.0, least: float = Z_LIMIT) -> bool:
    """z: of the usual change. size: of the step, noise: of the response, tread: of its reading, all in its unit."""
    return z >= least and abs(size) >= least_step(noise, tread)


def least_step(noise: float, tread: float) -> float:
    """A smaller one is none, however far it stands out. All in the response's unit."""
    return tread + max(NOISES * noise, LEAST_UM)


def _step_score(r: Float1D, t: Float1D, side: int) -> tuple[Float1D, Float1D]:
    """For a step before each sample: how far the extrapolations of both sides lie apart, by robust scale.

    Lines on both sides, so that a slope is not taken for a step; and means of the near thirds, so that a bend is less.
    """
    m = len(r)
    near = max(2, side // 3)
    left, right = _ends_of_lines(r, t, side)
    size = np.zeros(m)
    inner = np.arange(side, m - side + 1)
    total = np.concatenate([[0.0], np.cumsum(r)])
    by_line = right[inner] - left[inner - side]
    by_level = (total[inner + near] - 2 * total[inner] + total[inner - near]) / near
    smaller = np.where(np.abs(by_line) < np.abs(by_level), by_line, by_level)
    inner_size = np.where(by_line * by_level > 0, smaller, 0.0)
    used = inner < m
    size[inner[used]] = inner_size[used]
    # a step happens between two samples; a steep rise takes several
    jump = np.abs(np.diff(r, prepend=r[0]))
    sharp = jump > SHARP * np.abs(size)
    # over a hole the machine had time to move: what nobody saw is not called a slip
    sharp &= np.isfinite(over_three(r, t))
    scale = 1.4826 * float(np.median(np.abs(smaller - np.median(smaller)))) + 1e-9
    return np.where(sharp, np.abs(size) / scale, 0.0), size


def is_at_once(size: float, in_residual: float, in_response: float) -> bool:
    """Whether a step of a size is more than a bend and is the displacement's own, by what `beyond_slopes` has of it."""
    return in_residual >= WITHIN * abs(size) and SEEN * abs(size) <= in_response <= abs(size) / SEEN


def _ends_of_lines(r: Float1D, t: Float1D, side: int) -> tuple[Float1D, Float1D]:
    """Straight lines through each run of `side` samples: (value one sample after its end, value at its start)."""
    from numpy.lib.stride_tricks import sliding_window_view

    y, x = sliding_window_view(r, side), sliding_window_view(t, side)
    x_mean, y_mean = x.mean(axis=1), y.mean(axis=1)
    dx = x - x_mean[:, None]
    slope = np.einsum("ij,ij->i", dx, y) / np.maximum(np.einsum("ij,ij->i", dx, dx), 1e-300)
    step = np.median(np.diff(t))
    return y_mean + slope * (x[:, -1] + step - x_mean), y_mean + slope * (x[:, 0] - x_mean)


def _stands_out(step: Step) -> str:
    if step.alone:
        least = "at least " if step.bare and step.alone >= MOST_ALONE else ""
        of = " that no command makes" if step.bare else ""
        return f"{least}{step.alone:.1f} times as suddenly as anything else in this test{of}"
    return f"{step.z:.0f} times the usual change"


def _made_by(step: Step, among: Sequence[Step]) -> str:
    slipped, moved = "a probe or fixture slipped", f"a body that nobody logs moved ({BODY})"
    if not step.beside:
        return f"nothing logged goes with it, for {NOTHING_ELSEWHERE}: {slipped}, or {moved}; {which(step, among)}"
    verb, makes, it = ("change", "make", "they act") if len(step.beside) > 1 else ("changes", "makes", "it acts")
    return (
        f"{' and '.join(step.beside)} {verb} just then and {makes} no such step elsewhere: {slipped}, or {it} by what "
        f"was other there, as how warm a part is, or {moved}; {which(step, among)}"
    )


def _to_write(step: Step) -> str:
    """The line that takes it out of every fit. Its size stands in it: while an effect is missing, a step of a free time
    and size is fitted to that."""
    test, at_min = "/".join(step.test.key), step.at_s / 60
    line = f"{{effect: step, tests: [{test}], fixed: {{at: {at_min:.6g} min, gain: {step.size:.3g}}}}}"
    return (
        f"to fit without it, 'thermodata add MODEL step:{test}', or write '- {line}' under effects of "
        "model.yaml (with acts_on if it has other responses), and free its gain once nothing is missing"
    )


def as_artefacts(steps: list[Step], unit: str, among: Sequence[Step] | None = None) -> list[Artefact]:
    """How each is told. unit: of the response. among: all that were found, also those that are no artefacts of their
    own."""
    return [
        Artefact(
            kind="step",
            campaign=s.test.campaign,
            test=s.test.test,
            at_s=s.at_s,
            size_um=s.size,
            why=f"the displacement jumps by {s.size:+.1f} {unit} within {s.within_s:.0f} s, {_stands_out(s)}, "
            f"and does not decay; {_made_by(s, steps if among is None else among)}; {_to_write(s)}",
        )
        for s in steps
    ]
