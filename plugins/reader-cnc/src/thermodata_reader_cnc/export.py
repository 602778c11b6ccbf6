"""A control's plain export: rows of dates and times between ';' or tabs. Other delimited text is left to tables."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.claim import claimed_table
from thermodata.reader.text.locate import line_of

STREAM = "nc"


def claims(head: Head) -> str | None:
    """The reason for claiming a file by its first bytes, or None."""
    try:
        table = claimed_table(head)
    except FormatError as error:
        # a file of ours whose day and month nothing tells apart is still ours: reading it asks for the order
        asked = error.what.startswith("day and month") and (b";" in head.start or b"\t" in head.start)
        return "rows of a date and time between ';' or tabs" if asked else None
    if table is None or table.delimiter not in (";", "\t") or not table.absolute or not table.groups[0].formats:
        return None
    between = "';'" if table.delimiter == ";" else "tabs"
    column = table.groups[0].group.time[0] + 1
    return f"rows between {between} with a time {table.groups[0].said()} in column {column}"


def describe(path: Path, source: Source) -> Recording:
    return delimited.describe(delimited.open_table(path, source, STREAM), source)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    return delimited.blocks(path, delimited.open_table(path, source, STREAM), source)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    return line_of(blocks(path, source), stream, row)
