"""What the band of a prediction holds, and what it does not, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.words.numbers import number
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.modelling.compare.ahead import Ahead
    from thermodata.modelling.predictions.predict import Predicted

HOLDS_NOT = (
    "it does not hold drivers that are wrong, nor what acts here and in none of these tests: another machine or "
    "setup, a start that was warm"
)


def band_text(band: Ahead, made: Sequence[Predicted]) -> list[str]:
    """A line for each response that was predicted on a machine of the model."""
    if band.why_not is not None:
        return [f"no band of 95 %: {band.why_not}"]
    several, lines = len(band.scale) > 1, list[str]()
    for name in dict.fromkeys(p.response for p in made if not band.elsewhere(p)):
        left, of = band.left.get(name), f" of {name}" if several else ""
        if left is None or all(p.half is None for p in made if p.response == name):
            why = "how its parameters spread" if left else "what is left on tests that it has not seen"
            lines.append(f"no band of 95 %{of}: {why} is not known")
            continue
        tests = f"{len(left.tests)} {'open tests, each left out' if left.refitted else 'verification tests'}"
        scale = band.scale.get(name, 0.0)
        unsure = (
            f"the calibration (±{number(196 * scale, 2)} %)"
            if scale
            else "no calibration, for none says how sure it is"
        )
        lines.append(
            f"95 %{of}: from the parameters, {unsure}, and what the model leaves on "
            f"{tests} ({number(left.rms)} {left.unit} rms; beyond {number(left.reach)} {left.unit} in proportion); "
            f"{HOLDS_NOT}"
        )
    return lines


def locked_lines(model: str, made: Sequence[Predicted]) -> list[str]:
    """That locked tests are among those that were predicted, why no error stands there, and how it is asked for."""
    locked = dict.fromkeys(f"{p.campaign}/{p.test}" for p in made if p.locked)
    if not locked:
        return []
    are = "is locked: its error is" if len(locked) == 1 else "are locked: their errors are"
    return [
        f"{listed([*locked])} {are} not shown, for each look is counted; thermodata confirm {model} tells what the "
        "model leaves on the locked tests of its campaigns"
    ]


def elsewhere_text(model: str, band: Ahead, made: Sequence[Predicted]) -> list[str]:
    """A line for each other machine that the model was asked about."""
    found: dict[str, dict[str, list[str]]] = {}
    for p in made:
        if band.elsewhere(p):
            found.setdefault(p.machine, {}).setdefault(p.campaign, []).append(p.test)
    return [
        f"{listed([*campaigns])} {'is' if len(campaigns) == 1 else 'are'} of machine {machine}, and the model was "
        f"fitted to machine {listed(band.machines)}: no band says what that costs; thermodata portability {model} says "
        "how it carries over, where the displacement was measured"
        for machine, campaigns in found.items()
    ]
