"""Lines that say in words what happened, between the rows of a table of numbers: '08:25:30', 'EVENT: spindle on M3'."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from thermodata.reader.text.cells.cell import is_number
from thermodata.schema.words.sentences import counted, with_dots

_TIME = re.compile(r"(?i)\d[\d.:,/TZ+ -]*(?: ?[ap]\.?m\.?)?")
_WORDS = re.compile(r"[^\W\d_]{2,}.*\s.*\w")
_SAYS = re.compile(r"^\W*[^\W\d_]{2,}[\w ]*:\s*\w")
_NOTED = 2


def is_event_line(cells: Sequence[str], text_columns: Sequence[bool]) -> bool:
    """Whether cells are a time, or a date and a time of day, and one cell of words behind it, where rows have numbers:
    no row that is cut. text_columns: whether each column holds text."""
    full = [c.strip() for c in cells]
    while full and not full[-1]:
        full.pop()
    times = next((i for i, c in enumerate(full) if not _TIME.fullmatch(c)), len(full))
    if not (times == 1 or (times == 2 and ":" in full[1])) or len(full) != times + 1 or len(full) >= len(text_columns):
        return False
    said = full[-1]
    if text_columns[times] or is_number(said):
        return False
    return _WORDS.search(said) is not None or _SAYS.search(said) is not None


def event_notes(
    lines: Iterable[Sequence[str]], text_columns: Sequence[bool], first: int, whole: bool = True
) -> list[str]:
    """A note on the lines of these that are no rows and no loss. lines: the cells of each; first: the number of the
    first of them in its file; whole: whether they go up to its end."""
    found = {
        number: next(c.strip() for c in reversed(cells) if c.strip())
        for number, cells in enumerate(lines, first)
        if is_event_line(cells, text_columns)
    }
    if not found:
        return []
    shown = with_dots([f"'{text[:60]}'" for text in dict.fromkeys(found.values())], _NOTED)
    many = ("" if whole else "at least ") + counted(len(found), "line")
    told = f"{many}, the first is line {min(found)}"
    return [f"lines that say what happened are no rows, and are not read ({told}): {shown}"]
