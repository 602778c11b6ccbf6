"""Whether a file's first bytes hold a table in delimited text: for readers that claim such files."""

from __future__ import annotations

from functools import lru_cache

from thermodata.plugin import Head, Source
from thermodata.reader.text.file.encoding import decode_head
from thermodata.reader.text.file.lines import Sample
from thermodata.reader.text.page.timed.group import STREAM
from thermodata.reader.text.tables.find_table import find_table
from thermodata.reader.text.tables.table import Table


def head_lines(head: Head) -> tuple[str, ...]:
    """The whole lines of a text's first bytes (of XML, which need not have lines, all that is there); none where these
    are binary or blank."""
    text = decode_head(head.start)
    if text is None or not text.strip():
        return ()
    text = text.lstrip("\ufeff")
    if "\n" not in text:
        text = text.replace("\r", "\n")
    lines = [line.rstrip("\r") for line in text.split("\n")]
    if len(lines) > 1 and head.size_bytes > len(head.start) and not text.lstrip().startswith("<"):
        lines.pop()  # the head ends inside a line
    return tuple(lines)


_LINES = 300  # by which a table is known: how a column is typed may want more, whose it is does not


@lru_cache(maxsize=2)  # several readers are asked for the same file
def claimed_table(lines: tuple[str, ...]) -> Table:
    """The table in a file's first lines. FormatError where they hold none."""
    lines = lines[:_LINES] if len(lines) > 2 * _LINES else lines
    whole = lines[:-1] if len(lines) > 1 and not lines[-1] else lines
    # whose table it is does not hang on its decimal mark: whoever reads it asks for that
    source = Source(table={"decimal": "."})
    return find_table(whole, Sample(whole, (), "utf-8", None, False, True), source, "the first lines", STREAM)
