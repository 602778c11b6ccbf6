"""Whether a driver that the model names is of the quantity that its effect needs: by it the gain has its unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.calibration.expression.expression import Expression
from thermodata.calibration.expression.parser import parse
from thermodata.effect.binding import ANY
from thermodata.errors import SpecError, UsageError
from thermodata.plugin import Effect, Need
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import CANONICAL_UNIT, canonical
from thermodata.view.grid.dataset import ChannelInfo

_ALIKE = (frozenset({"temperature", "temperature_difference"}),)  # a driver counts from its start


@dataclass(frozen=True, slots=True)
class _Kind:
    """quantity: None where an expression's unit alone tells what it is; unit: None where it is not known."""

    quantity: str | None
    unit: str | None

    def __str__(self) -> str:
        return f"of quantity {self.quantity}" if self.quantity is not None else f"in {self.unit or 'no unit'}"

    def is_a(self, quantity: str) -> bool:
        if self.quantity is not None:
            return self.quantity == quantity or any({self.quantity, quantity} <= some for some in _ALIKE)
        return self.unit is None or quantity not in CANONICAL_UNIT or _same_unit(self.unit, canonical(quantity))


def refuse_another_quantity(
    effect: Effect, need: Need, text: str, channels: Mapping[str, ChannelInfo], where: str
) -> None:
    """SpecError where the channel or expression `text` is none of what the role needs. channels: holds its names."""
    if need.quantity == ANY:
        return
    kind = _kind(text, channels)
    if kind.is_a(need.quantity):
        return
    fitting = [n for n, info in channels.items() if _Kind(info.quantity, info.unit).is_a(need.quantity)]
    other = next((n.role for n in effect.needs if n.role != need.role and kind.is_a(n.quantity)), None)
    raise SpecError(
        f"'{effect.name}' needs a {need.quantity} as its {need.role}, and '{text}' is {kind}",
        where=f"{where}: drivers.{need.role}",
        expected=f"a {need.quantity}: {', '.join(fitting) or 'no channel is one'}",
        got=text,
        hint=f"drivers: {{{other}: {text}}}"
        if other is not None
        else f"an effect that takes any quantity: {{effect: lag, drivers: {{u: {text}}}}}",
    )


def _kind(text: str, channels: Mapping[str, ChannelInfo]) -> _Kind:
    if text in channels:
        return _Kind(channels[text].quantity, channels[text].unit)
    tree = parse(text)
    if tree.logical:
        return _Kind("state", "1")
    unit = _unit(tree, channels)
    quantities = {channels[name].quantity for name in tree.names}
    if len(quantities) == 1 and unit is not None:
        (quantity,) = quantities
        if quantity in CANONICAL_UNIT and _same_unit(unit, canonical(quantity)):
            return _Kind(quantity, unit)
    return _Kind(None, unit)


def _unit(tree: Expression, channels: Mapping[str, ChannelInfo]) -> str | None:
    return tree.unit({name: channels[name].unit for name in tree.names})


def _same_unit(unit: str, wanted: str) -> bool:
    """Whether numbers in `unit` are numbers in `wanted`, but for where zero is."""
    try:
        factor, _ = linear_conversion(unit or "1", wanted)
    except UsageError:
        return False
    return abs(factor - 1.0) < 1e-9
