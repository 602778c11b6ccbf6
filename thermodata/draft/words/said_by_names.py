"""What the names of files and folders say of a test: its speed or schedule, feed, air and date; and how sure that is.

A number is taken only where the name says what it is: 'n6000' and '6000 rpm' are speeds, 'S001' is the first sample,
'1-8k' may be 1800 rpm or the first test at 8000, and is asked.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime

from thermodata.draft.words.naming import without_marks
from thermodata.draft.words.tool_and_coolant import tool_and_coolant

_NUMBER = r"\d+(?:[.,]\d+)?"
_RPM = r"(?:k?rpm|u/?min|ot(?:/?min)?|1/min|min-1|转)"
_START, _END = r"(?<![a-z0-9.,])", r"(?![a-z0-9])"
_WORD = r"(?:sp|rpm|speed|spindle|spindel|drehzahl|otacky|ot|nspi|转速|主轴)"
_SCHEDULE = re.compile(
    rf"{_START}({_NUMBER}k?(?:\+{_NUMBER}k?)+) ?({_RPM})?{_END}|"
    rf"{_START}({_NUMBER}k(?:[->]{_NUMBER}k)+) ?({_RPM})?{_END}"
)
_EITHER = re.compile(rf"{_START}(\d)-(\d{{1,2}})k(?:{_RPM})?{_END}")
_SAID_SPEED = re.compile(rf"{_START}({_NUMBER}) ?(k?) ?{_RPM}{_END}|(?<![a-z]){_WORD} ?[=-]? ?({_NUMBER})(k?){_END}")
_LETTER = re.compile(rf"(?<![a-z])[sn](\d{{3,5}})(?!\d)(?![a-z])|(?<![a-z])[sn] (\d{{3,5}}){_END}")
_THOUSANDS = re.compile(rf"{_START}(\d{{1,2}}(?:[.,]\d)?)k{_END}")
_LEAST_RPM = 50  # of a number behind a word; no spindle test turns slower, and runs are counted so
# 'VF2' is a machine, 'vf2000', 'vf 2.5' and 'vf 2 m/min' are feeds
_VF = r"vf(?! ?\d{1,2}(?! ?m)(?![a-z0-9.,]))"
_FEED = re.compile(rf"(?<![a-z])(?:f|{_VF}|feed|vorschub|posuv|进给) ?({_NUMBER})(?: ?(m|mm)/? ?min)?{_END}")
_FEED_UNIT = re.compile(rf"{_START}({_NUMBER}) ?(m|mm)/?min{_END}")
_DEGREES = rf"((?:(?<![a-z0-9])-)?{_NUMBER}) ?(?:°|deg)?c"  # the dash of 0-20C is none of the number
_COURSE = re.compile(rf"{_DEGREES} ?(?:to|bis|na|az|auf|->|-|~) ?{_DEGREES}(?![a-z])")
_AT = re.compile(rf"(?<![a-z])(air|amb\w*|hall\w*|luft|raum\w*|umgebung|room|okoli|气温|室温) ?{_DEGREES}(?![a-z])")
_SOME_DEGREES = re.compile(rf"(?<![\d.,]){_DEGREES}(?![a-z])")
_CONDITIONED = re.compile(r"(?<![a-z])(wo|without|no|ohne|bez|w|with|mit|s)[ -]?ac(?![a-z])")
_WITHOUT = ("wo", "without", "no", "ohne", "bez")
_TIME = r"(?:[ t-]+([01]\d|2[0-3])[-:h. ]?([0-5]\d)(?:[-:m. ]?([0-5]\d))?(?!\d))?"
_DAY_AND_MONTH = "".join(rf"(?<!\b{day}[-. ]{month}[-. ])" for day in (r"\d", r"\d\d") for month in (r"\d", r"\d\d"))
_DATE = re.compile(  # '31.03.2026 08_10_00' is no 2026-08-10
    rf"(?<!\d){_DAY_AND_MONTH}(20\d\d)([-. ]?)(0[1-9]|1[0-2])\2(0[1-9]|[12]\d|3[01])(?!\d){_TIME}"
)
_DATE_DMY = re.compile(rf"(?<!\d)(0?[1-9]|[12]\d|3[01])\.(0?[1-9]|1[0-2])\.(20\d\d)(?!\d){_TIME}")
_DATE_SHORT = re.compile(r"(?<![\d.-])(\d\d)([-. ])(\d\d)\2(\d\d)(?![\d-])")
# tests of one day are told by letters: 20260307_f, of which 20260307_f_2 is another part; f 2000 is a feed
_DAY_LETTER = r"(?:[ -]?[a-z](?![a-z0-9])(?! ?\d{3}))?"
_FIRST_YEAR = 2015  # that two digits of a date are of, up to now


@dataclass(frozen=True, slots=True)
class SaidByNames:
    """conditions: condition -> value with unit, of which the names leave no other reading; guessed: those that are
    likely only; speeds: what a speed may be [rpm], where there are several readings; start: date and time of day; days:
    what a date with a year of two digits may be; questions: what to ask."""

    conditions: dict[str, str] = field(default_factory=dict)
    guessed: frozenset[str] = frozenset()
    speeds: tuple[float, ...] = ()
    start: str | None = None
    days: tuple[str, ...] = ()
    questions: tuple[str, ...] = ()


def said_by(names: Sequence[str]) -> SaidByNames:
    """What names say. names: of the test, of its folders and files, the one that counts most first."""
    texts = [_plain(n) for n in names]
    likely = tool_and_coolant(names)
    undated = [_without_day(t) for t in texts]
    speed, date = _speed(undated), _date(texts)
    all_of_it = (
        speed,
        _feed(undated),
        _air(undated),
        _air_conditioning(undated),
        SaidByNames(likely, frozenset(likely)),
        date,
    )
    return SaidByNames(
        conditions={condition: value for said in all_of_it for condition, value in said.conditions.items()},
        guessed=frozenset(condition for said in all_of_it for condition in said.guessed),
        speeds=speed.speeds,
        start=date.start,
        days=date.days,
        questions=tuple(question for said in all_of_it for question in said.questions),
    )


def speed_in(piece: str) -> bool:
    """Whether a piece of a name states a speed, and nothing else: 'S8000', '6000rpm', not 'S001'."""
    return "speed" in _speed([_without_day(_plain(piece))]).conditions


def _plain(name: str) -> str:
    return without_marks(name).replace("_", " ").casefold()


def _without_day(text: str) -> str:
    """A name without its date and the letter of a test of that day, whose digits are no quantity."""
    for pattern in (_DATE, _DATE_DMY, *([_DATE_SHORT] if _short_dates([text]) else [])):
        text = re.sub(pattern.pattern + _DAY_LETTER, " ", text)
    return text


def _first(pattern: re.Pattern[str], texts: Sequence[str]) -> re.Match[str] | None:
    return next((m for t in texts if (m := pattern.search(t))), None)


def _value(text: str, thousands: bool = False) -> float:
    return float(text.replace(",", ".")) * (1000 if thousands else 1)


def _speed(texts: Sequence[str]) -> SaidByNames:
    """The speed or the schedule; the readings of a speed that has several, and which is asked."""
    if match := _first(_SCHEDULE, texts):
        parts = re.split(r"[+>-]", match[1] or match[3])
        thousands = (match[2] or match[4] or "").startswith("k") or parts[-1].endswith("k")
        levels = [_value(p.rstrip("k"), p.endswith("k") or (thousands and _value(p.rstrip("k")) < 100)) for p in parts]
        return SaidByNames({"schedule": ", ".join(f"{v:g} rpm" for v in levels)})
    if match := _first(_EITHER, texts):
        one, other = _value(f"{match[1]}.{match[2]}", True), _value(match[2], True)
        asked = f"speed: '{match[0]}' is {one:g} rpm, or number {match[1]} at {other:g} rpm?"
        return SaidByNames(speeds=(one, other), questions=(asked,))
    for match in (m for t in texts for m in _SAID_SPEED.finditer(t)):
        number, k = (match[1], match[2] or match[0].find("krpm") > 0) if match[1] else (match[3], match[4])
        if not match[1] and not k and _value(number) < _LEAST_RPM:
            continue  # 'sp1' is the first spindle, or the first run
        return SaidByNames({"speed": f"{_value(number, bool(k)):g} rpm"})
    for match in (m for t in texts for m in _LETTER.finditer(t)):
        digits = match[1] or match[2]
        if not digits.startswith("0") and (len(digits) > 3 or int(digits) % 50 == 0):
            return SaidByNames({"speed": f"{int(digits)} rpm"})
    if match := _first(_THOUSANDS, texts):
        return SaidByNames({"speed": f"{_value(match[1], True):g} rpm"}, frozenset({"speed"}))
    return SaidByNames()


def _feed(texts: Sequence[str]) -> SaidByNames:
    """The feed; asked where the name has no unit, which its size tells."""
    match = _first(_FEED_UNIT, texts) or _first(_FEED, texts)
    if match is None or (match[1].startswith("0") and len(match[1]) > 1):
        return SaidByNames()
    value = _value(match[1])
    unit = f"{match[2]}/min" if match[2] else "mm/min" if value >= 100 else "m/min"
    return SaidByNames({"feed": f"{value:g} {unit}"}, questions=() if match[2] else (f"feed in {unit}?",))


def _air(texts: Sequence[str]) -> SaidByNames:
    """The temperature of the air, or its course; degrees of which no word says whose they are are asked."""
    if match := _first(_COURSE, texts):
        return SaidByNames({"air": f"{_value(match[1]):g} degC to {_value(match[2]):g} degC"}, frozenset({"air"}))
    if match := _first(_AT, texts):
        return SaidByNames({"air": f"{_value(match[2]):g} degC"})
    if (match := _first(_SOME_DEGREES, texts)) and not re.match(r"-?0\d", match[1]):  # '02_C' is number 2 of axis C
        return SaidByNames(
            questions=(f"{_value(match[1]):g} degC, says the name: of what? e.g. conditions: {{air: ...}}",)
        )
    return SaidByNames()


def _air_conditioning(texts: Sequence[str]) -> SaidByNames:
    match = _first(_CONDITIONED, texts)
    if match is None:
        return SaidByNames()
    return SaidByNames({"air_conditioning": "off" if match[1] in _WITHOUT else "on"}, frozenset({"air_conditioning"}))


def _date(texts: Sequence[str]) -> SaidByNames:
    """The date, and with a time of day the moment; the days that a date with a year of two digits may be."""
    match = next((m for t in texts if (m := _DATE.search(t)) and m[5]), None) or _first(_DATE, texts)
    if match is not None:
        return _at(f"{match[1]}-{match[3]}-{match[4]}", match.groups()[4:])
    if match := _first(_DATE_DMY, texts):
        return _at(f"{match[3]}-{int(match[2]):02d}-{int(match[1]):02d}", match.groups()[3:])
    return SaidByNames(days=_short_dates(texts))


def _at(date: str, clock: Sequence[str | None]) -> SaidByNames:
    """A date, and the moment where a name has a time of day too. clock: hour, minute, second, None where there is
    none."""
    hour, minute, second = clock
    return SaidByNames({"date": date}, start=None if hour is None else f"{date} {hour}:{minute}:{second or '00'}")


def _short_dates(texts: Sequence[str]) -> tuple[str, ...]:
    """The readings of '02-03-26': day or month first, or the year."""
    match = _first(_DATE_SHORT, texts)
    if match is None:
        return ()
    latest = datetime.now(UTC).year
    one, two, three = (int(match[k]) for k in (1, 3, 4))
    found = (
        (2000 + y, m, d)
        for d, m, y in ((one, two, three), (three, two, one), (two, one, three))
        if _FIRST_YEAR <= 2000 + y <= latest and 1 <= m <= 12 and 1 <= d <= 31
    )
    return tuple(dict.fromkeys(f"{y}-{m:02d}-{d:02d}" for y, m, d in found))
