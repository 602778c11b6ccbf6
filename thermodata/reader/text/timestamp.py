"""Dates and times as text: a pattern a column, read for whole columns at once.

Years of two digits are 1969 to 2068, as POSIX has them. Times without an offset are local: `local_clock` resolves them.

Cells of one width share the places of their digits, so a column is read as a byte matrix; only the rows that
differ go through the regular expression one by one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from datetime import UTC, date, datetime, timedelta
from typing import Any

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError
from thermodata.plugin import Int1D
from thermodata.reader.text.number import text_array
from thermodata.reader.text.zone_words import ZONE, offset_ns
from thermodata.reader.zone import NAT

CENTURY = 69  # years of two digits below it are of this one: 1969 to 2068, as strptime's %y
_S = 1_000_000_000
_DAY = 86_400 * _S
_EPOCH = date(1970, 1, 1)
_DAYS_IN_MONTH = np.array([0, 31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31])

# hours to seconds; more digits than nanoseconds are cut
_TIME = r"(?P<H>\d{1,2}):(?P<M>\d{2})(?::(?P<S>\d{2})(?:[.,:](?P<f>\d{1,9})\d*)?)?(?:\s*(?P<p>[AaPp]\.?[Mm]\.?))?"
_YEAR = r"(?:(?P<Y>\d{4})|(?P<y>\d{2}))"
_DATES = {
    "ymd": r"(?P<Y>\d{4})(?P<s>[-/.]) ?(?P<m>\d{1,2})(?P=s) ?(?P<d>\d{1,2})",
    "dmy": rf"(?P<d>\d{{1,2}})(?P<s>[-/.]) ?(?P<m>\d{{1,2}})(?P=s) ?{_YEAR}",
    "cjk": r"(?P<Y>\d{4})[年년] ?(?P<m>\d{1,2})[月월] ?(?P<d>\d{1,2})[日일]",
    "mdy": rf"(?P<m>\d{{1,2}})(?P<s>[-/.]) ?(?P<d>\d{{1,2}})(?P=s) ?{_YEAR}",
}
_BETWEEN = r"(?:,?\s*[T_-]?\s*)"
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
    "z": ZONE,
    "Z": ZONE,
    "%": "%",
}
_ISO = re.compile(r"^\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d{1,9})?)?$", re.ASCII)
_FIRST_NS, _LAST_NS = ((date(year, 1, 1) - _EPOCH).days * _DAY for year in (1900, 2201))
_CALENDAR = frozenset("YymdbBjGVUWu")  # letters of a declared format that Python reads, cell by cell
_OTHERS = frozenset("bBaAjGVUWuwcxX")


@dataclass(frozen=True, slots=True)
class TimeFormat:
    """How the cells of one time column read. role: datetime, date, time, millisecond, microsecond or fraction (of a
    second, behind whole ones), offset (milliseconds since a start), relative (numbers), or part (of the time of a
    column before it). zoned: whether the cells name their offset from UTC: None where either may come."""

    role: str
    pattern: re.Pattern[str] | None
    text: str  # for messages: "DD.MM.YYYY HH:MM:SS"
    body: str = ""  # the pattern without a zone
    zoned: bool | None = None
    strptime: str | None = None  # a declared format with names of months and the like
    columns: int = 1  # that hold its parts, from its own on

    @property
    def cycle_ns(self) -> int:
        """Behind what a time without a date begins anew: an hour where it has no hours, else a day."""
        return _DAY // 24 if self.pattern is not None and "N" in self.pattern.groupindex else _DAY


def _compile(body: str) -> re.Pattern[str]:
    return re.compile(r"\s*'?" + body + r"\s*", re.ASCII)  # an apostrophe keeps a spreadsheet from reading a date


def _format(role: str, body: str, text: str, zone: bool = True) -> TimeFormat:
    return TimeFormat(role, _compile(body + (f"{ZONE}?" if zone else "")), text, body)


TIME_OF_DAY = _format("time", _TIME, "HH:MM:SS")
# a duration, which goes on behind 23:59:59: 100:30:00
ELAPSED = _format(
    "time", r"(?P<E>\d{1,5}):(?P<M>\d{2}):(?P<S>\d{2})(?:[.,](?P<f>\d{1,9})\d*)?", "HHH:MM:SS", zone=False
)
HOURS = _format("time", r"(?P<E>\d{1,5}):(?P<M>\d{2})", "HHH:MM", zone=False)
MINUTES = _format("time", r"(?P<N>\d{1,5}):(?P<S>\d{2})(?:[.,](?P<f>\d{1,9})\d*)?", "MM:SS", zone=False)
OFFSET_MS = _format("offset", r"(?P<oms>\d{1,12})(?:\.(?P<of>\d{1,6})\d*|\.)?", "milliseconds", zone=False)
UNIX_MS = _format("offset", r"(?P<oms>\d{12,13})(?:\.(?P<of>\d{1,6})\d*|\.)?", "milliseconds since 1970", zone=False)
# by InfluxDB's precisions, which its exports count in
UNIX_US = _format("offset", r"(?P<oms>\d{13})(?P<of>\d{3})", "microseconds since 1970", zone=False)
UNIX_NS = _format("offset", r"(?P<oms>\d{13})(?P<of>\d{6})", "nanoseconds since 1970", zone=False)
MILLISECOND = _format("millisecond", r"(?P<ms>\d{1,3})(?:[.,]0*)?", "0...999", zone=False)
MILLISECONDS = re.compile(r"(?i)^(ms|msec|millise[ck]\w*|millis|毫秒)\b")  # the name of such a column
# parts of a second in a column behind whole ones: the name of such a column, and how its cells read
_PARTS_OF_A_SECOND = (
    (MILLISECONDS, MILLISECOND),
    (
        re.compile(r"(?i)^([uµμ]s|[uµμ]sec|mi[ck]rose[ck]\w*|micros|微秒)\b"),
        _format("microsecond", r"(?P<us>\d{1,6})(?:[.,]0*)?", "0...999999", zone=False),
    ),
    (
        re.compile(r"(?i)^(s|sec|seconds?)$"),
        _format("fraction", r"0?[.,](?P<f>\d{1,9})\d*", "0.000...0.999", zone=False),
    ),
)
_TEXTS = {"ymd": "YYYY-MM-DD", "dmy": "DD.MM.YYYY", "mdy": "MM/DD/YYYY", "cjk": "YYYY年MM月DD日"}
DATE = {order: _format("date", body, _TEXTS[order], zone=False) for order, body in _DATES.items()}
DATETIME = {
    # a spreadsheet leaves out the time of day at midnight
    order: _format("datetime", f"{body}(?:{_BETWEEN}{_TIME})?", f"{_TEXTS[order]} HH:MM:SS")
    for order, body in _DATES.items()
}


def part_of_a_second(name: str) -> TimeFormat | None:
    """How a column of this name behind whole seconds tells their parts; None where its name says nothing of them."""
    return next((form for known, form in _PARTS_OF_A_SECOND if known.match(name)), None)


def with_zone(form: TimeFormat, zoned: bool) -> TimeFormat:
    """The same format for cells that all name their offset from UTC, or that none of them does: a column's zone is one
    thing for all of its rows."""
    if form.role not in ("datetime", "time") or not form.body:
        return form
    text = form.text + (" and an offset from UTC" if zoned else "")
    return replace(form, pattern=_compile(form.body + (ZONE if zoned else "")), zoned=zoned, text=text)


def is_zoned(cell: str, form: TimeFormat) -> bool:
    """Whether a cell names its offset from UTC."""
    match = form.pattern.fullmatch(cell) if form.pattern is not None else None
    return bool(match is not None and match.groupdict().get("z"))


def declared_format(text: str) -> TimeFormat:
    """The format that a campaign file declares in strptime's letters; FormatError for a letter that is none."""
    letters = set(re.findall(r"%(.)", text))
    for needed, what in (("YyGcx", "a year: %Y or %y"), ("mbBjUWVcx", "a month: %m or %b")):
        if letters & (_CALENDAR | set("cx")) and not letters & set(needed):
            raise FormatError(f"time format '{text}' cannot be used", expected=what, got="a day without it")
    if letters - _STRPTIME.keys() and letters <= _STRPTIME.keys() | _OTHERS:
        role = "datetime" if letters & set("HIcX") else "date"
        return TimeFormat(role, None, text, zoned="z" in letters or None, strptime=text)
    body, used = "", set()
    for part in re.findall(r"%.?|[^%]+", text):
        if not part.startswith("%"):
            body += re.escape(part)
        elif part[1:] in _STRPTIME:
            body += _STRPTIME[part[1:]]
            used.add(part[1:])
        else:
            raise FormatError(
                f"time format '{text}' cannot be used", expected="%Y %y %m %d %b %H %I %M %S %f %p %z", got=part
            )
    day, clock = bool(used & _CALENDAR), bool(used & {"H", "I"})
    if "M" in used and not day and not clock:  # '%M:%S' are minutes from a start
        body = body.replace(_STRPTIME["M"], r"(?P<N>\d{1,5})")
    try:
        pattern = _compile(body)
    except re.error as error:
        raise FormatError(f"time format '{text}' cannot be used", got=str(error)) from None
    role = "datetime" if day and clock else "date" if day else "time"
    return TimeFormat(role, pattern, text, zoned=bool(used & {"z", "Z"}) or None)


