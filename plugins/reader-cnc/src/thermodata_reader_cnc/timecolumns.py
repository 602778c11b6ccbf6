"""Which columns of a table hold its time, and how they read: declared, absolute, or relative."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from thermodata.errors import FormatError
from thermodata.reader.text import clean, split_unit
from thermodata.reader.text import timestamp as when
from thermodata.reader.text.timestamp import TimeFormat
from thermodata.reader.zone import NAT
from thermodata_reader_cnc.header import Header


@dataclass(frozen=True, slots=True)
class Counted(TimeFormat):
    """A time that is a number of units."""

    unit_ns: int = 0


TimeColumns: TypeAlias = tuple[tuple[int, TimeFormat], ...]
_MILLISECONDS = re.compile(r"^(ms|msec|millise[ck]\w*|millis)\b", re.IGNORECASE)
_RELATIVE = re.compile(r"^(t|time|zeit|čas|cas|elapsed\w*|laufzeit|时间|時間|時刻|시간)$", re.IGNORECASE)
_UNIT_NS = {
    "s": 10**9,
    "sec": 10**9,
    "sek": 10**9,
    "ms": 10**6,
    "us": 10**3,
    "µs": 10**3,
    "min": 60 * 10**9,
    "h": 3600 * 10**9,
}


def _share(cells: Sequence[str], form: TimeFormat) -> float:
    """How many of the cells that hold anything are times of this format."""
    full = [c for c in cells if c.strip()]
    return sum(when.parse_one(c, form) != NAT for c in full) / len(full) if len(full) >= 0.5 * len(cells) > 0 else 0.0


def _spread(rows: Sequence[Sequence[str]], most: int = 40) -> list[Sequence[str]]:
    return list(rows[:: max(1, len(rows) // most)])


def absolute(tail: Sequence[Sequence[str]], others: Sequence[Sequence[str]], where: str) -> TimeColumns | None:
    """Columns of absolute times: a date and time in one, or a date and a time of day. None where there are none."""
    few = _spread(tail)
    if not few:
        return None
    columns = range(min(len(few[0]), 40))
    for forms in (when.DATETIME, when.DATE):
        for column in columns:
            cells = [r[column] for r in few]
            orders = [o for o, form in forms.items() if _share(cells, form) > 0.8]
            if not orders and any(_share(cells, form) > 0.3 for form in forms.values()):
                orders = [o for o, form in forms.items() if _share(cells, form) > 0.3]
            if not orders:
                continue
            order = _order(orders, [r[column] for r in _spread(tail, 2000)] + [r[column] for r in others], forms, where)
            if forms is when.DATETIME:
                return ((column, forms[order]),)
            clock = next(
                (c for c in columns if c != column and _share([r[c] for r in few], when.TIME_OF_DAY) > 0.8), None
            )
            if clock is not None:
                return (column, forms[order]), (clock, when.TIME_OF_DAY)
    return None


def _order(orders: list[str], cells: Sequence[str], forms: Mapping[str, TimeFormat], where: str) -> str:
    """Day or month first. Dots mean day first, AM/PM month first, a number above 12 decides, else it is an error."""
    if len(orders) == 1:
        return orders[0]
    if any("." in re.split(r"[ T]", c.strip())[0] for c in cells[:5]):
        return "dmy"
    shares = {o: _share(cells, forms[o]) for o in orders}
    best = max(shares.values())
    left = [o for o in orders if shares[o] == best]
    if len(left) == 1:
        return left[0]
    if any(re.search(r"[ap]\.?m", c, re.IGNORECASE) for c in cells[:5]) and "mdy" in left:
        return "mdy"
    raise FormatError(
        "day and month cannot be told apart",
        where=where,
        expected="DD/MM or MM/DD",
        got=cells[0].strip(),
        hint="declare table: {time: {format: '%d/%m/%Y %H:%M:%S'}}",
    )


def relative(rows: Sequence[Sequence[str]], tail: Sequence[Sequence[str]]) -> TimeColumns | None:
    """A column named Time with a unit of time in its name or in the row below."""
    for k, row in enumerate(rows[:60]):
        for column, cell in enumerate(row[:40]):
            name, unit = split_unit(clean(cell))
            if not _RELATIVE.match(name):
                continue
            if unit is None and k + 1 < len(rows) and column < len(rows[k + 1]):
                unit = clean(rows[k + 1][column]).strip("[]()")
            if unit in _UNIT_NS and tail and all(_is_number(r[column]) for r in _spread(tail)):
                return ((column, Counted("relative", None, f"a number [{unit}]", unit_ns=_UNIT_NS[unit])),)
    return None


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


def declared_time(
    table: Mapping[str, Any], rows: Sequence[Sequence[str]], body: Sequence[Sequence[str]], where: str
) -> TimeColumns | None:
    """The time columns that the campaign declares; FormatError where they do not read."""
    time = table["time"]
    wanted = time.get("column")
    forms = [when.declared_format(time["format"])] if time.get("format") else None
    if wanted is None:
        if forms is None:
            return None
        few = _spread(body)
        found = [c for c in range(len(few[0]) if few else 0) if _share([r[c] for r in few], forms[0]) > 0.8]
        if forms[0].role != "datetime" and len(found) == 1:
            others = [
                c for c in range(len(few[0])) if c != found[0] and _share([r[c] for r in few], when.TIME_OF_DAY) > 0.8
            ]
            if forms[0].role == "date" and others:
                return (found[0], forms[0]), (others[0], when.TIME_OF_DAY)
        if found and forms[0].role == "datetime":
            return ((found[0], forms[0]),)
        raise FormatError(
            "no column reads with the declared time format",
            where=where,
            expected=forms[0].text,
            got="; ".join(few[0])[:120] if few else "no rows",
        )
    columns = [_column(c, rows, where) for c in (wanted if isinstance(wanted, list) else [wanted])]
    if time.get("unit"):
        unit = str(time["unit"])
        if unit not in _UNIT_NS:
            raise FormatError("unknown unit of time", where=where, expected=", ".join(_UNIT_NS), got=unit)
        return ((columns[0], Counted("relative", None, f"a number [{unit}]", unit_ns=_UNIT_NS[unit])),)
    pairs = []
    for column in columns:
        cells = [r[column] for r in _spread(body, 2000) if column < len(r)]
        if forms and (len(columns) == 1 or _share(cells, forms[0]) > 0.8):
            pairs.append((column, forms[0]))
            continue
        for group in ({"": when.TIME_OF_DAY}, when.DATE, when.DATETIME):
            orders = [o for o, form in group.items() if _share(cells, form) > 0.8]
            if orders:
                pairs.append((column, group[_order(orders, cells, group, where) if orders != [""] else ""]))
                break
        else:
            raise FormatError(
                "the declared time column holds no times",
                where=f"{where} column {column + 1}",
                expected="a date, a time, or both",
                got=cells[0] if cells else "nothing",
                hint="declare table: {time: {unit: s}} for numbers, or a format",
            )
    return tuple(pairs)


def _column(wanted: int | str, rows: Sequence[Sequence[str]], where: str) -> int:
    if isinstance(wanted, int):
        return wanted - 1
    for row in rows[:60]:
        names = [clean(c) for c in row]
        for spelled in (names, [split_unit(n)[0] for n in names]):
            if wanted in spelled:
                return spelled.index(wanted)
    raise FormatError(
        f"no column '{wanted}'", where=where, expected="; ".join(clean(c) for c in rows[0])[:200], got=wanted
    )


def with_milliseconds(time: TimeColumns, header: Header, rows: Sequence[Sequence[str]]) -> TimeColumns:
    """A column of milliseconds right after the time belongs to it."""
    after = time[-1][0] + 1
    if (
        time[0][1].role != "relative"
        and after < len(header.names)
        and _MILLISECONDS.match(header.names[after])
        and _share([r[after] for r in rows], when.MILLISECOND) == 1.0
    ):
        return (*time, (after, when.MILLISECOND))
    return time


def first_row(rows: Sequence[Sequence[str]], width: int, time: TimeColumns, table: Mapping[str, Any]) -> int:
    """The 0-based place of the first row of data: declared, or the first whose time columns read."""
    if table.get("header_rows") is not None:
        return int(table["header_rows"])
    for k, row in enumerate(rows):
        if len(row) != width:
            continue
        if all(
            (_is_number(row[c]) if form.role == "relative" else when.parse_one(row[c], form) != NAT) for c, form in time
        ):
            while k and _torn(rows[k - 1], width, time):
                k -= 1
            return k
    return len(rows)


def _torn(row: Sequence[str], width: int, time: TimeColumns) -> bool:
    """Whether a row of another width is data all the same: it has its date and time, and something beside it."""
    return (
        len(row) != width
        and len(row) > len(time)
        and all(form.role != "relative" and c < len(row) and when.parse_one(row[c], form) != NAT for c, form in time)
    )
