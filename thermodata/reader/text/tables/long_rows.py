"""Long tables: each row names what it measures, beside its value and often its unit. Read as a wide table, degrees and
micrometres would stand in one channel."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Sequence
from itertools import combinations

from thermodata.errors import FormatError
from thermodata.reader.signals.header_words import NAME_WORDS, VALUE_WORDS
from thermodata.reader.signals.interleaved import STATES
from thermodata.reader.text.cells.values.number import is_number
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.schema.words.sentences import with_dots

_FEWEST_ROWS = 10
_MAY_NAME = re.compile(r"column \d+(?:#\d+)?")  # nobody called it anything
_LOOKED_AT = 100  # rows whose cells are held to be numbers
_MOST_NAMES = 200  # that one column may hold
_SHARED = 0.6  # of the rows: no more times than this, where each is told of several names


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
    column has several names, or by its rows, where each time comes once for each of several names; for one whose rows
    hold several names, each before its value, which change their places."""
    moved = _columns_of_moved_names(names, rows)
    if moved:
        raise FormatError(
            "rows of several names, each before its value",
            where=where,
            expected="a column a signal",
            got=f"'{names[moved[0]]}' and '{names[moved[1]]}' hold the same names in different rows",
            hint="call the columns time,channel,value,channel,value in a line above: the reader cnc takes them apart; "
            "else pivot it: a column a name",
        )
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
        hint=f"declare table: {{series: [{_as_yaml(names[tag])}]}}: its rows are taken apart, each name is a signal "
        "of its own; or, with a column of dates and times, and columns called tag and value, the reader cnc does so",
    )


def _as_yaml(name: str) -> str:
    """A name as a list in a campaign file holds it."""
    return name if re.fullmatch(r"[^\W\d][\w ]*", name) else json.dumps(name, ensure_ascii=False)


def _columns_of_moved_names(names: Sequence[str], rows: Sequence[Sequence[str]]) -> tuple[int, int] | None:
    """Two columns of words before numbers that hold the same words, never in one row, and no states: names of values
    that stand in other columns from row to row. Not of columns that are called otherwise: two spindles have tools."""
    if len(rows) < _FEWEST_ROWS:
        return None
    width = min(map(len, rows))
    words: dict[int, list[str]] = {}
    for i in (i for i in range(width - 1) if _MAY_NAME.fullmatch(names[i]) or _stem(names[i]) in NAME_WORDS):
        own = [clean(row[i]) for row in rows]
        some = set(own)
        if (
            "" in some
            or not len(some) <= min(_MOST_NAMES, len(own) // 3)
            or _are_states(some)
            or any(map(is_number, some))
        ):
            continue
        if all(is_number(row[i + 1]) for row in rows[:: max(1, len(rows) // _LOOKED_AT)]):
            words[i] = own
    for a, b in combinations(words, 2):
        if not set(words[a]).isdisjoint(words[b]) and all(x != y for x, y in zip(words[a], words[b], strict=True)):
            return a, b
    return None


def _are_states(words: Collection[str]) -> bool:
    return any(word.casefold() in STATES for word in words)


def _stem(name: str) -> str:
    return re.sub(r"[\s_.#()-]|\d+$", "", name).casefold()


def _names_rows(rows: Sequence[Sequence[str]], column: int, times: Sequence[int]) -> bool:
    """Whether a column of words tells apart the rows that share their times, each of which comes for several words."""
    if not times or len(rows) < _FEWEST_ROWS:
        return False
    words = [row[column] for row in rows]
    if not 1 < len(set(words)) <= min(_MOST_NAMES, len(words) // 3) or any(map(is_number, words)) or not all(words):
        return False
    stamps = [tuple(row[k] for k in times) for row in rows]
    return len(set(stamps)) <= _SHARED * len(rows) and len(set(zip(stamps, words, strict=True))) == len(rows)
