"""What a fit says of its bounds: values that one holds, and gains beyond what is known."""

from __future__ import annotations

import numpy as np

from thermodata.modelling.fitted_response import FittedTerm, bounds_of
from thermodata.modelling.parameters import UNDETERMINED, by_kelvin, interval, name_of
from thermodata.plugin import Param
from thermodata.schema.result import Check

AT_BOUND = 1e-3  # of the bound, or of the range where that may be zero


def at_bounds(term: FittedTerm) -> list[Check]:
    """Parameters and gains of an effect that a bound holds, and gains beyond what the library thinks possible."""
    # what groups share is said once
    of_params = {row.name: row for rows in (_bounds, _undetermined) for row in rows(term)}
    return [*of_params.values(), *_gain_bounds(term), *_plausible(term)]


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
                            advice=f"{param.meaning} stands at its bound {end:g} {param.unit}: another effect may be "
                            f"behind it, or the bound is wrong{_wider(param, end)}",
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
                        advice=f"{param.meaning} is not determined: these tests allow all from {low:g} to {high:g} "
                        f"{param.unit}; fix it, or add a test in which its driver moves",
                    )
                )
    return rows


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


def _plausible(term: FittedTerm) -> list[Check]:
    rows = []
    for gain in term.effect.gains:
        if gain.unit.endswith("/K") and not by_kelvin(term):
            continue  # what is known is a size a kelvin, and nothing here is a kelvin
        for group, values in term.groups.items():
            value, top = values.gains[gain.name], gain.magnitude[1]
            if np.isfinite(top) and top > 0 and abs(value) > top and gain.name not in term.bound.spec.fixed:
                tag = f"[{group}]" if group else ""
                rows.append(
                    Check(
                        name=f"implausible:{term.id}.{gain.name}{tag}",
                        value=value,
                        threshold=top,
                        passed=False,
                        advice=f"larger than anything known for '{term.effect.name}' "
                        f"({top:g} {gain.unit}): it may stand in for another effect",
                    )
                )
    return rows
