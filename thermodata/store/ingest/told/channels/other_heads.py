"""Heads of files that say another unit in some tests than in others, of one channel that is read in one unit."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.plugin import Signal
from thermodata.reader.text.preamble.units_said import HEAD, units_in
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.sentences import with_count
from thermodata.store.ingest.known.left_alone import TestNote
from thermodata.store.ingest.told.losses import Losses, loss_row

_SHOWN = 3


def head_of(signal: Signal | None) -> str | None:
    """What the head of a file says of the unit of a signal that has none beside."""
    return None if signal is None or signal.unit is not None else signal.properties.get(HEAD)


def other_heads(tests: Mapping[str, TestNote]) -> Losses:
    """A loss for each channel whose tests are read in one unit while their files' heads name different ones."""
    said: dict[tuple[str, str], dict[frozenset[str], tuple[str, list[str]]]] = {}
    for test, note in tests.items():
        for name, (unit, head) in note.heads.items():
            if units := frozenset(u for u in units_in(head) if converts(u, unit)):
                said.setdefault((name, normal_unit(unit)), {}).setdefault(units, (head, []))[1].append(test)
    return [
        loss_row(
            f"{name}: read in {unit} throughout, and the heads of its files differ: "
            + ", ".join(f"'{head}' in {with_count(names, _SHOWN)}" for head, names in heads.values())
            + f"; try: channels: {{{name}: {{unit: ...}}}} under the tests that are in another unit"
        )
        for (name, unit), heads in said.items()
        if len(heads) > 1
    ]
