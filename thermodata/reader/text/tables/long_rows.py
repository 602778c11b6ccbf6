"""Long tables: each row names what it measures, beside its value and often its unit. Read as a wide table, degrees and
micrometres would stand in one channel."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import FormatError
from thermodata.reader.header_words import NAME_WORDS, VALUE_WORDS
from thermodata.reader.text.cells.number import is_number
from thermodata.reader.text.cells.quotes import clean
from thermodata.schema.listed import with_dots

_FEWEST_ROWS = 10
_MOST_NAMES = 200  # that one column may hold
_SHARED = 0.6  # of the rows: no more times than this, where each is told of several names


_HINT = (
    "with a column of dates and times, and columns called tag and value, the reader cnc takes it apart; else "
    "pivot it: a column a name"
)


def name_column(names: Sequence[str]) -> int | None:
    """The column that names what another one holds the value of, by the header of both; None where none does."""
    bare = [re.sub(r"[\s_.#()-]", "", name).casefold() for name in names]
    tag = next((i for i, n in enumerate(bare) if n in NAME_WORDS), None)
    return tag if any(n in VALUE_WORDS for n in bare) else None


def refuse_long(
    names: Sequence[str],
    rows: Sequence[Sequence[str]],
    where: str,
    times: Sequence[int] = (),
) -> None:
    """FormatError for a table in which a column names what another one holds the value of: by its header, where that
    column has several names, or by its rows, where each time comes once for each of several names."""
    tag = name_column(names)
    if tag is None:
        tag = next((i for i in range(len(names)) if i not in times and _names_rows(rows, i, times)), None)
    if tag is None:
        return
    said = dict.fromkeys(clean(row[tag]) for row in rows if len(row) > tag)
    said.pop("", None)
    if len(said) < 2:
        return
    raise FormatError(
        "a long table: each row names what it measures",
        where=where,
        expected="a column a signal",
        got=f"'{names[tag]}' holds " + with_dots(said, 4),
        hint=_HINT,
    )


def _names_rows(rows: Sequence[Sequence[str]], column: int, times: Sequence[int]) -> bool:
    """Whether a column of words tells apart the rows that share their times, each of which comes for several words."""
    if not times or len(rows) < _FEWEST_ROWS:
        return False
    words = [row[column] for row in rows]
    if not 1 < len(set(words)) <= min(_MOST_NAMES, len(words) // 3) or any(map(is_number, words)) or not all(words):
        return False
    stamps = [tuple(row[k] for k in times) for row in rows]
    return len(set(stamps)) <= _SHARED * len(rows) and len(set(zip(stamps, words, strict=True))) == len(rows)
