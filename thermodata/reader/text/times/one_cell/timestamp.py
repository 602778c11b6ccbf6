"""What the cells of a time column say, in nanoseconds; read for whole columns at once.

Years of two digits are 1969 to 2068, as POSIX has them. Times without an offset are local: `local_clock` resolves them.

Cells of one width share the places of their digits, so a column is read as a byte matrix; only the rows that
differ go through the regular expression one by one.
"""

from __future__ import annotations

import re
from datetime import UTC, date, datetime, timedelta
from typing import Any

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Int1D
from thermodata.reader.text.cells.time_forms.calendar_words import in_english
from thermodata.reader.text.cells.time_forms.clock_pattern import in_24_hours
from thermodata.reader.text.cells.time_forms.time_pattern import DATETIME, DAY_NS, PARTS_NS, TimeFormat
from thermodata.reader.text.cells.time_forms.zone_words import offset_ns, with_zone_in_digits
from thermodata.reader.text.cells.values.arrow import text_array
from thermodata.reader.times.zone import NAT

CENTURY = 69  # years of two digits below it are of this one: 1969 to 2068, as strptime's %y
_NO_NUMBERS = ("s", "p", "q", "z")  # parts of a pattern
_REIWA = 2018  # the year before its first one
_S = 1_000_000_000
_LAST_SECOND = 60  # of a minute with a leap second, or rounded up: read as the minute after it
_END_HOUR = 24  # 24:00:00 is the end of a day, and the beginning of the next (ISO 8601)
_DAY_ENDS = re.compile(r"(?<![\d:])24(?=:00(?::00(?:[.,]0+)?)?(?![:.,\d]))")
_EPOCH = date(1970, 1, 1)
_DAYS_IN_MONTH = np.array([0, 31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31])
_ISO = re.compile(r"^\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d{1,9})?)?$", re.ASCII)
_FIRST_NS, _LAST_NS = ((date(year, 1, 1) - _EPOCH).days * DAY_NS for year in (1900, 2201))


def parse(cells: Any, form: TimeFormat) -> Int1D:
    """Nanoseconds of each cell: since 1970 for a date or datetime (UTC where the cell carries an offset, else
    local), in the day for a time. cells: an Arrow string array without nulls, or a list. NAT where none."""
    import pyarrow as pa

    column = text_array(cells) if isinstance(cells, list) else cells
    if isinstance(column, pa.ChunkedArray):
        column = column.combine_chunks()
    if isinstance(column, pa.ChunkedArray):  # pyarrow may return one of no chunks
        column = pa.array([], pa.string())
    n = len(column)
    result = np.full(n, NAT, np.int64)
    if not n:
        return result
    if form.reads is not None:
        cells = [c or "" for c in column.to_pylist()]
        each = {c: form.reads(c) for c in set(cells)}
        return np.array([each[c] for c in cells], np.int64)
    if form.pattern is None:
        return _by_strptime(column.to_pylist(), form)
    column = _plain_blanks(column)
    if (iso := _iso(column, form)) is not None:
        return iso
    start = column.offset
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


def _plain_blanks(column: Any) -> Any:
    """Cells with blanks in place of those that do not break: so cells of a width stay bytes of a width."""
    import pyarrow.compute as pc

    _, _, data = column.buffers()
    if data is None or not (np.frombuffer(data, np.uint8) > 127).any():
        return column
    for blank in ("\u00a0", "\u202f", "\u2009"):
        column = pc.replace_substring(column, blank, " ")
    return column


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
        text, ends = _DAY_ENDS.subn("00", with_zone_in_digits(cell.strip()) if form.zoned else cell.strip())
        try:
            moment = datetime.strptime(*in_english(text, form.strptime or "")) + timedelta(days=ends)
        except (ValueError, re.error):  # a format that names a month twice is no pattern
            known[cell] = NAT
            continue
        since = moment.replace(tzinfo=moment.tzinfo or UTC) - datetime(1970, 1, 1, tzinfo=UTC)
        known[cell] = since // timedelta(microseconds=1) * 1000
    return np.array([known[c or ""] for c in cells], np.int64)


