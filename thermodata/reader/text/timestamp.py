"""Time as controls write it: a pattern a column, read for whole columns at once.

Cells of one width share the places of their digits, so a column is read as a byte matrix; only the rows that
differ go through the regular expression one by one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date
from typing import Any

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError
from thermodata.plugin import Int1D
from thermodata.reader.zone import NAT

_S = 1_000_000_000
_DAY = 86_400 * _S
_EPOCH = date(1970, 1, 1)
_DAYS_IN_MONTH = np.array([0, 31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31])

_TIME = r"(?P<H>\d{1,2}):(?P<M>\d{2})(?::(?P<S>\d{2})(?:[.,:](?P<f>\d{1,9}))?)?(?:\s?(?P<p>[AaPp]\.?[Mm]\.?))?"
_DATES = {
    "ymd": r"(?P<Y>\d{4})(?P<s>[-/.])(?P<m>\d{1,2})(?P=s)(?P<d>\d{1,2})",
    "dmy": r"(?P<d>\d{1,2})(?P<s>[-/.]) ?(?P<m>\d{1,2})(?P=s) ?(?:(?P<Y>\d{4})|(?P<y>\d{2}))",
    "cjk": r"(?P<Y>\d{4})年(?P<m>\d{1,2})月(?P<d>\d{1,2})日",
    "mdy": r"(?P<m>\d{1,2})(?P<s>[-/.]) ?(?P<d>\d{1,2})(?P=s) ?(?:(?P<Y>\d{4})|(?P<y>\d{2}))",
}
_ZONE = r"(?P<z>\s?(?:Z|UTC|[+-]\d{2}:?\d{2}))?"
_STRPTIME = {
    "Y": r"(?P<Y>\d{4})",
    "y": r"(?P<y>\d{2})",
    "m": r"(?P<m>\d{1,2})",
    "d": r"(?P<d>\d{1,2})",
    "H": r"(?P<H>\d{1,2})",
    "I": r"(?P<H>\d{1,2})",
    "M": r"(?P<M>\d{1,2})",
    "S": r"(?P<S>\d{1,2})",
    "f": r"(?P<f>\d{1,9})",
    "p": r"(?P<p>[AaPp]\.?[Mm]\.?)",
    "z": r"(?P<z>Z|[+-]\d{2}:?\d{2})",
    "%": "%",
}


@dataclass(frozen=True, slots=True)
class TimeFormat:
    """How the cells of one time column read. role: datetime, date, time, millisecond, offset (milliseconds since a
    start), or relative (numbers)."""

    role: str
    pattern: re.Pattern[str] | None
    text: str  # for messages: "DD.MM.YYYY HH:MM:SS"
    unit_ns: int = 0  # relative: nanoseconds a unit


def _compile(body: str) -> re.Pattern[str]:
    return re.compile(r"\s*" + body + r"\s*", re.ASCII)


TIME_OF_DAY = TimeFormat("time", _compile(_TIME + _ZONE), "HH:MM:SS")
OFFSET_MS = TimeFormat("offset", _compile(r"(?P<oms>\d{1,12})(?:\.(?P<of>\d{1,6})\d*|\.)?"), "milliseconds")
MILLISECOND = TimeFormat("millisecond", _compile(r"(?P<ms>\d{1,3})"), "0...999")
DATE = {
    o: TimeFormat(
        "date", _compile(p), {"ymd": "YYYY-MM-DD", "dmy": "DD.MM.YYYY", "mdy": "MM/DD/YYYY", "cjk": "YYYY年MM月DD日"}[o]
    )
    for o, p in _DATES.items()
}
DATETIME = {
    o: TimeFormat("datetime", _compile(p + r"(?:[T,]?\s*|\s+)" + _TIME + _ZONE), f"{DATE[o].text} HH:MM:SS")
    for o, p in _DATES.items()
}


def declared_format(text: str) -> TimeFormat:
    """The format that a campaign file declares in strptime's letters; FormatError for a letter that is none."""
    body, used = "", set()
    for part in re.findall(r"%.?|[^%]+", text):
        if not part.startswith("%"):
            body += re.escape(part)
        elif part[1:] in _STRPTIME:
            body += _STRPTIME[part[1:]]
            used.add(part[1:])
        else:
            raise FormatError(
                f"time format '{text}' cannot be used", expected="%Y %y %m %d %H %I %M %S %f %p %z", got=part
            )
    day, clock = bool(used & {"Y", "y"}), bool(used & {"H", "I"})
    try:
        pattern = _compile(body)
    except re.error as error:
        raise FormatError(f"time format '{text}' cannot be used", got=str(error)) from None
    return TimeFormat("datetime" if day and clock else "date" if day else "time", pattern, text)


def parse(cells: Any, form: TimeFormat) -> Int1D:
    """Nanoseconds of each cell: since 1970 for a date or datetime (UTC where the cell carries an offset, else
    local), in the day for a time. cells: an Arrow string array without nulls, or a list. NAT where none."""
    import pyarrow as pa

    column = pa.array(cells, pa.string()) if isinstance(cells, list) else cells
    if isinstance(column, pa.ChunkedArray):
        column = column.combine_chunks()
    if isinstance(column, pa.ChunkedArray):  # pyarrow may return one of no chunks
        column = pa.array([], pa.string())
    n, start = len(column), column.offset
    result = np.full(n, NAT, np.int64)
    if not n:
        return result
    assert form.pattern is not None
    _, offsets_buffer, data_buffer = column.buffers()
    if data_buffer is None:
        return result
    offsets = np.frombuffer(offsets_buffer, np.int32)[start : start + n + 1].astype(np.int64)
    data = np.frombuffer(data_buffer, np.uint8)
    widths = np.diff(offsets)
    open_rows = np.ones(n, bool)
    for width in np.unique(widths):
        if not 0 < width <= 64:
            continue
        rows = np.flatnonzero(widths == width)
        matrix = (
            data[offsets[0] : offsets[-1]].reshape(n, width)
            if rows.size == n
            else data[offsets[rows][:, None] + np.arange(width)]
        )
        first = bytes(matrix[0]).decode("ascii", "replace")
        match = form.pattern.fullmatch(first)
        if match is None:
            continue
        ns, good = _read_matrix(matrix, match)
        result[rows[good]] = ns[good]
        open_rows[rows[good]] = False
    for row in np.flatnonzero(open_rows):
        result[row] = parse_one(bytes(data[offsets[row] : offsets[row + 1]]).decode("utf-8", "replace"), form)
    return result


