"""How a column of times is written: day and month by dots, numbers above 12, AM and PM, or asked; and its zone."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.cell import TIME_WORD
from thermodata.reader.text.cells.time_forms.time_pattern import DATE, DATETIME, TIME_OF_DAY, declared_format
from thermodata.reader.text.times.in_memory import times_of_numbers, times_of_texts
from thermodata.reader.text.times.time_formats import find_format, find_formats, share

S = 1_000_000_000


@pytest.mark.parametrize(
    ("cells", "form"),
    [
        (["03.04.2026 08:00", "04.04.2026 08:00"], DATETIME["dmy"]),
        (["3. 4. 2026", "4. 4. 2026"], DATE["dmy"]),
        (["03/04/2026 08:00", "13/04/2026 08:00"], DATETIME["dmy"]),
        (["03/04/2026 08:00", "03/13/2026 08:00"], DATETIME["mdy"]),
        (["03-04-26", "03-13-26"], DATE["mdy"]),
        (["03/04/2026 08:00 AM", "04/04/2026 08:00 PM"], DATETIME["mdy"]),
        (["13/04/2026 08:00 AM", "14/04/2026 08:00 PM"], DATETIME["dmy"]),
        (["03.04.2026 08:00 AM", "04.04.2026 08:00 PM"], DATETIME["dmy"]),
        (["2026/04/03 08:00", "2026/04/13 08:00"], DATETIME["ymd"]),
        (["2026年4月3日"], DATE["cjk"]),
        (["08:00:00", "09:00"], TIME_OF_DAY),
        (["2026-03-01", "2026-03-01 00:15", "2026-03-01 00:30"], DATETIME["ymd"]),
        (["", "x", "03/14/2026", "", "03/15/2026", "03/16/2026"], DATETIME["mdy"]),
    ],
)
def test_the_order_of_day_and_month(cells: list[str], form: object) -> None:
    assert find_format(cells, "a.csv") == form


def test_one_day_above_12_among_thousands_decides() -> None:
    cells = [
        f"{1 + k % 12:02d}/{1 + k // 400:02d}/2026 08:00" for k in range(2999)
    ]  # of which a sample of 40 has not the last
    assert find_format([*cells, "13/08/2026 08:00"], "a.csv") == DATETIME["dmy"]
    assert find_format([*cells, "08/13/2026 08:00"], "a.csv") == DATETIME["mdy"]


def test_further_cells_are_asked_for_where_the_sample_does_not_tell() -> None:
    cells = ["03/04/2026 08:00"] * 5
    assert find_format(cells, "a.csv", "t", lambda: [*cells, "25/04/2026 08:00"]) == DATETIME["dmy"]


def test_an_order_that_nothing_tells_is_asked() -> None:
    with pytest.raises(FormatError, match="either way round") as error:
        find_format(["03/04/2026 08:00", "04/05/2026 08:00"], "a.csv")
    assert error.value.where == "a.csv"


def test_a_column_without_times_is_refused() -> None:
    with pytest.raises(FormatError, match="holds no times") as error:
        find_format(["x", "y"], "a.csv", "when")
    assert error.value.where == "a.csv column 'when'"


@pytest.mark.parametrize(
    ("zoned", "local", "all_zoned"), [(3, 2, True), (2, 2, False), (2, 3, False), (1, 0, True), (0, 1, False)]
)
def test_most_cells_tell_whether_all_name_their_zone(zoned: int, local: int, all_zoned: bool) -> None:
    cells = ["2026-03-01 08:00:00Z"] * zoned + ["2026-03-01 08:00:00"] * local
    (form,) = find_formats(["t"], [cells], None, "a.csv")
    assert form.zoned is all_zoned
    assert share(cells, form) == (zoned if all_zoned else local) / len(cells)


def test_a_date_a_time_and_milliseconds_in_columns_of_their_own() -> None:
    forms = find_formats(["Date", "Time", "ms"], [["1.3.2026"] * 3, ["8:00:00"] * 3, ["1", "2", "125"]], None, "a.csv")
    assert [form.role for form in forms] == ["date", "time", "millisecond"]


def test_declared_formats_of_two_columns() -> None:
    forms = find_formats(["d", "t"], [["03/04/2026"] * 3, ["08:00:00"] * 3], "%m/%d/%Y %H:%M:%S", "a.csv")
    assert [form.text for form in forms] == ["%m/%d/%Y", "%H:%M:%S"]
    (form,) = find_formats(["t"], [["03/04/2026"]], "%m/%d/%Y", "a.csv")
    assert form.text == "%m/%d/%Y"


def test_columns_in_memory() -> None:
    found = times_of_texts(["2026-07-01 08:00:00", "2026-07-01 08:00:01"], "Europe/Prague", None, "a")
    assert found.absolute
    assert found.t_ns.tolist() == [1_782_885_600 * S, 1_782_885_601 * S]
    found = times_of_texts(["2026-07-01 08:00:00+02:00", "2026-07-01 08:00:01+02:00"], "Asia/Tokyo", None, "a")
    assert found.t_ns.tolist() == [1_782_885_600 * S, 1_782_885_601 * S]
    found = times_of_texts(["23:59:59", "00:00:01"], "Europe/Prague", None, "a")
    assert not found.absolute
    assert found.t_ns.tolist() == [0, 2 * S]
    found = times_of_numbers(np.array([0.5, 1.5]), "min", None)
    assert not found.absolute
    assert found.t_ns.tolist() == [30 * S, 90 * S]


@pytest.mark.parametrize("header", ["时间戳", "epoch_s", "unix_ms", "Horodatage", "日時", "시각", "Fecha"])
def test_what_labs_call_the_time_is_one(header: str) -> None:
    assert TIME_WORD.match(header)


@pytest.mark.parametrize("header", ["epoch speed", "unixes", "Fechadora", "T"])
def test_what_only_begins_so_is_no_time(header: str) -> None:
    assert not TIME_WORD.match(header)


@pytest.mark.parametrize(
    ("clock", "letters"),
    [
        ("", ""),
        (" 21:30", " %H:%M"),
        (" 21:30:{i:02d}", " %H:%M:%S"),
        (" 21:30:{i:02d}.0", " %H:%M:%S.%f"),
        (" 21:30:{i:02d},125", " %H:%M:%S,%f"),
        ("T21:30:{i:02d}:250", "T%H:%M:%S:%f"),
        (" 09:30:{i:02d} PM", " %I:%M:%S %p"),
        (" 21:30:{i:02d}+09:00", " %H:%M:%S%z"),
    ],
)
@pytest.mark.parametrize("sign", "-/.")
def test_a_format_that_is_proposed_reads_the_cells_that_it_is_proposed_for(sign: str, clock: str, letters: str) -> None:
    cells = [("'" if i % 2 else "") + f"26{sign}02{sign}09" + clock.format(i=i) for i in range(40)]
    with pytest.raises(QuestionError) as question:
        find_formats(["Time"], [cells], None, "here")
    proposed = f"%y{sign}%m{sign}%d{letters}"
    assert f"'{proposed}' or dmy?" in question.value.ask
    assert share(cells, declared_format(proposed)) == 1


@pytest.mark.parametrize("cells", [["09.02.26 21:30:00"], ["26.02.09 23:59:00", "27.02.09 00:01:00"], ["31.12.15"]])
def test_dots_mean_day_first_where_no_year_of_today_can_come_first(cells: list[str]) -> None:
    (found,) = find_formats(["Time"], [cells * 20], None, "here")
    assert found.text.startswith("DD.MM.YY")


@pytest.mark.parametrize(
    ("declared", "cell", "hint"),
    [
        ("%y-%m-%d %H:%M:%S", "26-02-09 21:30:00.0", "'%y-%m-%d %H:%M:%S.%f'"),
        ("%d.%m.%Y %H:%M:%S.%f", "09.02.2026 21:30:00", "'%d.%m.%Y %H:%M:%S'"),
        ("%d.%m.%Y", "09.02.2026 21:30", "'%d.%m.%Y %H:%M'"),
        ("%d.%m.%Y %H:%M", "nothing of it", "%f is a part of a second"),
    ],
)
def test_a_declared_format_that_reads_no_cell_is_refused_with_one_that_does(
    declared: str, cell: str, hint: str
) -> None:
    with pytest.raises(FormatError) as error:
        find_formats(["Time"], [[cell] * 40], declared, "here")
    assert hint in (error.value.hint or "")
    assert error.value.got == cell


def test_a_declared_format_that_reads_some_of_the_cells_is_kept() -> None:
    cells = ["26-02-09 21:30:00"] + ["damaged"] * 39
    (found,) = find_formats(["Time"], [cells], "%y-%m-%d %H:%M:%S", "here")
    assert found.text == "%y-%m-%d %H:%M:%S"


@pytest.mark.parametrize(
    ("before", "after", "order"),
    [("11/03/2026", "12/03/2026", "dmy"), ("03/11/2026", "03/12/2026", "mdy"), ("05/05/2026", "06/05/2026", "dmy")],
)
def test_a_midnight_tells_day_from_month(before: str, after: str, order: str) -> None:
    cells = [f"{before} 23:59:{s}" for s in (30, 40, 50)] + [f"{after} 00:00:{s}" for s in ("00", "10", "20")]
    right = find_format(cells, "a file", order=order)
    assert find_format(cells, "a file") == right


def test_a_pause_over_midnight_does_not() -> None:
    cells = [f"11/03/2026 08:00:{s}" for s in (30, 40, 50)] + [f"12/03/2026 08:00:{s}" for s in ("00", "10", "20")]
    with pytest.raises(QuestionError):
        find_format(cells, "a file")


@pytest.mark.parametrize(("declared", "other", "day"), [("mdy", "dmy", "13/04/2026"), ("dmy", "mdy", "04/13/2026")])
def test_dates_of_the_other_order_than_the_declared_one_are_said_to_be(declared: str, other: str, day: str) -> None:
    """Of a computer that writes them the other way round than those of other files."""
    cells = [f"{day} 08:{m:02d}:00" for m in range(30)]
    with pytest.raises(FormatError, match=f"declared as {declared} can only be {other}") as error:
        find_format(cells, "a1.csv", "time", order=declared)
    assert "a source of its own" in str(error.value.hint)
    assert f"format: {other}" in str(error.value.hint)
