"""Steps of the residual that a command makes: speed, feed, power, a switch. Decided by what it does elsewhere.

A centrifugal shift looks like a slip of the probe, but it comes with every change of the speed. A pump that cycles is
never far from a slip, but its other changes make no step. So a change explains a step only where the other changes of
the same channel, at the same distance in time, foretell it: by a straight line through zero, jump of the residual over
change of the command, or of its square (centrifugal force), or over how far it changes, whichever way (what speeds up
heats as much as what slows down). So does a temperature, where a body is changed for another. And so does an axis
that goes from one place to another: its screw grows by where it stands times how warm it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.steps.changes import POWERS, WARM, Course, courses, moves, warmth
from thermodata.diagnosis.steps.sudden import over_three
from thermodata.plugin import Float1D, Int1D
from thermodata.schema.words.places import is_around
from thermodata.view.grid.dataset import ChannelInfo

COMMANDS = ("rotational_speed", "feed", "power", "state", "load", "flow")
# a temperature jumps where one body takes the place of another: a workpiece, a pallet, a tool
JUMPING = (*COMMANDS, "temperature")
POSITION = "position"
COMMAND_S = 600.0  # between a change and its step, for clocks differ
ELSEWHERE_S = 1200.0  # nearer to the step, a change sees the step itself
FORETOLD = 0.2  # least share of the step that the others foretell, and of what they foretell that it is
ALIKE = 0.15  # least share of the others' squared jumps that goes with the command
AS_WARM = 0.5  # of how far an axis moves times how warm it is, by which another move tells of it at least


@dataclass(frozen=True, slots=True)
class _Command:
    """told: whether the machine is told so. courses: a block each, None where it lacks the command."""

    name: str
    told: bool
    courses: Sequence[Course | None]


def is_command(channel: ChannelInfo) -> bool:
    """Whether the machine is told to do something by it: who opens the door of the hall tells the machine nothing."""
    return channel.quantity in COMMANDS and not is_around(channel.at)


class Commands:
    """The commands of a problem, and what the residual does where they change."""

    def __init__(self, problem: Problem) -> None:
        self._step_s = problem.step_s
        self._jumps = np.concatenate([over_three(b.residual, b.t_s) for b in problem.blocks])
        self._moves = np.concatenate([over_three(b.response, b.t_s) for b in problem.blocks])
        self._sizes = np.array([len(b.t_s) for b in problem.blocks])
        self._starts = np.cumsum(self._sizes) - self._sizes
        found = {n: c for b in problem.blocks for n, c in b.test.channels.items()}
        self._commands: list[_Command] = []
        self._changes: dict[tuple[int, int], tuple[Float1D, Int1D, Int1D]] = {}
        self._followed: dict[tuple[int, int, int, int], tuple[Float1D, Float1D, Int1D, Int1D]] = {}
        for name, quantity in sorted((n, c.quantity) for n, c in found.items()):
            if quantity in JUMPING:
                told = quantity in COMMANDS
                self._commands.append(_Command(name, told, courses(problem.blocks, name, told=told)))
            elif quantity == POSITION:
                self._commands += [_Command(name, True, m) for m in moves(problem.blocks, name, warmth(name, found))]

    def explain(self, block: int, i: int) -> bool:
        """Whether a command makes the step before sample i of a block."""
        return any(self._explains(command.courses, block, i) for command in self._commands)

    def change_at(self, block: int, i: int) -> tuple[str, ...]:
        """The commands that change in the interval before sample i of a block, or in one beside it, whatever they do
        elsewhere."""
        changing = (
            command.name
            for command in self._commands
            if command.told
            and (own := command.courses[block]) is not None
            and any(i - 1 in r or i in r or i + 1 in r for r in own.rows.values())
        )
        return tuple(dict.fromkeys(changing))

    def make(self, name: str) -> float:
        """The largest step that a line through zero foretells of the changes of a command, in any of the ways that it
        may act; 0 where its steps are on none."""
        most = 0.0
        for command in (c for c in self._commands if c.name == name):
            for way in {way for course in command.courses if course for way in course.rows}:
                x, y = self._changes_elsewhere(command.courses, self._jumps, -1, 0, 0, way)
                if len(x):
                    slope, alike = through_zero(x, y)
                    most = max(most, abs(slope) * float(np.abs(x).max()) if alike >= ALIKE else 0.0)
        return most

    def _explains(self, command: Sequence[Course | None], block: int, i: int) -> bool:
        own, jump = command[block], float(self._jumps[self._starts[block] + i])
        if own is None or not np.isfinite(jump):
            return False
        for way, rows in own.rows.items():
            near = rows[np.abs(rows - i) <= int(COMMAND_S / self._step_s) + 1]
            for row in near.tolist():
                x, y = self._changes_elsewhere(command, self._jumps, block, i, i - row, way)
                change = float(own.change[way][row])
                # moves of a cold axis say nothing of a warm one's
                if way == WARM and not np.any(np.abs(x) >= AS_WARM * abs(change)):
                    x, y = np.empty(0), np.empty(0)
                if tells(jump, change, x, y, at_once=abs(i - row) <= 1):
                    return True
        # what a command did while nobody logged it, neither the model knows nor we: at most its largest change; what
        # it does whichever way it goes cannot stay, or the machine would walk off
        return bool(own.hole[i]) and any(self._might_explain(command, block, i, power) for power in POWERS)

    def _might_explain(self, command: Sequence[Course | None], block: int, i: int, power: int) -> bool:
        x, y = self._changes_elsewhere(command, self._moves, block, i, 0, power)
        if not len(x):
            return False
        slope, alike = through_zero(x, y)
        most = abs(slope) * float(np.abs(x).max())
        return alike >= ALIKE and most >= FORETOLD * abs(float(self._jumps[self._starts[block] + i]))

    def _changes_elsewhere(
        self, command: Sequence[Course | None], jumps: Float1D, block: int, i: int, lag: int, way: int
    ) -> tuple[Float1D, Float1D]:
        """Changes of the command elsewhere, and the jumps so many samples after each: shape (k,) both."""
        key = id(command), id(jumps), lag, way
        if key not in self._followed:
            self._followed[key] = self._changes_everywhere(command, jumps, lag, way)
        x, y, where, at = self._followed[key]
        far = (where != block) | (np.abs(at - i) > int(ELSEWHERE_S / self._step_s))
        return x[far], y[far]

    def _changes_everywhere(
        self, command: Sequence[Course | None], jumps: Float1D, lag: int, way: int
    ) -> tuple[Float1D, Float1D, Int1D, Int1D]:
        """All changes of a command, the jumps so many samples after each, and in which block and before which of its
        samples these are: shape (k,) each."""
        if (id(command), way) not in self._changes:
            self._changes[id(command), way] = _changes(command, way)
        x, rows, where = self._changes[id(command), way]
        after = rows + lag
        seen = np.flatnonzero((after >= 0) & (after < self._sizes[where]))
        y = jumps[self._starts[where[seen]] + after[seen]]
        known = np.isfinite(y)
        seen = seen[known]
        return x[seen], y[known], where[seen], after[seen]


def commands_of(problem: Problem) -> Commands:
    """Kept with the problem."""
    kept = problem.kept.setdefault("commands", {})
    if "found" not in kept:
        kept["found"] = Commands(problem)
    found: Commands = kept["found"]
    return found


def _changes(command: Sequence[Course | None], way: int) -> tuple[Float1D, Int1D, Int1D]:
    """All changes of a command, before which sample, and in which block these are: shape (k,) each."""
    own = [(k, c.change[way], c.rows[way]) for k, c in enumerate(command) if c is not None]
    x = np.concatenate([np.empty(0), *(change[rows] for _, change, rows in own)])
    rows = np.concatenate([np.empty(0, np.int64), *(rows for _, _, rows in own)])
    where = [np.full(len(rows), k) for k, _, rows in own]
    return x, rows, np.concatenate([np.empty(0, np.int64), *where])


def tells(jump: float, change: float, x: Float1D, y: Float1D, *, at_once: bool) -> bool:
    """Whether a change of a command makes a jump, by its changes elsewhere, x, and the jumps there, y: shape (k,).

    Where it changes nowhere else nobody can tell a slip from its doing, unless the clock does: at_once.
    """
    if not len(x):
        return at_once
    slope, alike = through_zero(x, y)
    return alike >= ALIKE and FORETOLD <= slope * change / jump <= 1 / FORETOLD


def through_zero(x: Float1D, y: Float1D) -> tuple[float, float]:
    """(slope of the line through zero, share of the squares of y that it takes away)."""
    slope = float(x @ y) / max(float(x @ x), 1e-300)
    return slope, 1 - float(np.sum((y - slope * x) ** 2)) / max(float(y @ y), 1e-300)
