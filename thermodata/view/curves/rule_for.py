"""A `measuring` rule for a stretch of a test: which state of the machine tells it from the rest.

A stretch that is masked by its times is masked in one test; a rule over what the machine did holds in all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.view.curves.predictions import Prediction
from thermodata.view.curves.window import Channel
from thermodata.view.query.store_view import StoreView

if TYPE_CHECKING:
    from thermodata.store import Store

STATES = ("position", "feed", "rotational_speed", "state", "power", "load", "flow")
TAKES, KEEPS = 0.9, 0.9  # of the samples inside, and of those outside
# a stretch that comes again in the test is told from half of it; then the rule must leave a smaller error than the
# test without the stretch
KEEPS_WHERE_IT_COMES_AGAIN, _SMALLER = 0.5, 0.95
# of the range of a probe: as good as its end, and apart from it; of a stretch: the least share at that end
_SAME, _APART, _STANDS = 0.02, 0.5, 0.2
_LEAPS = 0.2  # of the way to the end, from one sample to the next: heat takes its time, a probe that is left does not
_MOST = 4
_FEWEST = 5  # samples on either side


@dataclass(frozen=True, slots=True)
class Rule:
    """text: as `measuring` takes it, an expression or, in braces, its long form. n: samples that count with it; taken:
    of those in the stretch, lost: of those outside of it, that count no more. rmse: of what is left [of the response],
    None where nothing is."""

    text: str
    n: int
    taken: int
    lost: int
    rmse: float | None


def rules_for(store: Store, found: Prediction, channels: list[Channel], from_s: float, to_s: float) -> list[Rule]:
    """Rules under which a stretch does not count, the one first that leaves the rest most alone; empty where no logged
    state tells it from the rest."""
    names = [c.name for c in channels if c.quantity in STATES]
    if not names or len(found.t_s) < 2:
        return []
    step = float(np.median(np.diff(found.t_s)))
    binned = StoreView(store).binned(found.campaign, found.test, step).df()
    unit = next((c.unit for c in channels if c.name == found.response), "um")
    ranged = range_rule(found, unit, from_s, to_s)
    states = {
        n: _bin_of_time(found.t_s, binned["t_s"].to_numpy(), binned[n].to_numpy(), step) for n in names if n in binned
    }
    return [*([ranged] if ranged else []), *rules(found, states, from_s, to_s)]


def rules(found: Prediction, states: Mapping[str, Float1D], from_s: float, to_s: float) -> list[Rule]:
    """The same from states on the prediction's own grid: shape (n,) each, NaN where nothing was logged."""
    counts = found.valid & np.isfinite(found.residual)
    stretch = (found.t_s >= from_s) & (found.t_s <= to_s)
    inside, outside = counts & stretch, counts & ~stretch
    residual = found.residual
    without = _rms(residual[outside])
    for keeps_outside in (KEEPS, KEEPS_WHERE_IT_COMES_AGAIN):
        made = []
        for name, values in states.items():
            for text, keeps in _conditions(name, values, inside, outside, keeps_outside):
                kept = counts & keeps
                taken, lost = int((inside & ~keeps).sum()), int((outside & ~keeps).sum())
                if taken < TAKES * inside.sum() or lost > (1 - keeps_outside) * outside.sum():
                    continue
                rmse = _rms(residual[kept])
                again = keeps_outside < KEEPS
                if again and (rmse is None or without is None or rmse > _SMALLER * without):
                    continue
                made.append(Rule(text, int(kept.sum()), taken, lost, rmse))
        if made:
            return sorted(made, key=lambda r: (r.lost - r.taken, len(r.text)))[:_MOST]
    return []


def range_rule(found: Prediction, unit: str, from_s: float, to_s: float) -> Rule | None:
    """The range that a probe measures in, where it stands at an end of what it can say in the stretch; None where it
    does not. No clock is needed for it: the probe itself knows when it was out."""
    counts = found.valid & np.isfinite(found.measured) & np.isfinite(found.residual)
    inside = counts & (found.t_s >= from_s) & (found.t_s <= to_s)
    if inside.sum() < _FEWEST:
        return None
    x = found.measured
    span = float(np.ptp(x[counts]))
    for end in (float(x[inside].max()), float(x[inside].min())):
        at_end = counts & (np.abs(x - end) <= _SAME * span)
        # what is on its way between the range and its end is an average of both
        usual = x[counts & ~inside & (np.abs(x - end) > _APART * span)]
        if span <= 0 or (at_end & inside).sum() < _STANDS * inside.sum() or len(usual) < 0.5 * (counts & ~inside).sum():
            continue
        near = float(usual.max() if end > float(np.median(usual)) else usual.min())
        arrives = np.flatnonzero(at_end[1:] & ~at_end[:-1])
        if not len(arrives) or np.median(np.abs(np.diff(x)[arrives])) < _LEAPS * abs(end - near):
            continue
        far = float(usual.min() if end > near else usual.max())
        way = end - far
        limits = sorted((_between(near, end, 2), _between(far - 0.75 * way, far - 0.25 * way, 2)))
        kept = counts & (x >= limits[0]) & (x <= limits[1])
        taken, lost = int((inside & ~kept).sum()), int((counts & ~inside & ~kept).sum())
        low, high = (f"{limit:.12g} {unit}" for limit in limits)
        text = f"{{in_range: {{{found.response}: [{low}, {high}]}}}}"
        return Rule(text, int(kept.sum()), taken, lost, _rms(found.residual[kept]))
    return None


def _rms(x: Float1D) -> float | None:
    return float(np.sqrt(np.mean(x**2))) if len(x) else None


def _conditions(
    name: str, values: Float1D, inside: Bool1D, outside: Bool1D, keeps: float
) -> Iterator[tuple[str, Bool1D]]:
    """(the condition, where it holds): not where the state was not logged, as in `measuring`."""
    there = np.isfinite(values)
    a, b = values[inside & there], values[outside & there]
    if len(a) < _FEWEST or len(b) < _FEWEST:
        return
    usual = float(np.median(b))
    if np.mean(b == usual) >= keeps:
        yield f"{name} == {usual:g}", values == float(f"{usual:g}")
    for text, x in ((name, values), (f"abs({name})", np.abs(values))):
        low_in, high_in = np.quantile(x[inside & there], [1 - TAKES, TAKES])
        low_out, high_out = np.quantile(x[outside & there], [1 - keeps, keeps])
        if high_out < low_in:
            limit = _between(high_out, low_in)
            yield f"{text} < {limit:.12g}", x < limit
        if high_in < low_out:
            limit = _between(high_in, low_out)
            yield f"{text} > {limit:.12g}", x > limit
        if np.all(values[there] >= 0):
            break  # its size is itself


def _between(one: float, other: float, digits: int = 1) -> float:
    """The shortest number between two, near their middle. digits: that it has at least."""
    low, high = sorted((one, other))
    middle = 0.5 * (low + high)
    for n in range(digits, 12):
        value = float(f"{middle:.{n}g}")
        if low < value < high:
            return value
    return middle


def _bin_of_time(t_s: Float1D, bins_s: Float1D, values: Float1D, step: float) -> Float1D:
    """The bin that a time lies in; NaN where there is none."""
    place = np.searchsorted(bins_s, t_s + step / 2) - 1
    inside = (place >= 0) & (place < len(bins_s))
    place = np.clip(place, 0, len(bins_s) - 1)
    near = inside & (np.abs(bins_s[place] - t_s) < step)
    return np.where(near, values[place].astype(np.float64), np.nan)
