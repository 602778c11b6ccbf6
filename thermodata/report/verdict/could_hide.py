"""What a verdict without a claim can't exclude, in words: the same in the terminal and on the pages."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from thermodata.report.verdict.twins import as_named
from thermodata.report.words.numbers import number, percent
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import DetectionLimit, Diagnosis

SHOWN = 4
MOST = 3  # in a headline
NEARLY_ALL = 0.95  # of the response: a bound that excludes next to nothing
MOSTLY = 0.9  # of it: an effect that does less does not hide it alone


def could_hide(found: Diagnosis) -> str:
    """'these tests can't exclude guideway (C03_guide) up to 13.6 um, for feed_screw does 91 % of it; never moved in the
    open tests: feed_Y (it moves in day2), ...; not asked for by itself ...'; '' where nothing is known of these."""
    return "; ".join(filter(None, [_limits(found), _never_moved(found), _only_by_name(found)]))


def could_be(found: Diagnosis) -> str:
    """'spindle_motor (T_motor) or feed_motor (T_Y)': what no size of it, or none below the response, would have shown,
    and what no open test heats; '' where the tests would have shown all. Nothing that reads only what the missing heat,
    as it is estimated, does not go with."""
    response = found.response_um or 0.0
    heat = None if found.unknown is None else found.unknown.heat
    against = set() if heat is None else {one.channel for one in heat.goes_not_with}
    names = [f"what {one.channel} moves (no open test does)" for one in found.at_rest]
    resting = {channel for one in found.at_rest for channel in (one.channel, *one.warms)}
    names += [
        _name(one)
        for one in _of_each(found.limits, response)
        if one.large and _is_unbound(one, response) and resting.isdisjoint(one.drivers)
        if not against.issuperset(one.drivers)
    ]
    shown = list(dict.fromkeys(names))
    told = [*shown[:MOST], f"{len(shown) - MOST} more"] if len(shown) > MOST else shown
    return listed(told, "or")


def may_act_instead(found: Diagnosis, but: Collection[str] = ()) -> str:
    """'spindle_bearing (T_front), which spindle_gearbox hides in these tests, may do that instead (...)': of what could
    have any size behind an effect of the model the one that the tests speak for most; '' where there is none. but: ids
    that are told already."""
    response = found.response_um or 0.0
    of_each = _of_each(found.limits, response)
    hidden = next((one for one in of_each if one.behind and one.id not in but and _is_unbound(one, response)), None)
    if hidden is None:
        return ""
    asks = f"thermodata confirm {found.model[:8]} {hidden.id} asks locked ones, where there are some"
    return f"{_name(hidden)}, which {hidden.behind} hides in these tests, may do that instead ({asks})"


def was_not_asked(found: Diagnosis) -> str:
    """'overhang (T_head, pos_z) was not asked for, though all that drives it is logged'; '' where all was asked for."""
    names = [] if found.unknown is None else found.unknown.by_name
    if not names:
        return ""
    more = len(names) - 1
    were, drives = (f" and {more} more were", "them") if more else (" was", "it")
    return f"{as_named(names[0])}{were} not asked for, though all that drives {drives} is logged"


def _only_by_name(found: Diagnosis) -> str:
    """'not asked for by itself, though all that drives it is logged: overhang (T_head, pos_z); thermodata confirm ...
    asks locked tests of it'; '' where there is nothing of the kind."""
    names = [] if found.unknown is None else found.unknown.by_name
    if not names:
        return ""
    rest = [f"{len(names) - SHOWN} more"] if len(names) > SHOWN else []
    told = listed([*(as_named(name) for name in names[:SHOWN]), *rest])
    alone = len(names) == 1
    itself, drives, them = ("itself", "it", "it") if alone else ("themselves", "them", "the first")
    unasked = f"not asked for by {itself}, though all that drives {drives} is logged: {told}"
    return f"{unasked}; thermodata confirm {found.model[:8]} {names[0]} asks locked tests of {them}"


def _never_moved(found: Diagnosis) -> str:
    told = []
    for one in found.at_rest:
        moves = f"it moves in {', '.join(one.moves_in)}"
        warms = f", nor was {', '.join(one.warms)} heated by it" if one.warms else ""
        told.append(f"{one.channel} ({', '.join(one.effects)}{warms}; {moves})")
    tests = "; let an open test move it" if len(told) == 1 else "; let open tests move them"
    return f"never moved in the open tests: {'; '.join(told)}{tests}" if told else ""


def _limits(found: Diagnosis) -> str:
    least = _of_each(found.limits, found.response_um or 0.0)
    if not least or not found.response_um:
        return ""
    size = f"RMS where it acts; the response has {number(found.response_um)} um"
    large = [one for one in least if one.large]
    if not large:
        most = max(least, key=_size)
        return (
            f"an effect of the library that acts by more than {number(most.least_um)} um ({size}) would have been "
            f"named here; {_name(most)} could hide most"
        )
    told = "; ".join(_one(one, found.response_um) for one in large[:SHOWN])
    rest = f"; {len(large) - SHOWN} more" if len(large) > SHOWN else ""
    return f"these tests can't exclude {told}{rest} ({size})"


def _of_each(limits: list[DetectionLimit], response: float) -> list[DetectionLimit]:
    """Of each effect and family the sensor that shows it best, the one that could hide most first; of what nothing
    bounds, the one that the tests speak for most."""
    best: dict[tuple[str, str], DetectionLimit] = {}
    for one in sorted(limits, key=_size):
        best.setdefault((one.effect, one.family), one)

    def could_do(one: DetectionLimit) -> tuple[bool, float, float]:
        unbound = _is_unbound(one, response)
        spoken_for = one.evidence if unbound and one.evidence is not None else float("-inf")
        return unbound, spoken_for, _size(one)

    return sorted(best.values(), key=could_do, reverse=True)


def _size(one: DetectionLimit) -> float:
    return float("inf") if one.least_um is None else one.least_um


def _name(one: DetectionLimit) -> str:
    return f"{one.effect} ({', '.join(one.drivers)})"


def _is_unbound(one: DetectionLimit, response: float) -> bool:
    """More than all that was measured is no bound."""
    return one.least_um is None or one.least_um > response


def _one(one: DetectionLimit, response: float) -> str:
    unbound = _is_unbound(one, response)
    size = "of any size" if unbound else f"up to {number(one.least_um)} um"
    if not unbound and (one.least_um or 0.0) >= NEARLY_ALL * response:
        size += ", nearly all of the response"
    if not one.behind:
        return f"{_name(one)} {size}, for slow noise covers {'it' if unbound else 'what is less'}"
    # an effect that does little more than half of it would not hide it alone
    rest = " and slow noise covers the rest" if unbound and 1 - one.seen < MOSTLY else ""
    return f"{_name(one)} {size}, for {one.behind} does {percent(1 - one.seen)} of it{rest}"
