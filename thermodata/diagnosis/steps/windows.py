"""Displacements that are measured in windows, as where the machine stops every few minutes to be measured.

Between two windows there is a hole, and all that is asked from one sample to the next knows nothing there. So each
window is one sample too, and the time from one to the next the interval between samples.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.steps.sudden import HOLE_STEPS
from thermodata.plugin import Float1D, Int1D

LEAST_WINDOWS = 12  # of a test, below which there are only holes


def in_windows(problem: Problem) -> Problem | None:
    """The tests that were measured in windows, or in part, one sample each; without what the model can do, for nothing
    is fitted to it. None where no test was."""
    found = [
        (b, w) for b in problem.blocks if len(np.unique(w := _window_numbers(b.t_s, problem.step_s))) > LEAST_WINDOWS
    ]
    if not found:
        return None
    blocks = tuple(_window_means(b, w) for b, w in found)
    step_s = float(np.median(np.concatenate([np.diff(b.t_s) for b in blocks])))
    return replace(problem, blocks=blocks, step_s=step_s, kept={})


def _window_numbers(t_s: Float1D, step_s: float) -> Int1D:
    """The number of its window for each sample, shape (m,); -1 in what is measured for longer than it is not."""
    number = np.concatenate([[0], np.cumsum(np.diff(t_s) > HOLE_STEPS * step_s)]).astype(np.int64)
    first = np.flatnonzero(np.diff(number, prepend=-1))
    last = np.append(first[1:] - 1, len(t_s) - 1)
    lasts = t_s[last] - t_s[first] + step_s
    hole = np.concatenate([[0.0], t_s[first[1:]] - t_s[last[:-1]], [0.0]])
    is_window = lasts < np.maximum(hole[:-1], hole[1:])
    return np.where(is_window[number], number, -1)


def _window_means(block: Block, windows: Int1D) -> Block:
    used = windows >= 0
    _, first, window = np.unique(windows[used], return_index=True, return_inverse=True)
    samples = np.bincount(window).astype(np.float64)

    def mean(values: Float1D) -> Float1D:
        return np.bincount(window, values[used]) / samples

    none = np.empty((len(samples), 0))
    return replace(
        block,
        t_s=mean(block.t_s),
        response=mean(block.response),
        residual=mean(block.residual),
        base=none,
        slack=none,
        segment=block.segment[used][first],
    )