def parse_one(cell: str, form: TimeFormat) -> int:
    """One cell; NAT where it is no time."""
    match = form.pattern.fullmatch(cell) if form.pattern else None
    if match is None:
        return NAT
    g = match.groupdict()
    if g.get("ms") is not None:
        return int(g["ms"]) * 1_000_000
    if g.get("oms") is not None:
        return int(g["oms"]) * 1_000_000 + int((g["of"] or "0").ljust(6, "0"))
    total = 0
    if g.get("m") is not None:
        year = int(g["Y"]) if g.get("Y") else int(g["y"]) + (2000 if int(g["y"]) < 80 else 1900)
        if not 1900 <= year <= 2200:
            return NAT
        try:
            total = (date(year, int(g["m"]), int(g.get("d") or 1)) - _EPOCH).days * _DAY
        except ValueError:
            return NAT
    if g.get("H") is not None:
        hour, minute, second = int(g["H"]), int(g["M"]), int(g.get("S") or 0)
        if g.get("p"):
            if not 1 <= hour <= 12:
                return NAT
            hour = hour % 12 + (12 if g["p"][0] in "pP" else 0)
        if hour > 23 or minute > 59 or second > 59:
            return NAT
        total += (hour * 3600 + minute * 60 + second) * _S
    if g.get("f"):
        total += int(g["f"].ljust(9, "0"))
    return total - offset_ns(g["z"]) if g.get("z") else total


def _read_matrix(matrix: npt.NDArray[np.uint8], match: re.Match[str]) -> tuple[Int1D, npt.NDArray[np.bool_]]:
    """Nanoseconds of rows laid out like the first one, and which rows are laid out so."""
    fields: dict[str, npt.NDArray[np.int64]] = {}
    good = np.ones(len(matrix), bool)
    literal = set(range(matrix.shape[1]))
    for name, text in match.groupdict().items():
        if text is None or name in ("s", "p", "z"):
            continue
        start, stop = match.span(name)
        literal -= set(range(start, stop))
        value = np.zeros(len(matrix), np.int64)
        for place in range(start, stop):
            digit = matrix[:, place] - np.uint8(48)
            good &= digit < 10
            value = value * 10 + digit
        fields[name] = value * 10 ** ({"f": 9, "of": 6}[name] - (stop - start)) if name in ("f", "of") else value
    for place in literal:
        good &= matrix[:, place] == matrix[0, place]
    ns = _assemble(fields, match)
    return ns, good & (ns != NAT)


def _assemble(fields: dict[str, npt.NDArray[np.int64]], match: re.Match[str]) -> Int1D:
    groups = match.groupdict()
    if "ms" in fields:
        return fields["ms"] * 1_000_000
    if "oms" in fields:
        return fields["oms"] * 1_000_000 + fields.get("of", np.zeros_like(fields["oms"]))
    size = next(iter(fields.values())).shape
    total, bad = np.zeros(size, np.int64), np.zeros(size, bool)
    if "m" in fields:
        year = fields.get("Y")
        if year is None:
            year = fields["y"] + np.where(fields["y"] < 80, 2000, 1900)
        month, day = fields["m"], fields.get("d", np.ones(size, np.int64))
        bad |= (month < 1) | (month > 12) | (year < 1900) | (year > 2200) | (day < 1)
        safe = np.clip(month, 1, 12)
        leap = (year % 4 == 0) & ((year % 100 != 0) | (year % 400 == 0))
        bad |= day > _DAYS_IN_MONTH[safe] - ((safe == 2) & ~leap)
        total += _days(year, safe, day) * _DAY
    if "H" in fields:
        hour, minute, second = fields["H"], fields["M"], fields.get("S", np.zeros(size, np.int64))
        if groups.get("p"):
            bad |= (hour < 1) | (hour > 12)
            hour = hour % 12 + (12 if groups["p"][0] in "pP" else 0)
        bad |= (hour > 23) | (minute > 59) | (second > 59)
        total += (hour * 3600 + minute * 60 + second) * _S
    if "f" in fields:
        total += fields["f"]
    if groups.get("z"):
        total -= offset_ns(groups["z"])
    return np.where(bad, NAT, total)


def offset_ns(text: str) -> int:
    """Nanoseconds east of Greenwich: 'Z', '+01:00', '-0430'."""
    text = text.strip()
    if text[0] not in "+-":
        return 0
    digits = text[1:].replace(":", "")
    return (-1 if text[0] == "-" else 1) * (int(digits[:2]) * 3600 + int(digits[2:]) * 60) * _S


def _days(year: Int1D, month: Int1D, day: Int1D) -> Int1D:
    """Days since 1970-01-01 in the Gregorian calendar (Hinnant, days_from_civil)."""
    y = year - (month <= 2)
    era = y // 400
    of_era = y - era * 400
    of_year = (153 * (month + np.where(month > 2, -3, 9)) + 2) // 5 + day - 1
    result: Int1D = era * 146_097 + of_era * 365 + of_era // 4 - of_era // 100 + of_year - 719_468
    return result
