"""The dates in the titles of blocks that stand beside each other: 'Prova S4000  11/05/2026' above the columns of one
test, 'Prova S8000  12/05/2026' above those of the next."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from thermodata.errors import ThermodataError
from thermodata.reader.text.preamble.begin import HEAD, NOT
from thermodata.reader.text.preamble.head_start import ORDERS
from thermodata.reader.text.preamble.head_words import is_of_another_time
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.time_formats import find_format
from thermodata.reader.times.zone import NAT

_DATE = re.compile(
    r"(?<![\d./:-])(?:\d{4}([-/.])\d{1,2}\1\d{1,2}|\d{1,2}([-/.])\s?\d{1,2}\2\s?(?:\d{4}|\d{2}))(?![\d./:-])"
)
_LABEL = "Date"

Head = Sequence[Sequence[str]]


def dated_titles(heads: Sequence[Head], declared: str | None) -> list[list[list[str]]] | None:
    """The heads of blocks as their titles date them, a line with the date alone: each head has one date, whatever else
    its title names, and no word of another time ('calibrated'). None where that is not so, or `declared`, which is
    `table.time.start`, says what counts."""
    if len(heads) < 2 or declared in (HEAD, NOT):
        return None
    found = [_dates(head) for head in heads]
    if any(len(dates) != 1 for dates in found):
        return None
    return [[[_LABEL, date]] for date in _told([next(iter(dates)) for dates in found], declared)]


def _dates(head: Head) -> set[str]:
    """The dates of a block's own head; none where it speaks of another time, or tells an hour, which is a start."""
    texts = [cell for line in head for cell in line if cell]
    if any(map(is_of_another_time, texts)) or any(re.search(r"\d:\d\d", text) for text in texts):
        return set()
    return {m[0].replace(" ", "") for text in texts for m in _DATE.finditer(text)}


def _told(dates: Sequence[str], declared: str | None) -> list[str]:
    """Dates in the order of day and month that one of them tells all the others; as they stand where none does."""
    try:
        form = find_format(list(dates), "the titles", order=declared if declared in ORDERS else None)
    except ThermodataError:
        return list(dates)
    each = [timestamp.parse_one(date, form) for date in dates]
    return list(dates) if NAT in each else [str(np.datetime64(ns, "ns").astype("datetime64[D]")) for ns in each]
