"""The rows above the data of a table with the first rows below them, as all that judge its header are handed them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.reader.text.cells.cell import Cell


@dataclass(frozen=True, slots=True)
class Head:
    """above: the rows before the data, as `line_up` left them; below: rows of the data; width: columns of the table;
    row_of_units: its place in `above` where it is declared or called so, else None; skip: lines before `above`;
    between: what parts the cells of a text, as messages show it, None where the header is not held against the rows (no
    text, or only whose file it is); where: the file."""

    above: Sequence[Sequence[Cell]]
    below: Sequence[Sequence[Cell]]
    width: int
    row_of_units: int | None
    skip: int
    between: str | None
    where: str

    @property
    def ends(self) -> int:
        """The line of the file in which the last row before the data stands."""
        return self.skip + len(self.above)

    @property
    def named_anew(self) -> str:
        """What declares a name for each column in place of the header."""
        return f"table: {{skip_rows: {self.ends}, header_rows: 0, names: [...]}} with a name for each column"

    def line(self, row: int) -> int:
        """In which line of the file a row of `above` stands, from 1."""
        return self.skip + row + 1
