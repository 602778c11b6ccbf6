"""How the time columns of a table are written, told from their cells; and the times of a whole column in memory.

The order of day and month is read from the column, never guessed: dots mean day first (where a year of two digits may
not come first), a number above 12 decides, and AM or PM means month first. A column's cells all name their offset from
UTC, or none of them does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.time_forms.time_pattern import (
    DATE,
    DATETIME,
    DAY_NS,
    ELAPSED,
    HOURS,
    MINUTES,
    TIME_OF_DAY,
    TimeFormat,
)
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.one_cell.clock_letters import refuse_unread, with_clock
from thermodata.reader.text.times.one_cell.clock_words import CLOCKS, ask_for_minutes
from thermodata.reader.text.times.one_cell.spans import SPAN, are_spans
from thermodata.reader.text.times.several_cells import time_cells
from thermodata.reader.text.times.several_cells.clock_numbers import clock_of_numbers, since_midnight_format
from thermodata.reader.text.times.several_cells.date_parts import PART, declared_parts
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.zone import NAT

_FEW, _MANY = 40, 4000
_SHORT = re.compile(r"\s*'?(\d{2})[-/.](\d{2})[-/.](\d{2})(?!\d)")
_HUNDREDS = re.compile(r"\s*\d{3,}:")  # hours in three digits
_HINT = "declare table: {time: {format: dmy}} or mdy, or strptime's letters: '%d/%m/%Y %H:%M:%S'"
_MIDNIGHT_NS = 3600 * 10**9  # within which the row after midnight follows
_ORDERS = ("dmy", "mdy", "ymd")  # what may be declared in place of letters


def share(cells: Sequence[str], form: TimeFormat) -> float:
    """How many of the cells that hold anything are times of this format; 0 where most hold nothing."""
    full = [c for c in cells if c and c.strip()]
    return (
        sum(timestamp.parse_one(c, form) != NAT for c in full) / len(full) if len(full) >= 0.5 * len(cells) > 0 else 0.0
    )


def _spread_evenly(cells: Sequence[str], most: int) -> Sequence[str]:
    return cells[:: max(1, len(cells) // most)]


def find_formats(
    names: Sequence[str],
    columns: Sequence[Sequence[str]],
    declared: str | None,
    where: str,
    more: Callable[[int], Sequence[str]] = lambda k: (),
) -> tuple[TimeFormat, ...]:
    """The format of each time column of one time (a date and a time of day add up).

    names, columns: their names, and sampled cells of each; declared: strptime's letters, the order of day and month
    (dmy, mdy, ymd), or what two parts of a time are (mm:ss, hh:mm); more: further cells of the k-th column, asked for
    where those do not tell day from month. QuestionError: no order of day and month in all of them, or 05:10 that may
    be minutes or hours; FormatError: no cell is a time.
    """
    if declared == UNKNOWN:
        raise unanswered("time.format", f"{', '.join((*_ORDERS, *CLOCKS))}, or strptime's letters", where)
    if (of_day := since_midnight_format(declared)) is not None and len(columns) == 1:
        return (of_day,)
    order = declared if declared in _ORDERS else None
    clock = declared if declared in CLOCKS else None
    if declared is None and len(columns) == 1:
        ask_for_minutes(names[0], columns[0], partial(more, 0), where)
    forms: list[TimeFormat] = list(declared_parts(declared, len(columns)))
    if forms:
        declared = None  # what stands beside a date in parts tells its own format
    runs = [[k + len(forms) for k in run] for run in time_cells.runs(columns[len(forms) :])]
    wanted: Sequence[str] = () if declared is None or order or clock else [declared]
    if declared is not None and len(columns) > 1 and len(pieces := declared.split()) in (len(columns), len(runs)):
        each = len(pieces) == len(columns)
        wanted = [" ".join(pieces[k] for k in run) for run in runs] if each else pieces
    elif declared is not None and len(runs) > 1 and wanted and not forms:
        joined = [time_cells.joined_cells([columns[i] for i in run]) for run in runs]
        wanted = _format_by_column(declared.split(" "), joined) or wanted
    for at, run in enumerate(runs):
        k, name = run[0], names[run[0]]
        cells = columns[k] if len(run) == 1 else time_cells.joined_cells([columns[i] for i in run])
        whole = bool(forms) and forms[-1].text == "minutes"  # whose seconds stand behind them
        behind = time_pattern.part_of_a_second(name) if k and not whole else None
        if behind is not None:
            forms.append(behind)
            continue
        form = None
        further = partial(_further, more, run)
        alone = len(runs) == 1 and not forms
        for text in wanted[at : at + 1] if len(wanted) == len(runs) else wanted:
            own = time_pattern.declared_format(text)
            if alone:
                refuse_unread(text, own, _spread_evenly(cells, _MANY), share, f"{where} column '{name}'")
            form = own if alone or share(_spread_evenly(cells, _FEW), own) > 0.5 else form
        if form is None and k and forms[0].role == "date":
            form = clock_of_numbers(name, cells)
        form = form or _two_parts(clock, cells, further()) or find_format(cells, where, name, further, order)
        form = _zoned(form, cells)
        forms.append(form if len(run) == 1 else time_cells.read_together(form, [columns[i] for i in run]))
        forms += [PART] * (len(run) - 1)
    return tuple(forms)


def _format_by_column(pieces: Sequence[str], columns: Sequence[Sequence[str]]) -> list[str]:
    """A declared format of several columns ('%d. %b %Y %H:%M:%S') as one of each, by which its cells are read; empty
    where it cannot be parted so."""
    few = _spread_evenly(columns[0], _FEW)
    for end in range(1, len(pieces)) if len(columns) > 1 else [len(pieces)]:
        first = " ".join(pieces[:end])
        try:
            reads = share(few, time_pattern.declared_format(first)) > 0.5
        except FormatError:
            continue  # a day without its month
        if reads and len(columns) == 1:
            return [first]
        if reads and (rest := _format_by_column(pieces[end:], columns[1:])):
            return [first, *rest]
    return []


def _further(more: Callable[[int], Sequence[str]], run: Sequence[int]) -> Sequence[str]:
    return more(run[0]) if len(run) == 1 else time_cells.joined_cells([more(k) for k in run])


def _zoned(form: TimeFormat, cells: Sequence[str]) -> TimeFormat:
    some = [c for c in _spread_evenly(cells, _FEW) if timestamp.parse_one(c, form) != NAT]
    zoned = sum(time_pattern.is_zoned(c, form) for c in some)
    return time_pattern.with_zone(form, zoned * 2 > len(some))


def _two_parts(clock: str | None, cells: Sequence[str], more: Sequence[str]) -> TimeFormat | None:
    """The format of cells of two parts that are declared or named; None where they have others."""
    few = _spread_evenly(cells, _FEW)
    if clock == "mm:ss" and share(few, MINUTES) > 0.5:
        return MINUTES
    return HOURS if clock == "hh:mm" and share(few, HOURS) > 0.5 and _goes_on(more or cells, HOURS) else None


def find_format(
    cells: Sequence[str],
    where: str,
    name: str = "",
    more: Callable[[], Sequence[str]] = tuple,
    order: str | None = None,
) -> TimeFormat:
    """The format of cells of one column, whether they name an offset from UTC or not; errors as above. order: the
    declared one of day and month."""
    few = _spread_evenly(cells, _FEW)
    if share(few, SPAN) > 0.8 and are_spans(more() or cells):
        return SPAN
    if share(few, ELAPSED) > 0.8 and _goes_on(more() or cells, ELAPSED):
        return ELAPSED
    for least in (0.8, 0.3):
        for forms, enough in (({"": TIME_OF_DAY}, least), (DATE, max(least, 0.9)), (DATETIME, least)):
            known = {o: form for o, form in forms.items() if order is None or o in ("", order)}
            orders = [o for o, form in known.items() if share(few, form) > enough]
            if orders:
                if order is None:
                    _ask_for_year(few, where)
                return _ordered(orders, cells, more, forms, where)
    full = [c for c in cells if c.strip()]
    other = next(
        (
            o
            for forms in (DATE, DATETIME)
            for o, f in forms.items()
            if order and o not in ("", order) and share(few, f) > 0.8
        ),
        None,
    )
    if other is not None:
        raise FormatError(
            f"dates that are declared as {order} can only be {other}",
            where=f"{where} column '{name}'",
            expected=f"format: {other} for these",
            got=full[0],
            hint=f"where other files are {order}, a source of its own for those that are {other}, with table: {{time: "
            f"{{format: {other}}}}}",
        )
    raise FormatError(
        "the time column holds no times",
        where=f"{where} column '{name}'",
        expected="a date, a time of day, or both: 2026-03-01 08:00:00, 1.3.2026 8:00, ...",
        got=full[0] if full else "nothing",
        hint="declare table: {time: {column: ..., unit: s}} for numbers, or a format: '%d.%m.%Y %H:%M:%S'",
    )


def _goes_on(cells: Sequence[str], form: TimeFormat) -> bool:
    """Whether durations reach beyond a day, or leave room for it (000:10:00), and never fall: a damaged time of day is
    none."""
    ns = timestamp.parse(list(cells), form)
    ns = ns[ns != NAT]
    if not ns.size:
        return False
    roomy = all(_HUNDREDS.match(c) for c in cells if c.strip())
    beyond = ns.max() > DAY_NS or (ns.max() == DAY_NS and ns[0] == 0)  # 24:00:00 may be the end of a day, too
    return bool((roomy or beyond) and (np.diff(ns) >= 0).all())


def _ordered(
    orders: list[str],
    cells: Sequence[str],
    more: Callable[[], Sequence[str]],
    forms: Mapping[str, TimeFormat],
    where: str,
) -> TimeFormat:
    """The form that the dates' order tells."""
    if len(orders) == 1:
        return forms[orders[0]]
    first = next(c.strip() for c in cells if c.strip())
    if "." in re.split(r"[ T]", first)[0]:
        return forms["dmy"]
    left = orders
    for some in (partial(_spread_evenly, cells, _MANY), more):
        shares = {o: share(_dates(some()), forms[o]) for o in left}
        best = max(shares.values())
        left = [o for o in left if shares[o] == best]
        if len(left) == 1:
            return forms[left[0]]
    by_midnight = [o for o in left if _passes_midnight(more() or cells, forms[o])]
    if len(by_midnight) == 1:
        return forms[by_midnight[0]]
    if re.search(r"[ap]\.?m", first, re.IGNORECASE) and "mdy" in left:
        return replace(forms["mdy"], supposed=True)
    raise QuestionError(
        "day and month of the dates could be either way round",
        where=where,
        expected="one date with a day above 12",
        got=first,
        hint=_HINT,
        ask=f"format of the dates: dmy or mdy? {first} may be either",
        declare={"time": {"format": UNKNOWN}},
        meanwhile={"time": {"format": "dmy"}},
    )


