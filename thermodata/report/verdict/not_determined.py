"""Which effects of the model its tests do not determine, in words, and what it leaves without them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.words.numbers import number, quantity
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.schema.answers.result import Parameter
    from thermodata.schema.answers.undetermined import Undetermined

MOST = 3
AS_MUCH = 0.02  # of an error on left-out tests: a change by less is none


def not_determined(found: Diagnosis) -> list[str]:
    """'the tests that were fitted do not determine screw: its gain is 3.20 um/K (95 %: -0.100 to 6.50), ...', a clause
    for each of the first few."""
    if found.verdict == "effect":
        return _blurred(found.undetermined)
    told = [_told(one, found.model) for one in found.undetermined[:MOST]]
    more = [one.effect for one in found.undetermined[MOST:]]
    return [*told, *([f"nor do they determine {listed(more)}"] if more else [])]


def _blurred(some: Sequence[Undetermined]) -> list[str]:
    """One clause where a cause is named: what is missing may be what blurs the others."""
    if not some:
        return []
    named = [
        f"{one.effect} ({', '.join(map(_value_and_interval, one.gains.values()))}{_there(one)})" for one in some[:MOST]
    ]
    named += [one.effect for one in some[MOST:]]
    may = "that may be for what is missing, so add it first and ask again"
    return [f"the tests that were fitted do not determine {listed(named)}: {may}"]


def _told(one: Undetermined, model: str) -> str:
    drivers = listed(one.drivers)
    test = f"a test in which {drivers} {'moves' if len(one.drivers) == 1 else 'move'} and the rest does not"
    does = f", by which it does {there}" if (there := _there(one).removeprefix("; ")) else ""
    return (
        f"the tests that were fitted do not determine {one.effect}: {_gains(one)}{does}, {_without(one, model, test)}"
    )


def _gains(one: Undetermined) -> str:
    """'its gain is 3.20 um/K (95 %: -0.100 to 6.50)'."""
    return listed([f"its {n.rpartition('.')[2]} is {_value(p)} ({_interval(p)})" for n, p in one.gains.items()])


def _there(one: Undetermined) -> str:
    """'; 7.00 um in V03, against 0.500 um at most in those': where it counts for more than in what was fitted."""
    if one.elsewhere is None:
        return ""
    return f"; {number(one.elsewhere_um)} um in {one.elsewhere}, against {number(one.does_um)} um at most in those"


def _value_and_interval(p: Parameter) -> str:
    return f"{_value(p)}, {_interval(p)}"


def _value(p: Parameter) -> str:
    return quantity(p.value, p.unit)


def _interval(p: Parameter) -> str:
    """'95 %: -0.100 to 6.50'."""
    if p.low is None or p.high is None:
        return f"95 %: from {number(p.low)} on" if p.low is not None else f"95 %: up to {number(p.high)}"
    return f"95 %: {number(p.low)} to {number(p.high)}"


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
