"""A probe that looks between two axes, as those of a nest that is turned do: the jump tests of both axes move it."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.draft.probes.jumps import JumpTest, Moved
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import words

_AS_FAR = 0.5  # of its own axis's steps: what stands askew by less than 27 degrees answers by less
_AT_ONCE = 0.25  # of a dwell


def question_between(name: str, unit: str, jump: JumpTest, jumps: Sequence[JumpTest]) -> str | None:
    """What to ask of a probe that another axis's jump test moves about as far as its own; None of another. name: of its
    channel; jump: its own test; jumps: all."""
    own = _letter(jump)
    if own is None or jump.signal is None:
        return None
    here = Moved(jump.signal, jump.steps, jump.dwell_s)
    for other in jumps:
        axis = _letter(other)
        there = next((m for m in _all(other) if jump.is_of(*m.signal)), None)
        if axis in (None, own) or there is None or not _AS_FAR < there.height / here.height < 1 / _AS_FAR:
            continue
        if not all(_at_once(there, m) for m in _all(other)):
            continue  # it was moved by itself in that recording
        beside = next((m for m in _all(jump)[1:] if m.height > _AS_FAR * here.height), None)
        also = next((m for m in _all(other) if beside is not None and m.signal == beside.signal), None)
        with_it = f", as '{beside.signal[1]}' does" if beside else ""
        return (
            f"axis: {own} by {jump.file.path.name}, or {axis} by {other.file.path.name}? both move it, by "
            f"{here.height:.3g} and {there.height:.3g} {unit}{with_it}: of a nest that is turned, each axis gets a "
            f'channel that derives from both probes, d{own}: {{derive: "({name} {_sign(here, beside)} the other) * '
            f'? um / 1 {unit}", quantity: displacement, axis: {own}, at: tcp, relative_to: table}}, where ? is the '
            "move by "
            f"the sum of both steps, and d{axis} with ({name} {_sign(there, also)} the other)"
        )
    return None


def _letter(jump: JumpTest) -> str | None:
    letter = axis_of(words(jump.file.path.stem))
    return letter.upper() if letter else None


def _all(jump: JumpTest) -> list[Moved]:
    """The probes that moved in a jump test, its own first."""
    own = [] if jump.signal is None else [Moved(jump.signal, jump.steps, jump.dwell_s)]
    return [*own, *(m for m in jump.others if m.signal != jump.signal)]


def _at_once(one: Moved, other: Moved) -> bool:
    """Whether two probes moved at the same times."""
    if len(one.steps) != len(other.steps):
        return False
    apart = (abs(a.t_s - b.t_s) for a, b in zip(one.steps, other.steps, strict=True))
    return max(apart) < _AT_ONCE * max(one.dwell_s, other.dwell_s)


def _sign(one: Moved, other: Moved | None) -> str:
    """Of what two probes add up to, of which a move makes steps."""
    turned = other is not None and bool(other.steps) and one.steps[0].size * other.steps[0].size < 0
    return "-" if turned else "+"
