"""The counter of a logger beside a line above the rows that says when that was switched on: 'millis' below 'boot at
2026-03-09T05:47:12Z'. What they say together is proposed, never taken: it may have been another start."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.time_questions import COUNTERS, likely_time
from thermodata.reader.text.names.header import split_unit
from thermodata.reader.text.names.time_header import unit_of_time
from thermodata.reader.text.preamble.begin import HEAD
from thermodata.reader.text.preamble.head_start import head_start
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.reader.times.time_units import SECONDS, is_logged, to_ns

_COUNTER = re.compile(
    r"(?i)up[ _]?time[ _]?(?P<a>[^\W_]*)|"
    r"(?P<b>[^\W_]+)[ _](?:since|from|after|seit)[ _](?:boot|power[ _-]?(?:on|up)|reset|start)"
)
_LONGEST = 80  # letters of a line of the head in a message


def _unit_in(name: str) -> str | None:
    """The unit of time that the name of a counter tells: 'ms' of millis(), uptime_ms, uptime [ms], ms_since_boot."""
    bare, unit = split_unit(name.strip())
    low = bare.lower().removesuffix("()")
    match = _COUNTER.fullmatch(bare)
    found = (match["a"] or match["b"] or unit or "").lower() if match is not None else low
    return COUNTERS.get(found) or unit_of_time(name) or (found if found in SECONDS else None)


def with_start(question: QuestionError, seen: FirstRows, lines: Iterable[Sequence[str]]) -> QuestionError:
    """A question of the time from row to row, where a column counts from the start that stands above the rows: with
    both as its answer; another question as it is."""
    if question.declare.get("time") != {"period": UNKNOWN}:
        return question
    place, rising = likely_time(seen.rows)
    name = seen.names[place]
    unit = _unit_in(name)
    said = None if rising is None or unit not in SECONDS else head_start(list(lines), booted=True)
    if rising is None or unit is None or said is None or said.clock_ns is None or said.several or said.either:
        return question
    at_ns = said.date_ns + said.clock_ns + to_ns(rising, SECONDS[unit])
    if not is_logged(at_ns, "unix_ns"):
        return question
    at = str(np.datetime64(int(at_ns[0]) // 10**9, "s")).replace("T", " ") + (" UTC" if said.zoned else "")
    answer = {"time": {"column": place + 1, "unit": unit, "start": HEAD}}
    return QuestionError(
        question.what,
        where=question.where,
        expected=question.expected,
        got=f"{question.got}; above them: '{said.text[:_LONGEST]}'",
        hint=f"declare table: {{time: {{column: {place + 1}, unit: {unit}, start: {HEAD}}}}} where '{name}' "
        f"counts from there; else {question.hint}",
        ask=f"unit of the time: does '{name}' count {unit} from '{said.text[:_LONGEST]}' above the rows? "
        f"{rising[0]:.14g} is {at} then; else time: {{column: {place + 1}, unit: {unit}}}, or time: {{period: 10 s}}",
        declare=answer,
        meanwhile=answer,
        times=[name],
    )
