"""Delimited text that no other reader claims: loggers' exports, spreadsheets saved as text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from thermodata.errors import QuestionError, ThermodataError
from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.claim import claimed_table, head_lines
from thermodata.reader.text.file.locate import line_of
from thermodata.schema.words.sentences import with_count

_TAGS = {"_name", "node id", "nodeid", "tag", "tagname", "tag name", "item", "itemid", "display name", "displayname"}
_FEWEST_LINES = 10
_VALUES = {"_value", "value", "tagval", "tag value", "val"}


def claims(head: Head) -> str | None:
    """The reason for claiming a file by its first bytes, or None: a header says what its columns are, and no row names
    the one signal that it holds a value of."""
    try:
        table = claimed_table(head_lines(head))
    except QuestionError as question:
        return f"a table that leaves a question: {question.what}"
    except ThermodataError:
        return None
    if table.delimiter == "|" or _is_long(table.layout.names):
        return None
    if table.layout.first == 0 and len(table.sample.head) < _FEWEST_LINES:
        return None  # a few numbers without a header may be anything
    if table.named:
        return f"lines of a time and of names with their values: {with_count(table.named, 4)}"
    shown = "blanks" if table.blanks else "tab" if table.delimiter == "\t" else f"'{table.delimiter}'"
    return f"table: cells separated by {shown}, time in column '{table.layout.names[table.layout.time[0]]}'"


def _is_long(names: Sequence[str]) -> bool:
    """Whether each row names the one signal that it holds a value of."""
    low = {n.strip().lower() for n in names}
    return bool(low & _TAGS) and bool(low & _VALUES)


def describe(path: Path, source: Source) -> Recording:
    return delimited.describe(delimited.open_table(path, source), source)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    return delimited.blocks(path, delimited.open_table(path, source), source)


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    return line_of(blocks(path, source), stream, row)
