"""Times as text: whole columns at once, by Arrow where they are ISO, give what each cell gives alone."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from thermodata.errors import FormatError
from thermodata.reader.text.cells.time_forms.time_pattern import (
    DATE,
    DATETIME,
    MILLISECOND,
    OFFSET_MS,
    TIME_OF_DAY,
    TimeFormat,
    declared_format,
    is_date_text,
    is_time_of_day,
    is_zoned,
    with_zone,
)
from thermodata.reader.text.times.one_cell.timestamp import offset_ns, parse, parse_one
from thermodata.reader.times.zone import NAT

S = 1_000_000_000
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def ns(year: int, *rest: int) -> int:
    """Nanoseconds since 1970 of a year, a month, a day, and so on to microseconds."""
    return (datetime(year, *rest, tzinfo=UTC) - EPOCH) // timedelta(microseconds=1) * 1000  # type: ignore[arg-type]


def both(cell: str, form: TimeFormat) -> int:
    """The time of a cell, which is the same alone, in a column, and below a cell of another width."""
    one = parse_one(cell, form)
    assert parse([cell, cell, "no time at all", cell], form).tolist() == [one, one, NAT, one]
    return one


# ---- the clock -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("cell", "seconds"),
    [
        ("12:00:00 AM", 0),
        ("12:30 am", 1800),
        ("1:00:00 AM", 3600),
        ("11:59:59 a.m.", 43_199),
        ("12:00:00 PM", 43_200),
        ("12:30:00 p.m.", 45_000),
        ("1:00:00PM", 46_800),
        ("11:59:59 PM", 86_399),
        ("13:00:00 PM", None),
        ("0:30:00 AM", None),
        ("23:59:59", 86_399),
        ("24:00:00", 86_400),  # the end of the day
        ("24:00:01", None),
        ("8:60:00", None),
        ("8:00:60", 28_860),  # rounded up
        ("23:59:60", 86_400),  # a leap second
        ("8:00:61", None),
        ("8:05", 29_100),
    ],
)
def test_clocks_of_12_and_of_24_hours(cell: str, seconds: int | None) -> None:
    assert both(cell, TIME_OF_DAY) == (NAT if seconds is None else seconds * S)


@pytest.mark.parametrize(
    ("cell", "nanoseconds"),
    [
        ("0:00:01.5", 1_500_000_000),
        ("0:00:01,05", 1_050_000_000),
        ("0:00:01:264", 1_264_000_000),
        ("0:00:00.000000001", 1),
        ("0:00:00.1234567891", 123_456_789),
        ("0:00:00.", NAT),
    ],
)
def test_fractions_of_a_second(cell: str, nanoseconds: int) -> None:
    assert both(cell, TIME_OF_DAY) == nanoseconds


@pytest.mark.parametrize(
    ("zone", "hours"),
    [
        *(("Z", 0), (" UTC", 0), ("GMT", 0), ("+01:00", 1), ("-01:00", -1), ("+0530", 5.5), ("-0430", -4.5)),
        *((" +02", 2), (" +2", 2), (" -5", -5), (" +5:30", 5.5)),
    ],
)
def test_an_offset_is_taken_off(zone: str, hours: float) -> None:
    """08:00 one hour east of Greenwich is 07:00 UTC."""
    form = with_zone(DATETIME["ymd"], True)
    assert both(f"2026-03-01T08:00:00{zone}", form) == ns(2026, 3, 1, 8) - int(hours * 3600) * S
    assert offset_ns(zone) == int(hours * 3600) * S
    assert both("2026-03-01T08:00:00", form) == NAT
    assert both(f"2026-03-01T08:00:00{zone}", with_zone(DATETIME["ymd"], False)) == NAT
    assert is_zoned(f"2026-03-01T08:00:00{zone}", DATETIME["ymd"])
    assert not is_zoned("2026-03-01T08:00:00", DATETIME["ymd"])


@pytest.mark.parametrize("behind", ["+2", "+1.5", " +2.5", " +2 h", " 2", "-5"])
def test_what_may_be_part_of_a_second_or_a_value_is_no_offset(behind: str) -> None:
    assert not is_zoned(f"2026-03-01 08:00:00{behind}", DATETIME["ymd"])
    assert both(f"2026-03-01 08:00:00{behind}", with_zone(DATETIME["ymd"], True)) == NAT


def test_rows_of_one_width_with_another_offset_are_read_each_with_its_own() -> None:
    cells = ["2026-10-25T02:30:00+02:00", "2026-10-25T02:30:00+01:00", "2026-10-25T02:30:00-01:00"]
    assert parse(cells, DATETIME["ymd"]).tolist() == [ns(2026, 10, 25, h, 30) for h in (0, 1, 3)]


# ---- the calendar --------------------------------------------------------------------------------


@pytest.mark.parametrize(("written", "year"), [("68", 2068), ("69", 1969), ("00", 2000), ("99", 1999), ("26", 2026)])
def test_years_of_two_digits_are_1969_to_2068(written: str, year: int) -> None:
    assert both(f"25.12.{written}", DATE["dmy"]) == ns(year, 12, 25)
    assert both(f"25/12/{written}", declared_format("%d/%m/%y")) == ns(year, 12, 25)
    assert both(f"25-Dec-{written}", declared_format("%d-%b-%y")) == ns(year, 12, 25)


@pytest.mark.parametrize(
    ("cell", "order", "date"),
    [
        ("2026-03-04", "ymd", (2026, 3, 4)),
        ("2026/3/4", "ymd", (2026, 3, 4)),
        ("4. 3. 2026", "dmy", (2026, 3, 4)),
        ("3/4/2026", "mdy", (2026, 3, 4)),
        ("3/4/2026", "dmy", (2026, 4, 3)),
        ("2026年3月4日", "cjk", (2026, 3, 4)),
        ("29.2.2024", "dmy", (2024, 2, 29)),
        ("29.2.2026", "dmy", None),
        ("29.2.2100", "dmy", None),
        ("29.2.2000", "dmy", (2000, 2, 29)),
        ("31.4.2026", "dmy", None),
        ("0.3.2026", "dmy", None),
        ("1.0.2026", "dmy", None),
        ("1.13.2026", "dmy", None),
        ("1.1.1900", "dmy", (1900, 1, 1)),
        ("31.12.1899", "dmy", None),
        ("31.12.2200", "dmy", (2200, 12, 31)),
        ("1.1.2201", "dmy", None),
        ("1.3-2026", "dmy", None),
    ],
)
def test_days_of_the_calendar(cell: str, order: str, date: tuple[int, int, int] | None) -> None:
    wanted = NAT if date is None else ns(*date)
    assert both(cell, DATE[order]) == wanted
    assert both(cell, DATETIME[order]) == wanted  # midnight, which a spreadsheet does not write
    assert both(f"{cell} 8:00", DATETIME[order]) == (NAT if date is None else wanted + 8 * 3600 * S)


@given(st.dates(datetime(1900, 1, 1).date(), datetime(2200, 12, 31).date()))
def test_every_day_has_its_number(day: datetime) -> None:
    wanted = ns(day.year, day.month, day.day)
    assert both(day.strftime("%Y-%m-%d").zfill(10), DATE["ymd"]) == wanted


# ---- whole columns -------------------------------------------------------------------------------

ISO = st.datetimes(datetime(1850, 1, 1), datetime(2261, 12, 31)).flatmap(
    lambda t: st.sampled_from(
        [
            t.strftime("%Y-%m-%d %H:%M:%S"),
            t.strftime("%Y-%m-%dT%H:%M:%S.%f"),
            t.strftime("%Y-%m-%d %H:%M:%S.%f")[:-3],
            t.strftime("%Y-%m-%d %H:%M"),
            t.strftime("%Y-%m-%d"),
            t.strftime("%Y-%m-%d %H"),
            t.strftime("%Y-%m-%d %H%M%S"),
            t.strftime("%Y-%m-%d %H%M%S.%f"),
            t.strftime("%Y-%m-%d %H:%M:%S."),
            t.strftime("%Y-%m-%d %H:%M:%S.%f") + "123",
            t.strftime("%Y-%m-%d %H:%M:%S") + "Z",
            t.strftime("%Y-%m-%d %H:%M:%S") + "+01:00",
            t.strftime(" %Y-%m-%d %H:%M:%S "),
            t.strftime("%Y-%m-%d %H:%M:%S PM"),
            t.strftime("%Y-%m-%d 24:%M:%S"),
            t.strftime("%Y%m%d %H:%M:%S"),
        ]
    )
)


@settings(deadline=None, max_examples=300)
@given(st.lists(st.one_of(ISO, st.sampled_from(["", "x", "2026-02-30 08:00:00", "2026-03-01 08:00:60"])), max_size=4))
@example(["2026-03-01 08:00:00", "2026-03-01 08"])
@example(["2026-03-01 08:00:00", "2026-03-01 083000"])
@example(["2026-03-01 08:00:00", "2026-03-01"])
@example(["2026-03-01 08:00:00", "1899-12-31 00:00:00"])
def test_a_column_is_read_as_its_cells_are(cells: list[str]) -> None:
    for form in (DATETIME["ymd"], with_zone(DATETIME["ymd"], False), with_zone(DATETIME["ymd"], True)):
        rows = ["2026-03-01 08:00:00", *cells]  # by which a column looks like ISO
        assert parse(rows, form).tolist() == [parse_one(cell, form) for cell in rows]
        assert parse(cells, form).tolist() == [parse_one(cell, form) for cell in cells]


@settings(deadline=None)
@given(st.lists(st.text(alphabet="0123456789:.,/- TZapmPM+é", max_size=20), max_size=6))
def test_a_column_of_anything_is_read_as_its_cells_are(cells: list[str]) -> None:
    for form in (TIME_OF_DAY, DATE["dmy"], DATETIME["mdy"], MILLISECOND, OFFSET_MS):
        assert parse(cells, form).tolist() == [parse_one(cell, form) for cell in cells]


def test_counts_of_milliseconds() -> None:
    assert parse(["7", "250", "1000"], MILLISECOND).tolist() == [7_000_000, 250_000_000, NAT]
    assert parse(["7", "1500.25", "12."], OFFSET_MS).tolist() == [7_000_000, 1_500_250_000, 12_000_000]


# ---- declared ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "cell", "role", "wanted"),
    [
        ("%d-%b-%Y %H:%M:%S", "01-Mar-2026 08:00:00", "datetime", ns(2026, 3, 1, 8)),
        ("%d-%b-%Y %H:%M:%S", "01-XYZ-2026 08:00:00", "datetime", NAT),
        ("%B %d, %Y", "March 1, 2026", "date", ns(2026, 3, 1)),
        ("%d %b %Y %I:%M:%S %p", "1 Mar 2026 12:00:01 AM", "datetime", ns(2026, 3, 1, 0, 0, 1)),
        ("%a %d.%b.%Y %H:%M:%S.%f", "Sun 1.Mar.2026 08:00:00.125", "datetime", ns(2026, 3, 1, 8, 0, 0, 125_000)),
        ("%d %b %Y %H:%M:%S %z", "1 Mar 2026 08:00:00 +0200", "datetime", ns(2026, 3, 1, 6)),
        ("%Y-%j", "2026-060", "date", ns(2026, 3, 1)),
        ("%d/%m/%Y %H:%M:%S", "01/03/2026 08:00:00", "datetime", ns(2026, 3, 1, 8)),
        ("%m/%d/%Y %H:%M:%S", "03/01/2026 08:00:00", "datetime", ns(2026, 3, 1, 8)),
        ("%m/%d/%Y %I:%M %p", "03/01/2026 12:05 AM", "datetime", ns(2026, 3, 1, 0, 5)),
        ("%m/%d/%Y %I:%M %p", "03/01/2026 12:05 pm", "datetime", ns(2026, 3, 1, 12, 5)),
        ("%Y%m%d%H%M%S", "20260301080000", "datetime", ns(2026, 3, 1, 8)),
        ("%Y-%m-%d %H:%M:%S%z", "2026-03-01 08:00:00-01:00", "datetime", ns(2026, 3, 1, 9)),
        ("%H:%M:%S.%f", "00:00:01.5", "time", 1_500_000_000),
        ("%d.%m.%y", "01.03.26", "date", ns(2026, 3, 1)),
        ("%d.%m.%y", "01/03/26", "date", NAT),
        ("100%% %Y-%m", "100% 2026-03", "date", ns(2026, 3, 1)),
    ],
)
def test_declared_formats(text: str, cell: str, role: str, wanted: int) -> None:
    form = declared_format(text)
    assert form.role == role
    assert both(cell, form) == wanted


def test_a_declared_order_stands_though_the_cells_look_like_iso() -> None:
    assert both("2026-03-04 08:00:00", declared_format("%Y-%d-%m %H:%M:%S")) == ns(2026, 4, 3, 8)
    form = declared_format("%Y-%m-%d %H:%M:%S")
    assert parse(["2026-03-04 08:00:00", "2026-03-04", "2026-03-04 08:00"], form).tolist() == [
        ns(2026, 3, 4, 8),
        NAT,
        NAT,
    ]


@pytest.mark.parametrize("text", ["%Y-%q", "%Y-%Y", "%d.%m.%Y %Q"])
def test_a_declared_format_that_cannot_be_used_is_refused(text: str) -> None:
    with pytest.raises(FormatError, match="cannot be used"):
        declared_format(text)


def test_what_looks_like_a_date_or_a_time() -> None:
    assert all(is_date_text(c) for c in ("1.3.26", "2026-03-01T08:00:00Z", "3/14/2026 8:00 PM", "2026年3月1日"))
    assert not any(is_date_text(c) for c in ("1.3-26", "20.5", "08:00", "2026-03-01 8", ""))
    assert all(is_time_of_day(c) for c in ("08:00", "8:00:00.125", "8:00 PM", "08:00:00Z"))
    assert not any(is_time_of_day(c) for c in ("2026-03-01 08:00", "8", "8:0", ""))


def test_cells_of_one_width_that_are_laid_out_in_other_ways_are_read_each() -> None:
    """It ended the reading of the file: the hour of the second has a colon among its digits, where the first is."""
    form = declared_format("%H:%M:%S %p")
    cells = ["12:00:00 vorm.", "9:00:00 nachm.", "10:00:00 vorm."]
    assert parse(cells, form).tolist() == [parse_one(c, form) for c in cells] == [0, 21 * 3600 * S, 10 * 3600 * S]
