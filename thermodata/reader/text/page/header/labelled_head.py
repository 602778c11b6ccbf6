"""A head whose rows are labelled in a column that the data leave empty: 'TraceName;X;Y', 'Range;500;500', above
';0,12;0,08'. Labels say which row names and which gives units; all others are settings."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import Cell, is_number, is_stamp
from thermodata.reader.text.names.header_rows import texts_of
from thermodata.reader.text.names.units_row import are_units

_BLANK = 0.9  # of the rows of data
_FEWEST_SETTINGS = 2
_UNITS = re.compile(r"(?i)[vy]?[ _-]?(?:units?|einheit(?:en)?|jednotk[ay]|unité|unità|unidad|単位|单位)")


def labelled_head(
    above: Sequence[Sequence[Cell]], below: Sequence[Sequence[Cell]], width: int
) -> tuple[list[list[Cell]], str | None]:
    """(the rows above the data, those of settings without their cells, the note on them); as they are, and None, where
    they are no such head."""
    rows = [texts_of(r) for r in above]
    labelled = [i for i, r in enumerate(rows) if len(r) == width and r[0][:1].isalpha() and all(r)]
    settings = [i for i in labelled if all(is_number(c) or is_stamp(c) for c in rows[i][1:])]
    blank = sum(not r or r[0] in ("", None) for r in below)
    named = next((i for i in labelled if _names(rows[i][1:])), None)
    if blank < _BLANK * len(below) or len(settings) < _FEWEST_SETTINGS or named is None:
        return [list(r) for r in above], None
    units = next((i for i in labelled if i != named and _UNITS.fullmatch(rows[i][0].strip(" :"))), None)
    kept: list[list[Cell]] = [list(rows[i]) if i == named else ["" for _ in r] for i, r in enumerate(above)]
    if units is not None:
        kept[max(units, named)], kept[min(units, named)] = ["", *rows[units][1:]], list(rows[named])
    called = ", ".join(f"'{rows[i][0]}'" for i in settings)
    return kept, f"rows of settings above the data are not read: {called}"


def _names(cells: Sequence[str]) -> bool:
    return (
        len(set(cells)) == len(cells) and not any(is_number(c) or is_stamp(c) for c in cells) and not are_units(cells)
    )
