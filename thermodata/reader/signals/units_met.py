"""The units that rows say while a file is read: the first look at it may not have met all that are converted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from thermodata.plugin import Block, Signal
from thermodata.reader.signals.interleaved import words_of
from thermodata.reader.signals.row_units import UNIT_OF, UnitColumn, converts_here
from thermodata.schema.units.unit import normal_unit


@dataclass(slots=True)
class UnitsMet:
    """What rows say of their unit while their blocks pass: the first look at a file may not have met all."""

    stream: str
    said: UnitColumn
    _converted: dict[str, None] = field(default_factory=dict)

    def add(self, block: Block) -> None:
        """The next rows of the file."""
        if block.stream != self.stream or self.said.column not in block.values:
            return
        for word in dict.fromkeys(words_of(self.said.column, block.values[self.said.column])):
            if word and normal_unit(word) != normal_unit(self.said.unit) and converts_here(word, self.said.unit):
                self._converted[word] = None

    def note(self, told: Sequence[str]) -> str | None:
        """What is told of units that were converted and are not told yet. told: the notes of the first look."""
        own = f"'{self.said.column}' says the unit of "
        before = [note for note in told if own in note]
        late = [word for word in self._converted if not any(f"'{word}'" in note for note in before)]
        return replace(self.said, others=tuple(late)).note()


def units_met(signals: Sequence[Signal]) -> list[UnitsMet]:
    """One for each column of units among the signals of a file."""
    unit_of = {(s.stream, s.name): s.unit for s in signals}
    found = [(s, of, unit_of.get((s.stream, of))) for s in signals if (of := (s.properties or {}).get(UNIT_OF))]
    return [UnitsMet(s.stream, UnitColumn(s.name, of, unit)) for s, of, unit in found if unit is not None]
