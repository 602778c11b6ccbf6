"""Rows of units above a table's data: which rows are such, and what their cells say, known here or not."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import Cell
from thermodata.reader.text.names.header import looks_like_unit

STATISTIC = re.compile(r"(?i)avg|smp|min|max|tot|std|med|mean|last|tmn|tmx|sample|average")
# what controls and loggers write of the type of each column, or of how it was sampled
_TYPE = re.compile(
    r"(?i)l?real|float(32|64)?|double|single|u?[sld]?int(8|16|32|64)?|bool(ean)?|[dl]?word|byte|w?string|w?char|"
    r"l?dt|date_and_time|datetime|l?tod|time_of_day|inst(antaneous)?|meas(ured)?|math|comm"
)
# what recorders call such a row in its first cell, and the column of messages in its last
_ROW_CALLED = re.compile(r"(?i)(data )?type|kind")
_MESSAGES = re.compile(r"(?i)messages?|count")
# how times are written, in languages of spreadsheets: hh:mm:ss, TT.MM.JJJJ hh:mm, gg/mm/aaaa, yyyy-MM-ddTHH:mm:ss.fff
_PART = r"(?:[dgt]{1,2}|m{1,3}|[hs]{1,2}|y{2,4}|[jar]{2,4}|f{1,9}|0{1,9})"
_FORM = rf"(?i:(?=.*(?::|yy|jj|aa|rr)){_PART}(?:(?:[.:/,_ -]{{1,2}}|(?<=d)t(?=h)){_PART})+)"
_OF_TIME = re.compile(rf"[\[(]?(?:s|sec|sek|ms|us|µs|μs|min|h|{_FORM})[\])]?")
# what loggers write in the row of units for stamps, numbers of records and alarms
_NO_UNIT = re.compile(r"(?i)ts|rn|no\.?|time|zeit|date|datum|-+|alarm.*|[a-z]\d{3,}")
_ALARMS = re.compile(r"(?i)a1234(567890)?")  # the alarms of a logger by their numbers
_STAMPS = {"TS", "RN"}
_SIGN_FIRST = re.compile(r"[°º˚%‰]\S{0,4}")  # '°X': a unit, known or not
_LONGEST = 12  # letters of a unit


def as_units(cells: Sequence[str]) -> list[str | None]:
    return [u.strip("[]() ") or None for u in cells]


def units_below(names: Sequence[str], row: Sequence[str]) -> list[str | None]:
    """The units of a row below names: known ones, and what else stands among them, so that it is asked for."""
    return [u if u is not None and _may_be(n, u) else None for n, u in zip(names, as_units(row), strict=True)]


def known_units(row: Sequence[str]) -> list[str | None]:
    """The units of a row that holds other words too: known ones only."""
    return [u if u is not None and looks_like_unit(u) else None for u in as_units(row)]


def are_units(cells: Sequence[Cell]) -> bool:
    """Whether most filled cells of a row are units; of a row that holds the alarms that a logger writes among units
    only, most of the others: one or two channels stand beside as many of these. A row of stamps and numbers of records
    (TS, RN) is one whatever a program calls its units."""
    texts = [str(c) for c in cells]
    if _STAMPS.issubset(texts):
        return True
    if any(map(_ALARMS.fullmatch, texts)):
        texts = [c for c in texts if not _NO_UNIT.fullmatch(c)]
    return sum(map(_is_one, texts)) * 2 > len(texts)


def mostly_units(row: Sequence[str]) -> bool:
    return are_units([c for c in row if c])


def without_types(rows: Sequence[Sequence[str]]) -> list[Sequence[str]]:
    """The rows above the data, those emptied that say of each column its type (REAL, INT) or how it was sampled (Inst,
    Avg), where another row names the columns, each by a name of its own."""
    of_types = [_says_types(row) for row in rows]
    others = [[c for c in row if c] for row, says in zip(rows, of_types, strict=True) if not says]
    named = any(2 * len(cells) > len(rows[0]) and len(set(cells)) == len(cells) for cells in others)
    return [[""] * len(row) if says and named else row for row, says in zip(rows, of_types, strict=True)]


def _says_types(row: Sequence[str]) -> bool:
    filled = [c for c in row if c]
    if filled and _ROW_CALLED.fullmatch(filled[0]):
        filled = filled[1:-1] if _MESSAGES.fullmatch(filled[-1]) else filled[1:]
    types = sum(_TYPE.fullmatch(c) is not None for c in filled)
    return (
        len(filled) > 1
        and 2 * types >= len(filled)
        and all(_TYPE.fullmatch(c) or STATISTIC.fullmatch(c) for c in filled)
    )


def of_units(row: Sequence[str], times: Sequence[int]) -> bool:
    """Whether a row below names is one of units: most of its cells are, or some beside one of time below the words for
    the time. times: where these stand."""
    if mostly_units(row):
        return True
    others = [c for k, c in enumerate(row) if c and k not in times]
    below = [row[k] for k in times if row[k]]
    return (
        bool(below)
        and all(map(_OF_TIME.fullmatch, below))
        and any(map(looks_like_unit, others))
        and not any(STATISTIC.fullmatch(c) or len(c) > _LONGEST for c in others)
    )


def _is_one(cell: str) -> bool:
    return looks_like_unit(cell) or cell.startswith("[") or _SIGN_FIRST.fullmatch(cell) is not None


def _may_be(name: str, cell: str) -> bool:
    if looks_like_unit(cell):
        return True
    return len(cell) <= _LONGEST and cell != name and not (_NO_UNIT.fullmatch(cell) or STATISTIC.fullmatch(cell))
