"""Delimited text and its like, read in one place: every reader of text puts these parts together.

- what a file is made of: `encoding`, `lines` (whole lines in UTF-8, in bounded memory), `delimiter`;
- what a cell is: `number` (the one policy a cell), `timestamp`, `cell` (what a cell looks like), `status`;
- where things stand: `header` (names and units), `time_header`, `time_columns`, `time_groups`, `time_formats`,
  `time_questions` (what to ask where they are not said), `layout`, `columns`;
- rows: `grid` (how they lie, what they give), `rows` (typed columns, each row with its line), `arrow`;
- a whole table: `table` (the first look), `table_rows`, `quality_columns`, `local_clock`, `losses`, `delimited`
  (described and read), `claim` (is it one?), `locate` (where a row stands).
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
