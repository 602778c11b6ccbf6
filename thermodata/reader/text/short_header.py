"""A header with fewer cells than its rows: which cell has no name, nobody can tell, so no cell can be given one."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.delimiter import fields
from thermodata.reader.text.number import clean

_LOOKED_AT = 200  # rows below the header


def refuse_short_header(head: Sequence[str], first: int, width: int, delimiter: str, quoted: bool, where: str) -> None:
    """FormatError where most rows hold more than the header names, as where cells hold the delimiter without quotes.

    head: lines of the file; first: how many stand above the data; width: cells of most rows.
    """
    if any(line.count('"') % 2 for line in head[:first]):
        return  # a name in quotes goes over lines, so a line is no header
    above = [fields(line, delimiter, quoted) for line in head[:first]]
    longest = max(map(len, above), default=0)
    # a note or two above rows without a header name nothing
    if longest >= width or 2 * longest <= width:
        return
    at = next(k for k, line in enumerate(head[:first]) if len(fields(line, delimiter, quoted)) == longest)
    rows = [fields(line, delimiter, quoted) for line in head[first : first + _LOOKED_AT]]
    rows = [row for row in rows if len(row) == width]
    fuller = sum(any(map(clean, row[longest:])) for row in rows)
    if 2 * fuller <= len(rows):
        return  # rows that end with a delimiter, or with a remark now and then
    shown = {",": "','", "\t": "a tab"}.get(delimiter, f"'{delimiter}'")
    raise FormatError(
        "the header has fewer cells than the rows below it",
        where=f"{where} line {at + 1}, rows from line {first + 1}",
        expected=f"as many cells between {shown} in both",
        got=f"{longest} in the header, {width} in the rows: '{head[first][:80]}'",
        hint=f"{_decimals(delimiter, width - longest)}put cells that hold {shown} in quotes, or export with another "
        f"delimiter; if only the last columns have no name, declare table: {{header_rows: {at + 1}}}",
    )


def _decimals(delimiter: str, more: int) -> str:
    """What is said first where numbers may have a decimal comma between commas."""
    asked = f"has {more} column{'s' * (more != 1)} a decimal comma? then export with ';' between cells; else "
    return asked if delimiter == "," else ""
