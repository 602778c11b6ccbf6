"""Units that messages say of their own fields, `{"value": 1.2, "unit": "mm"}`: taken, and rows in others converted."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from thermodata.reader.signals.header_words import UNIT_WORDS, VALUE_WORDS
from thermodata.reader.signals.interleaved import bare_header
from thermodata.reader.signals.row_units import UNIT_OF, UnitColumn
from thermodata.reader.text import split_unit
from thermodata.reader.text.names.header import looks_like_unit
from thermodata.reader.text.names.time_header import is_time_header
from thermodata.reader.text.names.unit_column import unit_column, unit_column_note
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.field_paths import Path, any_element
from thermodata_reader_mcap.encodings.topic import Leaf, Topic
from thermodata_reader_mcap.signals.several_senders import looked_at

_LOOKED_AT = 1000  # messages of a channel, in pieces
_PAIRED = re.compile(r"(?P<of>.+?)(?:_units?|Units?)")  # 'dZ_unit' of 'dZ'
_NO_READING = ("seq", "sec", "nsec", "nanosec", "id", "counter", "index", "quality", "status", "state")


@dataclass(frozen=True, slots=True)
class UnitsSaid:
    """topics: with the units that their messages say; columns: which fields say the units of others, message by
    message; notes: on units that can't be told."""

    topics: Mapping[str, Topic]
    columns: tuple[UnitColumn, ...]
    notes: tuple[str, ...]


def units_said(
    topics: Mapping[str, Topic],
    readers: Mapping[Channel, Decoder],
    batches: Mapping[Channel, Batch],
    kept: Collection[Path],
) -> UnitsSaid:
    """Of some topics. kept: paths of times, which are no readings."""
    made: dict[str, Topic] = {}
    columns: list[UnitColumn] = []
    notes: list[str] = []
    for name, topic in topics.items():
        own = {c: one for c, one in readers.items() if c.topic == name and c in batches}
        told, more = _units_of_topic(topic, batches, own, kept)
        made[name] = replace(topic, leaves=_with_units(topic.leaves, told))
        columns += told.values()
        notes += more
    return UnitsSaid(made, tuple(columns), tuple(notes))


def _units_of_topic(
    topic: Topic, batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder], kept: Collection[Path]
) -> tuple[dict[str, UnitColumn], list[str]]:
    """Of one topic: (field -> which says its unit, notes). Several units that don't convert into each other, or may be
    of several fields, are a note."""
    words = [leaf for leaf in topic.leaves if leaf.dtype == "str" and _says_unit(leaf)]
    told: dict[str, UnitColumn] = {}
    notes: list[str] = []
    if not words:
        return told, notes
    for leaf, seen in zip(words, looked_at(words, batches, made, _LOOKED_AT)[2], strict=True):
        numbers = _numbers_beside(leaf, words, topic.leaves, kept)
        alias = f"{topic.name}.unit"  # a pair is called after its number
        kinds: dict[str, str | None] = {**{n.name: n.dtype for n in numbers}, alias: "str"}
        said: dict[str, Sequence[str]] = {alias: [str(word or "") for word in seen]}
        found = unit_column(kinds, said)
        if found is not None:
            told[found.of] = UnitColumn(leaf.name, found.of, found.unit, found.others)
        more = told[found.of].note() if found else unit_column_note(kinds, said)
        if more:
            notes.append(more.replace(f"'{alias}'", f"'{leaf.name}'"))
    return told, notes


def _says_unit(leaf: Leaf) -> bool:
    last = leaf.path[-1] if leaf.path else 0
    return isinstance(last, str) and (bare_header(last) in UNIT_WORDS or _PAIRED.fullmatch(last) is not None)


def _numbers_beside(unit: Leaf, words: Sequence[Leaf], leaves: Sequence[Leaf], kept: Collection[Path]) -> list[Leaf]:
    """The numbers that a field of a unit may be of: the one that it is called after, the one called a value, or all
    beside it whose unit nothing else says."""
    beside = [
        leaf
        for leaf in leaves
        if leaf.path[:-1] == unit.path[:-1] and leaf.path not in kept and leaf.dtype not in ("str", "bool")
    ]
    paired = {found["of"] for word in words if (found := _PAIRED.fullmatch(str(word.path[-1])))}
    own = _PAIRED.fullmatch(str(unit.path[-1]))
    if own is not None and bare_header(str(unit.path[-1])) not in UNIT_WORDS:
        return [leaf for leaf in beside if leaf.path[-1] == own["of"]]
    values = [leaf for leaf in beside if str(leaf.path[-1]).casefold() in VALUE_WORDS]
    return values or [leaf for leaf in beside if leaf.path[-1] not in paired and _is_bare(leaf)]


def _is_bare(leaf: Leaf) -> bool:
    """Whether a field of numbers is a reading whose unit nobody says."""
    last = str(leaf.path[-1])
    named = split_unit(last)[1] or (end if looks_like_unit(end := last.rpartition("_")[2]) and end != last else None)
    return leaf.unit is None and named is None and not is_time_header(last) and last.casefold() not in _NO_READING


def _with_units(leaves: Sequence[Leaf], told: Mapping[str, UnitColumn]) -> tuple[Leaf, ...]:
    of = {said.column: name for name, said in told.items()}
    # what is converted is whole no more, with the elements of its array
    converted = {any_element(leaf.path) for leaf in leaves if leaf.name in told and told[leaf.name].others}
    made = []
    for leaf in leaves:
        if leaf.name in of:
            leaf = replace(leaf, properties=(*leaf.properties, (UNIT_OF, of[leaf.name])))
        elif leaf.name in told:
            leaf = replace(leaf, unit=told[leaf.name].unit)
        whole = leaf.dtype in ("int64", "uint64")
        made.append(replace(leaf, dtype="float64") if whole and any_element(leaf.path) in converted else leaf)
    return tuple(made)
