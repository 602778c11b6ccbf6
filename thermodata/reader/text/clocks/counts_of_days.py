"""Times that count days or years from a date, by the size and the steps of their numbers; and numbers that can be no
times in the unit that they are said to have."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Array
from thermodata.reader.text.clocks.counts_of_seconds import Count, OpenTimes, may_be, scale_question
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.reader.times.time_units import EPOCHS, REACH_S, SECONDS, date_of_count, found_epoch

_SAID = {"jd": "Julian days, in UTC", "mjd": "modified Julian days, in UTC", "decimal_year": "decimal years"}
_MJD_NAME = re.compile(r"(?i)(?:^|[\W_])mjd(?:$|[\W_])|modified[\W_]*julian")
_DATE_NAME = re.compile(r"(?i)dat")
_MJD_2000 = 51_544
_LOGGED_YEARS = 1.5e-4  # from row to row: an hour and a bit, as four digits behind the point have it
_QUICK_S = 5e-6  # from row to row: what measures heat is slower by far


def may_be_excel(values: Array) -> bool:
    """Whether numbers may be Excel's days of 2000 to 2099; or seconds all the same."""
    return _are_days(values, 36_526, 73_051) and float(np.ptp(values)) < 400


def counted_by(name: str, values: Array) -> str | None:
    """The count of days or years that numbers can only be, by their size and their steps: Julian days (1983 to 2119),
    decimal years (1990 to 2099), and modified Julian days where the name says so, for Excel's are of the same size.
    None where they may be something else. values: shape (n,)."""
    if _are_days(values, 2_445_500, 2_495_000):
        return "jd"
    if _MJD_NAME.search(name) and _are_days(values, 40_000, 90_000):
        return "mjd"
    if not _are_days(values, 1990, 2100) or float(np.ptp(values)) >= 10:
        return None
    # within some days from row to row, mostly an hour: seconds beyond 1990 have steps of hundredths; whole years only,
    # or few of them, are anything
    steps = np.diff(values)
    years = bool((steps > 0).all()) and float(steps.max()) < 0.02 and float(np.median(steps)) <= _LOGGED_YEARS
    return "decimal_year" if years and float(np.median(values % 1)) else None


def count_question(name: str, values: Array, where: str, column: int | None = None) -> QuestionError | None:
    """Asks whether a time is such a count, in the draft that reads it so meanwhile; None where it is none. column: its
    number, from 1, where its name does not tell it for a time."""
    if (scale := scale_question(name, values, where, column)) is not None:
        return scale
    unit = counted_by(name, values)
    if unit is None:
        return None
    times, count = OpenTimes(name, values[0], where, column), Count(unit, _SAID[unit], date_of_count(values[0], unit))
    return may_be(times, count, declare_else="; else {time: {period: 60 s}}")


def excel_or_question(name: str, values: Array, where: str, other: str) -> str:
    """'excel' for what may be Excel's days where the name says that it is a date; QuestionError elsewhere. other: the
    unit in which the numbers count from a start, if they do."""
    if _DATE_NAME.search(name):
        return "excel"
    days = f"excel (days since 1900: {_day(values[0], 'excel')})"
    if values[0] > _MJD_2000:
        days += f", mjd (modified Julian days: {_day(values[0], 'mjd')})"
    from_start = "d (days from a start)" if other == "d" else other
    raise QuestionError(
        f"times that may be Excel's days or {'days from a start' if other == 'd' else 'seconds'}",
        where=where,
        got=f"{name}: {values[0]:.12g} ...",
        expected="a unit",
        hint=f"declare table: {{time: {{unit: excel}}}}, unit: mjd or unit: {other}",
        ask=f"unit of the time: {days} or {from_start}? '{name}' begins with {values[0]:.12g}",
        declare={"time": {"unit": UNKNOWN}},
        meanwhile={"time": {"unit": "excel"}},
    )


def _day(number: float, unit: str) -> str:
    """The day that a count of days says."""
    return str(np.datetime64(int(number) + EPOCHS[unit].zero_s // 86400, "D"))


def refuse_beyond(name: str, values: Array, unit: str, where: str, declared: bool) -> None:
    """FormatError where most numbers are longer than any time in their unit, as days counted from a date are. Where
    the file says that unit and no declaration does (`declared`), a QuestionError once their size tells what they are.
    """
    seconds = SECONDS.get(unit)
    finite = values[np.isfinite(values)]
    if seconds is None or not finite.size or float(np.median(np.abs(finite))) * seconds < REACH_S:
        return
    epoch = counted_by(name, finite) or found_epoch(finite)
    told = f": as {epoch} it is {date_of_count(finite[0], epoch)}" if epoch else ""
    what = f"'{name}' can be no time in {unit}"
    said: dict[str, Any] = {
        "where": where,
        "expected": f"up to {REACH_S / seconds:.3g} {unit} ({REACH_S / SECONDS['d'] / 365.25:.0f} years)",
        "got": f"{finite[0]:.14g}",
        "hint": f"declare table: {{time: {{unit: {epoch or '...'}}}}}{told}; counted from a date are "
        f"{', '.join(EPOCHS)}",
    }
    if epoch is None or declared:
        raise FormatError(what, **said)
    answer = {"time": {"unit": epoch}}
    then = f"{finite[0]:.14g} is {date_of_count(finite[0], epoch)} then, and none in {unit}"
    ask = f"unit of the time: is '{name}' in {epoch}? {then}"
    raise QuestionError(what, ask=ask, declare=answer, meanwhile=answer, times=[name], **said)


def days_note(name: str, values: Array, unit: str) -> list[str]:
    """What is told of a declared unit in which numbers that are days counted from a date are read as a span."""
    finite = values[np.isfinite(values)]
    days = "excel" if _DATE_NAME.search(name) and may_be_excel(finite) else counted_by(name, finite)
    if unit not in SECONDS or not finite.size or days is None:
        return []
    return [
        f"'{name}' is read in {unit}, as declared; by itself it counts {days}, from {date_of_count(finite[0], days)}: "
        f"declare table: {{time: {{unit: {days}}}}} if it does"
    ]


def quick_note(name: str, values: Array, unit: str) -> str | None:
    """What is told of rows that follow each other by less than any sensor of heat needs; None where they do not."""
    seconds = SECONDS.get(unit)
    finite = values[np.isfinite(values)]
    steps = np.abs(np.diff(finite))
    if seconds is None or not steps.size or not 0 < float(np.mean(steps)) * seconds < _QUICK_S:
        return None
    epoch = counted_by(name, finite)
    step_us = float(np.mean(steps)) * seconds * 1e6
    or_as = f"; as {epoch} it begins at {date_of_count(finite[0], epoch)}" if epoch else ""
    return (
        f"rows are {step_us:.2g} us apart by '{name}' in {unit}: is that its unit{or_as}? "
        "declare table: {time: {unit: ...}} if it is not"
    )


def _are_days(values: Array, first: float, last: float) -> bool:
    """Whether numbers may be days between two counts, in steps below some hours."""
    days = values.size > 1 and bool(((values > first) & (values < last)).all())
    return days and bool((np.abs(np.diff(values)) < 0.2).all()) and bool((values != np.floor(values)).any())
