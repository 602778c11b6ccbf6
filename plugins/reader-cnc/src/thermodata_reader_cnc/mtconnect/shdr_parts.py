"""What the fields of lines parted by '|' are, beside those of an adapter: times in numbers since 1970, and a unit
behind the value, as the shell of a database and loggers of one's own write them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from thermodata.errors import QuestionError, UsageError
from thermodata.reader.signals.unit_words import is_surely_unit
from thermodata.reader.text.cells.time_forms.time_pattern import OFFSET_MS, OFFSET_S, SINCE_A_DAY, TimeFormat
from thermodata.reader.text.cells.values.number import is_empty, is_number
from thermodata.reader.text.times.one_cell.timestamp import parse, parse_one
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.zone import NAT
from thermodata_reader_cnc import events

ALIKE = 0.9  # of the lines of a log
_UNITS = {"ms": OFFSET_MS, "s": OFFSET_S}
_FEW, _LOOKED_AT = 200, 10_000
_STEPS = 4  # that show a fixed rate
_LEAST_STEP_NS = 8e6  # between two reports: the shortest cycle at which a control is asked
_SURE = 0.5  # of the words behind values are units known here: a few may be of a trade
_MOST_UNITS = 3  # of an item, one that ranges by itself


def names_columns(parts: Sequence[str]) -> bool:
    """Whether the fields of a first line are names, of which none is a number."""
    return all(p.strip() and not is_number(p) for p in parts)


def numbered_form(stamps: Sequence[str]) -> TimeFormat | None:
    """How times in numbers count; None where they are none."""
    some = [s.partition("@")[0] for s in stamps[:_FEW]]
    for form in (*SINCE_A_DAY, OFFSET_MS) if some else ():
        if sum(parse_one(s, form) != NAT for s in some) >= ALIKE * len(some):
            return form
    return None


def time_form(stamps: Sequence[str], table: Mapping[str, Any] | None, where: str) -> TimeFormat:
    """How the times of all lines are written. table: what the campaign file declares. QuestionError: numbers from a
    start at a fixed rate, which an adapter has in milliseconds and other loggers in seconds; or so close to each other
    that no adapter reports so often."""
    times = [s.partition("@")[0] for s in stamps]
    if any(parse_one(s, events.ISO) != NAT for s in times):
        return events.ISO
    form = numbered_form(times) or OFFSET_MS
    said = (table or {}).get("time")
    unit = said.get("unit") if isinstance(said, Mapping) else None
    if form != OFFSET_MS or (unit is None and not (_at_a_rate(times) or _too_often(times))):
        return form
    if unit == UNKNOWN:
        raise unanswered("time.unit", " or ".join(_UNITS), where)
    if unit is None:
        raise _question(times, where)
    if unit not in _UNITS:
        raise UsageError(
            f"times in '{unit}'",
            where=where,
            expected=" or ".join(_UNITS),
            got=str(unit),
            hint="correct the option, or leave it out",
        )
    return _UNITS[unit]


def _question(times: Sequence[str], where: str) -> QuestionError:
    first = list(dict.fromkeys(times))[:3]
    return QuestionError(
        "times without a unit",
        where=where,
        expected="ms, as an adapter of MTConnect counts, or s",
        got=", ".join((*first, "...")),
        hint="declare table: {time: {unit: s}}, or unit: ms",
        ask=f"unit of the times: ms or s? They run {', '.join(first)}, ...",
        declare={"time": {"unit": UNKNOWN}},
        meanwhile={"time": {"unit": "ms"}},
    )


def _at_a_rate(times: Sequence[str]) -> bool:
    """Whether whole numbers go on in equal steps, as what is written on change does not."""
    different = list(dict.fromkeys(s.strip() for s in times[:_LOOKED_AT] if s.strip().isdecimal()))
    steps = [b - a for a, b in pairwise(parse(different, OFFSET_MS).tolist())]
    return len(steps) >= _STEPS and steps.count(steps[0]) >= ALIKE * len(steps)


def _too_often(times: Sequence[str]) -> bool:
    """Whether numbers lie so close to each other that, read as milliseconds, no control would report so often."""
    different = list(dict.fromkeys(s.strip() for s in times[:_LOOKED_AT] if s.strip()))
    ns = parse(different, OFFSET_MS)
    steps = np.diff(ns[ns != NAT])
    return steps.size >= _STEPS and 0 < float(np.median(steps)) < _LEAST_STEP_NS


def units_behind(parts: Sequence[Sequence[str]]) -> dict[str, str]:
    """Item -> the unit behind its values, '' where its lines have none, where nearly all lines are
    time|item|value|unit; nothing else: a fourth field is the text of a message. parts: the fields of each line."""
    full = [[p.strip() for p in each] for each in parts]
    four = [p for p in full if len(p) == 4 and p[1] and (is_number(p[2]) or is_empty(p[2]))]
    said = [p[3] for p in four if p[3]]
    if not said or len(four) < ALIKE * len(full) or sum(map(is_surely_unit, said)) < _SURE * len(said):
        return {}
    units: dict[str, set[str]] = {}
    for _, item, _, unit in four:
        units.setdefault(item, set()).add(unit)
    if max(map(len, units.values())) > _MOST_UNITS:
        return {}
    first = {item: unit for _, item, _, unit in reversed(four) if unit}
    return {item: first.get(item, "") for item in units}
