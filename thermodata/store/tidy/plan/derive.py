"""Channels that are computed from others: `derive: "(dY_high - dY_low) / 100 mm"`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from thermodata.plugin import Array, Float1D
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import canonical
from thermodata.store.tidy.plan.plan import Bound


@lru_cache(maxsize=512)
def _parsed_expression(text: str) -> Any:
    from thermodata.calibration.expression.parser import parse

    return parse(text, rates=True)


def names(text: str) -> frozenset[str]:
    """The channels that an expression uses."""
    found: frozenset[str] = _parsed_expression(text).names
    return found


def rated(text: str) -> frozenset[str]:
    """The channels among them whose rate it takes."""
    found: frozenset[str] = _parsed_expression(text).rated
    return found


def evaluate(bound: Bound, values: Mapping[str, Array], units: Mapping[str, str]) -> Float1D:
    """The derived values in the channel's canonical unit, shape (n,). values: also `rate_of` those that are rated."""
    target = canonical(bound.channel.quantity)
    own = bound.unit or target
    factor, offset = linear_conversion(own, target)
    derived: Float1D = _parsed_expression(bound.channel.derive or "").evaluate_in(values, units, own)
    return derived * factor + offset if (factor, offset) != (1.0, 0.0) else derived


def numbers(text: Array) -> Float1D:
    """Numbers out of a text column, shape (n,): decimal comma or point, on/off words; what is none becomes NaN."""
    words = {"true": 1.0, "false": 0.0, "on": 1.0, "off": 0.0, "active": 1.0, "ready": 0.0}

    def number(value: Any) -> float:
        if value is None:
            return np.nan
        bare = str(value).strip()
        try:
            return float(bare.replace(",", ".") if "." not in bare else bare)
        except ValueError:
            return words.get(bare.casefold(), np.nan)

    distinct = {v: number(v) for v in dict.fromkeys(text.tolist())}
    return np.fromiter((distinct[v] for v in text.tolist()), dtype=np.float64, count=len(text))
