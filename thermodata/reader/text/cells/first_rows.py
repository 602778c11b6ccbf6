"""The first rows of a table under the names of its columns: what is looked at where nobody says what they hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from thermodata.reader.text.cells.cell import Cell


@dataclass(frozen=True, slots=True)
class FirstRows:
    """names, units: of each column; rows: of as many cells; where: the file, for messages."""

    names: Sequence[str]
    units: Sequence[str | None]
    rows: Sequence[Sequence[Cell]]
    where: str

    def column(self, place: int) -> list[Cell]:
        """The cells of a column."""
        return [row[place] for row in self.rows]

    def of(self, places: Sequence[int]) -> FirstRows:
        """The same rows with some of their columns, in that order."""
        names, units = [self.names[i] for i in places], [self.units[i] for i in places]
        return replace(self, names=names, units=units, rows=[[row[i] for i in places] for row in self.rows])

    def with_rows(self, rows: Sequence[Sequence[Cell]]) -> FirstRows:
        """Other rows of the same columns."""
        return replace(self, rows=rows)
