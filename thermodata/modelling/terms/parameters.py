"""The parameters of a fitted model as a table of value, unit and interval."""

from __future__ import annotations

import math
from collections.abc import Sequence

from thermodata.calibration.expression.parser import parse
from thermodata.modelling.terms.fitted_response import FACTOR, FittedResponse, FittedTerm, Values, bounds_of
from thermodata.modelling.terms.identified import Identified, identified
from thermodata.plugin import Param
from thermodata.schema.agreed.certainty import Z95
from thermodata.schema.answers.result import SAMPLE, Parameter
from thermodata.schema.units.unit import difference_unit

Interval = tuple[float | None, float | None]
UNDETERMINED = "not_determined:"  # before the name of a parameter, in the name of a check


def parameters(responses: Sequence[FittedResponse]) -> dict[str, Parameter]:
    """See FittedModel.parameters."""
    by_name: dict[str, Parameter] = {}
    for response in responses:
        prefix = f"{response.name}/" if len(responses) > 1 else ""
        for term in response.terms:
            by_name |= {prefix + name: p for name, p in term_parameters(response, term).items()}
    return by_name


def term_parameters(response: FittedResponse, term: FittedTerm) -> dict[str, Parameter]:
    """'effect.parameter' of one term; parameters that groups share appear once. Of a function that was identified by
    its coefficients, its time constants and its gain at rest before these."""
    by_name: dict[str, Parameter] = {}
    function = identified(term.effect)
    taus = () if function is None else function.taus_min
    for number, tau in enumerate(taus, 1):
        by_name[f"{term.id}.tau" + (f"_{number}" if len(taus) > 1 else "")] = Parameter(value=tau, unit="min")
    for group, values in term.groups.items():
        tag = f"[{group}]" if group else ""
        for param in term.effect.params:
            if param.name in values.silent:
                continue
            ends = interval(param.name, values, bounds_of(term, param))
            by_name.setdefault(name_of(term, group, param), _parameter(values.params[param.name], param.unit, ends))
        if term.bound.spec.one_gain:
            by_name[f"{term.id}.{FACTOR}{tag}"] = _parameter(values.factor, "1", interval(FACTOR, values))
            tag = ""
        for gain in term.effect.gains:
            unit = gain_unit(response, term, gain.unit)
            if f"{term.id}.{gain.name}{tag}" in by_name and term.bound.spec.one_gain:
                continue
            value = values.gains[gain.name]
            if function is not None:
                value, unit = value * function.gain_at_rest, gain_unit(response, term, "um/u")
            ends = _with_scale(values.gains[gain.name], interval(gain.name, values), response.scale)
            by_name[f"{term.id}.{gain.name}{tag}"] = _parameter(value, unit, ends)
    if function is not None:
        by_name |= _coefficients(function, term.id, gain_unit(response, term, "um/u"))
    return by_name


def _coefficients(function: Identified, name: str, unit: str) -> dict[str, Parameter]:
    """As `fixed` of a transfer function takes them."""
    found = {f"{name}.a{i}": Parameter(value=a, unit=unit) for i, a in enumerate(function.a)}
    found |= {f"{name}.b{i}": Parameter(value=b, unit="1") for i, b in enumerate(function.b)}
    return {**found, name + SAMPLE: Parameter(value=function.step_s, unit="s")}


def name_of(term: FittedTerm, group: str, param: Param) -> str:
    """'effect.parameter', and '[group]' behind it where the groups do not share one value."""
    own = group and not term.bound.spec.shares(param.name)
    return f"{term.id}.{param.name}" + (f"[{group}]" if own else "")


def gain_unit(response: FittedResponse, term: FittedTerm, unit: str) -> str:
    """um/u -> the response's unit over the driver's; um -> the response's unit (a response may be no displacement)."""
    if unit.endswith("/u"):
        unit = f"um/{driver_unit(response, term)}"
    elif unit.endswith("/K") and not by_kelvin(term):
        unit = unit.removesuffix("/K")
    if unit == "um" or unit.startswith("um/"):
        unit = response.unit + unit[2:]
    return unit


def by_kelvin(term: FittedTerm) -> bool:
    """Whether a temperature drives a term. An effect with a gain a kelvin may be driven by a speed, a feed or a switch
    where no sensor is: its gain is then a displacement at that effect's own reference."""
    quantities = {need.role: need.quantity for need in term.effect.needs}
    return any(quantities.get(role, "").startswith("temperature") for role in term.binding)


def driver_unit(response: FittedResponse, term: FittedTerm) -> str:
    """K for a temperature or a difference of temperatures, else the unit of the channel or expression."""
    text = term.binding.get("u", "")
    units = response.bound.units
    if text.isidentifier():
        unit: str | None = units.get(text)
    else:
        unit = parse(text).unit({name: units.get(name, "1") for name in parse(text).names})
    return difference_unit(unit or "1")


def interval(
    name: str, values: Values, bounds: tuple[float, float] = (-math.inf, math.inf)
) -> tuple[float | None, float | None]:
    """The ends of the interval of 95 %. None: not known, or not within the bounds, beyond which nothing was asked: the
    data set no end there."""
    value, half = values.params.get(name, values.gains.get(name, values.factor)), values.half.get(name)
    low: float | None
    high: float | None
    if name in values.ends:
        low, high = values.ends[name]
    elif half is None:
        return None, None
    elif name in values.log_names and value > 0:
        spread = math.exp(min(half, 100.0))
        low, high = value / spread, value * spread
    else:
        low, high = value - half, value + half
    return (
        None if low is None or low <= bounds[0] else low,
        None if high is None or high >= bounds[1] else high,
    )


def _with_scale(value: float, ends: Interval, scale: float) -> Interval:
    """The interval of a gain that is as unsure, besides, as what the response was calibrated to; an end that is not
    known stays so. scale: standard uncertainty of that, as a share."""
    more = Z95 * scale * abs(value)
    low, high = ends
    return (
        None if low is None else value - math.hypot(value - low, more),
        None if high is None else value + math.hypot(high - value, more),
    )


def _parameter(value: float, unit: str, ends: tuple[float | None, float | None]) -> Parameter:
    return Parameter(value=value, unit=unit, low=ends[0], high=ends[1])
