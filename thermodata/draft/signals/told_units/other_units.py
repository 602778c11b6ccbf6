"""A signal without a unit whose values in some files are as far from those in others as two units are apart."""

from __future__ import annotations

import math
from collections.abc import Mapping
from statistics import median

from thermodata.draft.signals.values import Values, least_reading
from thermodata.schema.words.sentences import with_count
from thermodata.store.ingest.told.channels.other_units import APART_K, NO_HALL_C, ZERO_K, fahrenheit_among

THOUSAND = (300.0, 3000.0)  # of how much the rows differ: um and mm, W and kW
_SHOWN = 3


def unit_question(
    quantity: str | None, seen: Mapping[str, Values | None], coldest: Mapping[str, float] | None = None
) -> str | None:
    """What to ask of a signal; None where its files go together. seen: file -> its values there; coldest: file -> of
    all temperatures without a unit there, where they are known."""
    known = {name: v for name, v in seen.items() if v is not None and v.n and not v.constant}
    if len(known) < 2:
        return None
    if quantity == "temperature":
        return _asked(_warmer(known), known, "K there, and degC in the others") or _asked(
            _in_fahrenheit(known, coldest or {}), known, "degF there, and degC in the others"
        )
    if quantity == "displacement":
        return _asked(_coarser(known), known, "another unit there (um, mm)")
    return None


def _warmer(known: Mapping[str, Values]) -> list[str]:
    least = min(v.median for v in known.values())
    return [name for name, v in known.items() if abs(v.median - least - ZERO_K) < APART_K]


def _in_fahrenheit(known: Mapping[str, Values], coldest: Mapping[str, float]) -> list[str]:
    """Those that may be in degrees Fahrenheit: a part that was warm before leaves the air around it as it is."""
    found = fahrenheit_among({name: least_reading(v) for name, v in known.items()})
    return [name for name in found if coldest.get(name, -math.inf) >= NO_HALL_C]


def _coarser(known: Mapping[str, Values]) -> list[str]:
    """Those whose rows differ a thousand times as much as, or as little as, the usual ones: noise stays the same."""
    steps = {name: v.step for name, v in known.items() if v.step > 0}
    usual = median(sorted(steps.values())) if steps else 0.0
    low, high = THOUSAND
    return [n for n, s in steps.items() if usual and (low < s / usual < high or low < usual / s < high)]


def _asked(some: list[str], known: Mapping[str, Values], what: str) -> str | None:
    others = [v for name, v in known.items() if name not in some]
    if not some or not others:
        return None
    shown = with_count(some, _SHOWN)
    return f"unit: in {shown} values {known[some[0]].span()}, else {others[0].span()}: {what}?"
