"""Whether a file's first bytes hold a table in delimited text: for readers that claim such files."""

from __future__ import annotations

from thermodata.plugin import Head, Source
from thermodata.reader.text.encoding import decode_head
from thermodata.reader.text.layout import STREAM
from thermodata.reader.text.lines import Sample
from thermodata.reader.text.table import Table, find_table


def head_lines(head: Head) -> list[str]:
    """The whole lines of a text's first bytes; none where it is binary or blank."""
    text = decode_head(head.start)
    if text is None or not text.strip():
        return []
    text = text.lstrip("\ufeff")
    if "\n" not in text:
        text = text.replace("\r", "\n")
    lines = [line.rstrip("\r") for line in text.split("\n")]
    if len(lines) > 1 and (head.size_bytes > len(head.start) or not lines[-1]):
        lines.pop()  # empty, or the head ends inside a line
    return lines


def claimed_table(head: Head) -> Table | None:
    """The table in a file's first bytes; None where these are no text. FormatError where they hold none."""
    lines = head_lines(head)
    if not any(line.strip() for line in lines):
        return None
    sample = Sample(tuple(lines), (), "utf-8", None, head.size_bytes <= len(head.start), True)
    return find_table(lines, sample, Source(), head.name, STREAM)
