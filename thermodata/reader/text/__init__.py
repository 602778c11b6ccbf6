"""Delimited text and its like, read in one place: every reader of text puts these parts together.

`encoding` > `lines` (whole lines in UTF-8, in bounded memory) > `delimiter`, `header`, `time_columns`, `layout` (where
things stand) > `rows` (typed columns, each row with its line), `number` (the one policy a cell), `timestamp`,
`local_clock` (times) > `delimited` (a table, described and read), `losses` (what did not read).
"""

from __future__ import annotations

from thermodata.reader.text.encoding import decode, decode_head, file_encoding, find_encoding
from thermodata.reader.text.header import looks_like_unit, split_unit
from thermodata.reader.text.lines import last_line_is_whole
from thermodata.reader.text.number import clean, decimal_mark
from thermodata.reader.zone import local_to_utc_ns

__all__ = [
    "clean",
    "decimal_mark",
    "decode",
    "decode_head",
    "file_encoding",
    "find_encoding",
    "last_line_is_whole",
    "local_to_utc_ns",
    "looks_like_unit",
    "split_unit",
]
