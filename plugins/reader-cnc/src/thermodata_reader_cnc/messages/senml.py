"""Packs of SenML [RFC 8428]: an array of records, of which each says what it measured and some say what holds for those
behind them: the beginning of their names, times and values, and their unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal, InvalidOperation
from typing import Any

_BASES = frozenset({"bn", "bt", "bu", "bv", "bs", "bver"})
_OWN = frozenset({"n", "u", "v", "vs", "vb", "vd", "s", "t", "ut"})
_VALUES = ("v", "vb", "vs")
# below it a time is one before now, which a file does not know
_ABSOLUTE_S = Decimal(2**28)
_DIGITS = 300  # before or behind the point: what a float64 holds


def is_pack(records: Sequence[Any]) -> bool:
    """Whether all objects of a list have keys of SenML alone, with a value and a name or a beginning of one."""
    objects = [r for r in records if isinstance(r, dict)]
    keys = [{k for k in r if not k.endswith("_")} for r in objects]
    named = any("n" in some or "bn" in some for some in keys)
    valued = any(some & {*_VALUES, "s"} for some in keys)
    return named and valued and len(objects) == len(records) and all(some <= _BASES | _OWN for some in keys)


def resolved(records: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """A pack as objects with name, unit, value and time; of a time that is none of a calendar nothing."""
    base: dict[str, Any] = {}
    found = []
    for record in records:
        base |= {k: v for k, v in record.items() if k in _BASES}
        value = next((record[k] for k in _VALUES if k in record), None)
        if value is None and "bv" not in base:
            continue
        if "v" in record or value is None:
            value = _sum(base.get("bv"), record.get("v")) or value
        time = _sum(base.get("bt"), record.get("t"))
        found.append(
            {
                "name": f"{base.get('bn', '')}{record.get('n', '')}",
                "unit": record.get("u", base.get("bu", "")),
                "value": value,
                "time": time if time is not None and Decimal(time) >= _ABSOLUTE_S else "",
            }
        )
    return found


def _sum(base: Any, own: Any) -> str | None:
    """A base and what stands in the record, one of which may be missing; None where one of them is no finite number."""
    given = [each for each in (base, own) if each is not None]
    numbers = [n for each in given if (n := _number(each)) is not None]
    if not given or len(numbers) < len(given):
        return None
    return str(given[0]) if len(given) == 1 else str(sum(numbers))


def _number(said: Any) -> Decimal | None:
    """A log may say anything there: 'NaN', a list, an exponent that no computer holds."""
    try:
        number = Decimal(str(said))
    except InvalidOperation:
        return None
    return number if number.is_finite() and abs(number.adjusted()) < _DIGITS else None
