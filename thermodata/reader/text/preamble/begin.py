"""What rows without a date count from, where the lines above them say when they began; else what to ask, or to note."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Int1D
from thermodata.reader.text.cells.cell import number_of
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.preamble.head_start import ORDERS, HeadStart, Unread, head_start, unread_start
from thermodata.reader.text.preamble.head_words import TimeLabel
from thermodata.reader.text.times.several_cells.date_parts import row_time
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.reader.times.time_units import to_ns
from thermodata.reader.times.zone import NAT, local_to_utc_ns

HEAD, NOT = "head", "none"  # the answers beside ORDERS
ANSWERS = (*ORDERS, HEAD, NOT)
NOT_TAKEN = "which is not taken for the start of the rows"
UNREAD = "in which no date with a time of day is read"
BY_HALF = "month first for AM or PM alone: format: dmy, or start: dmy above the rows, where the day stands first"
EITHER = "whose day and month may be either way round"
_ORDER = "declare table: {time: {start: dmy}}, mdy or ymd; start: none, where the rows do not begin then"
_NOTHING = "no start stands above the rows, though time.start is '{}': they count from the start of the test"
_DATED = "the rows have dates of their own: the declared time.start is not used"
_HINT = "declare table: {time: {start: head}} where the rows begin then, or {start: none}"
ROWS = 40  # that show how a clock begins
_SECOND, _MINUTE, _HOUR = 10**9, 60 * 10**9, 3600 * 10**9
_STEPS = 10  # of the rows, by which the first may lie behind the start
_LONGEST = 60  # letters of a line of the head in a message


@dataclass(frozen=True, slots=True)
class Begin:
    """ns: the start since 1970, or the midnight before it where the rows hold times of day; local: in the time of the
    place; of_day: whether they do; text: the lines that say so; order: the declared one of day and month; supposed:
    whether it is month first for AM or PM alone."""

    ns: int
    local: bool
    of_day: bool
    text: str
    order: str | None = None
    supposed: bool = False

    def utc(self, since_ns: Int1D, timezone: str | None) -> Int1D:
        """UTC of times that count from the start [ns], shape (n,); NAT stays."""
        zero = self.ns
        if self.local and timezone is not None:
            zero = int(local_to_utc_ns(np.array([zero], np.int64).view("datetime64[ns]"), timezone)[0][0])
        return np.where(since_ns == NAT, NAT, since_ns + np.int64(zero))

    def note(self) -> str:
        what = "times of day are of the date" if self.of_day else "times count from the start"
        return f"{what} that stands above the rows: '{self.text}'{f', read {BY_HALF}' if self.supposed else ''}"


@dataclass(frozen=True, slots=True)
class FirstTimes:
    """The first rows of a relative clock. ns: from its zero, or in the day; of_day: whether they are written as times
    of day, which durations may be too."""

    ns: tuple[int, ...]
    of_day: bool

    @property
    def near_zero(self) -> bool:
        """Whether they begin at their zero, as rows do that count from the start of their recording."""
        steps = sorted(b - a for a, b in pairwise(self.ns))
        usual = steps[len(steps) // 2] if steps else 0
        return abs(self.ns[0]) <= max(_MINUTE, _STEPS * min(usual, _HOUR))


def first_times(
    time: Sequence[int], seconds: float | None, forms: Sequence[TimeFormat], rows: Sequence[Sequence[str]]
) -> FirstTimes:
    """The times of the first rows. time: their columns, none where rows are counted; seconds: of one unit; forms: how
    they are written, none for numbers."""
    each = seconds or 1.0
    if not time:
        return FirstTimes((0, round(each * 1e9)), False)
    found: list[int] = []
    for row in rows[:ROWS]:
        if forms:
            ns = row_time([row[i] for i in time], forms)
        else:
            value = number_of(row[time[0]])
            ns = NAT if value is None else int(to_ns(np.array([value]), each)[0])
        found += [] if ns == NAT else [ns]
    return FirstTimes(tuple(found), bool(forms) and forms[0].of_day)


def declared_start(table: Mapping[str, Any]) -> str | None:
    """`start` of a declared time, or of the first of several that has one."""
    said = table.get("time") or {}
    each = [said] if isinstance(said, Mapping) else list(said)
    return next((str(one["start"]) for one in each if one.get("start") is not None), None)


def unused_start(declared: str | None) -> str | None:
    """The note on a declared start of rows that have dates of their own; None where there is nothing to say."""
    return _DATED if declared in (*ORDERS, HEAD) else None


def find_begin(
    lines: Sequence[Sequence[str]], first: FirstTimes, declared: str | None, where: str
) -> tuple[Begin | None, str | None]:
    """(what the rows count from, a note where the head's word is not taken). lines: above the rows, each as its cells;
    declared: `table.time.start`.

    FormatError where the answer fits nothing, or leaves day and month of the start open.
    """
    if declared == UNKNOWN:
        raise unanswered("time.start", ", ".join(ANSWERS), where)
    if declared == NOT:
        return None, None
    order = declared if declared in ORDERS else None
    said, unread = head_start(lines, order, booted=declared is not None), unread_start(lines, order, first.of_day)
    begin = None if said is None else _begin_by_head(said, first, sure=declared is None)
    if begin is None and declared == HEAD and (said is not None or unread is not None):
        raise _not_taken(said, unread, where)
    # a moment that is less surely a start is none of the rows where the surer one may be another
    open_start = begin is None or (declared is None and unread is not None and unread.timed and not begin.of_day)
    if open_start and unread is not None and (said is None or unread.says > said.says):
        return None, _unread(unread)
    if said is None:  # of files that are declared alike only some may have such a line
        if declared is not None:
            return None, _NOTHING.format(declared)
        booted = head_start(lines, booted=True)
        return None, None if booted is None or booted.clock_ns is None else _note(booted)
    if begin is None:
        return None, None if said.clock_ns is None and not first.of_day else _note(said)
    if said.either and declared is not None:
        raise _which_order(said, where)
    # who tells no order may know the start otherwise: `init` asks, and what was read before still is
    return (None, _either(said)) if said.either else (begin and replace(begin, order=order), None)


def begun_anew(lines: Sequence[Sequence[str]], begin: Begin | None) -> Begin | None:
    """What the rows behind a second head count from, where a logger was started again and its file went on. lines: of
    that head; begin: of the rows before it. None where they say no start for sure, or the rows tell times of day."""
    if begin is None or begin.of_day:
        return None
    said = head_start(lines, begin.order)
    if said is None or said.clock_ns is None or said.several or said.either or said.says < TimeLabel.RECORDED:
        return None
    return Begin(said.date_ns + said.clock_ns, not said.zoned, False, said.text, begin.order)


def anew_note(begin: Begin) -> str:
    """What is told of such a start."""
    return f"times count anew from the start in a further head: '{begin.text}'"


def _begin_by_head(said: HeadStart, first: FirstTimes, sure: bool) -> Begin | None:
    """What the rows count from; None where the head does not tell it for sure. sure: only where it does by itself."""
    if said.several or not first.ns:
        return None
    if first.of_day and (_are_times_of_day(said, first) or not (sure or first.near_zero)):
        taken = not said.zoned and (said.says >= TimeLabel.BARE or not sure)
        return Begin(said.date_ns, True, True, said.text, supposed=said.supposed) if taken else None
    if said.clock_ns is None or (sure and (said.says < TimeLabel.RECORDED or not first.near_zero)):
        return None
    return Begin(said.date_ns + said.clock_ns, not said.zoned, False, said.text, supposed=said.supposed)


def _are_times_of_day(said: HeadStart, first: FirstTimes) -> bool:
    """Whether times that are written as of day are: they begin when the head says or soon behind it; where it tells a
    date only, they begin at no zero, from which durations count."""
    if said.clock_ns is None:
        return not first.near_zero
    behind = first.ns[0] - said.clock_ns
    return -_SECOND <= behind <= _HOUR and not (first.near_zero and said.clock_ns > _HOUR)


def _not_taken(said: HeadStart | None, unread: Unread | None, where: str) -> FormatError:
    text = said.text if said is not None else unread.text if unread is not None else ""
    other = said is not None and said.several
    return FormatError(
        "the start above the rows can't be taken, and time.start is 'head'",
        where=where,
        expected="one date with a time of day, such as 'Start time: 2026-03-02 08:00:00'",
        got=f"'{text[:_LONGEST]}'" + (", and another start on another line" if other else ""),
        hint="declare start: none, and give each test its start: 2026-03-02 08:00",
    )


def _unread(unread: Unread) -> str:
    return (
        f"the head says '{unread.text[:_LONGEST]}', {UNREAD}: they count from the start of the test; write it there as "
        "2026-03-02 08:00:00, or declare table: {time: {start: none}} and give each test its start, or clock: {offset: "
        "...}"
    )


def _note(said: HeadStart) -> str:
    shown = said.text[:_LONGEST]
    if said.several:
        return f"the head says '{shown}', and another start on another line, {NOT_TAKEN}: give each test its start"
    return not_taken_note(said.text)


def not_taken_note(text: str, who: str = "the head") -> str:
    """What is told of a start that nobody declared to be that of the rows. who: says the text."""
    return f"{who} says '{text[:_LONGEST]}', {NOT_TAKEN}; {_HINT}"


def _either(said: HeadStart) -> str:
    return f"the head says '{said.text[:_LONGEST]}', {EITHER}, {NOT_TAKEN}; {_ORDER}"


def _which_order(said: HeadStart, where: str) -> FormatError:
    return FormatError(
        "day and month of the start above the rows could be either way round",
        where=where,
        expected="a day above 12, or the order declared",
        got=said.text,
        hint=_ORDER,
    )
