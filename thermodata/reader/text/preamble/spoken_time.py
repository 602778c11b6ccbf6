"""A moment above a table as people write it: 'Di, 6. Mai 2026 um 08.10 Uhr (Ortszeit)', 'le 6 mai 2026 à 8h10'. Its one
date, its one time of day and its one zone are found among words that say nothing else, and put as formats read them.
Where anything stands there that is none of these, a text is no such moment: 'morgens', 'CST', a second date."""

from __future__ import annotations

import re
from dataclasses import dataclass

from thermodata.reader.text.cells.time_forms.calendar_words import MONTH, WEEKDAYS, folded
from thermodata.reader.text.cells.time_forms.clock_pattern import HALF
from thermodata.reader.text.cells.time_forms.zone_words import OFFSET, WORDS
from thermodata.reader.text.preamble.zone_places import place_in
from thermodata.reader.text.times.one_cell.timestamp import CENTURY

# between the parts of a date and a time of day
_FILLING = (
    "am um den der dem vom ab im le la les a de du d il alle ore del di el las al y dne ve v o w dnia godz godzina on "
    "at the of in kl klo om das as op uhr h hrs hr hod hodin hodina uur heures horas oclock"
)
_WORDLESS = frozenset(f"{WEEKDAYS} {_FILLING}".split())
_LOCAL = re.compile(
    r"\b(?:local(?:ly)?(?: ?time)?|lt|ortszeit|lokal ?zeit|lokale zeit|lokal|lokaal|heure locale|ora locale|hora local|"
    r"mistni(?:ho)? casu?|lokal ?tid|czasu? lokaln(?:y|ego)|(?:lokale|plaatselijke) tijd|helyi ido)\b"
)
_CJK = re.compile(
    r"[\[(（]?[日月火水木金土]曜日?[\])）]?|[\[(（][日月火水木金土][\])）]|(?:星期|周|週)[一二三四五六日天]|"
    r"[\[(（]?(?:当地时间|當地時間|本地时间|本地時間|現地時間|현지 ?시간)[\])）]?"
)
_WORD = r"(?P<word>[^\W\d_]{3,})\.?"
_YEAR = r"(?P<year>\d{4}|\d\d(?![\d:.h]))(?!\d)"
_SPELLED = (
    re.compile(
        rf"(?<![\d.:])(?P<day>\d{{1,2}})(?:st|nd|rd|th|er|º|°)?\.?(?:[ -]|(?<=\.))(?:de |of )?"
        rf"{_WORD}[ ,-]+(?:del? )?{_YEAR}"
    ),
    re.compile(rf"(?<![^\W_]){_WORD} (?P<day>\d{{1,2}})(?:st|nd|rd|th)?,? (?P<year>\d{{4}})(?!\d)"),
    re.compile(rf"(?<!\d)(?P<year>\d{{4}})[. ,-]+{_WORD}[ -](?P<day>\d{{1,2}})(?!\d)\.?"),
)
_NUMBERS = re.compile(
    r"(?<![\d.])(?:\d{4}([-/.]) ?\d{1,2}\1 ?\d{1,2}|\d{1,2}([-/.]) ?\d{1,2}\2 ?(?:\d{4}|\d{2})|"
    r"\d{4}[年년] ?\d{1,2}[月월] ?\d{1,2}[日일])(?!\d)\.?"
)
_CLOCKS = (
    re.compile(rf"(?<![\d:.])\d{{1,2}}(?::\d\d){{1,2}}(?:[.,]\d{{1,9}})?(?:\s?{HALF})?(?![\d:])"),
    re.compile(
        r"(?<![\d:.])(?P<H>\d{1,2}) ?h ?(?P<M>\d\d)(?: ?(?:min|m|')? ?(?P<S>\d\d) ?(?:s|sec|\")?| ?(?:min|m)?)(?!\w)"
    ),
    re.compile(
        r"(?i)(?<![\d:.])(?P<H>\d{1,2})\.(?P<M>\d\d)(?:\.(?P<S>\d\d))?(?=\s?(?:uhr|h|hrs|hod|uur|godz)\b)|"
        r"(?i:(?<=um )|(?<=at )|(?<=kl )|(?<=kl\. )|(?<=klo )|(?<=ore )|(?<=om ))(?P<H2>\d{1,2})\.(?P<M2>\d\d)(?![\d.])"
    ),
    re.compile(r"(?i)(?<![\d:.])(?P<H>\d{1,2})\s?(?:uhr|h|hrs|hod|uur|o'clock)(?![\w])(?:\s(?P<M>\d\d)(?![\d.:]))?"),
    re.compile(r"(?i)(?<![\d:.])(?P<H>\d{1,2})\s?(?P<half>[ap]\.?m\.?)(?!\w)"),
    re.compile(r"(?<!\d)\d{1,2} ?[時时시] ?\d{2}[分분](?: ?\d{2}[秒초])?"),
)
_ZONE = re.compile(
    rf"(?<![^\W_])(?:(?:UTC|GMT) ?[+-]\d{{1,2}}(?::?\d\d)?|(?:{WORDS})(?![^\W_]))|"
    rf"(?<=[\s(])(?:{OFFSET})(?![\d:])|(?<=\d)Z\b"
)
_HOURS = re.compile(r"(?i)\d ?h(?:rs?)?(?!\w)|\dh\d")
# a number of hours, and the word before it: 'a 8 h' tells a time of day
_HOURS_ALONE = re.compile(r"(?:(?P<word>[^\W\d_]+)\W+)?(?<![\d:.,])\d{1,3} ?h(?:rs?)?(?!\w)")
# the same of a whole day, by the words that else stand behind a time of day, too: '8 hod', '8 uur'
_DAY_LONG = re.compile(r"(?:(?P<word>[^\W\d_]+)\W+)?(?<![\d:.,])24 ?(?:h(?:rs?)?|hod(?:in)?|uur)(?!\w)")
_AT = frozenset(
    ("a", "um", "at", "v", "ve", "alle", "las", "ore", "kl", "om", "o", "as", "ab", "von", "vom", "from", "de", "dalle")
)
_LONGEST = 200  # letters that a date is looked for in


