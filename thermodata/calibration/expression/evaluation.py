"""Evaluates an expression's tree with units, and with unknown where a value is missing.

Units: a bare number takes the unit of what it meets; a literal with a unit is converted. Temperatures:
degC - degC is a difference in K, degC +- K is degC, degC + degC stays degC (for means).
Missing: a comparison with NaN is neither true nor false, and stays so through and, or, not (Kleene).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.calibration.expression.nodes import (
    Absolute,
    AnyOf,
    Arithmetic,
    Comparison,
    Constant,
    Every,
    Name,
    Negative,
    Node,
    Not,
    Rate,
)
from thermodata.errors import UsageError, nearest
from thermodata.plugin import Array
from thermodata.schema.agreed.comparators import COMPARE, Comparator
from thermodata.schema.units.conversion import delta_factor, linear_conversion
from thermodata.schema.units.unit import compound_unit, normal_unit

_OFFSET_UNITS = ("degC", "degF")


@dataclass(frozen=True, slots=True)
class Number:
    """unit: "" dimensionless, None unknown. bare: from literals without a unit only. label: for messages.
    literal: one number written in the expression."""

    value: Any
    unit: str | None
    bare: bool
    label: str
    literal: bool = False


@dataclass(frozen=True, slots=True)
class Logic:
    """Where it is known to be true, and where it is known to be false."""

    yes: Any
    no: Any


Value = Number | Logic


def rate_of(name: str) -> str:
    """The key by which `Evaluation.values` holds the rate of a channel, in its unit by the second."""
    return f"rate({name})"


class Evaluation:
    """One walk over a tree. Raises UsageError for a missing name or units that don't fit."""

    def __init__(self, values: Mapping[str, Array], units: Mapping[str, str], text: str) -> None:
        self.values, self.units, self.text = values, units, text

    def of(self, node: Node) -> Value:
        match node:
            case Constant(value, unit):
                return Number(value, unit, not unit, f"{value:g} {unit}".strip(), True)
            case Name(name):
                return self._name(name)
            case Negative(of):
                a = number(self.of(of))
                return Number(-a.value, a.unit, a.bare, f"-{a.label}", a.literal)
            case Absolute(of):
                a = number(self.of(of))
                return Number(np.abs(a.value), a.unit, a.bare, a.label)
            case Rate(name):
                return self._rate(name)
            case Arithmetic("+" | "-" as operator, left, right):
                return self._sum(operator, number(self.of(left)), number(self.of(right)))
            case Arithmetic(operator, left, right):
                return self._product(operator, number(self.of(left)), number(self.of(right)))
            case Comparison(operands, operators):
                parts = [number(self.of(o)) for o in operands]
                pairs = zip(parts[:-1], operators, parts[1:], strict=True)
                return _all_of([self._compare(a, op, b) for a, op, b in pairs])
            case Every(of):
                return _all_of([logic(self.of(o)) for o in of])
            case AnyOf(of):
                parts_ = [logic(self.of(o)) for o in of]
                return _negated(_all_of([_negated(p) for p in parts_]))
            case Not(of):
                return _negated(logic(self.of(of)))
        raise AssertionError(f"unknown node {node!r}")

    def _refusal(self, what: str, expected: str, got: str, hint: str | None = None) -> UsageError:
        return UsageError(what, where=f"expression '{self.text}'", expected=expected, got=got, hint=hint)

    def _name(self, name: str) -> Number:
        if name not in self.values:
            close = nearest(name, list(self.values))
            raise self._refusal(
                f"no channel '{name}'",
                ", ".join(sorted(self.values)) or "nothing: there is none",
                name,
                f"did you mean '{close}'?" if close else None,
            )
        value = np.asarray(self.values[name])
        if value.dtype.kind not in "biuf":
            raise self._refusal(
                f"channel '{name}' is text",
                "numbers",
                str(value.dtype),
                "labels can't be compared; make it a channel of quantity 'state'",
            )
        unit = self.units.get(name)
        if unit is not None and normal_unit(unit) == "dimensionless":
            unit = ""
        return Number(value.astype(np.float64, copy=False), unit, False, name)

    def _rate(self, name: str) -> Number:
        of, label = self._name(name), rate_of(name)
        return Number(np.asarray(self.values[label]), compound_unit(of.unit or "", "/", "s"), False, label)

    def _right_in_left(self, a: Number, b: Number, difference: bool) -> tuple[Any, Any, str | None, bool]:
        """(a, b) as numbers of one unit, that unit, and whether both are bare."""
        if a.bare or b.bare:
            return a.value, b.value, (b if a.bare else a).unit, a.bare and b.bare
        if a.unit is None and b.unit is None:
            return a.value, b.value, None, False
        if a.unit is None or b.unit is None:
            unknown, known = (a, b) if a.unit is None else (b, a)
            raise self._refusal(
                f"no unit is known of '{unknown.label}'",
                f"one that converts to {known.unit or '1'}",
                "no unit",
                "declare the channel's unit, or leave the unit of the number away",
            )
        if a.unit == b.unit:
            return a.value, b.value, a.unit, False
        try:
            if difference:
                return a.value, b.value * delta_factor(b.unit or "1", a.unit or "1"), a.unit, False
            factor, offset = linear_conversion(b.unit or "1", a.unit or "1")
        except UsageError as error:
            raise self._refusal(
                f"'{a.label}' and '{b.label}' have units that don't fit", a.unit or "no unit", b.unit or "no unit"
            ) from error
        return a.value, b.value * factor + offset, a.unit, False

    def _sum(self, operator: str, a: Number, b: Number) -> Number:
        sign = 1.0 if operator == "+" else -1.0
        label = f"{a.label} {operator} {b.label}"
        if _is_offset(b) and b.literal and a.unit == "K":
            b = _as_difference(b)  # (T_nut - T_amb) - 1 degC
        a_abs, b_abs = _is_offset(a), _is_offset(b)
        if b_abs and not a_abs and not a.bare and a.unit is not None:
            if operator == "-":
                raise self._refusal("a temperature subtracted from a difference", "degC - K or degC - degC", label)
            a, b, a_abs, b_abs = b, a, True, False
        x, y, unit, bare = self._right_in_left(a, b, difference=a_abs and not b_abs)
        value = x + sign * y
        if operator == "-" and a_abs and b_abs and unit is not None:
            return Number(value * delta_factor(unit, "K"), "K", False, label)
        return Number(value, unit, bare, label)

    def _product(self, operator: str, a: Number, b: Number) -> Number:
        label = f"{a.label} {operator} {b.label}"
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            value = a.value * b.value if operator == "*" else np.true_divide(a.value, b.value)
        value = np.where(np.isfinite(value), value, np.nan)  # x / 0 is a missing value
        if a.bare and b.bare:
            return Number(value, "", True, label)
        a_unit, b_unit = "" if a.bare else a.unit, "" if b.bare else b.unit
        if a_unit is None or b_unit is None:
            with_unit = next((n for n in (a, b) if n.unit and not n.bare), None)
            if with_unit is not None:
                unknown = a if a_unit is None else b
                raise self._refusal(
                    f"no unit is known of '{unknown.label}'",
                    f"a unit, beside '{with_unit.label}' in {with_unit.unit}",
                    "no unit",
                    "declare the channel's unit",
                )
            return Number(value, None, False, label)
        if not b_unit:
            return Number(value, a_unit, False, label)
        if not a_unit and operator == "*":
            return Number(value, b_unit, False, label)
        return Number(value, compound_unit(a_unit, "*" if operator == "*" else "/", b_unit), False, label)

    def _compare(self, a: Number, operator: Comparator, b: Number) -> Logic:
        a_abs, b_abs = _is_offset(a), _is_offset(b)
        if "K" in (a.unit, b.unit) and a_abs != b_abs and not (a.bare or b.bare):
            # 1 degC against a difference is 1 K; 293 K against a temperature is 19.85 degC
            a, b = (_as_difference(x) if _is_offset(x) and x.literal else x for x in (a, b))
            if not (a.literal or b.literal):
                raise self._refusal(
                    "a temperature compared with a difference",
                    "both of a kind",
                    f"'{a.label}' in {a.unit} and '{b.label}' in {b.unit}",
                )
        x, y, _, _ = self._right_in_left(a, b, difference=False)
        known = ~(np.isnan(x) | np.isnan(y))
        holds = np.asarray(COMPARE[operator](x, y))
        return Logic(holds & known, ~holds & known)


def number(value: Value) -> Number:
    """A truth value counts as 1 or 0, so that '(n > 0) * P' works."""
    if isinstance(value, Number):
        return value
    return Number(np.where(value.yes, 1.0, np.where(value.no, 0.0, np.nan)), "", False, "a comparison")


def logic(value: Value) -> Logic:
    """A number is true where it is not 0: states are channels of 0 and 1."""
    if isinstance(value, Logic):
        return value
    known = ~np.isnan(value.value)
    return Logic(known & (value.value != 0), known & (value.value == 0))


def _is_offset(a: Number) -> bool:
    return not a.bare and a.unit is not None and normal_unit(a.unit) in _OFFSET_UNITS


def _as_difference(a: Number) -> Number:
    return Number(a.value * delta_factor(a.unit or "K", "K"), "K", a.bare, a.label, a.literal)


def _negated(a: Logic) -> Logic:
    return Logic(a.no, a.yes)


def _all_of(parts: list[Logic]) -> Logic:
    yes, no = parts[0].yes, parts[0].no
    for part in parts[1:]:
        yes, no = yes & part.yes, no | part.no
    return Logic(yes, no)
