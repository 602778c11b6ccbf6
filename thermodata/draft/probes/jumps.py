"""Finds jump tests: recordings in which a displacement voltage goes up and down a staircase while all else stands.

Names help (jump, skok, Sprung, Kalibrierung, 标定), the data decide: without steps in it a recording is no jump test.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermodata.calibration.jump.plateaus import Step, find_steps
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import LONGEST_JUMP_NS, Course
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.quantity.guessed import NOTHING, Guess
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.plugin import Float1D

NAMED = (
    "^jump ^skok ^sprung ^kalib ^calib ^einmess stufe. stufen schritt. staircase cal. 标定 校准 跳变 阶跃 step. steps."
)
_LONGEST_S = LONGEST_JUMP_NS / 1e9
_MOST_STEPS, _LEAST_STEPS = 40, 2
TRAVEL_MM = 5.0  # more than that an axis travels, and no probe goes
# a jump test is as short as a logger's rate lets it be: three plateaus of so many samples
_LEAST_ROWS, _FEW_ROWS, _LEAST_ON_PLATEAU = 12, 40, 4
_ALONG = 0.4  # of the steps of the probe that moved most: what is across the axis answers by less
_APART = 0.5  # of a dwell, from the last step of one probe to the first of another that moves in turn


@dataclass(frozen=True, slots=True)
class Moved:
    """A probe that moved in steps: (stream, name), in the unit of the signal, and the usual time between them."""

    signal: tuple[str, str]
    steps: tuple[Step, ...]
    dwell_s: float

    @property
    def height(self) -> float:
        """Of the largest step."""
        return max(abs(float(s.size)) for s in self.steps)


@dataclass(frozen=True, slots=True)
class JumpTest:
    """A recording of a jump test. signal: (stream, name) of the probe that moved, None where none is seen to; steps: in
    the unit of the signal; dwell_s: the usual time between them; named: the file's name says so too. source: that reads
    it; written: what its own file calls the probe, where the tests call it otherwise. others: probes that moved nearly
    as far, as a second one along the axis does. moved_with: the probe with which it was moved along its axis,
    by the same moves."""

    file: RawFile
    signal: tuple[str, str] | None
    steps: tuple[Step, ...]
    dwell_s: float
    named: bool
    source: str = ""
    written: str | None = None
    others: tuple[Moved, ...] = ()
    moved_with: str | None = None

    def is_of(self, stream: str, name: str) -> bool:
        """Whether that is the probe that moved. Where each signal has a stream, each file may count these anew."""
        if self.signal is None or self.signal[1] != name:
            return False
        return self.signal[0] == stream or sum(s.name == name for s in self.file.signals) == 1


def jump_of(file: RawFile) -> JumpTest | None:
    """The jump test that a file holds, that of the probe that moved most where several moved in turn; or None."""
    return next(iter(jumps_in(file)), None)


def jumps_in(file: RawFile) -> list[JumpTest]:
    """The jump tests that a file holds: of the probe that moved most, and of each that moved while the others stood, as
    where the axes were moved in turn. A file whose name says jump and that shows no steps is one with signal None: a
    person must look."""
    named = holds_word(NAMED, words(file.path.stem)) or holds_word(NAMED, words(" ".join(file.path.parent.parts)))
    moved: list[Moved] = []
    probes = _probes(file, named)
    stirred = _others_move(file, probes)
    for key in probes or (_nameless(file) if named else ()):
        course = file.sample.courses.get(key)
        found = staircase(course) if course is not None else None
        if found is None or (stirred and not named):
            continue
        moved.append(Moved(key, *found))
    if moved:
        leads: list[Moved] = []
        for one in sorted(moved, key=lambda m: -m.height):
            if all(_in_turn(one, lead) for lead in leads):
                leads.append(one)
        return [_jump(file, lead, moved, named) for lead in leads]
    if named and probes and not stirred and _is_short(file):
        return [JumpTest(file, None, (), 10.0, True)]
    return []


def _jump(file: RawFile, lead: Moved, moved: Sequence[Moved], named: bool) -> JumpTest:
    along = (m for m in moved if m is not lead and not _in_turn(m, lead))
    others = tuple(m for m in along if m.height > _ALONG * lead.height)
    return JumpTest(file, lead.signal, lead.steps, lead.dwell_s, named, others=others)


def _in_turn(one: Moved, other: Moved) -> bool:
    """Whether all steps of one probe were before those of another, or behind them."""
    first, then = sorted((one.steps, other.steps), key=lambda steps: steps[0].t_s)
    return first[-1].t_s < then[0].t_s - _APART * min(one.dwell_s, other.dwell_s)


def is_length(said: Guess) -> bool:
    """Whether only its unit says that a signal is a position: a probe that logs in mm may be called 'Channel 1'."""
    return said.quantity == "position" and said.basis == ("unit",)


def _probes(file: RawFile, named: bool) -> list[tuple[str, str]]:
    """(stream, name) of what may be moved in a jump test: displacements and voltages; where there are none, and the
    file is called a jump test, lengths that no axis of the machine travels. What is called as an axis is its position
    where more than lengths is logged."""
    said = {(s.stream, s.name): guess_of(s) for s in file.signals}
    found = [key for key, g in said.items() if g.quantity in ("displacement", "voltage")]
    if found or not named:
        return found
    alone = all(map(is_length, said.values()))
    lengths = [key for key, g in said.items() if is_length(g) and (alone or axis_of(words(key[1])) is None)]
    return [key for key in lengths if (v := file.sample.values.get(key)) and v.high - v.low < TRAVEL_MM]


def is_nameless(said: Guess) -> bool:
    """Whether nothing tells what a signal is: 'S1', without a unit."""
    return said.quantity is None and (said.why_not or "").startswith(NOTHING)


def _nameless(file: RawFile) -> list[tuple[str, str]]:
    """(stream, name) of what nothing tells of: what moves in steps in a file that is called a jump test is a probe."""
    return [(s.stream, s.name) for s in file.signals if s.dtype not in ("str", "bool") and is_nameless(guess_of(s))]


def _is_short(file: RawFile) -> bool:
    """Whether it lasts no longer than a jump test: a 'step' of the spindle's speed takes a day."""
    courses = [c for c in file.sample.courses.values() if c.t_ns.size]
    return not courses or max(int(c.t_ns[-1]) - int(c.t_ns[0]) for c in courses) / 1e9 <= _LONGEST_S


