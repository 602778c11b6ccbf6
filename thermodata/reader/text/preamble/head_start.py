"""When the rows of a table began, as the lines above it say: 'Start time: 04/07/2026 08:07:00', 'T0 = ...', or a date
and a time on lines of their own. It counts for rows without a date: seconds from a start, or times of day."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS, TIME_OF_DAY
from thermodata.reader.text.cells.time_forms.zone_words import WORDS, offset_ns
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.preamble.head_words import TimeLabel, said_by
from thermodata.reader.text.preamble.pass_words import without_pass
from thermodata.reader.text.preamble.spoken_time import names_a_moment, spoken, tells_the_hour, with_month
from thermodata.reader.text.preamble.zone_places import without_places
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.one_cell.clock_letters import with_clock
from thermodata.reader.text.times.one_cell.odd_stamps import guess_format
from thermodata.reader.text.times.time_formats import find_format
from thermodata.reader.times.zone import NAT, local_to_utc_ns

ORDERS = ("dmy", "mdy", "ymd")  # of day and month, which an answer may be
_LABELLED = (re.compile(r"^([^:=]{1,60}?)\s*[:=]\s*(.*)$"), re.compile(r"^([^\W\d_][^\d:=]{0,58}?)\s+(\d.*)$"))
_PARTS = re.compile(r"\s{2,}|[,;] | [-–] ")
_MARKS = "#%;*'\"/!<> \t"  # by which a line is a comment
_FULL_WIDTH = str.maketrans("：＝（）", ":=()")
_MOST_CELLS = 4  # that one moment may stand in: 'Start', '02.03.2026', '07:00:00', 'CET'
_LONGEST_CELL, _LONGEST_TIME = 200, 100  # letters: what is longer is prose, and a pattern would take its time over it
_SHORT_YEAR = re.compile(r"\d{2}(?P<mark>[-/.])\d{1,2}(?P=mark)\d{1,2}(?!\d)", re.ASCII)
_NUMBERED = re.compile(r"\d{4}-\d{1,2}-\d{1,2}-\d{1,3}")  # the second run of a day, and no hour
_NEAR_NS = 10**9  # by which two lines on one start may differ
_QUARTER_NS, _FARTHEST_NS = 900 * 10**9, 14 * 3600 * 10**9  # zones differ by whole quarters of an hour
# a zone in the label of a time: 'Start (UTC)', 'Beginn [MESZ]', 'start_utc', 'StartTimeUTC'
_ZONED_LABEL = re.compile(
    r"^(?P<label>[^\d:=]{1,60}?)(?:(?<=[a-z])(?=[A-Z])|[ _\[(]{1,4})"
    rf"(?P<zone>(?i:UTC|GMT) ?[+-]\d{{1,2}}(?::?\d\d)?|{WORDS}|(?i:UTC|GMT))"
    r"(?:[\])]|(?!\w))(?P<rest>\s*(?:[:=].*|\d.*)?)$"
)


@dataclass(frozen=True, slots=True)
class Moment:
    """A date, a time of day, or both, as one line says them. says: what its label is; text: the line, for messages;
    date_ns: since 1970, at midnight; clock_ns: in the day; zoned: whether it names its offset from UTC, and is in UTC;
    either: what is open about its order of day and month; supposed: whether it is month first for AM or PM alone."""

    says: TimeLabel
    text: str
    date_ns: int | None = None
    clock_ns: int | None = None
    zoned: bool = False
    either: bool = False
    supposed: bool = False


@dataclass(frozen=True, slots=True)
class Unread:
    """A line that names a start or a date, and whose moment can't be read whole. says, text: as of `Moment`; timed:
    whether a time of day stands in it, too."""

    says: TimeLabel
    text: str
    timed: bool


@dataclass(frozen=True, slots=True)
class HeadStart:
    """What the head says of the start. says: how sure it is that it is one; text: the lines, for messages; clock_ns:
    None where no line tells the time of day; either: its day and month may be either way round; several: other lines
    say another start; supposed: as of `Moment`."""

    says: TimeLabel
    text: str
    date_ns: int
    clock_ns: int | None
    zoned: bool = False
    either: bool = False
    several: bool = False
    supposed: bool = False


def head_start(lines: Sequence[Sequence[str]], order: str | None = None, booted: bool = False) -> HeadStart | None:
    """The start that lines above a table say, each as its cells; None where they say no date. order: the declared one
    of day and month; booted: whether the moment at which the logger was switched on may be it."""
    each = (m for cells in lines for m in _moments(cells, order) if isinstance(m, Moment))
    moments = [m for m in each if booted or m.says is not TimeLabel.BOOTED]
    whole = [m for m in moments if m.date_ns is not None and m.clock_ns is not None]
    dates = [m for m in moments if m.date_ns is not None and m.clock_ns is None]
    clocks = [m for m in moments if m.date_ns is None]
    # a duration is written like a time of day, and is called "Recording time" too: only words for a start say which
    pairs = [
        Moment(_of_two(a, b), f"{a.text}; {b.text}", a.date_ns, b.clock_ns, either=a.either, supposed=a.supposed)
        for a, b in product(dates, clocks)
        if b.says >= TimeLabel.BARE
    ]
    best = max((m.says for m in whole), default=None)
    paired = max((m.says for m in pairs), default=None)
    found = whole if paired is None or (best is not None and best >= paired) else pairs
    found = found or dates
    if not found:
        return None
    first = max(found, key=lambda m: (m.says, m.zoned))
    several = any(m.says == first.says and not _are_one_moment(m, first) for m in found)
    date = first.date_ns if first.date_ns is not None else 0
    return HeadStart(first.says, first.text, date, first.clock_ns, first.zoned, first.either, several, first.supposed)


def _of_two(date: Moment, clock: Moment) -> TimeLabel:
    """What a date and a time of day on two lines say together: of a start where one says so and no other thing."""
    low, high = sorted((date.says, clock.says))
    return high if high is TimeLabel.BEGAN and low >= TimeLabel.BARE else min(low, TimeLabel.BARE)


def unread_start(lines: Sequence[Sequence[str]], order: str | None = None, dates: bool = False) -> Unread | None:
    """The surest of the lines above a table that name a start or a date, and whose moment can't be read; None where
    all are read. order: as of `head_start`; dates: whether a mere date would say when the rows began."""
    every = [m for cells in lines for m in _moments(cells, order) if isinstance(m, Unread) and m.says > TimeLabel.MADE]
    each = [m for m in every if dates or m.timed or m.says is TimeLabel.BEGAN]
    return max(each, key=lambda m: m.says, default=None)


def _are_one_moment(one: Moment, other: Moment) -> bool:
    """Whether two lines say one moment: the same, or one in UTC and the other in the time of a place."""
    apart = abs(_ns(one) - _ns(other))
    in_zones = one.zoned != other.zoned and apart <= _FARTHEST_NS and apart % _QUARTER_NS <= _NEAR_NS
    return apart <= _NEAR_NS or in_zones


def _ns(moment: Moment) -> int:
    return (moment.date_ns or 0) + (moment.clock_ns or 0)


def _moments(cells: Sequence[str], order: str | None) -> Iterator[Moment | Unread]:
    """The moments of one line: a label and its time in one cell, or in cells behind each other."""
    bare = [clean(c).strip(_MARKS) if k == 0 else clean(c) for k, c in enumerate(cells)]
    left = [" ".join(c.split()) for whole in bare for c in _in_parts(whole)]
    left = [without_pass(c.translate(_FULL_WIDTH)) for c in left if 0 < len(c) <= _LONGEST_CELL]
    k = 0
    while k < len(left):
        label, zone, value = _label_zone_value(left[k])
        says = said_by(label)
        if says is None:
            k += 1
            continue
        values = [value] if value else []
        found, used = None, 0
        for n in range(min(_MOST_CELLS, len(left) - k)):
            text = " ".join([*values, *left[k + 1 : k + 1 + n]]).strip(" \"'")
            if text and (read := _moment_in(text, zone, says, f"{label}: {text}", order)) is not None:
                found, used = read, n
        if found is not None:
            yield found
        elif names_a_moment(rest := " ".join([*values, *left[k + 1 : k + _MOST_CELLS]]), says is TimeLabel.BEGAN):
            yield Unread(says, f"{label}: {rest}", tells_the_hour(rest))
        k += 1 + used


def _in_parts(cell: str) -> list[str]:
    """The parts of a title that names a start behind other things: 'Machine MCV 750   start 04.05.2026 08:00'; else the
    whole cell."""
    label = _label_zone_value(" ".join(cell[:_LONGEST_CELL].split()))[0]
    if len(cell) > _LONGEST_CELL or (said_by(label) is TimeLabel.BEGAN and not re.search(r"\d", label)):
        return [cell]
    parts = _PARTS.split(cell)
    began = [said_by(_label_zone_value(part)[0]) is TimeLabel.BEGAN for part in parts]
    return parts if any(began) else [cell]


def _label_zone_value(cell: str) -> tuple[str, str, str]:
    """(label, the zone that it names, value) of a cell; the whole cell is the label where there is no value in it."""
    zoned = _ZONED_LABEL.match(cell)
    zone = ""
    if zoned is not None and said_by(zoned["label"]) is not None:
        cell, zone = zoned["label"] + zoned["rest"], zoned["zone"]
    for known in _LABELLED:
        match = known.match(cell)
        if match is None:
            continue
        label, value = with_month(match[1], match[2].strip())
        if said_by(label) is not None:
            return label, zone, value
    return cell.strip(" :="), zone, ""


def _moment_in(text: str, zone: str, says: TimeLabel, line: str, order: str | None) -> Moment | None:
    """A text as a moment, as it stands or as people write one; None where it is none. zone: that its label names."""
    text = without_places(text)
    if len(text) > _LONGEST_TIME or not re.search(r"\d", text) or _NUMBERED.fullmatch(text):
        return None
    read, place = _read_plain(text, says, line, order), None
    if read is None and (said := spoken(text)) is not None:
        read, place = _read_plain(said.text, says, line, order), said.place
        if says is not TimeLabel.BEGAN and (
            said.lasting or not (said.timed or read is None or read.date_ns is not None)
        ):
            return None  # which may be a duration
    if read is None or read.zoned or not (zone or place) or read.date_ns is None or read.clock_ns is None:
        return read
    local = read.date_ns + read.clock_ns
    if zone:
        utc = local - offset_ns(zone.upper().replace(" ", ""))
    else:
        utc = int(local_to_utc_ns(np.array([local], np.int64).view("datetime64[ns]"), place)[0][0])
    day = utc // DAY_NS * DAY_NS
    return replace(read, date_ns=day, clock_ns=utc - day, zoned=True)


def _read_plain(text: str, says: TimeLabel, line: str, order: str | None) -> Moment | None:
    """A text of a date and a time of day that a format reads as a moment; None where none does."""
    clock = timestamp.parse_one(text, time_pattern.with_zone(TIME_OF_DAY, False))
    if clock != NAT:
        return Moment(says, line, None, clock)
    if not re.search(r"\d{2}", text):
        return None
    either = False
    short = _SHORT_YEAR.match(text) if order == "ymd" else None
    try:
        if short is not None:
            letters = f"%y{short['mark']}%m{short['mark']}%d"
            form = time_pattern.declared_format(with_clock(letters, text[short.end() :]))
        else:
            form = find_format([text], "the head", order=order)
    except QuestionError:
        form, either = find_format([text], "the head", order="dmy"), True
    except FormatError:
        spelled = guess_format([text])
        if spelled is None:
            return None
        form = time_pattern.declared_format(spelled)
    ns = timestamp.parse_one(text, form)
    if ns == NAT or form.role == "time":
        return None
    zoned = time_pattern.is_zoned(text, form)
    day = ns // DAY_NS * DAY_NS
    clocked = form.role == "datetime" and re.search(r"\d[:.h時时]\s?\d\d|T\d{4}", text) is not None
    return Moment(says, line, day, ns - day if clocked or ns != day else None, zoned, either, form.supposed)
