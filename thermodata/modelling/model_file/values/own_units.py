"""Values of a model file that carry a unit of their own."""

from __future__ import annotations

from thermodata.errors import SpecError, UsageError
from thermodata.plugin import Effect
from thermodata.schema.files.model import EffectSpec
from thermodata.schema.strict.printed import WithUnit
from thermodata.schema.units.unit import difference_unit
from thermodata.schema.units.value import value_in


def in_own_units(
    spec: EffectSpec, effect: Effect, where: str, driver: str | None = None, response: str | None = None
) -> EffectSpec:
    """What is fixed, started or bounded with a unit, in the effect's own. driver, response: units of what a gain 'um/u'
    is of, where they are known. SpecError for a unit of another kind."""
    units = {p.name: p.unit for p in effect.params} | {g.name: g.unit for g in effect.gains}
    units |= getattr(effect, "constants", {})
    if driver is not None and response is not None:
        of_both = f"{difference_unit(response)}/{difference_unit(driver)}"
        units |= {g.name: of_both for g in effect.gains if g.unit == "um/u"}

    def own(name: str, value: float) -> float:
        return in_unit(name, value, units.get(name, "1"), where)

    return spec.model_copy(
        update={
            "fixed": {n: own(n, v) for n, v in spec.fixed.items()},
            "start": {n: own(n, v) for n, v in spec.start.items()},
            "bounds": {n: (own(n, low), own(n, high)) for n, (low, high) in spec.bounds.items()},
        }
    )


def in_unit(name: str, value: float, unit: str, where: str | None) -> float:
    """A value of a model file in this unit; SpecError where its own is of another kind."""
    if not isinstance(value, WithUnit):
        return value
    try:
        return value_in(value.text, unit)
    except UsageError as error:
        raise SpecError(
            f"'{name}' has another unit",
            where=where,
            expected=f"{unit}, or what converts to it",
            got=value.text,
            hint="leave the unit out, which means the parameter's own, or correct it",
        ) from error
