"""What stands behind a time for the zone that it is in: an offset, or an abbreviation that names one zone only.

CST may be Chicago, Shanghai or Havana: such a word is asked about, never taken for one of them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

_HOUR_NS = 3600 * 1_000_000_000
# hours east of Greenwich; those of Europe in English, German and Czech, those of the United States by RFC 5322
HOURS = {
    **dict.fromkeys(("Z", "UTC", "GMT", "UT", "WET", "WEZ"), 0),
    **dict.fromkeys(("WEST", "WESZ", "CET", "MEZ", "SEČ"), 1),
    **dict.fromkeys(("CEST", "MESZ", "SELČ", "EET", "OEZ"), 2),
    **dict.fromkeys(("EEST", "OESZ", "MSK"), 3),
    "EDT": -4,
    **dict.fromkeys(("EST", "CDT"), -5),
    "MDT": -6,
    **dict.fromkeys(("MST", "PDT"), -7),
    **dict.fromkeys(("PST", "AKDT"), -8),
    "AKST": -9,
    "HST": -10,
}
# abbreviations of several zones, or of one that is not read by its word, with what may be declared
SEVERAL = {
    "CST": ("America/Chicago", "Asia/Shanghai", "America/Havana"),
    "BST": ("Europe/London", "Asia/Dhaka"),
    "IST": ("Asia/Kolkata", "Europe/Dublin", "Asia/Jerusalem"),
    "AST": ("America/Halifax", "Asia/Riyadh"),
    "SST": ("Pacific/Pago_Pago", "Asia/Singapore"),
    "JST": ("Asia/Tokyo",),
    "KST": ("Asia/Seoul",),
    "HKT": ("Asia/Hong_Kong",),
    "SGT": ("Asia/Singapore",),
    "MYT": ("Asia/Kuala_Lumpur",),
    "ICT": ("Asia/Bangkok",),
    "WIB": ("Asia/Jakarta",),
    "TRT": ("Europe/Istanbul",),
    "BRT": ("America/Sao_Paulo",),
    "SAST": ("Africa/Johannesburg",),
    **dict.fromkeys(("AEST", "AEDT"), ("Australia/Sydney", "Australia/Brisbane")),
    **dict.fromkeys(("NZST", "NZDT"), ("Pacific/Auckland",)),
}
ANY_ZONE = "Area/City, as Europe/Prague,"
OFFSET = r"[+-]\d{2}(?::?\d{2})?"
# longer words first, or CEST would be read as CE and a rest
WORDS = "|".join(sorted(HOURS, key=len, reverse=True))
_SHORT_OFFSET = r"(?<=\s)[+-]\d(?::\d{2})?(?!\w)"  # '11:58:00 +2'
_STATED_OFFSET = rf"(?:UTC|GMT)[+-]\d{{1,2}}(?::?\d{{2}})?|{OFFSET}|{_SHORT_OFFSET}"
ZONE = rf"(?P<z>\s*(?:{_STATED_OFFSET}|\((?:{_STATED_OFFSET})\)|\(?(?:{WORDS})\)?(?!\w)))"
_ALONE = re.compile(ZONE, re.ASCII)
# behind minutes or seconds, with AM or PM between them: the last part of a date is none
_AT_END = re.compile(rf":\d{{2}}(?:[.,:;]\d{{1,9}})?(?:\s*[AaPp]\.?[Mm]\.?)?{ZONE}$", re.ASCII)
_BEHIND = re.compile(r"\d\s*(?:[AaPp]\.?[Mm]\.?)?\s*(?P<word>\(?[^\W\d_]{2,5}\)?)$")


def offset_ns(text: str) -> int:
    """Nanoseconds east of Greenwich: 'Z', '+01:00', '-0430', 'UTC+2', 'CEST'."""
    text = text.strip().strip("()")
    word = re.match(r"[^\W\d_]*", text)
    named = word[0] if word else ""
    rest = text[len(named) :]
    if not rest:
        return HOURS[named] * _HOUR_NS
    digits = rest[1:].replace(":", "")
    hours, minutes = (digits[:2], digits[2:]) if len(digits) != 3 else (digits[:1], digits[1:])
    return (-1 if rest[0] == "-" else 1) * (int(hours) * 3600 + int(minutes or 0) * 60) * 1_000_000_000


def with_zone_in_digits(cell: str) -> str:
    """A cell whose zone at its end is an offset in four digits, for strptime: '10:00 PM EDT' is '10:00 PM -0400'.
    As it stands where it ends in none."""
    match = _AT_END.search(cell)
    if match is None:
        return cell
    minutes = offset_ns(match["z"]) // (_HOUR_NS // 60)
    blank = match["z"][: len(match["z"]) - len(match["z"].lstrip())]
    digits = f"{'-' if minutes < 0 else '+'}{abs(minutes) // 60:02d}{abs(minutes) % 60:02d}"
    return f"{cell[: match.start('z')]}{blank}{digits}"


def without_zone(cell: str) -> tuple[str, str] | None:
    """(the cell before it, '%z' with the blanks before it) of a zone behind a time of day; None where none is."""
    match = _AT_END.search(cell)
    if match is None:
        return None
    blank = match["z"][: len(match["z"]) - len(match["z"].lstrip())]
    return cell[: match.start("z")], f"{blank}%z"


def is_zone(text: str) -> bool:
    """Whether a text alone is an offset, or a word for one zone: '+02:00', '+0100', 'CEST'."""
    return _ALONE.fullmatch(text.strip()) is not None


def is_offset(text: str) -> bool:
    """Whether a zone has no letters: '+02:00', '+0100'."""
    return text.strip().strip("()")[:1] in ("+", "-")


def word_behind(cell: str) -> str | None:
    """The word behind a time that may be a zone and is none of those above: 'CST' of '2026-03-02 08:00:00 CST'."""
    match = _BEHIND.search(cell.strip())
    word = match["word"].strip("()") if match else ""
    return word if word and word.isupper() and word not in HOURS and word not in ("AM", "PM") else None


_STATED = re.compile(
    r"(?:^|[\s_,;(\[])(?:GMT|UTC)(?:\s?(?P<sign>[+\u2212-])(?P<hours>\d{1,2})(?::?(?P<minutes>\d\d))?)?(?=$|[\s,;)\]])",
    re.IGNORECASE,
)


def stated_zone(headers: Iterable[str]) -> str | None:
    """The zone that the headers of a time say it is in, as an IANA name: 'Date Time, GMT+01:00', 'time_utc'. None where
    they say none, or one that is no whole hours from UTC."""
    for header in headers:
        match = _STATED.search(header)
        if match is None or int(match["minutes"] or 0) or int(match["hours"] or 0) > 12:
            continue
        hours = int(match["hours"] or 0)
        return f"Etc/GMT{'-' if match['sign'] == '+' else '+'}{hours}" if hours else "UTC"  # signs as POSIX has them
    return None


_ABOVE = re.compile(
    r"(?i)(?:utc[ -]?offset|time ?zone|tz|zeitzone|fuseau(?: horaire)?|fuso(?: orario)?|zona horaria|časové pásmo|"
    r"strefa czasowa|tijdzone|tidszon|időzóna|часовой пояс|タイムゾーン|時差|时区|時區|표준시간대)"
)
_OFFSET_ALONE = re.compile(
    r"(?i)\(?(?:UTC|GMT)?\s?(?P<sign>[+\u2212-])(?P<hours>\d{1,2})(?::?00)?(?:\s?h)?\)?|UTC|GMT|Z"
)

# of T&D: '時差:GMT+9:00/夏時間:off'
_WITH_SUMMER = re.compile(
    r"(?:時差|时差) ?[:：] ?(?P<offset>[^/]{1,12})/ ?(?:夏時間|夏令时) ?[:：] ?(?P<saving>on|off)"
)


def offset_and_saving(lines: Iterable[Sequence[str]]) -> Iterator[Sequence[str]]:
    """The lines, an offset and whether clocks are put ahead in summer, which T&D writes into one, as two."""
    for cells in lines:
        text = " ".join(c.strip() for c in cells if c.strip()).strip("\"' ")
        if (both := _WITH_SUMMER.match(text)) is None:
            yield cells
        else:
            yield [f"時差: {both['offset']}"]
            yield [f"夏時間: {both['saving']}"]


def zone_above(lines: Iterable[Sequence[str]]) -> tuple[str, str] | None:
    """(IANA name, the line) of a zone that a line above the rows says: 'Zeitzone: UTC+1'. None where none says one, or
    they say several, or one with places, whose clocks are put ahead in summer: '(UTC+01:00) Berlin'."""
    found: dict[str, str] = {}
    for cells in lines:
        text = " ".join(c.strip() for c in cells if c.strip()).strip("#%;/* \t\"'")
        label, mark, value = re.sub(r"\s*[=;]\s*|\s*:\s+", ": ", text, count=1).partition(": ")
        if not mark and (word := _ABOVE.match(text)):
            label, value = word[0], text[word.end() :]
        if not _ABOVE.fullmatch(label.strip()):
            continue
        offset = _OFFSET_ALONE.fullmatch(value.strip())
        if offset is None:
            return None
        hours = int(offset["hours"] or 0)
        if hours > 12:
            return None
        found[f"Etc/GMT{'-' if offset['sign'] == '+' else '+'}{hours}" if hours else "UTC"] = text
    return next(iter(found.items())) if len(found) == 1 else None
