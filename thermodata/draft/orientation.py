"""What turns a displacement to the machine's axes: its sign, asked where nothing tells it, and jump tests that are left
over."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from thermodata.draft.jumps import JumpTest
from thermodata.draft.parts import DraftJump
from thermodata.draft.quantity import Guess


def which_way(said: Guess) -> str:
    """The question for the sign of a displacement that no calibration turns to the machine's axes."""
    axis, unit = said.axis or "Z", said.unit if said.unit and said.unit.isalpha() else "um"
    name = f"sign_{axis.lower()}"
    return (
        f"which way does it count? its sign is unknown until 'calibration: {name}' stands here, and {name}: {{kind: "
        f"scale, axis: {axis}, gain: 1 um/{unit}, facing: ?, increases_with: ?}} under calibrations; facing: "
        f"+{axis} or -{axis}, where the probe looks; increases_with: gap or approach"
    )


def why_idle(path: str, jumps: Sequence[JumpTest], used: Sequence[DraftJump]) -> str:
    """Why a jump test is not used; where another one of the same probe is, with the steps of both."""
    own = next(j for j in jumps if str(j.file.path) == path)
    name = own.signal[1] if own.signal is not None else None
    other = next((c for c in used if name is not None and c.signal == name), None)
    if other is None:
        return "taken for a jump test, and no probe in volts needs it"
    said = f"a second jump test of '{name}', beside {other.file}"
    here, there = _height([s.size for s in own.steps]), _height(other.seen)
    if not here or not there:
        return said
    unit = other.unit or "V"
    return (
        f"{said}, which is used: steps of {here:.4g} {unit} here and {there:.4g} {unit} there, "
        f"{100 * (here / there - 1):+.1f} %; "
        "if the moves were the same, so much do the sensitivities differ: which holds for the tests? "
        f"'file: {path}' takes this one"
    )


def _height(steps: Sequence[float]) -> float:
    """The usual height of steps; 0 where there are none."""
    return median(abs(s) for s in steps) if steps else 0.0
