"""What a fit says of its bounds: values that one holds, and gains beyond what is known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, bounds_of
from thermodata.modelling.terms.parameters import UNDETERMINED, interval, name_of
from thermodata.modelling.trust.checks.at_reference import reached
from thermodata.modelling.trust.checks.usual_gain import usual_gain
from thermodata.plugin import Param
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import TestData

IMPLAUSIBLE = "implausible:"  # before the name of a gain, in the name of a check
AT_BOUND = 1e-3  # of the bound, or of the range where that may be zero


def at_bounds(response: FittedResponse, term: FittedTerm, tests: Sequence[TestData] = ()) -> list[Check]:
    """Parameters and gains of an effect that a bound holds, and gains beyond what the library thinks possible. tests:
    those that it was fitted to, which say how far its drivers go."""
    # what groups share is said once
    of_params = {row.name: row for rows in (_bounds, _undetermined) for row in rows(term)}
    return [*of_params.values(), *_gain_bounds(term), *_plausible(response, term, tests)]


def _bounds(term: FittedTerm) -> list[Check]:
    rows = []
    for group, values in term.groups.items():
        for param in term.effect.params:
            if param.name in term.bound.spec.fixed or param.name in values.silent:
                continue
            low, high = bounds_of(term, param)
            value = values.params[param.name]
            for end in (low, high):
                if abs(value - end) <= AT_BOUND * (abs(end) if low > 0 else high - low):
                    rows.append(
                        Check(
                            name=f"at_bound:{name_of(term, group, param)}",
                            value=value,
                            threshold=end,
                            passed=False,
                            advice=f"{param.meaning} {_stands(value, end, param)}: {_why(term, param, end, low)}",
                        )
                    )
    return rows


def _undetermined(term: FittedTerm) -> list[Check]:
    """Parameters whose interval holds all values between their bounds: one that reaches to 1e17 min says no more."""
    rows = []
    for group, values in term.groups.items():
        for param in term.effect.params:
            ends = interval(param.name, values, bounds_of(term, param))
            if ends == (None, None) and (param.name in values.half or param.name in values.ends):
                low, high = bounds_of(term, param)
                rows.append(
                    Check(
                        name=UNDETERMINED + name_of(term, group, param),
                        value=values.params[param.name],
                        threshold=None,
                        passed=False,
                        advice=f"{param.meaning} is not determined: these tests allow all from {low:g} to "
                        f"{_with_unit(high, param)}; fix it, or add a test in which its driver moves",
                    )
                )
    return rows


def _stands(value: float, end: float, param: Param) -> str:
    """Where it can be read off that the value is another one than its bound, how near it lies."""
    if abs(value - end) <= AT_BOUND * abs(end):
        return f"stands at its bound {_with_unit(end, param)}"
    return f"is {value:.3g}, as good as its bound {_with_unit(end, param)}"


def _why(term: FittedTerm, param: Param, end: float, low: float) -> str:
    if param.name in term.bound.spec.also and end == low:
        return f"these tests show none; leave {param.name} out of 'also'"
    return f"another effect may be behind it, or the bound is wrong{_wider(param, end)}"


def _with_unit(value: float, param: Param) -> str:
    """'100 min'; of a number without a unit the number alone."""
    return f"{value:g}" if param.unit == "1" else f"{value:g} {param.unit}"


def _wider(param: Param, end: float) -> str:
    """What to write where the library knows that bodies reach beyond the bound; '' else."""
    if param.reach is None or not param.reach[0] < end < param.reach[1]:
        return ""
    return f"; to let it go on, in the effect: bounds: {{{param.name}: [{param.reach[0]:g}, {param.reach[1]:g}]}}"


def _gain_bounds(term: FittedTerm) -> list[Check]:
    """A gain that a bound holds: the data want another, and the fit could not say which."""
    rows = []
    for group, values in term.groups.items():
        tag = f"[{group}]" if group else ""
        for gain in term.effect.gains:
            spec = term.bound.spec
            if gain.name in spec.fixed or (gain.name not in spec.bounds and gain.sign == "any"):
                continue
            library = {"+": (0.0, np.inf), "-": (-np.inf, 0.0), "any": (-np.inf, np.inf)}[gain.sign]
            whose = "the model file" if gain.name in spec.bounds else f"the library ({term.effect.name}: {gain.sign})"
            value = values.gains[gain.name]
            for end in spec.bounds.get(gain.name, library):
                if np.isfinite(end) and abs(value - end) <= AT_BOUND * abs(end):
                    rows.append(
                        Check(
                            name=f"at_bound:{term.id}.{gain.name}{tag}",
                            value=value,
                            threshold=float(end),
                            passed=False,
                            advice=f"held at {end:g} by a bound of {whose}: the data want it beyond; another effect "
                            "may be behind it, or the bound is wrong",
                        )
                    )
    return rows


def _plausible(response: FittedResponse, term: FittedTerm, tests: Sequence[TestData] = ()) -> list[Check]:
    rows = []
    for place, gain in enumerate(term.effect.gains):
        usual = usual_gain(response, term, gain)
        if usual is None or gain.name in term.bound.spec.fixed:
            continue
        for group, values in term.groups.items():
            value, tag = values.gains[gain.name], f"[{group}]" if group else ""
            there = reached(term, place, values.params, tests)
            if abs(value) * there.share > usual.largest:
                rows.append(
                    Check(
                        name=f"{IMPLAUSIBLE}{term.id}.{gain.name}{tag}",
                        value=value,
                        threshold=usual.largest / there.share,
                        passed=False,
                        advice=usual.said(value, interval(gain.name, values), there),
                    )
                )
    return rows