_CLOCK_TEXT = re.sub(r"\?P<\w+>", "?:", _TIME + ZONE + "?")
_DATE_TEXT = (
    r"(?:\d{4}([-/.]) ?\d{1,2}\1 ?\d{1,2}|\d{1,2}([-/.]) ?\d{1,2}\2 ?(?:\d{4}|\d{2})|"
    r"\d{4}[年년] ?\d{1,2}[月월] ?\d{1,2}[日일])"
)
_ANY_DATE = _compile(rf"{_DATE_TEXT}(?:{_BETWEEN}{_CLOCK_TEXT})?")


def is_date_text(cell: str) -> bool:
    """Whether a text is a date, with or without a time of day, in any order of day and month."""
    return _ANY_DATE.fullmatch(cell) is not None


def is_time_of_day(cell: str) -> bool:
    """Whether a text is a time of day without a date, or a duration that is written like one."""
    return any(form.pattern is not None and form.pattern.fullmatch(cell) for form in (TIME_OF_DAY, ELAPSED, MINUTES))


def parse(cells: Any, form: TimeFormat) -> Int1D:
    """Nanoseconds of each cell: since 1970 for a date or datetime (UTC where the cell carries an offset, else
    local), in the day for a time. cells: an Arrow string array without nulls, or a list. NAT where none."""
    import pyarrow as pa

    column = text_array(cells) if isinstance(cells, list) else cells
    if isinstance(column, pa.ChunkedArray):
        column = column.combine_chunks()
    if isinstance(column, pa.ChunkedArray):  # pyarrow may return one of no chunks
        column = pa.array([], pa.string())
    n, start = len(column), column.offset
    result = np.full(n, NAT, np.int64)
    if not n:
        return result
    if form.pattern is None:
        return _by_strptime(column.to_pylist(), form)
    if (iso := _iso(column, form)) is not None:
        return iso
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