def parse_one(cell: str, form: TimeFormat) -> int:
    """One cell; NAT where it is no time."""
    if form.reads is not None:
        return form.reads(cell)
    if form.strptime is not None:
        return int(_by_strptime([cell], form)[0])
    match = form.pattern.fullmatch(cell) if form.pattern else None
    if match is None:
        return NAT
    g = match.groupdict()
    if g and not any(text for name, text in g.items() if name not in _NO_NUMBERS):
        return NAT
    if (part := next((name for name in PARTS_NS if g.get(name) is not None), None)) is not None:
        return int(g[part]) * PARTS_NS[part]
    if g.get("os") is not None:
        return int(g["os"]) * _S + int((g["f"] or "0").ljust(9, "0"))
    if g.get("oms") is not None:
        return int(g["oms"]) * 1_000_000 + int((g["of"] or "0").ljust(6, "0"))
    total = 0
    if g.get("m") is not None:
        if g.get("R"):
            year = int(g["R"]) + _REIWA
        else:
            year = int(g["Y"]) if g.get("Y") else int(g["y"]) + (2000 if int(g["y"]) < CENTURY else 1900)
        if not 1900 <= year <= 2200:
            return NAT
        try:
            total = (date(year, int(g["m"]), int(g.get("d") or 1)) - _EPOCH).days * DAY_NS
        except ValueError:
            return NAT
    if g.get("H") is not None:
        hour, minute, second = int(g["H"]), int(g.get("M") or 0), int(g.get("S") or 0)
        if half := g.get("p") or g.get("q"):
            of_day = in_24_hours(hour, half)
            if of_day is None:
                return NAT
            hour = of_day
        ends = hour == _END_HOUR and not (half or minute or second or int(g.get("f") or 0))
        if (hour > 23 and not ends) or minute > 59 or second > _LAST_SECOND:
            return NAT
        total += (hour * 3600 + minute * 60 + second) * _S
    if g.get("E") is not None:
        minute, second = int(g.get("M") or 0), int(g.get("S") or 0)
        if minute > 59 or second > _LAST_SECOND:
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
        if text is None or name in _NO_NUMBERS:
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
    if not fields:  # 'PM' alone, in a declared format, is no time
        return np.full(len(matrix), NAT, np.int64), good
    if not good.all():  # '12:00:00 vorm.' is as long as '9:00:00 nachm.': what stands elsewhere is no number
        fields = {name: np.where(good, value, 0) for name, value in fields.items()}
    ns = _assemble(fields, match)
    return ns, good & (ns != NAT)


def _assemble(fields: dict[str, npt.NDArray[np.int64]], match: re.Match[str]) -> Int1D:
    groups = match.groupdict()
    if (part := next((name for name in PARTS_NS if name in fields), None)) is not None:
        return fields[part] * PARTS_NS[part]
    if "os" in fields:
        return fields["os"] * _S + fields.get("f", np.zeros_like(fields["os"]))
    if "oms" in fields:
        return fields["oms"] * 1_000_000 + fields.get("of", np.zeros_like(fields["oms"]))
    size = next(iter(fields.values())).shape
    total, bad = np.zeros(size, np.int64), np.zeros(size, bool)
    minute, second = (fields.get(x, np.zeros(size, np.int64)) for x in "MS")
    if "m" in fields:
        year = fields.get("Y")
        if "R" in fields:
            year = fields["R"] + _REIWA
        if year is None:
            year = fields["y"] + np.where(fields["y"] < CENTURY, 2000, 1900)
        month, day = fields["m"], fields.get("d", np.ones(size, np.int64))
        bad |= (month < 1) | (month > 12) | (year < 1900) | (year > 2200) | (day < 1)
        safe = np.clip(month, 1, 12)
        leap = (year % 4 == 0) & ((year % 100 != 0) | (year % 400 == 0))
        bad |= day > _DAYS_IN_MONTH[safe] - ((safe == 2) & ~leap)
        total += _days(year, safe, day) * DAY_NS
    if "H" in fields:
        hour = fields["H"]
        if half := groups.get("p") or groups.get("q"):
            of_day = np.array([-1 if (h := in_24_hours(k, half)) is None else h for k in range(100)])
            hour = of_day[hour]
            bad |= hour < 0
        ends = (hour == _END_HOUR) & (minute == 0) & (second == 0) & (fields.get("f", np.zeros(size, np.int64)) == 0)
        bad |= ((hour > 23) & ~(ends & (not half))) | (minute > 59) | (second > _LAST_SECOND)
        total += (hour * 3600 + minute * 60 + second) * _S
    if "E" in fields:
        bad |= (minute > 59) | (second > _LAST_SECOND)
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
