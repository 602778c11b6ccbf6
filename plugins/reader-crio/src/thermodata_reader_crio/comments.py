"""The free text beside rows: kept as a signal, and a flag on the rows of which it says that nothing was measured."""

from __future__ import annotations

import re

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.text.cells.values.number import to_bool, to_float
from thermodata.schema.flag import Flag

_LOST = re.compile(
    r"(?i)\b(lost|communication|comm\.? ?(error|fail)|time-?out|error|fault|fail(ed|ure)?|disconnect|"
    r"offline|invalid|no (data|signal|response)|not (connected|responding)|"
    r"fehler|ausfall|störung|unterbrochen|chyba|výpadek|ztráta)"
)
_GOOD = re.compile(r"(?i)\b(no|without|0|kein(e)?|ohne|bez) (error|fault|fehler|chyb)|\brestored\b|\bok\b")
_OVER = re.compile(r"(?i)overload|over ?range|overflow|saturat|clipp(ed|ing)|übersteuer")


def texts(words: Array) -> Array | None:
    """Cells of free text with '' where there is none, shape (n,), object; None where no row has any."""
    filled = words.astype(bool)
    return np.where(filled, words, "") if filled.any() else None


def is_odd(comment: str, decimal: str) -> bool:
    """Whether a comment is a number, for then the cells of its row have moved, or bytes that are no text."""
    return "\ufffd" in comment or (to_float(comment, decimal) is not None and to_bool(comment) is None)


def flag_of(comment: str) -> int:
    """The flag of a row that is commented so: 0 for a remark."""
    if not comment:
        return 0
    if _OVER.search(comment):
        return int(Flag.SATURATED)
    return int(Flag.NOT_MEASURING) if _LOST.search(comment) and not _GOOD.search(comment) else 0


def flags_of(comments: Array) -> Array | None:
    """Flags of rows, shape (n,), uint16; None where no comment gives any."""
    known = {c: flag_of(c) for c in set(comments.tolist())}
    if not any(known.values()):
        return None
    return np.array([known[c] for c in comments.tolist()], np.uint16)