def _iso(column: Any, form: TimeFormat) -> Int1D | None:
    """2026-03-01 08:00:00.125 and the like by Arrow's own parser; None where a cell is written in another way."""
    import pyarrow as pa

    if form.body != DATETIME["ymd"].body or form.zoned:  # a declared format may have its day before its month
        return None
    if column.null_count or _ISO.match(column[0].as_py()) is None:
        return None
    try:
        cast = column.cast(pa.timestamp("ns"))
    except pa.ArrowException:
        return None
    if not _has_colons(column):
        return None
    ns: Int1D = np.frombuffer(cast.buffers()[1], np.int64, len(cast), cast.offset * 8)
    return ns if int(ns.min()) >= _FIRST_NS and int(ns.max()) < _LAST_NS else None


def _has_colons(column: Any) -> bool:
    """Whether each ISO time of day has minutes behind a colon: Arrow takes "2026-03-01 08" (what is left of a torn
    cell) and "2026-03-01 083000" too, which are no times alone."""
    start, n = column.offset, len(column)
    _, ends, letters = column.buffers()
    offsets = np.frombuffer(ends, np.int32)[start : start + n + 1]
    widths = np.diff(offsets)
    clocked = widths > 10  # dates alone are midnight
    data = np.frombuffer(letters, np.uint8)
    return bool((widths[clocked] > 13).all() and (data[offsets[:-1][clocked] + 13] == ord(":")).all())


def _by_strptime(cells: list[str | None], form: TimeFormat) -> Int1D:
    """Cells of a declared format with names of months and the like, each different one once."""
    known: dict[str, int] = {}
    for cell in {c or "" for c in cells}:
        try:
            moment = datetime.strptime(cell.strip(), form.strptime or "")
        except ValueError:
            known[cell] = NAT
            continue
        since = moment.replace(tzinfo=moment.tzinfo or UTC) - datetime(1970, 1, 1, tzinfo=UTC)
        known[cell] = since // timedelta(microseconds=1) * 1000
    return np.array([known[c or ""] for c in cells], np.int64)