def _passes_midnight(cells: Sequence[str], form: TimeFormat) -> bool:
    """Whether the date changes somewhere from one row to the next within minutes: read the other way round, it would
    go on by a month there."""
    ns = timestamp.parse([c for c in cells if c.strip()], form)
    if form.role != "datetime" or ns.size < 2:
        return False
    turns = (ns[1:] // DAY_NS != ns[:-1] // DAY_NS) & (ns[1:] != NAT) & (ns[:-1] != NAT)
    return bool((np.abs(np.diff(ns))[turns] < _MIDNIGHT_NS).any())


def _ask_for_year(cells: Sequence[str], where: str) -> None:
    """QuestionError where all dates may begin with a year of two digits, as loggers of East Asia write them, and would
    be older with their year at the end: 26/03/14 is of 2026 or of 2014."""
    parts = [m for c in cells if (m := _SHORT.match(c))]
    latest = datetime.now(UTC).year % 100
    if not parts or 10 * len(parts) < 9 * len([c for c in cells if c.strip()]):
        return
    for first, middle, last in ((int(x) for x in m.groups()) for m in parts):
        if not (last < first <= latest and 1 <= middle <= 12 and last >= 1):
            return
    got = parts[0].group().strip(" '")
    date = f"%y{got[2]}%m{got[2]}%d"
    spelled = {with_clock(date, m.string[m.end() :]) for m in parts}
    letters = max(sorted(spelled), key=lambda text: share(cells, time_pattern.declared_format(text)))
    raise QuestionError(
        "dates with a year of two digits at either end",
        where=where,
        expected="a year of four digits, or its place declared",
        got=got,
        hint=f"declare table: {{time: {{format: '{letters}'}}}}, or {{format: dmy}}",
        ask=f"format of the dates: '{letters}' or dmy? {got} may be either",
        declare={"time": {"format": UNKNOWN}},
        meanwhile={"time": {"format": "dmy"}},
    )


def _dates(cells: Sequence[str]) -> list[str]:
    """One cell a day: the first ten letters hold day and month."""
    return list({c.strip()[:10]: c for c in cells if c.strip()}.values())