def _others_move(file: RawFile, probes: Collection[tuple[str, str]]) -> bool:
    """Whether a spindle turned or an axis travelled, which a jump test does not do."""
    for signal in file.signals:
        key = (signal.stream, signal.name)
        seen = file.sample.values.get(key)
        if key in probes or seen is None:
            continue
        quantity = guess_of(signal).quantity
        if quantity == "rotational_speed" and max(abs(seen.low), abs(seen.high)) > 20:
            return True
        if quantity == "temperature" and seen.high - seen.low > 5:
            return True
        if quantity == "position" and seen.high - seen.low > TRAVEL_MM:
            return True
    return False


def staircase(course: Course) -> tuple[tuple[Step, ...], float] | None:
    """(steps, dwell [s]) where a signal stands on plateaus and little else; the dwell is searched: nobody says it."""
    fine = np.isfinite(course.values)
    t: Float1D = (course.t_ns[fine] - course.t_ns[0]) / 1e9
    x = course.values[fine]
    # of a clock that was set back, what came before
    grows = np.concatenate([[True], t[1:] > np.maximum.accumulate(t)[:-1]]) if t.size else np.zeros(0, bool)
    t, x = t[grows], x[grows]
    if t.size < _LEAST_ROWS or t[-1] > _LONGEST_S or np.ptp(x) <= 0:
        return None
    best: tuple[float, tuple[Step, ...], float] | None = None
    for share in (60, 40, 25, 15, 10, 6, 4):
        dwell = float(t[-1]) / share
        steps, noise = find_steps(t, x, dwell)
        largest = max((abs(s.size) for s in steps), default=0.0)
        steps = [s for s in steps if abs(s.size) > max(0.08 * largest, 10 * noise)]
        if not _LEAST_STEPS <= len(steps) <= _MOST_STEPS or (t.size < _FEW_ROWS and not _stood(t, steps)):
            continue
        rest = _unexplained(t, x, steps)
        if best is None or rest < 0.8 * best[0]:
            pauses = np.diff([s.t_s for s in steps])
            best = (rest, tuple(steps), float(np.median(pauses)))
    # a staircase is explained by its plateaus; a creeping probe is not, nor is one that turns with the spindle
    if best is None or best[0] > 0.03:
        return None
    return best[1], best[2]


def _stood(t: Float1D, steps: Sequence[Step]) -> bool:
    """Whether several samples lie on each plateau, so that few of them are no chance."""
    edges = np.searchsorted(t, [float(t[0]), *(s.t_s for s in steps), np.inf])
    return bool((np.diff(edges) >= _LEAST_ON_PLATEAU).all())


def _unexplained(t: Float1D, x: Float1D, steps: list[Step]) -> float:
    """The share of the signal's range that its plateaus leave: the scatter about each one's own median."""
    edges = [float(t[0]) - 1.0, *(s.t_s for s in steps), float(t[-1]) + 1.0]
    rests = []
    for i, (a, b) in enumerate(pairwise(edges)):
        low = steps[i - 1].to_s if i else a
        high = steps[i].from_s if i < len(steps) else b
        part = x[(t > low) & (t < high)]
        if part.size:
            rests.append(np.abs(part - np.median(part)))
    return float(np.quantile(np.concatenate(rests), 0.9) / np.ptp(x)) if rests else 1.0


def ratio(steps: tuple[Step, ...]) -> list[float]:
    """The steps as multiples of the smallest, rounded to halves: [1, 0.5, -2, ...] of the first one's size."""
    unit = abs(steps[0].size) or 1.0
    return [round(2 * s.size / unit) / 2 for s in steps]
