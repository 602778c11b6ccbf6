"""Which effects of the model its tests do not determine, in words, and what it leaves without them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.words.numbers import number, quantity
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.schema.answers.result import Parameter
    from thermodata.schema.answers.undetermined import Undetermined

MOST = 3
AS_MUCH = 0.02  # of an error on left-out tests: a change by less is none


def not_determined(found: Diagnosis) -> list[str]:
    """'the tests that were fitted do not determine screw: its gain is 3.20 um/K (95 %: -0.100 to 6.50), ...', a clause
    for each of the first few."""
    missing = found.verdict == "effect"
    told = [_told(one, found.model, missing) for one in found.undetermined[:MOST]]
    more = [one.effect for one in found.undetermined[MOST:]]
    return [*told, *([f"nor do they determine {listed(more)}"] if more else [])]


def _told(one: Undetermined, model: str, missing: bool) -> str:
    gains = listed([f"its {name.rpartition('.')[2]} is {_with_interval(p)}" for name, p in one.gains.items()])
    there = ""
    if one.elsewhere is not None:
        there = (
            f", by which it does {number(one.elsewhere_um)} um in {one.elsewhere}, against {number(one.does_um)} um at "
            "most in those"
        )
    drivers = listed(one.drivers)
    test = f"a test in which {drivers} {'moves' if len(one.drivers) == 1 else 'move'} and the rest does not"
    do = (
        f"which may be for what is missing: add that first, and where it stays so, {test}"
        if missing
        else _without(one, model, test)
    )
    return f"the tests that were fitted do not determine {one.effect}: {gains}{there}, {do}"


def _with_interval(p: Parameter) -> str:
    """'3.20 um/K (95 %: -0.100 to 6.50)'."""
    value = quantity(p.value, p.unit)
    if p.low is None or p.high is None:
        end = f"from {number(p.low)} on" if p.low is not None else f"up to {number(p.high)}"
        return f"{value} (95 %: {end})"
    return f"{value} (95 %: {number(p.low)} to {number(p.high)})"


def _without(one: Undetermined, model: str, test: str) -> str:
    """What it costs or gives on left-out tests, and what to do."""
    left, without = one.left_out_um, one.left_out_without_um
    if left is None or without is None:
        return f"so add {test}"
    errors = f"where each open test is foretold by a fit to the others, the model errs by {number(left)} um with it"
    if without < (1 - AS_MUCH) * left:
        return (
            f"and {errors} and by {number(without)} um without: take it out (thermodata remove {model[:8]} "
            f"{one.effect}) until there is {test}"
        )
    if without <= (1 + AS_MUCH) * left:
        return (
            f"and {errors} and by {number(without)} um without, so these tests need it as little: take it out "
            f"(thermodata remove {model[:8]} {one.effect}), or add {test}"
        )
    return f"though {errors} and by {number(without)} um without: keep it, and add {test}"
