"""Times of day in numbers beside a date, and days of the year."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader import load

DAY = np.datetime64("2026-07-14", "ns").astype(np.int64)
MINUTE = 60 * 10**9


def times(tmp_path: Path, head: str, row: str, **said: object) -> list[int]:
    """Minutes since the day began, of every 15 minutes of a day and the first hour of the next."""
    rows = []
    for k in range(0, 1500, 15):
        day, m = divmod(k, 1440)
        joined = str(m // 60 * 10000 + m % 60 * 100)
        of_day = {"d": 14 + day, "h": m // 60, "m": m % 60, "dec": m / 60, "part": m / 1440, "joined": joined}
        rows.append(row.format(T=f"{20 + k / 60:.2f}", doy=195 + day, hhmm=int(joined) // 100, **of_day))
    (tmp_path / "a.csv").write_text("\n".join([head, *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC", table=said or None))
    assert [name for _, name in data.values] == ["T_front"]
    return np.round((data.t_ns["table"] - DAY) / MINUTE, 6).tolist()


EVERY = [float(m) for m in range(0, 1500, 15)]


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Date;Hour;Minute;T_front", "2026-07-{d};{h};{m};{T}"),
        ("Date;Hour;Minute;Second;T_front", "2026-07-{d};{h};{m};0;{T}"),
        ("Datum;Stunde;T_front", "{d}.07.2026;{dec:.2f};{T}"),
    ],
)
def test_hours_and_minutes_beside_a_date_are_its_time_of_day(tmp_path: Path, head: str, row: str) -> None:
    assert times(tmp_path, head, row) == EVERY


@pytest.mark.parametrize(
    ("head", "row", "ask"),
    [
        ("Date;Time;T_front", "2026-07-{d};{part:.10f};{T}", "fraction of the day in 'Date'"),
        ("Date,Time,T_front", "202607{d},{joined},{T}", "%Y%m%d %H%M%S"),
        ("Date,Time,T_front", "2026-07-{d},{hhmm},{T}", "%Y-%m-%d %H%M"),
        ("Datum;Uhrzeit;T_front", "{d}.07.2026;{hhmm};{T}", "%d.%m.%Y %H%M"),
        ("Year,DOY,HHMM,T_front", "2026,{doy},{hhmm},{T}", "%Y %j %H%M"),
    ],
)
def test_what_may_be_a_time_of_day_is_asked_with_an_answer_that_reads_it(
    tmp_path: Path, head: str, row: str, ask: str
) -> None:
    with pytest.raises(QuestionError) as asked:
        times(tmp_path, head, row)
    assert ask in asked.value.ask
    assert times(tmp_path, head, row, **asked.value.declare) == EVERY


def test_a_year_its_day_and_a_clock_without_a_header_are_asked_as_such_and_no_channels(tmp_path: Path) -> None:
    rows = [f"101,2026,71,{800 + k},{20 + k / 9:.2f},{20 + k / 7:.2f}" for k in range(59)]
    (tmp_path / "a.csv").write_text("\n".join([*rows, ""]))
    with pytest.raises(QuestionError) as asked:
        load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert asked.value.declare == {"time": {"column": [2, 3, 4], "format": "%Y %j %H%M"}}
    assert asked.value.times == ("column 2", "column 3", "column 4")
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC", table=asked.value.declare))
    assert data.t_ns["table"][0] == np.datetime64("2026-03-12T08:00", "ns").astype(np.int64)


def of_two_kinds(folder: Path) -> Path:
    """A logger's rows of two arrays: every fifth row of the one has one of the other behind it."""
    rows = []
    for k in range(200):
        clock = f"2026,71,{800 + 2 * k // 60},{2 * k % 60}"
        rows.append(f"110,{clock},{k},{2 * k}")
        rows += [f"120,{clock},13.2,21.5,21.5,21.1,21.5"] if k % 5 == 0 else []
    (folder / "a.dat").write_text("\n".join([*rows, ""]))
    return folder / "a.dat"


