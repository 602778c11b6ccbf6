"""Delimited text and its like, read in one place: every reader of text puts these parts together.

Each room stands on those above it:

- `file`: a text before it is a table: its encoding, whole lines in bounded memory, where a row stands, losses;
- `cells`: what one says: `values` (`number` is the one policy), `time_forms`; what stands between them: `lines`;
- `names`: what a header says: names and units, which column is called a time, which rows are a header;
- `times`: how times are written in a column, of `one_cell` or `several_cells`, and what they say in nanoseconds;
- `preamble`: what the lines above a table say of its times; `clocks`: which of its columns are times;
- `rows`: typed columns, each row with its line;
- `page`: how a table lies on its page: its `header`, and the columns that are `timed` alike;
- `tables`: a whole table: the first look that finds it (`sample`), and its rows in `blocks`.

`delimited` describes and reads a file with all of them; `claim` says whether it is a table.
"""

from __future__ import annotations

from thermodata.reader.text.cells.values.number import decimal_mark
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.encoding import decode, decode_head, find_encoding
from thermodata.reader.text.file.lines import last_line_is_whole
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.times.zone import local_to_utc_ns

__all__ = [
    "clean",
    "decimal_mark",
    "decode",
    "decode_head",
    "find_encoding",
    "last_line_is_whole",
    "local_to_utc_ns",
    "looks_like_unit",
    "split_unit",
]
