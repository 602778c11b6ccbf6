"""Which columns the header of a long table names, under the names that loggers and historians give them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.cells.values.status import are_qualities, is_severity, tells_quality
from thermodata_reader_cnc.opcua.long_times import Times, time_columns
from thermodata_reader_cnc.opcua.long_words import TAGS, bare, value_columns, value_pairs


@dataclass(frozen=True, slots=True)
class Header:
    """Which columns a header names. raw, names: its cells, as they stand and `bare`; typed: further ones of the value,
    of other types; pairs: of tag and value, of a row that holds several; influx: it is one of InfluxDB."""

    raw: Sequence[str]
    names: Sequence[str]
    said: Times
    tag: int | None
    value: int
    typed: tuple[int, ...]
    status: int | None
    pairs: Sequence[tuple[int, int]]
    influx: bool

    @property
    def times(self) -> tuple[int, ...]:
        """The columns of the time."""
        return self.said.places

    def whole(self, rows: Iterable[Sequence[str]]) -> list[Sequence[str]]:
        """The rows with a cell for each name."""
        return [cells for cells in rows if len(cells) == len(self.names)]


def find_header(raw: Sequence[str], below: Sequence[Sequence[str]]) -> Header | None:
    """raw: the cells of a line; below: those of the lines below it. None where they name no time and value, or nothing
    tells what the value is of."""
    names = [bare(c) for c in raw]
    pairs = value_pairs(names, below)
    values = (pairs[0][1],) if pairs else value_columns(names)
    if not values:
        return None
    value, typed = values[0], values[1:]
    tag = pairs[0][0] if pairs else next((names.index(n) for n in TAGS if n in names), None)
    if {"_time", "_value"} <= set(raw):
        return Header(raw, names, Times((raw.index("_time"),), "_time", None), tag, value, (), None, pairs, True)
    told = qualities(names, below)
    status = min(told, key=lambda k: (told[k], k), default=None)
    if tag is None and ("sourcetimestamp" not in names or status is None):
        return None
    others = {k for k in (tag, *values, status, *(k for pair in pairs for k in pair)) if k is not None}
    said = time_columns(raw, names, below, others)
    return None if said is None else Header(raw, names, said, tag, value, typed, status, pairs, False)


def qualities(names: Sequence[str], rows: Iterable[Sequence[str]]) -> dict[int, int]:
    """The columns that say how good a value is -> how surely, 0 and less the surest. names: bare; rows: their cells,
    by which a severity is one of EPICS, beside whose INVALID its status says why."""
    whole = [cells for cells in rows if len(cells) == len(names)]
    found: dict[int, int] = {}
    for k, name in enumerate(names):
        if is_severity(name) and are_qualities((clean(cells[k]) for cells in whole), name):
            found[k] = -1
        elif (sure := tells_quality(name)) is not None:
            found[k] = sure
    return found


def time_cell(cells: Sequence[str], times: Sequence[int]) -> str:
    return next((text for k in times if (text := clean(cells[k]))), "")
