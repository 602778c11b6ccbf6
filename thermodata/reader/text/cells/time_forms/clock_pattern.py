"""How a time of day is written: 08:00:00.5, 8:00 PM, 8:00:00 p. m., 下午 8:00, 20時00分00秒. Half days are written
before the time or behind it; of words for other parts of a day (noon, evening) none is read."""

from __future__ import annotations

import re

BLANK = "[\\s\u00a0\u202f\u2009]"  # a spreadsheet parts 'p. m.' by blanks that do not break
_FORENOON, _AFTERNOON = ("上午", "午前", "오전"), ("下午", "午後", "오후")
_LATE = ("nachm", "nachmittags", "odp", "du")  # in German, Czech and Hungarian
HALF = (
    rf"(?:[AaPp]\.?{BLANK}?[Mm]\.?|(?:[Vv]orm(?:ittags)?|[Nn]achm(?:ittags)?|[Dd]op|[Oo]dp)(?:\.|(?!\w))|(?:de|du)\.)"
)
_BEFORE = "|".join((*_FORENOON, *_AFTERNOON))
# hours to seconds; more digits than nanoseconds are cut
CLOCK = (
    rf"(?:(?P<q>{HALF}|{_BEFORE}){BLANK}*)?(?P<H>\d{{1,2}})(?::|[時时시]{BLANK}?)(?P<M>\d{{2}})"
    rf"(?:(?::|[分분]{BLANK}?)(?P<S>\d{{2}})(?:[.,:;](?P<f>\d{{1,9}})\d*)?)?[分분秒초]?(?:{BLANK}*(?P<p>{HALF}))?"
)
_ALONE = re.compile(rf"{HALF}|{_BEFORE}")
_CLOCKED = re.compile(r"[:時时시]")


def says_the_hour(text: str) -> bool:
    """Whether a text that is a date or a time has a time of day."""
    return _CLOCKED.search(text) is not None


def is_half(text: str) -> bool:
    """Whether a text alone says a half of the day: 'PM', 'p. m.', '午後'."""
    return _ALONE.fullmatch(text.strip()) is not None


def needs_half(pattern: re.Pattern[str]) -> re.Pattern[str]:
    """A pattern of times that say their half of the day."""
    return re.compile(rf"(?=(?:.*[\d\s])?(?:{HALF}|{_BEFORE}))" + pattern.pattern, pattern.flags)


def in_24_hours(hour: int, half: str) -> int | None:
    """The hour of a day of 24, of one of a half day; None where it is none. 午後0時 is noon, as 12 PM is."""
    native = half in _FORENOON or half in _AFTERNOON
    if not (0 if native else 1) <= hour <= 12:
        return None
    late = half[0] in "pP" or half in _AFTERNOON or half.casefold().rstrip(".") in _LATE
    return hour % 12 + (12 if late else 0)
