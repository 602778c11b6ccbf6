"""Steps of the residual that a command makes: speed, feed, power, a switch. Decided by what it does elsewhere.

A centrifugal shift looks like a slip of the probe, but it comes with every change of the speed. A pump that cycles is
never far from a slip, but its other changes make no step. So a change explains a step only where the other changes of
the same channel, at the same distance in time, foretell it: by a straight line through zero, jump of the residual over
change of the command, or of its square (centrifugal force), or over how far it changes, whichever way (what speeds up
heats as much as what slows down). So does a temperature, where a body is changed for another. And so does an axis
that goes from one place to another: its screw grows by where it stands times how warm it is.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.steps.sudden import BESIDE, HOLE_STEPS, over_three, suddenly
from thermodata.effect.places import holds
from thermodata.modelling.inputs.drivers import start_value
from thermodata.plugin import Bool1D, Float1D, Int1D
from thermodata.schema.places import is_around
from thermodata.view.dataset import ChannelInfo

_T = TypeVar("_T")

COMMANDS = ("rotational_speed", "feed", "power", "state", "load", "flow")
# a temperature jumps where one body takes the place of another: a workpiece, a pallet, a tool
JUMPING = (*COMMANDS, "temperature")
POSITION = "position"
POWERS = (1, 2)
EITHER_WAY = 0  # no power: how far it changes, up or down
WARM = -1  # nor that: how far an axis moves, times how warm it is
COMMAND_S = 600.0  # between a change and its step, for clocks differ
MOVED = 0.1  # share of a command's range over all tests, in the power by which it acts, that makes it a change
# and of a temperature, too, what is so many times its usual sudden change and so large: a gate opens on air that a day
# warms by ten times as much
SUDDEN, LEAST_K = 4.0, 0.5
ELSEWHERE_S = 1200.0  # nearer to the step, a change sees the step itself
FORETOLD = 0.2  # least share of the step that the others foretell, and of what they foretell that it is
ALIKE = 0.15  # least share of the others' squared jumps that goes with the command
LEAST_MM = 1.0  # less moves no screw that is 30 K warm by LEAST_UM
STANDS_S = 300.0  # before and after a move, or it is none from one place to another
AS_WARM = 0.5  # of how far an axis moves times how warm it is, by which another move tells of it at least


@dataclass(frozen=True, slots=True)
class _Course:
    """A command in one block. change: way -> shape (m,), over three intervals; rows: way, in the order of asking ->
    where that is a change of its own. hole: shape (m,), whether the interval before a sample is one in which nobody
    logged the command."""

    change: Mapping[int, Float1D]
    rows: Mapping[int, Int1D]
    hole: Bool1D


@dataclass(frozen=True, slots=True)
class _Command:
    """told: whether the machine is told so. courses: a block each, None where it lacks the command."""

    name: str
    told: bool
    courses: Sequence[_Course | None]


def is_command(channel: ChannelInfo) -> bool:
    """Whether the machine is told to do something by it: who opens the door of the hall tells the machine nothing."""
    return channel.quantity in COMMANDS and not is_around(channel.at)


class Commands:
    """The commands of a problem, and what the residual does where they change."""

    def __init__(self, problem: Problem) -> None:
        self._step_s = problem.step_s
        self._jumps = [over_three(b.residual, b.t_s) for b in problem.blocks]
        self._moves = [over_three(b.response, b.t_s) for b in problem.blocks]
        found = {n: c for b in problem.blocks for n, c in b.test.channels.items()}
        self._commands: list[_Command] = []
        self._changes: dict[tuple[int, int, int, int], tuple[Float1D, Float1D, Int1D, Int1D]] = {}
        for name, quantity in sorted((n, c.quantity) for n, c in found.items()):
            if quantity in JUMPING:
                told = quantity in COMMANDS
                self._commands.append(_Command(name, told, _courses(problem.blocks, name, told=told)))
            elif quantity == POSITION:
                self._commands += [_Command(name, True, m) for m in _moves(problem.blocks, name, _warmth(name, found))]

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
                x, y = self._elsewhere(command.courses, self._jumps, -1, 0, 0, way)
                if len(x):
                    slope, alike = through_zero(x, y)
                    most = max(most, abs(slope) * float(np.abs(x).max()) if alike >= ALIKE else 0.0)
        return most

    def _explains(self, command: Sequence[_Course | None], block: int, i: int) -> bool:
        own, jump = command[block], float(self._jumps[block][i])
        if own is None or not np.isfinite(jump):
            return False
        for way, rows in own.rows.items():
            near = rows[np.abs(rows - i) <= int(COMMAND_S / self._step_s) + 1]
            for row in near.tolist():
                x, y = self._elsewhere(command, self._jumps, block, i, i - row, way)
                change = float(own.change[way][row])
                # moves of a cold axis say nothing of a warm one's
                if way == WARM and not np.any(np.abs(x) >= AS_WARM * abs(change)):
                    x, y = np.empty(0), np.empty(0)
                if tells(jump, change, x, y, at_once=abs(i - row) <= 1):
                    return True
        # what a command did while nobody logged it, neither the model knows nor we: at most its largest change; what
        # it does whichever way it goes cannot stay, or the machine would walk off
        return bool(own.hole[i]) and any(self._might(command, block, i, power) for power in POWERS)

    def _might(self, command: Sequence[_Course | None], block: int, i: int, power: int) -> bool:
        x, y = self._elsewhere(command, self._moves, block, i, 0, power)
        if not len(x):
            return False
        slope, alike = through_zero(x, y)
        most = abs(slope) * float(np.abs(x).max())
        return alike >= ALIKE and most >= FORETOLD * abs(float(self._jumps[block][i]))

    def _elsewhere(
        self, command: Sequence[_Course | None], jumps: Sequence[Float1D], block: int, i: int, lag: int, way: int
    ) -> tuple[Float1D, Float1D]:
        """Changes of the command elsewhere, and the jumps so many samples after each: shape (k,) both."""
        key = id(command), id(jumps), lag, way
        if key not in self._changes:
            self._changes[key] = _everywhere(command, jumps, lag, way)
        x, y, where, at = self._changes[key]
        near = (where == block) & (np.abs(at - i) <= int(ELSEWHERE_S / self._step_s))
        return x[~near], y[~near]


def commands_of(problem: Problem) -> Commands:
    """Kept with the problem."""
    kept = problem.kept.setdefault("commands", {})
    if "found" not in kept:
        kept["found"] = Commands(problem)
    found: Commands = kept["found"]
    return found


def _everywhere(
    command: Sequence[_Course | None], jumps: Sequence[Float1D], lag: int, way: int
) -> tuple[Float1D, Float1D, Int1D, Int1D]:
    """All changes of a command, the jumps so many samples after each, and in which block and before which of its
    samples these are: shape (k,) each."""
    x, y, where, at = [np.empty(0)], [np.empty(0)], [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for k, course in enumerate(command):
        if course is None:
            continue
        after = course.rows[way] + lag
        after = after[(after >= 0) & (after < len(jumps[k]))]
        after = after[np.isfinite(jumps[k][after])]
        x.append(course.change[way][after - lag])
        y.append(jumps[k][after])
        where.append(np.full(len(after), k))
        at.append(after)
    return np.concatenate(x), np.concatenate(y), np.concatenate(where), np.concatenate(at)


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


def _courses(blocks: Sequence[Block], name: str, *, told: bool) -> list[_Course | None]:
    """Of one command, None for each block that lacks it. told: whether the machine is told so. All heat moves a
    temperature: it changes where that is sudden, and does nothing while nobody logs it."""
    held = [_kept(_held, b, name) for b in blocks]
    values = [v for v, _ in held if len(v)]
    every = np.concatenate(values) if values else np.zeros(1)
    # the power by which a command acts decides what is a change: of the square, a fast spindle's is the larger
    least = tuple(MOVED * float(np.ptp(every**p)) for p in POWERS)
    logged = [b if len(own) else None for b, (own, _) in zip(blocks, held, strict=True)]
    if told:
        return [None if b is None else _kept(_of_command, b, name, least) for b in logged]
    # a motor that cools once its axis rests is no other body
    sudden = [_kept(_sudden, b, name) for b in logged if b is not None]
    usual = float(np.sqrt(np.mean(np.concatenate([*sudden, np.zeros(1)]) ** 2)))
    enough = min(least[0], max(SUDDEN * usual, LEAST_K))
    return [None if b is None else _kept(_of_temperature, b, name, enough) for b in logged]


def _warmth(position: str, channels: Mapping[str, ChannelInfo]) -> list[str]:
    """The temperatures of an axis, by the channel of its position."""
    at = channels[position].at
    return sorted(n for n, c in channels.items() if at and c.quantity == "temperature" and holds(at, c.at))


def _moves(blocks: Sequence[Block], name: str, warmth: Sequence[str]) -> list[list[_Course | None]]:
    """Of the position of an axis: what it does by how far it moves, and by that times how warm it is, by each of its
    temperatures; None for each block that lacks one."""
    places = [_held(b, name)[0] for b in blocks]
    span = float(np.ptp(np.concatenate(places))) if any(map(len, places)) else 0.0
    least = max(MOVED * span, LEAST_MM)
    found: list[list[_Course | None]] = [[] for _ in range(1 + len(warmth))]
    for block, place in zip(blocks, places, strict=True):
        far, unknown = over_three(place, block.t_s), np.zeros(len(place), dtype=np.bool_)
        rows = _from_place_to_place(place, far, least, max(1, int(STANDS_S / _step_s(block.t_s))))
        found[0].append(_Course({1: far}, {1: rows}, unknown) if len(place) else None)
        for own, temperature in zip(found[1:], warmth, strict=True):
            rise = _rise(block, temperature)
            both = len(place) and len(rise)
            own.append(_Course({WARM: far * rise}, {WARM: rows}, unknown) if both else None)
    return found


def _from_place_to_place(place: Float1D, far: Float1D, least: float, many: int) -> Int1D:
    """Rows of `far` in which it moves so far, and stands in the many samples before and after: where it goes to and
    fro all the time nothing begins."""
    found = np.flatnonzero(np.abs(np.nan_to_num(far)) > least)
    sides = ((place[max(0, i - 1 - many) : i - 1], place[i + 1 : i + 1 + many]) for i in found.tolist())
    return found[np.array([all(np.ptp(side) <= least for side in both) for both in sides], dtype=np.bool_)]


def _rise(block: Block, name: str) -> Float1D:
    """How much warmer than at the start of its test, at each sample, shape (m,); empty where nothing is logged."""
    value, _ = _held(block, name)
    if not len(value):
        return value
    logged = np.asarray(block.test.values[name], dtype=np.float64)
    return value - start_value(logged[np.isfinite(logged)], _step_s(block.test.t_s))


def _step_s(t_s: Float1D) -> float:
    return float(np.median(np.diff(t_s)))


def _kept(make: Callable[..., _T], block: Block, *what: Hashable) -> _T:
    """What is made of a test at the samples of a block, which is the same in each problem that has these."""
    key = make.__name__, block.t_s.tobytes(), what
    if key not in block.test.kept:
        block.test.kept[key] = make(block, *what)
    found: _T = block.test.kept[key]
    return found


def _held(block: Block, name: str) -> tuple[Float1D, Bool1D]:
    """(last logged value, whether that is old) at each sample, shape (m,); empty where nothing is logged."""
    test = block.test
    known = np.flatnonzero(np.isfinite(test.values[name])) if name in test.values else np.empty(0, np.int64)
    if not len(known):
        return np.empty(0), np.empty(0, dtype=np.bool_)
    last = known[np.clip(np.searchsorted(test.t_s[known], block.t_s, side="right") - 1, 0, None)]
    step = float(np.median(np.diff(test.t_s)))
    return np.asarray(test.values[name][last]), np.abs(block.t_s - test.t_s[last]) > HOLE_STEPS * step


def _of_command(block: Block, name: str, least: tuple[float, ...]) -> _Course:
    """least: what makes it a change, by `POWERS`."""
    value, old = _kept(_held, block, name)
    change = {p: over_three(value**p, block.t_s) for p in POWERS}
    rows = {p: np.flatnonzero(np.abs(np.nan_to_num(change[p])) > own) for p, own in zip(POWERS, least, strict=True)}
    # a hole begins after the last logged sample and ends before the next one
    hole = old.copy()
    hole[1:] |= old[:-1]
    hole[:-1] |= old[1:]
    return _Course({**change, EITHER_WAY: np.abs(change[1])}, {**rows, EITHER_WAY: rows[1]}, hole)


def _sudden(block: Block, name: str) -> Float1D:
    """What a temperature changes by beyond the slopes beside it, shape (m,)."""
    return suddenly(_kept(_held, block, name)[0], block.t_s, BESIDE + 2)


def _of_temperature(block: Block, name: str, least: float) -> _Course:
    """A body expands by its temperature, not by the square, and one way."""
    value, _ = _kept(_held, block, name)
    nowhere = np.zeros(len(value), dtype=np.bool_)
    return _Course({1: over_three(value, block.t_s)}, {1: np.flatnonzero(_kept(_sudden, block, name) > least)}, nowhere)
