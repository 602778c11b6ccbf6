"""Which columns of a long table are its time, and in what zone their names say they are: 'Timestamp (UTC)', 'Event
Time', 'Horodatage'. What a historian calls it in no known way, its cells tell: dates with a time of day."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.text.cells.cell import TIME_WORD
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.cells.time_forms.time_pattern import (
    DATETIME,
    SINCE_A_DAY,
    TimeFormat,
    declared_format,
    is_date_text,
    is_zoned,
)
from thermodata.reader.text.cells.time_forms.zone_words import WORDS, stated_zone
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.preamble.zone_places import place_in
from thermodata.reader.text.tables.sample.zone_named import named_note
from thermodata.reader.text.times.one_cell.odd_stamps import guess_format
from thermodata.reader.text.times.one_cell.timestamp import parse, parse_one
from thermodata.reader.text.times.time_formats import find_format
from thermodata.reader.times.zone import NAT

_KNOWN = (
    *("sourcetimestamp", "sourcetime", "datetime", "timestamp", "timestring", "servertimestamp", "servertime", "time"),
    *("tstamp", "ts", "receivedat", "updatedate", "lastchanged", "lastupdated", "zeitstempel", "zeit", "čas"),
)
_WORDED = re.compile(
    r"(?:unix|epoch)(?:s|sec|seconds|ms|millis)?|"
    r"(?:unix|epoch|event|sampl(?:e|ing)|record(?:ed)?|log(?:ged)?|meas(?:ured?|urement)?|acq(?:uisition)?|read(?:ing)?|opc|plc|da|"
    r"device|value|data|tag|point|change|update|insert(?:ion)?|messzeit|erfassungs)?"
    r"(?:time|timestamp|timestring|datetime|datetimestamp|stamp|zeit|zeitpunkt|zeitstempel)|"
    r"messzeit|(?:record|logg|measur)edat|datumzeit|datumuhrzeit|dateheure|dataora|dataeora|datahora|fechahora|"
    r"fechayhora|marcadetiempo|časováznačka|znacznikczasu|tijdstempel|tidsstämpel|时间戳|采集时间|记录时间|测量时间|"
    r"採集時間|記錄時間|収集時刻|収集日時|測定日時|計測日時|タイムスタンプ|타임스탬프|수집시간"
)
_LOCAL = r"local(?: ?time)?|lokal(?:e ?zeit)?|ortszeit|heure locale|ora locale|hora local"
_OFFSET = r"(?:utc|gmt)(?: ?[+\u2212-] ?\d{1,2}(?::?\d\d)?)?"
_PLACE = r"[A-Z][a-z]+/[A-Z][A-Za-z_]+"
_FORM = r"[ymdhisfaptz.,:/ -]{5,}|iso ?\d*"  # yyyy-mm-dd hh:mm:ss
_IN_BRACKETS = re.compile(rf"\s*[\[(（](?:(?i:{_OFFSET}|{_LOCAL}|{_FORM})|{WORDS}|{_PLACE})[\])）]")
_BESIDE = re.compile(rf"(?i)^(?P<before>utc|gmt|local)(?=[^\W\d])[ _]?|[ _,;/-]*(?:{_OFFSET}|{_LOCAL})$")
_SOME, _ENOUGH = 200, 0.9  # rows that show what a column holds, and their share


@dataclass(frozen=True, slots=True)
class Times:
    """places: the columns, the first that a row has is its time; header: of the first, as it stands; zone: the IANA
    zone that it says its times are in, None where it says none; sure: whether it is called as in known exports."""

    places: tuple[int, ...]
    header: str
    zone: str | None
    sure: bool = True

    def source(self, source: Source, first: str | None, form: TimeFormat) -> tuple[Source, list[str]]:
        """(the source with the zone that the header says, notes on it). first, form: the first time, and how it is
        written: one that names its own zone is in that."""
        if first is None or form.role == "offset" or is_zoned(first, form):
            return source, []
        if self.zone is None:
            open_zone = named_note([self.header], source.timezone, 0, 0) if source.timezone is None else None
            return source, [open_zone] if open_zone else []
        unused = [] if source.timezone in (None, self.zone) else [f"the declared {source.timezone} is not used"]
        note = "; ".join([f"times in {self.zone} by their header '{self.header}'", *unused])
        return replace(source, timezone=self.zone), [note]


def time_columns(
    raw: Sequence[str], names: Sequence[str], rows: Sequence[Sequence[str]], others: Collection[int]
) -> Times | None:
    """The columns that hold the time; None where none does. raw, names: the header, as it stands and bare; rows: below
    it; others: columns that are known to be something else."""
    known = tuple(names.index(n) for n in _KNOWN if n in names)
    if known:
        return _in_one_zone(raw, known)
    worded = sorted((rank, k) for k, cell in enumerate(raw) if k not in others and (rank := _rank(cell)) is not None)
    if worded:
        return replace(_in_one_zone(raw, tuple(k for _, k in worded)), sure=False)
    dated = next((k for k in range(len(raw)) if k not in others and _go_on(_dates(rows, k))), None)
    return None if dated is None else replace(_in_one_zone(raw, (dated,)), sure=False)


def _in_one_zone(raw: Sequence[str], places: Sequence[int]) -> Times:
    """The columns but those in another zone than the first: they would be read as if they were in its."""
    zone = _zone(raw[places[0]])
    return Times(tuple(k for k in places if _zone(raw[k]) == zone), raw[places[0]], zone)


def _zone(header: str) -> str | None:
    beside = _BESIDE.match(header)
    return (
        stated_zone([header])
        or place_in(header)[0]
        or ("UTC" if beside and (beside["before"] or "").lower() in ("utc", "gmt") else None)
    )


def _rank(header: str) -> tuple[int, bool] | None:
    """How surely a header names the time, the least the surest, and one in UTC before one that is not; None where it
    names none."""
    plain = _BESIDE.sub("", _IN_BRACKETS.sub("", header).strip()).strip()
    name = re.sub(r"[\s_.#()/-]", "", plain).casefold()
    if name in _KNOWN:
        rank = _KNOWN.index(name)
    elif _WORDED.fullmatch(name) or TIME_WORD.match(plain) or (not name and _zone(header) is not None):
        rank = len(_KNOWN)
    else:
        return None
    return rank, _zone(header) != "UTC"


def _dates(rows: Sequence[Sequence[str]], column: int) -> list[str]:
    """The cells of a column of which nearly all are dates with a time of day; none of another."""
    cells = [cell for row in rows[:_SOME] if column < len(row) and (cell := clean(row[column]))]
    dated = [c for c in cells if is_date_text(c) and says_the_hour(c)]
    return dated if len(dated) >= _ENOUGH * len(cells) else []


def _go_on(stamps: Sequence[str]) -> bool:
    """Whether dates go on from row to row, to later or to earlier ones, as those of a log do; when a sensor was
    calibrated, or is due again, stands still, or goes to and fro with the sensor."""
    try:
        form = time_form(stamps, "", None)
    except FormatError:  # of day and month, which the reading asks for
        form = DATETIME["dmy"]
    if form is None or len(stamps) == 1:
        return form is not None
    steps = np.diff(parse(stamps, form))
    later, earlier = int((steps > 0).sum()), int((steps < 0).sum())
    return max(later, earlier) > 2 * min(later, earlier)


def time_form(stamps: Sequence[str], where: str, declared: str | None) -> TimeFormat | None:
    """How the times are written; None where they are no dates. FormatError: no order of day and month."""
    counted = next((form for form in SINCE_A_DAY if all(parse_one(s, form) != NAT for s in stamps)), None)
    if stamps and counted is not None:
        return counted
    order = declared if declared in ("dmy", "mdy", "ymd") else None
    if declared and not order and "%" in declared:
        return declared_format(declared)
    try:
        form = find_format(stamps, where, order=order)
    except FormatError as error:
        if error.what.startswith("day and month"):
            raise
        spelled = guess_format(stamps) if stamps else None
        # the name of a month leaves nothing to confirm but which end of it is the year
        return declared_format(spelled) if spelled and "%b" in spelled and _year_is_last(spelled, stamps) else None
    return form if form.role == "datetime" else None


def _year_is_last(spelled: str, stamps: Sequence[str]) -> bool:
    """Whether 02-Mar-26 is of 2026, as historians write it: a log goes through days, and hardly through years."""
    if "%Y" in spelled:
        return True
    ends = {m.groups() for s in stamps if (m := re.match(r"\s*(\d{1,2})\W[^\W\d]+\W(\d{2})\b", s))}
    return bool(ends) and len({last for _, last in ends}) <= len({first for first, _ in ends})
