"""What turns a displacement to the machine's axes: jump tests, and the sign, asked where nothing tells it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import median

from thermodata.draft.campaign.parts import DraftJump
from thermodata.draft.folder.into_sources.one_signal import OneSignal
from thermodata.draft.probes.between_axes import question_between
from thermodata.draft.probes.jumps import JumpTest
from thermodata.draft.probes.which_way import ASKED, CALIBRATION_ASKED, calibration_for
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.signals.units import converts
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import parts_of, words
from thermodata.plugin import Signal
from thermodata.schema.words.sentences import with_dots

_SHOWN_STEPS = 12


@dataclass(frozen=True, slots=True)
class Turned:
    """How a displacement comes to the machine's axes. said: what it is by that, with what is asked; calibration: the
    name of the one that turns it, None where there is none yet; jump: its jump test, as the draft has it."""

    said: Guess
    calibration: str | None = None
    jump: DraftJump | None = None


def which_way(said: Guess) -> str:
    """The question for the sign of a displacement that no calibration turns to the machine's axes."""
    axis, name = said.axis or "?", f"sign_{said.axis.lower()}" if said.axis else "sign"
    along = f"+{said.axis}" if said.axis else "+ of its axis"
    looks = f"+{axis} or -{axis}" if said.axis else "+X, -X, +Y, -Y, +Z or -Z"
    return (
        f"{ASKED} its sign is unknown until 'calibration: {name}' stands here, and {name}: "
        f"{calibration_for(axis, '?', '?')} under calibrations; facing: {looks}, where a probe that stands on the "
        "table looks, and the opposite of where one in the spindle does; increases_with: gap or approach; a "
        f"reading that has the machine's sign already, + where the tool goes towards {along}: facing: {along}, "
        "increases_with: gap"
    )


def reads_a_length(one: OneSignal) -> bool:
    """Whether a displacement needs no gain: in every file that has it, its unit is one of lengths."""
    units = {(one.of(f) or one.signal).unit for f in one.files}
    return all(unit is not None and converts(unit, "displacement") for unit in units)


def why_idle(path: str, jumps: Sequence[JumpTest], used: Sequence[DraftJump], behind: Sequence[str]) -> str:
    """Why a jump test is not used; where another one of the same probe is, with the steps of both. behind: the tests
    that were recorded after it and that one."""
    own = next(j for j in jumps if str(j.file.path) == path)
    name = own.written or own.signal[1] if own.signal is not None else None
    other = next((c for c in used if name is not None and c.signal == name), None)
    if other is None and name is None:
        return "taken for a jump test by its name, and nothing is seen to move in it"
    if other is None and question_between(str(name), "V", own, jumps) is not None:
        return (
            f"a jump test of '{name}', which looks between two axes, in steps of "
            f"{_listed([s.size for s in own.steps])}: what each axis gets of both probes is derived"
        )
    if other is None:
        return f"taken for a jump test of '{name}', and there is no one displacement in the tests that is called so"
    said = f"a second jump test of '{name}', beside {other.file}"
    steps = [s.size for s in own.steps]
    here, there = _height(steps), _height(other.seen)
    if not here or not there:
        return said
    unit = other.unit or "V"
    differ = f"steps of {here:.4g} {unit} here and {there:.4g} {unit} there, {100 * (here / there - 1):+.1f} %"
    if turned := _is_turned(steps, other.seen):
        differ += f" in size, of opposite signs ({_listed(steps)} here, {_listed(other.seen)} there)"
    what = "so much, and in sign," if turned else "so much"
    which = f"; after it: {', '.join(behind)}" if behind else ""
    return (
        f"{said}, which is used: {differ}; "
        f"if the moves were the same, {what} do the sensitivities differ: which holds for the tests{which}? "
        f"'file: {path}' takes this one for all; a calibration of its own, and in each test that it is for "
        f"channels: {{{other.name.removeprefix('jump_')}: {{calibration: ...}}}}, for these alone"
    )


def _is_turned(here: Sequence[float], there: Sequence[float]) -> bool:
    """Whether the steps of two jump tests are the same moves with the opposite sign."""
    return len(here) == len(there) and all(a * b < 0 for a, b in zip(here, there, strict=True))


def _listed(steps: Sequence[float]) -> str:
    return with_dots([f"{s:+.3g}" for s in steps], _SHOWN_STEPS)


def _height(steps: Sequence[float]) -> float:
    """The usual height of steps; 0 where there are none."""
    return median(abs(s) for s in steps) if steps else 0.0


