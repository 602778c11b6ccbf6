"""A parsed expression, computed on values of channels, in the units that these have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.expression import nodes
from thermodata.calibration.expression.evaluation import Evaluation, Logic, Number, logic, number, rate_of
from thermodata.calibration.expression.nodes import Node
from thermodata.errors import UsageError
from thermodata.plugin import Array, Bool1D, Float1D
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import normal_unit


@dataclass(frozen=True, slots=True)
class Expression:
    """A parsed expression. names: the channels that it reads; rated: those among them whose rate it takes, which
    `values` hold by `rate_of` beside them. logical: whether it gives true or false."""

    text: str
    tree: Node
    names: frozenset[str]
    rated: frozenset[str] = frozenset()

    @property
    def logical(self) -> bool:
        return isinstance(self.tree, nodes.Comparison | nodes.Every | nodes.AnyOf | nodes.Not)

    def evaluate(self, values: Mapping[str, Array], units: Mapping[str, str] | None = None) -> Array:
        """Bool (a missing value is never true) or float64, in the unit that `unit` tells; in the shape of the values.

        units: channel -> unit. Without them, expressions with units in literals are refused (UsageError).
        """
        result = Evaluation(values, units or {}, self.text).of(self.tree)
        if isinstance(result, Logic):
            return self._in_shape_of(values, np.asarray(result.yes, dtype=bool))
        return self._in_shape_of(values, np.asarray(result.value, dtype=np.float64))

    def evaluate_bool(self, values: Mapping[str, Array], units: Mapping[str, str] | None = None) -> Bool1D:
        """As `evaluate`; a number counts as true where it is known and not 0."""
        result = logic(Evaluation(values, units or {}, self.text).of(self.tree))
        return self._in_shape_of(values, np.asarray(result.yes, dtype=bool))

    def evaluate_in(self, values: Mapping[str, Array], units: Mapping[str, str], target_unit: str) -> Float1D:
        """Float64 in `target_unit`: (dY_high - dY_low) / 100 mm, from um, in urad. UsageError where it can't be."""
        result = number(Evaluation(values, units, self.text).of(self.tree))
        factor, offset = 1.0, 0.0
        if not result.bare and result.unit is not None:
            factor, offset = self._conversion(result, target_unit)
        return self._in_shape_of(values, np.asarray(result.value, dtype=np.float64) * factor + offset)

    def unit(self, units: Mapping[str, str]) -> str | None:
        """The unit that `evaluate` gives with these units of the channels; "" for none, None for unknown."""
        keys = (*self.names, *map(rate_of, self.rated))
        result = number(Evaluation({key: np.zeros(1) for key in keys}, units, self.text).of(self.tree))
        return result.unit

    def _in_shape_of(self, values: Mapping[str, Array], result: Array) -> Array:
        """A result in the shape of the values that it is of: one of constants alone stands at each of them."""
        shape = np.broadcast_shapes(*(np.shape(values[n]) for n in self.names))
        return np.broadcast_to(result, shape).copy()

    def _conversion(self, result: Number, target: str) -> tuple[float, float]:
        """(factor, offset) from the unit of the result to that of the channel; UsageError where they don't convert."""
        unit = result.unit or "1"
        if (normal_unit(unit) == "degC") != (normal_unit(target) == "degC"):
            raise self._in_another(
                unit, target, "a difference of two temperatures is of quantity temperature_difference (K)"
            )
        try:
            return linear_conversion(unit, target)
        except UsageError as error:
            raise self._in_another(unit, target, "correct the expression or the channel's quantity") from error

    def _in_another(self, unit: str, target: str, hint: str) -> UsageError:
        return UsageError(
            f"the expression gives {unit}, the channel is in {target}",
            where=f"expression '{self.text}'",
            expected=target,
            got=unit,
            hint=hint,
        )
