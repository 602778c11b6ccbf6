"""Units that the channels of a topic declare, each for its own messages: in a JSON Schema, or in their metadata. A
sender that was started anew may send in other ones."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.reader.signals.row_units import converts_here
from thermodata.reader.signals.unit_words import is_surely_unit
from thermodata.reader.text import split_unit
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import normal_unit
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.encodings.columns import MISSING, Columns, Wrong
from thermodata_reader_mcap.encodings.decoder import Decoder, hints
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.topic import Hint, Topic

_KEY = re.compile(r"(?:units?[._/: -]+(?P<behind>.+)|(?P<before>.+?)[._/: -]+units?)", re.IGNORECASE)
_IN = re.compile(r"\S\s+in\s+(\S+?)\.?$")  # 'temperature in degC'
_ALONE = re.compile(r"units?", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class OtherUnit:
    """A field that a channel sends in another unit: value * factor + offset; None where it does not convert."""

    name: str
    unit: str
    wanted: str
    line: tuple[float, float] | None


@dataclass(slots=True)
class UnitsOfChannels:
    """The unit of each field of numbers of each topic; what the channels send in others."""

    units: dict[str, dict[str, str]] = field(default_factory=dict)
    _known: dict[Channel, tuple[OtherUnit, ...]] = field(default_factory=dict)

    def settle(self, topic: Topic, made: Mapping[Channel, Decoder]) -> Topic:
        """The topic with the units that its channels declare: of several, the first one's."""
        own = self.units.setdefault(topic.name, {})
        for channel, one in made.items():
            for name, unit in _declared_units(channel, one, topic).items():
                own.setdefault(name, unit)
        floats = {o.name for c, one in made.items() for o in self.others(c, one, topic)}
        leaves = [replace(leaf, unit=leaf.unit or own.get(leaf.name)) for leaf in topic.leaves]
        return replace(topic, leaves=tuple(replace(x, dtype="float64") if x.name in floats else x for x in leaves))

    def others(self, channel: Channel, one: Decoder, topic: Topic) -> tuple[OtherUnit, ...]:
        """What a channel sends in another unit than the first one that declared it."""
        known = self._known.get(channel)
        if known is None:
            own = self.units.get(topic.name, {})
            found = _declared_units(channel, one, topic) if own else {}
            pairs = [(n, u, own[n]) for n, u in found.items() if n in own and normal_unit(u) != normal_unit(own[n])]
            known = self._known[channel] = tuple(
                OtherUnit(n, u, w, linear_conversion(u, w) if converts_here(u, w) else None) for n, u, w in pairs
            )
        return known

    def leave(self, fields: Collection[str]) -> None:
        """Takes no unit for fields that messages say the unit of: they know better what they hold."""
        for own in self.units.values():
            for name in fields:
                own.pop(name, None)
        self._known.clear()

    def note(self, topic: Topic, made: Mapping[Channel, Decoder]) -> str | None:
        """What is told of channels that send in several units."""
        others = dict.fromkeys(o for c, one in made.items() for o in self.others(c, one, topic) if o.line)
        said = ", ".join(f"{o.name} in '{o.unit}' is converted to '{o.wanted}'" for o in others)
        return f"topic '{topic.name}' comes in several units: {said}" if said else None


def in_units_of_topic(part: Columns, others: tuple[OtherUnit, ...]) -> Columns:
    """Columns of one channel with what it sends in other units converted; what does not convert is no reading."""
    for other in others:
        values = part.values.get(other.name)
        if values is None or not values.size:
            continue
        if other.line is not None and values.dtype.kind == "f":
            part.values[other.name] = values * other.line[0] + other.line[1]
            continue
        part.values[other.name] = np.full(values.shape, np.nan if values.dtype.kind == "f" else 0, values.dtype)
        part.flags[other.name] = np.full(values.shape, MISSING, np.uint16)
        part.wrong.append(Wrong(0, other.name, f"values in '{other.wanted}'", f"such in '{other.unit}'"))
    return part


def _declared_units(channel: Channel, one: Decoder, topic: Topic) -> dict[str, str]:
    """Field -> its unit by the channel's schema, or by its metadata."""
    numbers = [leaf for leaf in topic.leaves if leaf.dtype not in ("str", "bool")]
    told = hints(one)
    found: dict[str, str] = {}
    for key, text in channel.metadata:
        match = _KEY.fullmatch(key)
        name = (match["behind"] or match["before"]).casefold() if match is not None else None
        alone = _ALONE.fullmatch(key) is not None and len(numbers) == 1
        for leaf in numbers if is_surely_unit(text.strip()) else ():
            if alone or (name is not None and name in _spellings(leaf.path)):
                found[leaf.name] = text.strip()
    for leaf in numbers:
        unit = _of_schema(told(leaf.path))
        if unit is not None:
            found.setdefault(leaf.name, unit)
    return found


def _of_schema(hint: Hint | None) -> str | None:
    """The unit that a schema says of a field, or that is its description, or stands at its end."""
    if hint is None or hint.unit:
        return None if hint is None else hint.unit
    said = dict(hint.properties).get("description", "").strip()
    behind = _IN.search(said)
    unit = split_unit(said)[1] or (behind[1] if behind else said)
    return unit if len(unit) > 1 and is_surely_unit(unit) else None


def _spellings(path: Path) -> tuple[str, ...]:
    names = [str(part).casefold() for part in path]
    return (names[-1], ".".join(names), "/".join(names)) if names else ()
