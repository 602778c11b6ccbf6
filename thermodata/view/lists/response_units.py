"""The units in which a model's responses are told, and which of them have an error together."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from thermodata.schema.units.unit import difference_unit

if TYPE_CHECKING:
    from thermodata.store import Store

_UNITS = """select distinct channel, unit from channel
where list_contains($names, channel) and ($campaigns is null or list_contains($campaigns, campaign)) order by all"""


def measured_units(store: Store, names: Sequence[str], campaigns: Collection[str] | None) -> dict[str, str]:
    """channel -> its unit, of those that the campaigns (None: any) have."""
    given = {"names": list(names), "campaigns": None if campaigns is None else list(campaigns)}
    with store.reader() as con:
        found = con.execute(_UNITS, given).fetchall()
    units = {str(name): str(unit) for name, unit in found}
    return {name: units[name] for name in names if name in units}


def response_units(store: Store, names: Sequence[str], campaigns: Collection[str] | None = None) -> dict[str, str]:
    """response -> unit of its errors, of those that the campaigns (None: any) have."""
    return {name: difference_unit(unit) for name, unit in measured_units(store, names, campaigns).items()}


def told_together(names: Sequence[str], units: Mapping[str, str]) -> list[str]:
    """The responses whose errors are one error: those in the unit of the first."""
    return [name for name in names if units.get(name) == units.get(names[0])]


def unit_of(store: Store, response: str | None, campaigns: Collection[str] | None = None) -> str:
    """Of one response's errors; um where none is named, or it is not known."""
    return "um" if response is None else response_units(store, [response], campaigns).get(response, "um")