@dataclass(frozen=True, slots=True)
class Spoken:
    """text: the moment, as formats read it; place: the IANA zone that is named behind it; timed: whether it tells a
    time of day that is no number of hours: '8 h' may be a duration; lasting: whether it may be one beside a date, too:
    '02.03.2026, 8 h'."""

    text: str
    place: str | None
    timed: bool
    lasting: bool


def spoken(text: str) -> Spoken | None:
    """The moment that a text says: '2026-05-06 08:10 CEST' of 'Mi, 6. Mai 2026, 8h10 CEST'. None where it says none, or
    anything that is no part of one."""
    date, rest = _date_in(" ".join(text.split()))
    place, rest = place_in(rest)
    zone = _ZONE.search(rest)
    if zone is not None:
        rest = f"{rest[: zone.start()]} {rest[zone.end() :]}"
    hours = _HOURS_ALONE.search(folded(rest))
    lasting = hours is not None and hours["word"] not in _AT
    day_long = _DAY_LONG.search(folded(rest))
    clock, timed, rest = _clock_in(rest)
    if clock is not None and day_long is not None and day_long["word"] not in _AT:
        return None  # '24 h' beside a date is more likely how long it took than the midnight behind it
    left = _LOCAL.sub(" ", folded(_CJK.sub(" ", rest)))
    whole = all(rest.count(a) == rest.count(b) for a, b in ("()", "[]"))
    if (date is None and clock is None) or not whole or set(re.findall(r"[^\W_]+", left)) - _WORDLESS:
        return None
    return Spoken(" ".join(filter(None, (date, clock, zone and zone[0]))), None if zone else place, timed, lasting)


def names_a_moment(text: str, started: bool) -> bool:
    """Whether a date stands in a text, or, behind a label of a start, a time of day."""
    text = " ".join(text.split())[:_LONGEST]
    return _date_in(text)[0] is not None or (started and _CLOCKS[0].search(text) is not None)


def tells_the_hour(text: str) -> bool:
    """Whether a time of day stands in a text, beside a date or alone, or beside a date hours that may be one."""
    date, rest = _date_in(" ".join(text.split())[:_LONGEST])
    clock, timed, _ = _clock_in(rest)
    return timed or (date is not None and clock is not None)


def with_month(label: str, value: str) -> tuple[str, str]:
    """(label, value) with the name of a month that ends the label before the value: 'Started on March', '2, 2026'."""
    bare, _, word = label.rpartition(" ")
    return (bare, f"{word} {value}") if bare and folded(word.strip(".,")) in MONTH else (label, value)


def _date_in(text: str) -> tuple[str | None, str]:
    """(the first date of a text, the rest of it)"""
    for known in _SPELLED:
        match = known.search(text)
        month = MONTH.get(folded(match["word"])) if match is not None else None
        if match is not None and month is not None:
            year = int(match["year"])
            year += 0 if len(match["year"]) == 4 else 2000 if year < CENTURY else 1900
            date = f"{year}-{month:02d}-{int(match['day']):02d}"
            return date, f"{text[: match.start()]} {text[match.end() :]}"
    match = _NUMBERS.search(text)
    if match is None:
        return None, text
    return match[0].rstrip("."), f"{text[: match.start()]} {text[match.end() :].removeprefix('T')}"


def _clock_in(text: str) -> tuple[str | None, bool, str]:
    """(the first time of day of a text, whether it is surely one, the rest of it)"""
    for known in _CLOCKS:
        match = known.search(text)
        if match is None:
            continue
        part = match.groupdict()
        hour, minute = part.get("H") or part.get("H2"), part.get("M") or part.get("M2") or "00"
        plain = match[0]
        if hour is not None:
            plain = ":".join(filter(None, (hour, minute, part.get("S")))) + f" {part.get('half') or ''}"
        return (
            plain.strip(),
            _HOURS.search(text[match.start() :]) is None,
            f"{text[: match.start()]} {text[match.end() :]}",
        )
    return None, False, text
