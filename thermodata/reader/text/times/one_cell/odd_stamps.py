"""Dates and times that are written in no way that is read by itself: guessed in strptime's letters, to be confirmed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.time_forms.calendar_words import letters_of
from thermodata.reader.text.cells.time_forms.zone_words import without_zone
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.times.zone import NAT

_HALF = re.compile(r"(?i)[ap]m")
_JOINED = {8: "%Y%m%d", 12: "%Y%m%d%{hour}%M", 14: "%Y%m%d%{hour}%M%S"}
_JOINED_CLOCK = {4: "%{hour}%M", 6: "%{hour}%M%S"}
_ENOUGH, _FEW = 0.9, 40
_ISO_WEEK = re.compile(r"(?:19|20)\d\d-W\d{2}-[1-7]")  # ISO 8601: 2026-W19-1, the Monday of week 19


def guess_format(cells: Sequence[str]) -> str | None:
    """The format of stamps such as '02-Mar-2026 08:00:00', '20260302T080000' or '02.03.2026 08.00.00'; None where none
    fits nearly all cells, or two do. cells: of one column, those that hold something."""
    fitting = fitting_formats(cells)
    return fitting[0] if len(fitting) == 1 else None


def fitting_formats(cells: Sequence[str]) -> list[str]:
    """All formats that fit nearly all stamps, as in `guess_format`."""
    some = [c.strip() for c in cells[:: max(1, len(cells) // _FEW)]]
    return [text for text in dict.fromkeys(_spellings(some[0])) if _share(some, text) >= _ENOUGH] if some else []


def is_iso_week(cell: str) -> bool:
    """Whether a cell is a day by its week: 2026-W19-1."""
    return _ISO_WEEK.fullmatch(cell) is not None


def _share(cells: Sequence[str], text: str) -> float:
    try:
        form = time_pattern.declared_format(text)
    except FormatError:
        return 0.0
    return sum(timestamp.parse_one(c, form) != NAT for c in cells) / len(cells)


def _spellings(cell: str) -> Iterator[str]:
    """What a stamp may be in strptime's letters: day before month where a dot parts them, month before day behind a
    year, else either."""
    if (week := _ISO_WEEK.match(cell)) is not None:
        yield from (f"%G-W%V-%u{clock}" for clock in _clocks(cell[week.end() :]))
        return
    if (zoned := without_zone(cell)) is not None:
        yield from (f"{spelled}{zoned[1]}" for spelled in _spellings(zoned[0]))
        return
    parts = re.findall(r"\d+|[^\W\d_]+|[\W_]+", cell)
    words = [
        letters or ("%p" if _HALF.fullmatch(p) else None) for p, letters in zip(parts, letters_of(parts), strict=True)
    ]
    numbers = [p for p in parts if p.isdecimal()]
    odd = any(w is None and p.isalpha() and p.casefold() != "t" for p, w in zip(parts, words, strict=True))
    if not numbers or odd or re.search(r"\d\s*[+-]\d{2}:?\d{2}$", cell):
        return  # a zone, or a word that is no month
    hour = "I" if "%p" in words else "H"
    joined, year = len(numbers[0]) in _JOINED, any(len(n) == 4 for n in numbers)
    orders = ["md"] if len(numbers[0]) == 4 else ["dm"] if re.match(r"\D*\d+\.", cell) else ["md", "dm"]
    for order in ["d"] if "%b" in words or "%B" in words else orders:
        left = [*([] if joined else [*order, *([] if year else ["y"])]), hour, "M", "S", "f"]
        spelled = ""
        for part, word in zip(parts, words, strict=True):
            letters = word or part.replace("%", "%%")
            if part.isdecimal():
                together = _JOINED if "%Y" not in spelled else _JOINED_CLOCK if joined else {}
                if len(part) == 4 and not joined and "%Y" not in spelled:
                    letters = "%Y"
                elif len(part) in together:
                    letters = together[len(part)].replace("{hour}", hour)
                else:
                    letters = f"%{left[0]}" if left else part
                left = [x for x in left if f"%{x}" not in letters]
            spelled += letters
        if not left or left[0] in ("S", "f") or (left[0] == hour and "%Y" in spelled and ":" not in cell):
            yield spelled


def _clocks(rest: str) -> Iterator[str]:
    """What stands behind a day, in strptime's letters: ' 08:00:00' is ' %H:%M:%S'."""
    letters = iter(("%H", "%M", "%S", "%f"))
    yield re.sub(r"\d+", lambda _: next(letters, "%"), rest.replace("%", "%%"))