def calibration_of(name: str, signal: Signal, said: Guess, jump: JumpTest | None, jumps: Sequence[JumpTest]) -> Turned:
    """The jump test of a probe in volts; without one, the question for it. jump: the one in which it is seen to move;
    jumps: all, of which one that shows no steps may be its own by its name."""
    jump = jump or next((j for j in jumps if _may_be_of(j, signal, said)), None)
    if jump is None:
        return Turned(replace(said, sure=False, questions=(*said.questions, CALIBRATION_ASKED)))
    if (between := question_between(name, said.unit or "V", jump, jumps)) is not None:
        others = (q for q in said.questions if q != "axis?")
        questions = (*others, between)
        return Turned(replace(said, quantity="voltage", axis=None, at=None, sure=False, questions=questions))
    return _by_jump(name, signal, said, jump)


def moved_too(signal: Signal, said: Guess, jumps: Sequence[JumpTest]) -> tuple[JumpTest | None, Guess]:
    """The jump test of another probe in which this one, which has none of its own, moved nearly as far, and what the
    signal is by it. Along the axis that the test is of, it is the test of both. Of another axis's probe it is asked
    whether its own axis was moved, too: what is across an axis answers by less. None where the file is called after
    another axis, or nothing tells whose the test is."""
    for jump in jumps if said.axis else ():
        if jump.signal is None:
            continue
        called = axis_of(words(jump.file.path.stem))
        moved = called or axis_of(words(parts_of(jump.written or jump.signal[1])[-1]))
        for other in jump.others:
            own = replace(jump, signal=other.signal, steps=other.steps, dwell_s=other.dwell_s, written=None, others=())
            if not own.is_of(signal.stream, signal.name):
                continue
            if moved == (said.axis or "").lower():
                return replace(own, moved_with=jump.signal[1]), said
            if moved is not None and called is None:
                asked = (
                    f"did the axis {said.axis} move in {jump.file.path.name}? '{jump.signal[1]}' moved at the same time"
                )
                return own, replace(said, sure=False, questions=(*said.questions, asked))
    return None, said


def sign_of(name: str, signal: Signal, said: Guess, jump: JumpTest | None) -> Turned:
    """What turns a probe that reads a length: the jump test in which it is seen to move; without one, the question
    which way it counts."""
    if jump is None:
        return Turned(replace(said, sure=False, questions=(*said.questions, which_way(said))))
    without = f"; until they stand here, {name} has no values: without 'calibration' it has, its sign unknown"
    return _by_jump(name, signal, said, jump, without)


def _by_jump(name: str, signal: Signal, said: Guess, jump: JumpTest, beside: str = "") -> Turned:
    """By its jump test, unless no axis is known. beside: what else to say to the question for the moves."""
    letter = axis_of(words(jump.file.path.stem))
    axis = said.axis or (letter.upper() if letter and letter in "xyz" else None)
    if said.axis is None and axis is not None:
        others = (q for q in said.questions if q != "axis?")
        asked = f"axis: {axis} by {jump.file.path.name}?"
        said = replace(said, axis=axis, sure=False, questions=(*others, asked))
    seen = tuple(float(f"{s.size:.3g}") for s in jump.steps)
    unit = said.unit or ("of a unit that is asked" if any(q.startswith("unit:") for q in said.questions) else "V")
    alike = f"; the same as for '{jump.moved_with}'" if jump.moved_with else ""
    drafted = DraftJump(
        f"jump_{name}",
        jump.source,
        str(jump.file.path),
        jump.written or signal.name,
        axis,
        float(f"{jump.dwell_s:.2g}"),
        seen,
        said.unit,
        "moves: the commanded ones, signed, in machine coordinates; " + _steps(seen, unit) + alike + beside,
        jump.file.sheet,
    )
    return Turned(said, drafted.name if axis else None, drafted)


def _steps(seen: Sequence[float], unit: str) -> str:
    if not seen:
        return "no steps were seen in it"
    more = f" ... ({len(seen)} in all)" if len(seen) > _SHOWN_STEPS else ""
    return f"seen: steps of {', '.join(f'{s:+g}' for s in seen[:_SHOWN_STEPS])}{more} {unit}"


def _may_be_of(jump: JumpTest, signal: Signal, said: Guess) -> bool:
    """Whether a jump test in which nothing is seen to move has the probe, and is called after no other axis."""
    has = any((s.stream, s.name) == (signal.stream, signal.name) for s in jump.file.signals)
    return jump.signal is None and has and axis_of(words(jump.file.path.stem)) in (None, (said.axis or "").lower())
