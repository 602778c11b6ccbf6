"""Dates that stand in some rows only, and dates that stay while midnight passes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files
from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import delimited

START = int(np.datetime64("2026-03-02T21:00", "ns").astype(np.int64))
MINUTE = 60 * 10**9


def read(
    folder: Path, days: list[str], clocks: list[str], **options: int
) -> tuple[list[int], list[Loss], tuple[str, ...]]:
    """(minutes since the start, losses, notes)"""
    rows = [
        "Date;Time;T1 [degC];n",
        *(f"{d};{c};2{i % 9}.5;{i}" for i, (d, c) in enumerate(zip(days, clocks, strict=True))),
    ]
    path = folder / "a.csv"
    path.write_text("\n".join([*rows, ""]))
    source = Source(options=options)
    table = delimited.open_table(path, source)
    parts = list(delimited.blocks(path, table, source))
    times = [(int(t) - START) / MINUTE for b in parts if isinstance(b, Block) for t in b.t_ns]
    return times, [p for p in parts if isinstance(p, Loss)], delimited.describe(table, source).notes


def clocks(minutes: list[int]) -> list[str]:
    return [f"{(21 + m // 60) % 24:02d}:{m % 60:02d}:00" for m in minutes]


def days(minutes: list[int], shift: int = 0) -> list[str]:
    return [f"{2 + (21 * 60 + m + shift) // 1440:02d}.03.2026" for m in minutes]


EVERY = list(range(0, 3000, 5))  # two midnights


@pytest.mark.parametrize("again", [[], [36], [36, 324], [100, 400]])
def test_a_date_in_the_first_row_is_that_of_the_rows_behind_it(tmp_path: Path, again: list[int]) -> None:
    """again: rows that have a date too, of midnights and others"""
    dates = [d if i in (0, *again) else "" for i, d in enumerate(days(EVERY))]
    found, losses, notes = read(tmp_path, dates, clocks(EVERY))
    assert found == EVERY
    assert not losses
    assert any("the date stands in some rows only" in n for n in notes)


def test_a_log_that_goes_on_next_morning_without_a_date_is_of_the_next_day(tmp_path: Path) -> None:
    minutes = [m - 300 for m in (*range(0, 110, 10), *range(960, 1200, 10), *range(2400, 2500, 10))]  # from 16:00
    found, losses, _ = read(tmp_path, ["02.03.2026", *[""] * (len(minutes) - 1)], clocks(minutes))
    assert (found, losses) == (minutes, [])


def test_a_clock_that_is_set_back_in_autumn_is_of_the_same_day(tmp_path: Path) -> None:
    minutes = [*range(300, 360, 5), *range(300, 600, 5)]  # 02:00 to 02:55, and again
    assert read(tmp_path, ["03.03.2026", *[""] * 71], clocks(minutes))[0] == minutes


def test_a_date_that_does_not_change_at_midnight_is_that_of_the_start(tmp_path: Path) -> None:
    found, losses, notes = read(tmp_path, days([0] * len(EVERY)), clocks(EVERY))
    assert (found, losses) == (EVERY, [])
    assert any("does not change at midnight" in n for n in notes)
    assert not any("midnight" in n for n in read(tmp_path, days(EVERY), clocks(EVERY))[2])


def test_a_date_that_changes_late_is_put_right(tmp_path: Path) -> None:
    assert read(tmp_path, days(EVERY, -15), clocks(EVERY))[0] == EVERY


def test_a_date_that_changes_early_moves_no_day_behind_it(tmp_path: Path) -> None:
    found = read(tmp_path, days(EVERY, 5), clocks(EVERY))[0]
    assert [a - b for a, b in zip(found, EVERY, strict=True) if a != b] == [1440, 1440]


@pytest.mark.parametrize("begin", [2820, 1980])
def test_a_date_of_a_session_is_that_of_its_start(tmp_path: Path, begin: int) -> None:
    """begin: at 20:00 two days after a session from 06:00 to 08:30, or at 06:00"""
    first, second = list(range(-900, -740, 10)), list(range(begin, begin + 1200, 10))
    dates = [days([0])[0]] * len(first) + [days([begin])[0]] * len(second)
    assert read(tmp_path, dates, clocks([*first, *second]))[0] == [*first, *second]


def test_a_clock_that_was_set_back_passes_no_midnight(tmp_path: Path) -> None:
    minutes = [*range(0, 100), *range(-1200, -1100)]  # 22:39 to 01:00 of the same day
    assert read(tmp_path, days([0] * 200), clocks(minutes))[0] == minutes


def test_rows_with_dates_of_their_own_are_as_they_say_over_a_pause(tmp_path: Path) -> None:
    minutes = [*range(0, 60), *range(1440 + 60, 1440 + 300)]
    assert read(tmp_path, days(minutes), clocks(minutes))[0] == minutes


def test_a_row_whose_date_is_torn_is_lost_alone(tmp_path: Path) -> None:
    dates = days(EVERY)
    dates[50], dates[60] = "02.0", ""
    found, losses, _ = read(tmp_path, dates, clocks(EVERY))
    assert found == [m for i, m in enumerate(EVERY) if i not in (50, 60)]
    assert len(losses) == 2


HEAD = '"DATUM:";"UHRZEIT:";"M00: °C"'


@pytest.mark.parametrize("first", [30, 450, 2300], ids=["among the first rows", "behind them", "behind the sample"])
@pytest.mark.parametrize("again", [HEAD, HEAD.replace("°C", "degC")])
def test_a_header_that_stands_again_is_no_date_of_its_rows(tmp_path: Path, first: int, again: str) -> None:
    """first: rows from 08:00 of one day, before the logger is started anew at 09:00 of the next; a date in the first
    row of each"""

    def rows(day: str, hour: int, count: int) -> list[str]:
        clock = [f"{hour + k // 360:02d}:{k // 6 % 60:02d}:{k % 6 * 10:02d}" for k in range(count)]
        return [f'"{"" if k else day}";"{c}";{20 + k % 300 / 100:.2f}' for k, c in enumerate(clock)]

    path = tmp_path / "almemo.txt"
    path.write_text("\n".join([HEAD, *rows("21.04.26", 8, first), again, *rows("22.04.26", 9, 60), ""]), "utf-8")
    source = Source(timezone="UTC")
    table = delimited.open_table(path, source)
    parts = list(delimited.blocks(path, table, source))
    found = np.concatenate([b.t_ns for b in parts if isinstance(b, Block)])
    starts = np.array(["2026-04-21T08:00", "2026-04-22T09:00"], "datetime64[ns]").astype(np.int64)
    wanted = [start + 10 * 10**9 * np.arange(n) for start, n in zip(starts, (first, 60), strict=True)]
    assert not [p for p in parts if isinstance(p, Loss)]
    np.testing.assert_array_equal(found, np.concatenate(wanted))


@pytest.mark.parametrize(("name", "year"), [("log_2026-03-12.csv", "2026"), ("log.csv", "YYYY")])
@pytest.mark.parametrize("day", ["12.03.", "12/03", "12.3."])
def test_days_without_a_year_are_told_and_the_year_is_asked(tmp_path: Path, name: str, year: str, day: str) -> None:
    rows = [f"{day};08:{k:02d}:00;{20 + k / 9:.2f}" for k in range(50)]
    (tmp_path / name).write_text("\n".join(["Datum;Uhrzeit;T_Lager [°C]", *rows, ""]), "utf-8")
    draft_files(tmp_path)
    drafted = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert f"'Datum' says days without a year, '{day}'" in drafted
    assert f"its start: {year}-MM-DD 08:00:00" in drafted
    table = delimited.open_table(tmp_path / name, Source())
    notes = delimited.describe(table, Source()).notes
    assert not any("without a date" in note for note in notes)


@pytest.mark.parametrize(
    ("names", "first"),
    [
        ("Uhrzeit;Zeit [h];T_Lager [°C]", 0),
        ("Uhrzeit;Zeit [h];T_Lager [°C]", 11),
        ("Uhrzeit;Zeit;T_Lager\n;h;°C", 11),
        ("Uhrzeit;Zeit;T_Lager [°C]", 0),
        ("Uhrzeit;Zeit;T_Lager [°C]", 129),
    ],
)
def test_hours_that_count_beside_times_of_day_are_no_days(tmp_path: Path, names: str, first: int) -> None:
    rows = [f"08:{k:02d}:00;{(first + k) / 10:.1f};{20 + k / 9:.2f}" for k in range(8)]
    (tmp_path / "log.csv").write_text("\n".join([names, *rows, ""]), "utf-8")
    notes = delimited.describe(delimited.open_table(tmp_path / "log.csv", Source()), Source()).notes
    assert any("without a date" in note for note in notes)
    assert not any("which year" in note for note in notes)


def test_times_of_day_beside_other_numbers_are_without_a_date(tmp_path: Path) -> None:
    rows = [f"12.{k % 10};08:{k:02d}:00;{20 + k / 9:.2f}" for k in range(50)]
    (tmp_path / "log.csv").write_text("\n".join(["Druck;Uhrzeit;T_Lager [°C]", *rows, ""]), "utf-8")
    table = delimited.open_table(tmp_path / "log.csv", Source())
    assert any("without a date" in note for note in delimited.describe(table, Source()).notes)
