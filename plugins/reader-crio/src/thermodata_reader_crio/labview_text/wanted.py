"""What a source declares of the time of plain LabVIEW text, and what is asked where it declares nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Float1D, Source
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.time_units import SECONDS, check_unit
from thermodata.schema.units.value import value_in


@dataclass(frozen=True)
class WantedTime:
    """column: its name, or number from 1; unit: of a time that counts from a start; period_s: from row to row, where no
    column is the time; sure: whether a column that may be the time or not is asked for."""

    column: Any = None
    unit: str | None = None
    period_s: float | None = None
    sure: bool = True


def wanted_of(source: Source, where: str) -> WantedTime:
    """`options: {time: 1, increment: 1 s}`, else `table: {time: {column: 1, unit: s}}` or `{period: 1 s}`. FormatError
    where an answer is open, or for several columns or a unit that counts from a date."""
    said = (source.table or {}).get("time") or {}
    if isinstance(said, list) or isinstance(said.get("column"), list):
        raise FormatError(
            "several columns for the time of LabVIEW's text",
            where=where,
            expected="one, in s, min or h",
            hint="name the one by which the rows follow each other",
        )
    column, unit, period = source.options.get("time", said.get("column")), said.get("unit"), said.get("period")
    if isinstance(period, int | float):
        period = f"{period} s"
    period = source.options.get("increment", period)
    if period == UNKNOWN:
        raise unanswered("time.period", "the time from row to row: 10 s, 1 min", where)
    if unit is not None and check_unit(str(unit), where) not in SECONDS:
        raise FormatError(
            "a unit that counts from a date",
            where=where,
            expected="s, min, h or ms",
            got=str(unit),
            hint="the rows count from a start: give that as the test's 'start'",
        )
    return WantedTime(column, unit, None if period is None else value_in(period, "s"))


def no_time(names: Sequence[str], where: str) -> QuestionError:
    """Rows of numbers without a time."""
    return QuestionError(
        "no time column",
        where=where,
        expected="a column called time, seconds since 1904, or rows at a declared period",
        got=", ".join(names[:12]),
        hint="declare options: {increment: 1 s} for rows at a period, or {time: 1} for a column of seconds",
        ask="period: the time from row to row, e.g. 10 s or 1 min? no column holds a time",
        declare={"time": {"period": UNKNOWN}},
        meanwhile={"time": {"period": 1.0}},
    )


def may_be_time(name: str, values: Float1D, where: str) -> QuestionError:
    """A first column, shape (n,), that rises from row to row as a time does, but also a temperature."""
    shown = f"{name}: {values[0]:g}, {values[1]:g}, ..."
    return QuestionError(
        "a first column that rises from row to row, and is not called a time",
        where=where,
        expected="a column called time, or a declared one",
        got=shown,
        hint="declare options: {time: 1} where it is the time [s], or {increment: 1 s} where rows come at a period",
        ask=f"unit of the time: s, min, h or ms? it may be no time ({shown}): then write time: {{period: 1 s}} instead",
        declare={"time": {"column": 1, "unit": UNKNOWN}},
        meanwhile={"time": {"column": 1, "unit": "s"}},
    )
