"""Parameters of a claim in words: with their intervals, the bound that one stands at, and what a gain is a gain of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from thermodata.report.words.numbers import number, quantity

if TYPE_CHECKING:
    from thermodata.plugin import Effect
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.result import Parameter

_SAME = 1e-6
AT_BOUND = "at its bound"


def parameters_text(one: Candidate) -> str:
    """'screw.tau 23.9 min (22.3 to 25.6), screw.gain 8.59 um (7.99 to 9.20); in brackets intervals of 95 %'; and below
    it what a gain is, where its unit does not say that. '' where there are none."""
    from thermodata.effect import all_effects

    effect = all_effects().get(one.effect)
    each = [f"{name} {quantity(p.value, p.unit)}{_interval(name, p, effect)}" for name, p in one.parameters.items()]
    known = any(p.low is not None or p.high is not None for p in one.parameters.values())
    told = ", ".join(each) + ("; in brackets intervals of 95 %" if known else "")
    if AT_BOUND in told:
        told += "; what stands at its bound may be the work of another effect"
    return "\n".join([told, *_meanings(one, effect)])


def _interval(name: str, p: Parameter, effect: Effect | None) -> str:
    """' (22.3 to 25.6)', ' (at its bound; up to 4.12)'; '' where these tests set none, and no bound holds it."""
    bound = AT_BOUND if (p.low is None or p.high is None) and _is_at_bound(name, p, effect) else ""
    ends = ""
    if p.low is not None and p.high is not None:
        ends = f"{number(p.low)} to {number(p.high)}"
    elif p.high is not None:
        ends = f"up to {number(p.high)}"
    elif p.low is not None:
        ends = f"from {number(p.low)} on"
    told = "; ".join(filter(None, [bound, ends]))
    return f" ({told})" if told else ""


def _is_at_bound(name: str, p: Parameter, effect: Effect | None) -> bool:
    for one in () if effect is None else effect.params:
        if one.name == name.rpartition(".")[2] and one.unit == p.unit:
            ends = (one.lower, one.upper, *(one.reach or ()))
            return any(math.isclose(p.value, end, rel_tol=_SAME) for end in ends)
    return False


def _meanings(one: Candidate, effect: Effect | None) -> list[str]:
    """Of gains in a unit that does not say a what: 8.59 um, at which feed?"""
    means = {} if effect is None else {g.name: g.meaning for g in effect.gains}
    bare = {n: means.get(n.rpartition(".")[2], "") for n, p in one.parameters.items() if "/" not in p.unit}
    return [f"{name} is {meaning}" for name, meaning in bare.items() if meaning]
