"""How dates and times are written: a pattern a column. What they say in nanoseconds: times/one_cell/timestamp.py."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from thermodata.errors import FormatError
from thermodata.reader.text.cells.time_forms.clock_pattern import BLANK, CLOCK, HALF
from thermodata.reader.text.cells.time_forms.joined_clock import joined_clock
from thermodata.reader.text.cells.time_forms.julian_days import julian_ns
from thermodata.reader.text.cells.time_forms.zone_words import ZONE

DAY_NS = 86_400 * 1_000_000_000
NEVER_NS = 40_000 * DAY_NS

_YEAR = r"(?:(?P<Y>\d{4})|(?P<y>\d{2}))"
_DATES = {
    "ymd": r"(?P<Y>\d{4})(?P<s>[-/.]) ?(?P<m>\d{1,2})(?P=s) ?(?P<d>\d{1,2})",
    "dmy": rf"(?P<d>\d{{1,2}})(?P<s>[-/.]) ?(?P<m>\d{{1,2}})(?P=s) ?{_YEAR}",
    "cjk": r"(?P<Y>\d{4})[年년] ?(?P<m>\d{1,2})[月월] ?(?P<d>\d{1,2})[日일]",
    # years of an emperor: R8/03/02, 令和8年3月2日
    "reiwa": r"(?:R|令和) ?(?P<R>\d{1,2})[-/.年] ?(?P<m>\d{1,2})[-/.月] ?(?P<d>\d{1,2})日?",
    "mdy": rf"(?P<m>\d{{1,2}})(?P<s>[-/.]) ?(?P<d>\d{{1,2}})(?P=s) ?{_YEAR}",
}
_IEC = r"(?:(?:DTL|L?DT|DATE_AND_TIME)#)?"  # of IEC 61131-3, and of Siemens S7: DTL#2026-03-02-08:00:00.000
_BETWEEN = rf"(?:,?{BLANK}*[T_-]?{BLANK}*)"
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
    "p": rf"(?P<p>{HALF})",
    "z": ZONE,
    "Z": ZONE,
    "%": "%",
}
_CALENDAR = frozenset("YymdbBjGVUWu")  # letters of a declared format that Python reads, cell by cell
_OTHERS = frozenset("bBaAjGVUWuwcxX")


@dataclass(frozen=True, slots=True)
class TimeFormat:
    """How the cells of one time column read. role: datetime, date, time, tenth, hundredth, millisecond, microsecond or
    fraction (of a second, behind whole ones), offset (milliseconds since a start), relative (numbers), or part (of the
    time of a column before it). zoned: whether the cells name their offset from UTC: None where either may come."""

    role: str
    pattern: re.Pattern[str] | None
    text: str  # for messages: "DD.MM.YYYY HH:MM:SS"
    body: str = ""  # the pattern without a zone
    zoned: bool | None = None
    strptime: str | None = None  # a declared format with names of months and the like
    columns: int = 1  # that hold its parts, from its own on
    supposed: bool = field(default=False, compare=False)  # month first for AM and PM alone, which British loggers write
    reads: Callable[[str], int] | None = None  # of what no pattern fits: nanoseconds of a cell, NAT where it is none

    @property
    def of_day(self) -> bool:
        """Whether cells are written as times of day, as durations may be too."""
        return self.role == "time" and self.pattern is not None and "H" in self.pattern.groupindex

    @property
    def cycle_ns(self) -> int:
        """Behind what a time without a date begins anew: an hour where it has no hours, else a day; a span never."""
        if self.reads is not None and self.pattern is None:
            return NEVER_NS
        return DAY_NS // 24 if self.pattern is not None and "N" in self.pattern.groupindex else DAY_NS


def _compile(body: str) -> re.Pattern[str]:
    return re.compile(r"\s*'?" + body + r"\s*", re.ASCII)  # an apostrophe keeps a spreadsheet from reading a date


def _format(role: str, body: str, text: str, zone: bool = True) -> TimeFormat:
    return TimeFormat(role, _compile(body + (f"{ZONE}?" if zone else "")), text, body)


TIME_OF_DAY = _format("time", CLOCK, "HH:MM:SS")
# a duration, which goes on behind 23:59:59: 100:30:00
ELAPSED = _format(
    "time", r"(?P<E>\d{1,5}):(?P<M>\d{2}):(?P<S>\d{2})(?:[.,](?P<f>\d{1,9})\d*)?", "HHH:MM:SS", zone=False
)
HOURS = _format("time", r"(?P<E>\d{1,5}):(?P<M>\d{2})", "HHH:MM", zone=False)
MINUTES = _format("time", r"(?P<N>\d{1,5}):(?P<S>\d{2})(?:[.,](?P<f>\d{1,9})\d*)?", "MM:SS", zone=False)
OFFSET_MS = _format("offset", r"(?P<oms>\d{1,12})(?:\.(?P<of>\d{1,6})\d*|\.)?", "milliseconds", zone=False)
OFFSET_S = _format("offset", r"(?P<os>\d{1,9})(?:\.(?P<f>\d{1,9})\d*|\.)?", "seconds", zone=False)
# of the years 2001 to 2099
UNIX_S = _format("offset", r"(?P<os>[1-3]\d{9}|40\d{8})(?:\.(?P<f>\d{1,9})\d*)?", "seconds since 1970", zone=False)
UNIX_MS = _format("offset", r"(?P<oms>\d{12,13})(?:\.(?P<of>\d{1,6})\d*|\.)?", "milliseconds since 1970", zone=False)
# by InfluxDB's precisions, which its exports count in
UNIX_US = _format("offset", r"(?P<oms>\d{13})(?P<of>\d{3})", "microseconds since 1970", zone=False)
UNIX_NS = _format("offset", r"(?P<oms>\d{13})(?P<of>\d{6})", "nanoseconds since 1970", zone=False)
JULIAN = TimeFormat("offset", None, "Julian days", reads=julian_ns)
SINCE_A_DAY = (UNIX_S, UNIX_MS, UNIX_US, UNIX_NS, JULIAN)  # of numbers that say the day and the hour, in UTC
MILLISECOND = _format("millisecond", r"(?P<ms>\d{1,3})(?:[.,]0*)?", "0...999", zone=False)
MILLISECONDS = re.compile(r"(?i)^(ms|msec|millise[ck]\w*|millis|millitm|毫秒)\b")  # the name of such a column
PARTS_NS = {"ds": 10**8, "cs": 10**7, "ms": 10**6, "us": 10**3}  # by the group of the pattern
_S = r"(?:s|se[ck]|se[ck]onds?|sekunden?)\.?"
_TENTHS = r"tenths?(?: of a second)?|zehntel(?:-?sekunden?)?"
_HUNDREDTHS = r"hundredths?(?: of a second)?|hundertstel(?:-?sekunden?)?|centise[ck]\w*"
# parts of a second in a column behind whole ones: the name of such a column, and how its cells read
_PARTS_OF_A_SECOND = (
    (MILLISECONDS, MILLISECOND),
    (
        re.compile(r"(?i)^([uµμ]s|[uµμ]sec|mi[ck]rose[ck]\w*|micros|微秒)\b"),
        _format("microsecond", r"(?P<us>\d{1,6})(?:[.,]0*)?", "0...999999", zone=False),
    ),
    (
        re.compile(rf"(?i)^(1/10 ?{_S}|{_TENTHS})$"),
        _format("tenth", r"(?P<ds>\d)(?:[.,]0*)?", "0...9", zone=False),
    ),
    (
        re.compile(rf"(?i)^(1/100 ?{_S}|{_HUNDREDTHS})$"),
        _format("hundredth", r"(?P<cs>\d{1,2})(?:[.,]0*)?", "0...99", zone=False),
    ),
    (re.compile(rf"(?i)^1/1000 ?{_S}$"), MILLISECOND),
    (
        re.compile(r"(?i)^(s|sec|seconds?|fraction(s|al)?[ _]?(of[ _]a[ _])?(s|secs?|seconds?)?)$"),
        _format("fraction", r"0?[.,](?P<f>\d{1,9})\d*", "0.000...0.999", zone=False),
    ),
)
_TEXTS = {"ymd": "YYYY-MM-DD", "dmy": "DD.MM.YYYY", "mdy": "MM/DD/YYYY", "cjk": "YYYY年MM月DD日", "reiwa": "Rn/MM/DD"}
DATE = {order: _format("date", body, _TEXTS[order], zone=False) for order, body in _DATES.items()}
DATETIME = {
    # a spreadsheet leaves out the time of day at midnight
    order: _format(
        "datetime", f"{_IEC if order == 'ymd' else ''}{body}(?:{_BETWEEN}{CLOCK})?", f"{_TEXTS[order]} HH:MM:SS"
    )
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
            raise FormatError(
                f"time format '{text}' cannot be used",
                expected=what,
                got="a day without it",
                hint="add what is missing to the format, or leave 'format' out, so that it is told by the cells",
            )
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
                f"time format '{text}' cannot be used",
                expected="%Y %y %m %d %b %H %I %M %S %f %p %z",
                got=part,
                hint="write the rest of a cell as it stands there; leave 'format' out, so that it is told by the cells",
            )
    day, clock = bool(used & _CALENDAR), bool(used & {"H", "I"})
    if "M" in used and not day and not clock:  # '%M:%S' are minutes from a start
        body = body.replace(_STRPTIME["M"], r"(?P<N>\d{1,5})")
    try:
        pattern = _compile(body)
    except re.error as error:
        raise FormatError(
            f"time format '{text}' cannot be used",
            got=str(error),
            hint="leave 'format' out, so that it is told by the cells",
        ) from None
    role = "datetime" if day and clock else "date" if day else "time"
    return TimeFormat(role, pattern, text, zoned=bool(used & {"z", "Z"}) or None, reads=joined_clock(text))


_CLOCK_TEXT = re.sub(r"\?P<\w+>", "?:", CLOCK + ZONE + "?")
_DATE_TEXT = (
    r"(?:\d{4}([-/.]) ?\d{1,2}\1 ?\d{1,2}|\d{1,2}([-/.]) ?\d{1,2}\2 ?(?:\d{4}|\d{2})|"
    r"\d{4}[年년] ?\d{1,2}[月월] ?\d{1,2}[日일]|(?:R|令和) ?\d{1,2}[-/.年] ?\d{1,2}[-/.月] ?\d{1,2}日?)"
)
_ANY_DATE = _compile(rf"{_IEC}{_DATE_TEXT}(?:{_BETWEEN}{_CLOCK_TEXT})?")


def is_date_text(cell: str) -> bool:
    """Whether a text is a date, with or without a time of day, in any order of day and month."""
    return _ANY_DATE.fullmatch(cell) is not None


def is_time_of_day(cell: str) -> bool:
    """Whether a text is a time of day without a date, or a duration that is written like one."""
    return any(form.pattern is not None and form.pattern.fullmatch(cell) for form in (TIME_OF_DAY, ELAPSED, MINUTES))