def parse_one(cell: str, form: TimeFormat) -> int:
    """One cell; NAT where it is no time."""
    if form.strptime is not None:
        return int(_by_strptime([cell], form)[0])
    match = form.pattern.fullmatch(cell) if form.pattern else None
    if match is None:
        return NAT
    g = match.groupdict()
    if g.get("ms") is not None:
        return int(g["ms"]) * 1_000_000
    if g.get("us") is not None:
        return int(g["us"]) * 1000
    if g.get("oms") is not None:
        return int(g["oms"]) * 1_000_000 + int((g["of"] or "0").ljust(6, "0"))
    total = 0
    if g.get("m") is not None:
        year = int(g["Y"]) if g.get("Y") else int(g["y"]) + (2000 if int(g["y"]) < CENTURY else 1900)
        if not 1900 <= year <= 2200:
            return NAT
        try:
            total = (date(year, int(g["m"]), int(g.get("d") or 1)) - _EPOCH).days * _DAY
        except ValueError:
            return NAT
    if g.get("H") is not None:
        hour, minute, second = int(g["H"]), int(g.get("M") or 0), int(g.get("S") or 0)
        if g.get("p"):
            if not 1 <= hour <= 12:
                return NAT
            hour = hour % 12 + (12 if g["p"][0] in "pP" else 0)
        if hour > 23 or minute > 59 or second > 59:
            return NAT
        total += (hour * 3600 + minute * 60 + second) * _S
    if g.get("E") is not None:
        minute, second = int(g.get("M") or 0), int(g.get("S") or 0)
        if minute > 59 or second > 59:
            return NAT
        total += (int(g["E"]) * 3600 + minute * 60 + second) * _S
    if g.get("N") is not None:
        second = int(g.get("S") or 0)
        if second > 59:
            return NAT
        total += (int(g["N"]) * 60 + second) * _S
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
    if "us" in fields:
        return fields["us"] * 1000
    if "oms" in fields:
        return fields["oms"] * 1_000_000 + fields.get("of", np.zeros_like(fields["oms"]))
    size = next(iter(fields.values())).shape
    total, bad = np.zeros(size, np.int64), np.zeros(size, bool)
    minute, second = (fields.get(x, np.zeros(size, np.int64)) for x in "MS")
    if "m" in fields:
        year = fields.get("Y")
        if year is None:
            year = fields["y"] + np.where(fields["y"] < CENTURY, 2000, 1900)
        month, day = fields["m"], fields.get("d", np.ones(size, np.int64))
        bad |= (month < 1) | (month > 12) | (year < 1900) | (year > 2200) | (day < 1)
        safe = np.clip(month, 1, 12)
        leap = (year % 4 == 0) & ((year % 100 != 0) | (year % 400 == 0))
        bad |= day > _DAYS_IN_MONTH[safe] - ((safe == 2) & ~leap)
        total += _days(year, safe, day) * _DAY
    if "H" in fields:
        hour = fields["H"]
        if groups.get("p"):
            bad |= (hour < 1) | (hour > 12)
            hour = hour % 12 + (12 if groups["p"][0] in "pP" else 0)
        bad |= (hour > 23) | (minute > 59) | (second > 59)
        total += (hour * 3600 + minute * 60 + second) * _S
    if "E" in fields:
        bad |= (minute > 59) | (second > 59)
        total += (fields["E"] * 3600 + minute * 60 + second) * _S
    if "N" in fields:
        bad |= second > 59
        total += (fields["N"] * 60 + second) * _S
    if "f" in fields:
        total += fields["f"]
    if groups.get("z"):
        total -= offset_ns(groups["z"])
    return np.where(bad, NAT, total)


def _days(year: Int1D, month: Int1D, day: Int1D) -> Int1D:
    """Days since 1970-01-01 in the Gregorian calendar (Hinnant, days_from_civil)."""
    y = year - (month <= 2)
    era = y // 400
    of_era = y - era * 400
    of_year = (153 * (month + np.where(month > 2, -3, 9)) + 2) // 5 + day - 1
    result: Int1D = era * 146_097 + of_era * 365 + of_era // 4 - of_era // 100 + of_year - 719_468
    return result
