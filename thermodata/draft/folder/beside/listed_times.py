"""When the tests of a list began and ended, by its columns: 'Datum;Beginn;Ende', or moments with their dates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.errors import FormatError
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.cells.time_forms.time_pattern import DAY_NS, is_date_text, is_time_of_day, is_zoned
from thermodata.reader.text.names.time_header import is_time_header
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.time_formats import find_format
from thermodata.reader.times.zone import NAT

BEGIN = (
    "start. begin. begins. began. beginn. anfang. von. from. debut. depart. van. aanvang. starttijd. begintijd. "
    "startzeit. inizio. inicio. zacatek. od. 开始 起始 開始"
)
END = (
    "end. ends. ended. ende. stop. bis. to. until. fin. arret. tot. einde. eindtijd. stoptijd. endzeit. fine. konec. "
    "do. 结束 終了 停止"
)
DAY = "data. date. datum. dato. day. tag. giorno. jour. dia. fecha. den. 日期 日付"
DURATION = "duration. dauer. duree. duur. 时长 時間長"


@dataclass(frozen=True, slots=True)
class ListedTime:
    """begin_ns, end_ns: as they stand there, in whatever zone, since 1970 [ns]; end_ns None where it is not said.
    zoned: whether they are in UTC. file: the list."""

    file: str
    begin_ns: int
    end_ns: int | None
    zoned: bool = False

    def said(self) -> str:
        until = f" to {to_the_minute(self.end_ns)}" if self.end_ns else ""
        return f"{self.file} says {to_the_minute(self.begin_ns)}{until}"


def to_the_minute(ns: int) -> str:
    """A time to the minute: '2026-05-06 08:00'."""
    return f"{datetime.fromtimestamp(ns // 10**9, UTC):%Y-%m-%d %H:%M}"


def listed_times(file: str, header: Sequence[str], rows: Mapping[str, Sequence[str]]) -> dict[str, ListedTime]:
    """Test -> when it began and ended; empty where the list says no begin, or its dates may be read in two ways. rows:
    test -> the cells of its row."""
    cells = {t: [c.strip().removesuffix(" 00:00:00") for c in row] for t, row in rows.items()}
    titles = [words(split_unit(t)[0]) for t in header]
    columns = {name: _column(titles, cells, *listed) for name, listed in _WANTED.items()}
    date = _dates(titles, cells)
    columns["begin"] = _bare_time(header, titles, cells, date) if columns["begin"] is None else columns["begin"]
    begins = _moments(cells, columns["begin"], date)
    ends = _moments(cells, columns["end"], date)
    found = {}
    for test, (begin, zoned) in begins.items():
        end = ends[test][0] if test in ends else None
        if end is not None and end < begin and columns["end"] is not None and _is_clock(cells, columns["end"]):
            end += DAY_NS  # over midnight
        found[test] = ListedTime(file, begin, end if end is not None and end > begin else None, zoned)
    return found


_WANTED = {"begin": (BEGIN, f"{END} {DURATION}"), "end": (END, f"{BEGIN} {DURATION}")}


def _column(titles: Sequence[str], cells: Mapping[str, Sequence[str]], listed: str, but: str) -> int | None:
    """The first column that is called so, and tells hours."""
    called = (i for i, t in enumerate(titles) if holds_word(listed, t) and not holds_word(but, t))
    return next((i for i in called if any(says_the_hour(c) for c in _filled(cells, i))), None)


def _bare_time(
    header: Sequence[str], titles: Sequence[str], cells: Mapping[str, Sequence[str]], date: int | None
) -> int | None:
    """The one column of moments, or of times of day beside dates, that is called a time and no end: 'Data;Ora'."""
    called = [
        i
        for i, t in enumerate(titles)
        if (is_time_header(header[i]) or holds_word(DAY, t)) and not holds_word(f"{END} {DURATION}", t)
    ]
    telling = [i for i in called if any(says_the_hour(c) for c in _filled(cells, i))]
    dated = [i for i in telling if date is not None or not _is_clock(cells, i)]
    return dated[0] if len(dated) == 1 else None


def _dates(titles: Sequence[str], cells: Mapping[str, Sequence[str]]) -> int | None:
    """The column of dates without a time of day."""
    days = (i for i in range(len(titles)) if (own := _filled(cells, i)) and all(map(_is_day, own)))
    return next(days, None)


def _is_day(cell: str) -> bool:
    return is_date_text(cell) and not says_the_hour(cell)


def _is_clock(cells: Mapping[str, Sequence[str]], column: int) -> bool:
    return all(is_time_of_day(c) for c in _filled(cells, column))


def _filled(cells: Mapping[str, Sequence[str]], column: int) -> list[str]:
    return [row[column] for row in cells.values() if column < len(row) and row[column]]


def _moments(cells: Mapping[str, Sequence[str]], column: int | None, date: int | None) -> dict[str, tuple[int, bool]]:
    """Test -> (a moment of a column, with its date beside it where it has none [ns]; whether it is in UTC)."""
    if column is None:
        return {}
    texts = dict(_texts(cells, column, date))
    if not texts:
        return {}
    try:
        form = find_format(list(texts.values()), "")
    except FormatError:  # of day and month, whose order nobody knows
        return {}
    read = {t: (timestamp.parse_one(text, form), is_zoned(text, form)) for t, text in texts.items()}
    return {t: (ns, zoned) for t, (ns, zoned) in read.items() if ns != NAT and ns >= 365 * DAY_NS}


def _texts(cells: Mapping[str, Sequence[str]], column: int, date: int | None) -> Iterator[tuple[str, str]]:
    for test, row in cells.items():
        cell = row[column] if column < len(row) else ""
        if is_date_text(cell) and says_the_hour(cell):
            yield test, cell
        elif is_time_of_day(cell) and date is not None and date < len(row) and row[date]:
            yield test, f"{row[date]} {cell}"
