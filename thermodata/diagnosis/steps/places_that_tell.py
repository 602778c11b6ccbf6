"""Axes whose place shows in the displacement: their screws grow by how warm they are times where they stand.

Where it is measured all the time, that makes a step at a move from one place to another. Where the machine stops every
few minutes to be measured, the axis may stand elsewhere each time, and moves as it likes between: there each window is
held against the one before.
"""

from __future__ import annotations

import numpy as np

from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.steps.artefact import least_step, tread_of_response
from thermodata.diagnosis.steps.changes import held_value, rise, warmth
from thermodata.diagnosis.steps.commanded import ALIKE, POSITION, commands_of, through_zero
from thermodata.diagnosis.steps.windows import in_windows
from thermodata.plugin import Float1D


def places_that_tell(problem: Problem) -> list[str]:
    """The positions of axes with which the residual goes where they go from one place to another, by a least step."""
    channels = {n: c for b in problem.blocks for n, c in b.test.channels.items()}
    commands, windows = commands_of(problem), in_windows(problem)
    least = least_step(problem.noise, tread_of_response(problem))

    def tells(name: str) -> bool:
        if commands.make(name) >= least:
            return True
        return windows is not None and _between(windows, name, warmth(name, channels)) >= least

    return sorted(n for n, c in channels.items() if c.quantity == POSITION and tells(n))


def _between(windows: Problem, name: str, temperatures: list[str]) -> float:
    """The largest step from one window to the next that a line through zero foretells of how far the axis went times
    how warm it is, by one of its temperatures; 0 where the steps are on none."""
    jumps = np.concatenate([np.diff(b.residual) for b in windows.blocks])
    most = 0.0
    for temperature in temperatures:
        moves = np.concatenate([_warm_moves(b, name, temperature) for b in windows.blocks])
        known = np.isfinite(moves) & np.isfinite(jumps)
        x, y = moves[known], jumps[known]
        slope, alike = through_zero(x, y)
        most = max(most, abs(slope) * float(np.abs(x).max(initial=0.0)) if alike >= ALIKE else 0.0)
    return most


def _warm_moves(block: Block, name: str, temperature: str) -> Float1D:
    """How far the axis went from each window to the next, times how much warmer it was than at the start, shape
    (windows - 1,); NaN where that is not logged."""
    place, warm = held_value(block, name), rise(block, temperature)
    if not len(place) or not len(warm):
        return np.full(max(0, len(block.t_s) - 1), np.nan)
    return np.asarray(np.diff(place) * (warm[1:] + warm[:-1]) / 2)
