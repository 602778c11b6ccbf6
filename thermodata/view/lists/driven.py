"""What an effect of a model stands for, as pages say it: its id with what drives it, and the part that this reads."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.store.base.connection import fetch

if TYPE_CHECKING:
    from thermodata.store import Store


@dataclass(frozen=True, slots=True)
class _Channel:
    quantity: str
    at: str | None


def effects_driven(store: Store, models: Sequence[str]) -> dict[str, str]:
    """Id of an effect -> 'lag_2 (T_mot at spindle.motor)'; ' or ' between what the models drive it by. models: ids. An
    effect that is driven by other channels in each campaign, or is not installed, has its id alone."""
    found: dict[str, dict[str, None]] = {}
    with store.reader() as con:
        for row in fetch(con, "select spec, campaigns from model where list_contains(?, model)", [list(models)]):
            told = 'select channel, quantity, "at" from channel where list_contains(?, campaign) order by rowid desc'
            channels = {c["channel"]: _Channel(c["quantity"], c["at"]) for c in fetch(con, told, [row["campaigns"]])}
            places = {name: channel.at for name, channel in channels.items()}
            effects = json.loads(row["spec"]).get("effects", [])
            for name, effect in zip(ids_of((e["effect"], e.get("id")) for e in effects), effects, strict=True):
                said = driven(name, _drivers(effect, channels), places)
                found.setdefault(name, {})[said.removeprefix(name).strip()[1:-1]] = None
    each = {name: " or ".join(filter(None, said)) for name, said in found.items()}
    return {name: f"{name} ({said})" if said else name for name, said in each.items()}


def _drivers(effect: dict[str, Any], channels: Mapping[str, _Channel]) -> list[str]:
    """As the model file says, and where it leaves them out, what fits by quantity and place, as the fit took it."""
    given = effect.get("drivers", {}).values()
    if given:
        return [driver if isinstance(driver, str) else _there(str(driver.get("at", "")), channels) for driver in given]
    from thermodata.effect import effects  # the library: a model whose drivers stand in it is told without
    from thermodata.effect.binding import unnamed

    known = effects().get(effect["effect"])
    fits = unnamed(known, channels) if known and known.needs else []
    return list(fits[0].values()) if len(fits) == 1 else []


def _there(place: str, channels: Mapping[str, _Channel]) -> str:
    """The channel at a place, or the place where none or several are."""
    there = [name for name, channel in channels.items() if channel.at == place]
    return there[0] if len(there) == 1 else place


def driven(name: str, drivers: Iterable[str], places: Mapping[str, str | None]) -> str:
    """'lag_2 (T_mot at spindle.motor)'; 'spindle_bearing (T_brg)', which says its part itself; the name alone where it
    has no drivers. places: channel -> where it sits, as far as that is known."""
    said = [_at(one, places.get(one), name) for one in dict.fromkeys(drivers)]
    return f"{name} ({', '.join(said)})" if said else name


def _at(driver: str, place: str | None, name: str) -> str:
    """With its place where neither the effect nor the channel says a word of it."""
    words = set(re.findall(r"[a-z]+", place.lower())) if place else set()
    told = set(re.findall(r"[a-z]+", f"{name} {driver}".lower().replace("_", " ")))
    return f"{driver} at {place}" if place and not words & told else driver
