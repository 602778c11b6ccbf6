"""A control's plain export: rows of dates and times between ';' or tabs. Other delimited text is left to tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.claim import claimed_table
from thermodata.reader.text.file.locate import line_of

STREAM = "nc"
EXAMPLE = (
    "Datum;Uhrzeit;Drehzahl;T_Lager\n;;U/min;°C\n"
    "02.03.2026;08:00:00;1000;20,5\n02.03.2026;08:00:01;1001;20,5\n02.03.2026;08:00:02;1002;20,75\n"
).encode()


def claims(lines: Sequence[str]) -> str | None:
    """The reason for claiming a file that begins with these lines, or None."""
    try:
        table = claimed_table(tuple(lines))
    except QuestionError as question:
        # a file of ours whose day and month nothing tells apart is still ours: reading it asks for the order
        dated = "format" in question.declare.get("time", {}) and any(";" in line or "\t" in line for line in lines[-3:])
        return "rows of a date and time between ';' or tabs" if dated else None
    except FormatError:
        return None
    if table.delimiter not in (";", "\t") or table.named or not table.groups[0].absolute or not table.groups[0].formats:
        return None
    between = "';'" if table.delimiter == ";" else "tabs"
    column = table.groups[0].group.time[0] + 1
    return f"rows between {between} with a time {table.groups[0].said()} in column {column}"


def describe(path: Path, source: Source) -> Recording:
    """Signals, clock and start of an export, by samples of it."""
    return delimited.describe(_table(path, source), source)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """Its rows, and a loss for each part that does not read."""
    return delimited.blocks(path, _table(path, source), source)


def _table(path: Path, source: Source) -> delimited.Table:
    """FormatError for bars that nobody declared: they part the fields of logs that are no tables."""
    table = delimited.open_table(path, source, STREAM)
    if table.delimiter == "|" and not (source.table or {}).get("delimiter"):
        raise FormatError(
            "no columns found",
            where=path.name,
            expected="rows of cells between ';', tabs or commas",
            got="'|'",
            hint="declare table: {delimiter: '|'} if it is a table all the same",
        )
    return table


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """The line of a row (counted from 0) of a stream; None where there is no such row."""
    return line_of(blocks(path, source), stream, row)
