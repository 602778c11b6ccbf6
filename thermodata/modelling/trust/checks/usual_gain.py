"""What gains are usual: of an effect, as it says itself; of one that names no physics, as all in that unit do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from thermodata.effect.registry import all_effects
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.parameters import gain_unit
from thermodata.modelling.trust.checks.at_reference import WHOLE, Reached
from thermodata.plugin import Gain


@dataclass(frozen=True, slots=True)
class Usual:
    """Sizes of a gain in `unit`. whose: of what they are known."""

    smallest: float
    largest: float
    unit: str
    whose: str

    def said(self, value: float, ends: tuple[float | None, float | None] = (None, None), there: Reached = WHOLE) -> str:
        """Of a gain that is larger: how much, and what is usual. ends: of its interval; where usual sizes lie within,
        the tests do not know the gain, and the value says nothing against the effect. there: what of it this machine
        reaches."""
        low, high = ends
        left_open = ""
        largest = self.largest / there.share
        if low is not None and high is not None and low <= largest and high >= -largest:
            left_open = (
                f"; these tests leave it open ({low:.3g} to {high:.3g} {self.unit}, 95 %), usual sizes among them, so "
                "the value speaks neither for the effect nor against it"
            )
        size = f"{_number(value)} {self.unit}"
        if there.at:
            size += f", which is {_number(value * there.share)} {self.unit} at the {there.at} that were logged,"
        sizes = f"{self.smallest:g} to {self.largest:g}" if self.smallest > 0 else f"up to {self.largest:g}"
        return (
            f"{size} is larger than anything known for {self.whose} ({sizes} {self.unit}): it may "
            f"stand in for another effect, or its driver may have another unit{left_open}"
        )


def _number(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def usual_gain(response: FittedResponse, term: FittedTerm, gain: Gain) -> Usual | None:
    """None where nothing is known: of another response than a displacement, or of a unit that no effect has a gain
    in."""
    unit = gain_unit(response, term, gain.unit)
    if gain.unit.endswith("/u"):
        return _known_in(unit)
    # an effect with a gain a kelvin may be driven by a speed, where nothing is a kelvin
    if unit != gain.unit or not 0 < gain.magnitude[1] < math.inf:
        return None
    return Usual(*gain.magnitude, unit, f"'{term.effect.name}'")


@lru_cache(maxsize=64)
def _known_in(unit: str) -> Usual | None:
    sizes = [
        g.magnitude
        for effect in all_effects().values()
        for g in effect.gains
        if g.unit == unit and "/" in unit and 0 < g.magnitude[1] < math.inf
    ]
    if not sizes:
        return None
    smallest = min((low for low, _ in sizes if low > 0), default=0.0)
    return Usual(smallest, max(high for _, high in sizes), unit, f"any effect with a gain in {unit}")
