"""Where a command, a temperature or an axis changes, and by how much: what may make a step of the displacement.

A command changes by a twentieth of its range; a temperature where that is sudden, for one body takes the place of
another, or a gate opens on the air; an axis where it goes from one place to another.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from thermodata.diagnosis.question.problem import Block
from thermodata.diagnosis.steps.sudden import BESIDE, HOLE_STEPS, over_three, suddenly
from thermodata.effect.places import holds
from thermodata.modelling.inputs.drivers import start_value
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Bool1D, Float1D, Int1D
from thermodata.view.grid.dataset import ChannelInfo

_T = TypeVar("_T")

POWERS = (1, 2)
EITHER_WAY = 0  # no power: how far it changes, up or down
WARM = -1  # nor that: how far an axis moves, times how warm it is
COMMANDED = 0.05  # share of a command's range over all tests, in the power by which it acts, that makes it a change
MOVED = 0.1  # the same of a temperature and of an axis
# and of a temperature, too, what is so many times its usual sudden change and so large: a gate opens on air that a day
# warms by ten times as much
SUDDEN, LEAST_K = 4.0, 0.5
LEAST_MM = 1.0  # less moves no screw that is 30 K warm by LEAST_UM
STANDS_S = 300.0  # before and after a move, or it is none from one place to another


@dataclass(frozen=True, slots=True)
class Course:
    """A command in one block. change: way -> shape (m,), over three intervals; rows: way, in the order of asking ->
    where that is a change of its own. hole: shape (m,), whether the interval before a sample is one in which nobody
    logged the command."""

    change: Mapping[int, Float1D]
    rows: Mapping[int, Int1D]
    hole: Bool1D


def courses(blocks: Sequence[Block], name: str, *, told: bool) -> list[Course | None]:
    """Of one command, None for each block that lacks it. told: whether the machine is told so. All heat moves a
    temperature: it changes where that is sudden, and does nothing while nobody logs it."""
    held = [_kept_or_made(_value_held, b, name) for b in blocks]
    values = [v for v, _ in held if len(v)]
    every = np.concatenate(values) if values else np.zeros(1)
    # the power by which a command acts decides what is a change: of the square, a fast spindle's is the larger
    least = tuple((COMMANDED if told else MOVED) * float(np.ptp(every**p)) for p in POWERS)
    logged = [b if len(own) else None for b, (own, _) in zip(blocks, held, strict=True)]
    if told:
        return [None if b is None else _kept_or_made(_of_command, b, name, least) for b in logged]
    # a motor that cools once its axis rests is no other body
    sudden = [_kept_or_made(_suddenness, b, name) for b in logged if b is not None]
    usual = rms([*sudden, np.zeros(1)])
    enough = min(least[0], max(SUDDEN * usual, LEAST_K))
    return [None if b is None else _kept_or_made(_of_temperature, b, name, enough) for b in logged]


def warmth(position: str, channels: Mapping[str, ChannelInfo]) -> list[str]:
    """The temperatures of an axis, by the channel of its position."""
    at = channels[position].at
    return sorted(n for n, c in channels.items() if at and c.quantity == "temperature" and holds(at, c.at))


def moves(blocks: Sequence[Block], name: str, temperatures: Sequence[str]) -> list[list[Course | None]]:
    """Of the position of an axis: what it does by how far it moves, and by that times how warm it is, by each of its
    temperatures; None for each block that lacks one."""
    places = [_kept_or_made(_value_held, b, name)[0] for b in blocks]
    span = float(np.ptp(np.concatenate(places))) if any(map(len, places)) else 0.0
    least = max(MOVED * span, LEAST_MM)
    each = [_kept_or_made(_of_axis, b, name, tuple(temperatures), least) for b in blocks]
    return [list(of_blocks) for of_blocks in zip(*each, strict=True)]


def _of_axis(block: Block, name: str, temperatures: tuple[str, ...], least: float) -> list[Course | None]:
    """Of one block, by how far it moves and by each of its temperatures. least: what makes it a move [mm]."""
    place, _ = _kept_or_made(_value_held, block, name)
    far, unknown = over_three(place, block.t_s), np.zeros(len(place), dtype=np.bool_)
    rows = _from_place_to_place(place, far, least, max(1, int(STANDS_S / _step_s(block.t_s))))
    found: list[Course | None] = [Course({1: far}, {1: rows}, unknown) if len(place) else None]
    for temperature in temperatures:
        warmer = rise(block, temperature)
        both = len(place) and len(warmer)
        found.append(Course({WARM: far * warmer}, {WARM: rows}, unknown) if both else None)
    return found


def _from_place_to_place(place: Float1D, far: Float1D, least: float, many: int) -> Int1D:
    """Rows of `far` in which it moves so far, and stands in the many samples before and after: where it goes to and
    fro all the time nothing begins."""
    found = np.flatnonzero(np.abs(np.nan_to_num(far)) > least)
    sides = ((place[max(0, i - 1 - many) : i - 1], place[i + 1 : i + 1 + many]) for i in found.tolist())
    return found[np.array([all(np.ptp(side) <= least for side in both) for both in sides], dtype=np.bool_)]


def held_value(block: Block, name: str) -> Float1D:
    """The last logged value at each sample, shape (m,); empty where nothing is logged."""
    value, _ = _kept_or_made(_value_held, block, name)
    return value


def rise(block: Block, name: str) -> Float1D:
    """How much warmer than at the start of its test, at each sample, shape (m,); empty where nothing is logged."""
    value = held_value(block, name)
    if not len(value):
        return value
    logged = np.asarray(block.test.values[name], dtype=np.float64)
    return value - start_value(logged[np.isfinite(logged)], _step_s(block.test.t_s))


def _step_s(t_s: Float1D) -> float:
    return float(np.median(np.diff(t_s)))


def _kept_or_made(make: Callable[..., _T], block: Block, *what: Hashable) -> _T:
    """What is made of a test at the samples of a block, which is the same in each problem that has these."""
    key = make.__name__, block.t_s.tobytes(), what
    if key not in block.test.kept:
        block.test.kept[key] = make(block, *what)
    found: _T = block.test.kept[key]
    return found


def _value_held(block: Block, name: str) -> tuple[Float1D, Bool1D]:
    """(last logged value, whether that is old) at each sample, shape (m,); empty where nothing is logged."""
    test = block.test
    known = np.flatnonzero(np.isfinite(test.values[name])) if name in test.values else np.empty(0, np.int64)
    if not len(known):
        return np.empty(0), np.empty(0, dtype=np.bool_)
    last = known[np.clip(np.searchsorted(test.t_s[known], block.t_s, side="right") - 1, 0, None)]
    step = float(np.median(np.diff(test.t_s)))
    return np.asarray(test.values[name][last]), np.abs(block.t_s - test.t_s[last]) > HOLE_STEPS * step


def _of_command(block: Block, name: str, least: tuple[float, ...]) -> Course:
    """least: what makes it a change, by `POWERS`."""
    value, old = _kept_or_made(_value_held, block, name)
    change = {p: over_three(value**p, block.t_s) for p in POWERS}
    rows = {p: np.flatnonzero(np.abs(np.nan_to_num(change[p])) > own) for p, own in zip(POWERS, least, strict=True)}
    # a hole begins after the last logged sample and ends before the next one
    hole = old.copy()
    hole[1:] |= old[:-1]
    hole[:-1] |= old[1:]
    return Course({**change, EITHER_WAY: np.abs(change[1])}, {**rows, EITHER_WAY: rows[1]}, hole)


def _suddenness(block: Block, name: str) -> Float1D:
    """What a temperature changes by beyond the slopes beside it, shape (m,)."""
    return suddenly(_kept_or_made(_value_held, block, name)[0], block.t_s, BESIDE + 2)


def _of_temperature(block: Block, name: str, least: float) -> Course:
    """A body expands by its temperature, not by the square, and one way."""
    value, _ = _kept_or_made(_value_held, block, name)
    nowhere = np.zeros(len(value), dtype=np.bool_)
    return Course(
        {1: over_three(value, block.t_s)}, {1: np.flatnonzero(_kept_or_made(_suddenness, block, name) > least)}, nowhere
    )
