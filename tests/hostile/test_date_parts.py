"""Dates in columns of their own, and times with the zone's abbreviation behind them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.draft.labs import workbook
from thermodata.errors import FormatError, QuestionError

from .conftest import Lab

FIRST = datetime(2026, 2, 28, 23, 40)  # over the end of a month, with no leap day
MOMENTS = [FIRST + timedelta(seconds=15 * i) for i in range(200)]
WANTED = np.arange(200) * 15_000_000_000 + np.datetime64(FIRST, "ns").astype(np.int64)
T1 = {"T1": {"signal": "T", "quantity": "temperature", "unit": "degC"}}


def times(data: Any) -> Any:
    """Of the one stream."""
    (t_ns,) = data.t_ns.values()
    return t_ns


def table(header: str, cells: Callable[[datetime], Sequence[Any]], between: str = ";") -> str:
    lines = [between.join([*map(str, cells(t)), f"{20 + i / 8}"]) for i, t in enumerate(MOMENTS)]
    return "\n".join([header, *lines]) + "\n"


def in_six(t: datetime) -> list[int]:
    return [t.year, t.month, t.day, t.hour, t.minute, t.second]


WAYS = {
    "Year;Month;Day;Hour;Minute;Second;T": (in_six, ";"),
    "Jahr;Monat;Tag;Stunde;Minute;Sekunde;T": (in_six, ";"),
    "Rok;Měsíc;Den;Hodina;Minuta;Sekunda;T": (in_six, ";"),
    "Année,Mois,Jour,Heure,Minute,Seconde,T": (in_six, ","),
    "YYYY,MM,DD,hh,mm,ss,T": (lambda t: [f"{x:.6f}" for x in in_six(t)], ","),
    "#YY MM DD hh mm ss T": (lambda t: [f"{x % 100:02d}" for x in in_six(t)], "\t"),
    "year\tmonth\tday\ttime\tT": (lambda t: [t.year, t.month, t.day, f"{t:%H:%M:%S}"], "\t"),
    "Jahr;Monat;Tag;Uhrzeit;T": (lambda t: [t.year, f"{t.month:02d}", f"{t.day:02d}", f"{t:%H:%M:%S}"], ";"),
    "Day,Month,Year,Hour,Min,Sec,T": (lambda t: [t.day, t.month, t.year, t.hour, t.minute, t.second], ","),
}


@pytest.mark.parametrize("header", WAYS)
def test_a_date_in_columns_is_one_time(read: Any, header: str) -> None:
    cells, between = WAYS[header]
    data = read(table(header.replace(" ", "\t"), cells, between))
    assert data.recording.clock == "absolute"
    assert [s.name for s in data.recording.signals] == ["T"]
    np.testing.assert_array_equal(times(data), WANTED)
    np.testing.assert_array_equal(next(iter(data.values.values())), 20 + np.arange(200) / 8)
    assert not data.losses
    assert any("the time stands in" in note for note in data.recording.notes)


def test_seconds_in_a_column_may_have_a_fraction_and_comma(read: Any) -> None:
    data = read(
        "\n".join(
            ["Jahr;Monat;Tag;Stunde;Minute;Sekunde;T"]
            + [f"2026;3;2;8;{i // 4};{i % 4 * 15},25;20,{i:03d}" for i in range(100)]
        )
        + "\n"
    )
    np.testing.assert_array_equal(np.diff(times(data)), 15_000_000_000)
    assert times(data)[0] % 1_000_000_000 == 250_000_000


def test_a_day_that_is_none_is_a_loss_and_the_others_are_read(read: Any) -> None:
    lines = table("Year;Month;Day;Hour;Minute;Second;T", in_six).splitlines()
    lines[50] = "2026;2;31;23;52;0;21"
    lines[60] = "2026;;28;23;54;30;21"
    data = read("\n".join(lines) + "\n")
    assert times(data).size == 198
    assert len(data.losses) == 2
    assert "line 51" in str(data.losses[0].where)


def test_columns_of_other_names_are_declared(read: Any) -> None:
    text = table("a;b;c;d;e;f;T", in_six)
    with pytest.raises((QuestionError, FormatError)):
        read(text, by="table")
    form = "%Y %m %d %H %M %S"
    data = read(text, by="table", table={"time": {"column": [1, 2, 3, 4, 5, 6], "format": form}})
    np.testing.assert_array_equal(times(data), WANTED)
    named = table("Day;Month;Year;Hour;Minute;Second;T", lambda t: [t.day, t.month, t.year, *in_six(t)[3:]])
    data = read(named, table={"time": {"column": ["Year", "Month", "Day", "Hour", "Minute", "Second"]}})
    np.testing.assert_array_equal(times(data), WANTED)


@pytest.mark.parametrize(
    "header",
    ["Year;Month;Day;Hour;Minute;Second;T", "Pressure;Month;Day;Hour;Minute;Second;T"],
)
def test_numbers_that_are_no_date_are_none(read: Any, header: str) -> None:
    """Operating hours beside a year of build, or parts without a year."""
    text = table(header, lambda t: [7000.5, t.month, t.day, t.hour, t.minute, t.second])
    with pytest.raises(FormatError):
        read(text)


def test_local_times_in_columns_know_the_hour_that_comes_twice(read: Any) -> None:
    first = datetime(2026, 10, 25, 0, 30)  # UTC: 02:30 CEST
    local = [first + timedelta(minutes=10 * i) + timedelta(hours=2 if i < 3 else 1) for i in range(60)]
    rows = "\n".join(f"{t.year};{t.month};{t.day};{t.hour};{t.minute};{i}" for i, t in enumerate(local))
    data = read(f"Year;Month;Day;Hour;Minute;T\n{rows}\n", timezone="Europe/Prague")
    np.testing.assert_array_equal(np.diff(times(data)), 600_000_000_000)


def test_a_new_user_gets_a_draft_and_a_trace_of_a_date_in_columns(lab: Lab) -> None:
    lab.write("raw/a.csv", table("Year;Month;Day;Hour;Minute;Second;T_spindle [degC]", in_six))
    assert lab("init", lab.folder).code == 0
    drafted = (lab.folder / "campaign.yaml").read_text(encoding="utf-8")
    assert "Month" not in drafted, "parts of a date are no channels"
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    t_s, _ = lab.values("T_spindle", "a")
    np.testing.assert_allclose(t_s, np.arange(200) * 15.0)
    assert "2026-02-28 23:40:00" in lab("sql", "select min(t) from sample").out
    campaign = next(line for line in drafted.splitlines() if line.startswith("id:")).split()[1]
    traced = lab("trace", campaign, "a", "T_spindle", "--at", "150 s", "--verify")
    assert (traced.code, "line 12" in traced.out) == (0, True), traced.out + traced.err


@pytest.mark.parametrize("sheet", ["four", "six"])
def test_a_workbook_with_a_date_in_columns(read: Any, tmp_path: Path, sheet: str) -> None:
    four = [[t.year, t.month, t.day, f"{t:%H:%M:%S}", 20 + i / 8] for i, t in enumerate(MOMENTS)]
    six = [[*map(float, in_six(t)), 20 + i / 8] for i, t in enumerate(MOMENTS)]
    book = {
        "four": [["Year", "Month", "Day", "Time", "T"], *four],
        "six": [["Year", "Month", "Day", "Hour", "Minute", "Second", "T"], *six],
    }
    workbook(tmp_path / "made.xlsx", book)
    data = read((tmp_path / "made.xlsx").read_bytes(), "a.xlsx", by="table", table={"sheet": sheet})
    np.testing.assert_array_equal(times(data), WANTED)


# ---- zones ---------------------------------------------------------------------------------------


def stamped(word: Callable[[datetime], str], between: str = " ", form: str = "%Y-%m-%d %H:%M:%S") -> str:
    return "time;T\n" + "".join(f"{t:{form}}{between}{word(t)};{20 + i / 8}\n" for i, t in enumerate(MOMENTS))


@pytest.mark.parametrize(
    ("word", "hours"),
    [
        *[("UTC", 0), ("GMT", 0), ("CET", 1), ("MEZ", 1), ("SEČ", 1), ("CEST", 2), ("SELČ", 2), ("EEST", 3)],
        *[("EST", -5), ("EDT", -4), ("PDT", -7), ("(CEST)", 2), ("UTC+2", 2), ("GMT-03:30", -3.5)],
    ],
)
@pytest.mark.parametrize("between", [" ", ""])
@pytest.mark.parametrize("form", ["%Y-%m-%d %H:%M:%S", "%d.%m.%Y %H:%M:%S"])
def test_a_zone_that_is_known_by_its_letters_is_heeded(
    read: Any, word: str, hours: float, between: str, form: str
) -> None:
    data = read(stamped(lambda t: word, between, form), timezone="Asia/Tokyo")  # the file's own counts
    np.testing.assert_array_equal(times(data), WANTED - round(hours * 3600) * 1_000_000_000)


def test_the_zone_may_change_within_a_file(read: Any) -> None:
    first = datetime(2026, 10, 25, 0, 30)
    zones = [(2, "CEST")] * 3 + [(1, "CET")] * 57
    rows = "".join(
        f"{first + timedelta(minutes=10 * i, hours=hours):%d.%m.%Y %H:%M:%S} {word};{i}\n"
        for i, (hours, word) in enumerate(zones)
    )
    data = read(f"time;T\n{rows}")
    np.testing.assert_array_equal(np.diff(times(data)), 600_000_000_000)
    assert not data.losses


@pytest.mark.parametrize(
    ("word", "zone"), [("CST", "Asia/Shanghai"), ("BST", "Europe/London"), ("XYZ", "Europe/Prague")]
)
def test_a_zone_of_several_meanings_is_asked_for(read: Any, lab: Lab, word: str, zone: str) -> None:
    text = stamped(lambda t: word)
    with pytest.raises(QuestionError, match=f"'{word}'") as asked:
        read(text)
    assert zone in str(asked.value.hint)
    assert "CEST" in str(asked.value.expected)
    lab.write("raw/a.csv", text)
    assert lab("init", lab.folder).code == 0
    campaign = lab.folder / "campaign.yaml"
    drafted = campaign.read_text(encoding="utf-8")
    assert f"what is '{word}'? write timezone: " in drafted
    assert f'format: "%Y-%m-%d %H:%M:%S {word}"' in drafted
    campaign.write_text(drafted.replace(", files:", f", timezone: {zone}, files:"), encoding="utf-8")
    said = lab("ingest", campaign)
    assert said.code == 0, said.out + said.err
    begins = lab("sql", "select epoch_ns(min(t)) as t from sample", "--csv").out.split()[-1]
    # in winter none of them has daylight saving
    assert int(begins) == WANTED[0] - {"CST": 8, "BST": 0, "XYZ": 1}[word] * 3600 * 1_000_000_000


def test_a_declared_zone_letter_reads_abbreviations(read: Any) -> None:
    data = read(
        stamped(lambda t: "CEST", form="%d.%m.%Y %H:%M:%S"),
        timezone="Asia/Tokyo",
        table={"time": {"column": 1, "format": "%d.%m.%Y %H:%M:%S %Z"}},
    )
    np.testing.assert_array_equal(times(data), WANTED - 2 * 3600 * 1_000_000_000)


# ---- parts beside a time, and words beside one ---------------------------------------------------


SECONDS = [FIRST + timedelta(seconds=i) for i in range(60)]


def parts_beside(header: str, cells: Callable[[int, datetime], Sequence[Any]]) -> str:
    rows = [";".join(map(str, (*cells(i, t), 20 + i / 8))) for i, t in enumerate(SECONDS)]
    return "\n".join([header, *rows]) + "\n"


def in_five(t: datetime) -> list[int]:
    return in_six(t)[:5]


@pytest.mark.parametrize("form", ["%Y-%m-%d %H:%M:%S", "%d.%m.%Y %H:%M:%S"])
def test_a_time_of_its_own_comes_before_parts(read: Any, form: str) -> None:
    data = read(
        parts_beside("Timestamp;Year;Month;Day;Hour;Minute;T1", lambda i, t: [f"{t:{form}}", *in_five(t)]), by="table"
    )
    np.testing.assert_array_equal(np.diff(times(data)), 1_000_000_000)
    assert "Timestamp" not in {s.name for s in data.recording.signals}


def test_relative_seconds_come_before_parts(read: Any) -> None:
    data = read(parts_beside("Time [s];Year;Month;Day;Hour;Minute;T1", lambda i, t: [i * 1.0, *in_five(t)]), by="table")
    np.testing.assert_array_equal(times(data), np.arange(60) * 1_000_000_000)
    assert not {s.name for s in data.recording.signals} & {"Time", "Time [s]"}


def test_parts_come_before_a_date_that_tells_no_time_of_day(read: Any) -> None:
    data = read(
        parts_beside("Date;Year;Month;Day;Hour;Minute;Second;T1", lambda i, t: [f"{t:%Y-%m-%d}", *in_six(t)]),
        by="table",
    )
    np.testing.assert_array_equal(np.diff(times(data)), 1_000_000_000)


@pytest.mark.parametrize("cell", ["{}", "{:03d}", "{}.000"])
def test_milliseconds_are_a_part(read: Any, cell: str) -> None:
    rows = [[*in_six(FIRST + timedelta(seconds=i // 2)), cell.format(i % 2 * 500), 20 + i / 8] for i in range(60)]
    text = "\n".join(["Year;Month;Day;Hour;Minute;Second;Millisecond;T1", *(";".join(map(str, r)) for r in rows)])
    data = read(text + "\n", by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 500_000_000)
    assert [s.name for s in data.recording.signals] == ["T1"]


def test_milliseconds_are_a_part_in_a_workbook(read: Any, tmp_path: Path) -> None:
    rows = [[*in_six(FIRST + timedelta(seconds=i // 2)), i % 2 * 500, 20 + i / 8] for i in range(60)]
    workbook(
        tmp_path / "made.xlsx", {"a": [["Year", "Month", "Day", "Hour", "Minute", "Second", "Millisecond", "T"], *rows]}
    )
    data = read((tmp_path / "made.xlsx").read_bytes(), "a.xlsx", by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 500_000_000)


HOURLY = [datetime(2026, 2, 28) + timedelta(hours=i) for i in range(60)]
HOURS_NS = np.arange(60) * 3_600_000_000_000 + np.datetime64(HOURLY[0], "ns").astype(np.int64)


def test_hours_need_no_minutes(read: Any, lab: Lab, tmp_path: Path) -> None:
    rows = [[t.year, t.month, t.day, t.hour, 20 + i / 8] for i, t in enumerate(HOURLY)]
    head = ["Year", "Month", "Day", "Hour", "T1"]
    text = "\n".join(";".join(map(str, r)) for r in (head, *rows)) + "\n"
    np.testing.assert_array_equal(times(read(text, by="table")), HOURS_NS)
    workbook(tmp_path / "made.xlsx", {"a": [head, *rows]})
    data = read((tmp_path / "made.xlsx").read_bytes(), "a.xlsx", by="table")
    np.testing.assert_array_equal(times(data), HOURS_NS)
    told = {"time": {"column": [1, 2, 3, 4], "format": "%Y %m %d %H"}}
    np.testing.assert_array_equal(times(read(text.replace("Year", "a"), by="table", table=told)), HOURS_NS)
    one = "t;T1\n" + "".join(f"{t:%Y-%m-%d %H};{i}\n" for i, t in enumerate(HOURLY))
    data = read(one, by="table", table={"time": {"column": 1, "format": "%Y-%m-%d %H"}})
    np.testing.assert_array_equal(times(data), HOURS_NS)
    lab.write("raw/a.csv", text)
    said = lab.ingest(T1 | {"T1": {**T1["T1"], "signal": "T1"}})
    assert said.code == 0, said.out + said.err
    np.testing.assert_allclose(lab.values("T1")[0], np.arange(60) * 3600.0)


@pytest.mark.parametrize("form", ["%H:%M:%S", "%H:%M:%S.%f", "%I:%M:%S %p"])
@pytest.mark.parametrize("parts", [4, 5])
def test_a_time_of_day_beside_parts_without_seconds_tells_them(
    read: Any, tmp_path: Path, parts: int, form: str
) -> None:
    head = ["Year", "Month", "Day", "Hour", "Minute"][:parts]
    rows = [[*in_six(t)[:parts], f"{t:{form}}", 20 + i / 8] for i, t in enumerate(SECONDS)]
    text = "\n".join(";".join(map(str, r)) for r in ([*head, "Clock", "T1"], *rows)) + "\n"
    data = read(text, by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 1_000_000_000)
    assert any("'Day', 'Clock'" in note for note in data.recording.notes)
    named = [s.name for s in data.recording.signals]
    assert named == [*head[3:], "T1"], "hours and minutes stay what they are, signals"
    workbook(
        tmp_path / "made.xlsx",
        {"a": [[*head, "Clock", "T1"], *([*r[:-2], t.time(), r[-1]] for r, t in zip(rows, SECONDS, strict=True))]},
    )
    data = read((tmp_path / "made.xlsx").read_bytes(), "a.xlsx", by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 1_000_000_000)


def test_a_time_of_day_that_disagrees_with_parts_is_none_of_them(read: Any) -> None:
    """How long a test has lasted, beside the minute in which the row was written."""
    text = parts_beside("Year;Month;Day;Hour;Minute;Elapsed;T1", lambda i, t: [*in_five(t), f"0:00:{i:02d}"])
    data = read(text, by="table")
    np.testing.assert_array_equal(times(data), np.full(60, WANTED[0]))
    assert [s.name for s in data.recording.signals] == ["Elapsed", "T1"]


def test_a_time_of_day_that_most_rows_lack_is_no_part_of_the_time(read: Any) -> None:
    """When something was switched on, beside the minute in which the row was written."""
    text = parts_beside(
        "Year;Month;Day;Hour;Minute;Event;T1", lambda i, t: [*in_five(t), "" if i % 3 else f"{t:%H:%M:%S}"]
    )
    data = read(text, by="table")
    np.testing.assert_array_equal(times(data), np.full(60, WANTED[0]))
    assert not data.losses


@pytest.mark.parametrize("clock", ["%H:%M:%S", "%I:%M:%S %p"])
def test_milliseconds_behind_a_time_of_day_beside_parts_are_joined(read: Any, tmp_path: Path, clock: str) -> None:
    moments = [FIRST + timedelta(milliseconds=500 * i) for i in range(60)]
    head = ["Year", "Month", "Day", "Time", "ms", "T1"]
    rows = [[*in_six(t)[:3], f"{t:{clock}}", t.microsecond // 1000, 20 + i / 8] for i, t in enumerate(moments)]
    data = read("\n".join(";".join(map(str, r)) for r in (head, *rows)) + "\n", by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 500_000_000)
    assert [s.name for s in data.recording.signals] == ["T1"]
    workbook(
        tmp_path / "made.xlsx",
        {"a": [head, *([*r[:3], t.time().replace(microsecond=0), *r[4:]] for r, t in zip(rows, moments, strict=True))]},
    )
    data = read((tmp_path / "made.xlsx").read_bytes(), "a.xlsx", by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 500_000_000)


@pytest.mark.parametrize(
    ("clock", "thousandths"),
    [("%H:%M:%S.%f", lambda i: 500), ("%H:%M", lambda i: i), ("%H:%M:%S", lambda i: i * 40)],
)
def test_numbers_that_are_no_milliseconds_of_the_time_stay_a_signal(
    read: Any, clock: str, thousandths: Callable[[int], int]
) -> None:
    """Of a time with fractions, of one without seconds, and beyond a second."""
    text = parts_beside("Year;Month;Day;Time;ms;T1", lambda i, t: [*in_six(t)[:3], f"{t:{clock}}", thousandths(i)])
    data = read(text, by="table")
    assert [s.name for s in data.recording.signals] == ["ms", "T1"]
    assert times(data)[0] == WANTED[0]


CALIBRATED = ["2025-11-03 10:00:00", "03.11.2025 10:00", "2025-11-03"]


GOING_ON: dict[str, Callable[[int, datetime], Sequence[Any]]] = {
    "Year;Month;Day;Hour;Minute;Second": lambda i, t: in_six(t),
    "Year;Month;Day;Time": lambda i, t: [*in_six(t)[:3], f"{t:%H:%M:%S}"],
    "Measured at": lambda i, t: [f"{t:%Y-%m-%d %H:%M:%S}"],
    "Tag;Messung um": lambda i, t: [f"{t:%Y-%m-%d}", f"{t:%H:%M:%S}"],
}


@pytest.mark.parametrize(
    ("stamp", "header"),
    # of two days beside a time of day the first counts
    [(s, h) for s in CALIBRATED for h in GOING_ON if ":" in s or not h.startswith("Tag")],
)
def test_a_date_that_is_the_same_in_all_rows_is_not_their_time(read: Any, stamp: str, header: str) -> None:
    cells = GOING_ON[header]
    data = read(parts_beside(f"Calibrated;{header};T1", lambda i, t: [stamp, *cells(i, t)]), by="table")
    np.testing.assert_array_equal(times(data), WANTED[0] + np.arange(60) * 1_000_000_000)
    assert [s.name for s in data.recording.signals] == ["Calibrated", "T1"]


@pytest.mark.parametrize("stamp", ["2025-11-03", "2025-11-03 07:00:00"])
def test_a_date_that_is_the_same_in_all_rows_is_not_their_time_beside_seconds_from_a_start(
    read: Any, stamp: str
) -> None:
    data = read("Calibrated;Time [s];T1\n" + "".join(f"{stamp};{i};{20 + i}\n" for i in range(60)), by="table")
    assert data.recording.clock == "relative"
    np.testing.assert_array_equal(times(data), np.arange(60) * 1_000_000_000)
    # numbers under such a name that do not go on either are no better
    data = read("Measured;Time [s];T1\n" + "".join(f"{stamp};5;{20 + i}\n" for i in range(60)), by="table")
    assert data.recording.clock == "absolute"


@pytest.mark.parametrize(("step_s", "clock"), [(6000, "relative"), (86_400, "absolute")])
def test_days_are_no_time_beside_seconds_that_go_on_where_a_day_has_many_rows(
    read: Any, step_s: int, clock: str
) -> None:
    days = [3 + i * step_s // 86_400 for i in range(25)]
    text = "".join(f"2025-11-{day:02d};{i * step_s};{20 + i}\n" for i, day in enumerate(days))
    data = read("Date;Time [s];T1\n" + text, by="table")
    assert data.recording.clock == clock
    assert [s.name for s in data.recording.signals] == [*(["Date"] if clock == "relative" else ["Time [s]"]), "T1"]
    np.testing.assert_array_equal(np.diff(times(data)), step_s * 1_000_000_000)


def test_days_with_a_time_of_day_beside_seconds_that_go_on_are_the_time(read: Any) -> None:
    rows = "".join(f"2025-11-03;{8 + i // 60:02d}:{i % 60:02d}:00;{60 * i};{20 + i}\n" for i in range(60))
    data = read("Date;Clock;Time [s];T1\n" + rows, by="table")
    assert data.recording.clock == "absolute"


def test_a_date_that_is_the_same_in_all_rows_is_the_time_where_nothing_else_is(read: Any) -> None:
    rows = "".join(f"2026-02-28 23:40:00;{i}\n" for i in range(60))
    data = read("Measured;T1\n" + rows, by="table")
    np.testing.assert_array_equal(times(data), np.full(60, WANTED[0]))
    standing = "".join(f"2026;2;28;23;40;2026-02-28 23:40:00;{i}\n" for i in range(60))
    data = read("Year;Month;Day;Hour;Minute;Measured;T1\n" + standing, by="table")
    np.testing.assert_array_equal(times(data), np.full(60, WANTED[0]))


@pytest.mark.parametrize("declared", [None, {"time": {"column": 1}}])
def test_a_word_behind_another_column_is_not_asked_for(read: Any, declared: Any) -> None:
    rows = "".join(f"{t:%Y-%m-%d %H:%M:%S};{i};{t:%H:%M:%S} OK\n" for i, t in enumerate(SECONDS))
    data = read("Time;T1;checked\n" + rows, by="table", **({"table": declared} if declared else {}))
    np.testing.assert_array_equal(np.diff(times(data)), 1_000_000_000)


def test_a_word_beside_relative_seconds_is_not_asked_for(read: Any) -> None:
    rows = "".join(f"{i};{20 + i};{t:%H:%M:%S} UHR\n" for i, t in enumerate(SECONDS))
    data = read("Time [s];T1;Uhrzeit\n" + rows, by="table")
    np.testing.assert_array_equal(times(data), np.arange(60) * 1_000_000_000)


@pytest.mark.parametrize("beside", ["Time [s];Timestamp", "Year;Timestamp", "checked;Timestamp"])
def test_a_word_behind_what_would_be_the_time_is_asked_for(read: Any, beside: str) -> None:
    rows = "".join(f"{i};{t:%Y-%m-%d %H:%M:%S} CST;{20 + i}\n" for i, t in enumerate(SECONDS))
    with pytest.raises(QuestionError, match="'CST'"):
        read(f"{beside};T1\n{rows}", by="table")