def test_a_year_its_day_a_clock_and_seconds_are_asked_as_such_in_rows_of_two_kinds(tmp_path: Path) -> None:
    path = of_two_kinds(tmp_path)
    with pytest.raises(QuestionError) as asked:
        load(Reader(), path, Source(timezone="UTC"))
    assert asked.value.declare == {"time": {"column": [2, 3, 4, 5], "format": "%Y %j %H%M %S"}}
    data = load(Reader(), path, Source(timezone="UTC", table=asked.value.declare))
    assert ((data.t_ns["table"] - data.t_ns["table"][0]) // 10**9).tolist() == list(range(0, 400, 2))


def test_rows_of_another_kind_take_no_time_where_rows_are_counted(tmp_path: Path) -> None:
    data = load(Reader(), of_two_kinds(tmp_path), Source(table={"time": {"period": 2.0}}))
    assert (data.t_ns["table"] // 10**9).tolist() == list(range(0, 400, 2))
    assert any("rows of 10 cells stand among those of 7" in note for note in data.recording.notes)


def test_a_damaged_row_takes_its_time_where_rows_are_counted(tmp_path: Path) -> None:
    rows = [f"{k};{20 + k / 9:.2f};21.5" if k != 30 else "30;21" for k in range(90)]
    (tmp_path / "a.csv").write_text("\n".join(["n;T1;T2", *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source(table={"time": {"period": 2.0}}))
    assert (data.t_ns["table"] // 10**9).tolist() == [2 * k for k in range(90) if k != 30]


def test_a_year_its_day_a_clock_and_seconds_are_known_by_their_names(tmp_path: Path) -> None:
    rows = [f"2026,71,{800 + k // 6},{10 * k % 60},{20 + k / 9:.2f}" for k in range(90)]
    (tmp_path / "a.csv").write_text("\n".join(["Year,DOY,HHMM,Sec,T_front", *rows, ""]))
    with pytest.raises(QuestionError) as asked:
        load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert asked.value.declare == {"time": {"column": [1, 2, 3, 4], "format": "%Y %j %H%M %S"}}


def test_a_day_of_the_year_with_its_part_is_asked_as_days(tmp_path: Path) -> None:
    rows = [f"{87.25 + k / 8640:.6f},{20 + k / 9:.2f}" for k in range(90)]
    (tmp_path / "a.csv").write_text("\n".join(["DOY,T_front", *rows, ""]))
    with pytest.raises(QuestionError) as asked:
        load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert "then time: {column: 1, unit: d}" in asked.value.ask


def test_minutes_from_a_start_beside_a_date_are_no_clock(tmp_path: Path) -> None:
    """They go on behind 59, where a clock has its next hour."""
    rows = [f"2026-07-14;{800 + k};{20 + k / 9:.2f}" for k in range(90)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time;T", *rows, ""]))
    with pytest.raises(QuestionError) as asked:
        load(Reader(), tmp_path / "a.csv", Source())
    assert asked.value.declare == {"time": {"unit": "unknown"}}


def test_seconds_from_a_start_beside_a_date_are_no_fraction_of_it(tmp_path: Path) -> None:
    rows = [f"2026-07-14;{k / 4};{k}.5" for k in range(40)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time [s];T", *rows, ""]))
    assert load(Reader(), tmp_path / "a.csv", Source()).recording.clock == "relative"


def test_a_column_behind_a_date_that_is_called_otherwise_is_a_signal(tmp_path: Path) -> None:
    rows = [f"2026-07-14 08:{k:02d}:00;{k % 24};{k}.5" for k in range(40)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Hour;T", *rows, ""]))
    assert [name for _, name in load(Reader(), tmp_path / "a.csv", Source()).values] == ["Hour", "T"]


@pytest.mark.parametrize(
    ("head", "each", "step_ns"),
    [
        ("1/10s", 1, 10**8),
        ("Zehntel", 1, 10**8),
        ("1/100 s", 10, 10**7),
        ("hundredths", 5, 10**7),
        ("1/1000s", 5, 10**6),
    ],
)
def test_parts_of_a_second_in_a_column_behind_whole_ones_are_read(
    tmp_path: Path, head: str, each: int, step_ns: int
) -> None:
    rows = [f"12.03.2026;08:00:{k // 5:02d};{k % 5 * each};{20 + k / 9:.2f}" for k in range(50)]
    (tmp_path / "a.csv").write_text("\n".join([f"Date;Time;{head};T", *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    expected = [(k // 5) * 10**9 + k % 5 * each * step_ns for k in range(50)]
    assert (data.t_ns["table"] - data.t_ns["table"][0]).tolist() == expected
    assert [name for _, name in data.values] == ["T"]


def test_parts_beyond_those_of_a_second_are_a_signal(tmp_path: Path) -> None:
    rows = [f"12.03.2026;08:00:{k:02d};{k};{20 + k / 9:.2f}" for k in range(50)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time;1/10s;T", *rows, ""]))
    assert len(load(Reader(), tmp_path / "a.csv", Source(timezone="UTC")).values) == 2


def test_a_temperature_behind_the_clock_is_no_second_where_arrays_share_their_times(tmp_path: Path) -> None:
    """As a CR10X writes several: each with its number, in rows of its own length."""
    rows = []
    for k in range(60):
        rows.append(f"101,2026,60,{800 + k},{21 + k / 10:.2f},12.6,3.5")
        rows += [f"102,2026,60,{800 + k},{30 + k / 10:.2f}"] if k % 5 == 0 else []
    (tmp_path / "a.dat").write_text("\n".join([*rows, ""]))
    with pytest.raises(QuestionError) as asked:
        load(Reader(), tmp_path / "a.dat", Source(timezone="UTC"))
    assert asked.value.declare == {"time": {"column": [2, 3, 4], "format": "%Y %j %H%M"}}
    data = load(Reader(), tmp_path / "a.dat", Source(timezone="UTC", table=asked.value.declare))
    assert data.values["table", "column 5"].tolist() == [round(21 + k / 10, 2) for k in range(60)]
    assert [loss.where for loss in data.losses][:1] == ["a.dat line 2"]
