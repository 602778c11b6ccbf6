"""Dates with names of months and weekdays, in the languages of labs, and in a column beside a time of day."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.reader.text.cells.time_forms.calendar_words import is_worded_date
from thermodata.reader.text.cells.time_forms.time_pattern import declared_format
from thermodata.reader.text.times.one_cell.odd_stamps import guess_format
from thermodata.reader.text.times.one_cell.timestamp import parse_one
from thermodata.testing.reader import load

NS = 1_000_000_000


def at(text: str) -> int:
    return int(np.datetime64(text, "ns").astype(np.int64))


@pytest.mark.parametrize(
    ("cell", "form", "moment"),
    [
        ("04-Mai-2026 16:00:00", "%d-%b-%Y %H:%M:%S", "2026-05-04T16:00"),
        ("04-kvě-2026 16:00:00", "%d-%b-%Y %H:%M:%S", "2026-05-04T16:00"),
        ("04-mag-2026 16:00:00", "%d-%b-%Y %H:%M:%S", "2026-05-04T16:00"),
        ("04-March-2026 16:00:00", "%d-%B-%Y %H:%M:%S", "2026-03-04T16:00"),
        ("04. Jan. 2026 16:00:00", "%d. %b. %Y %H:%M:%S", "2026-01-04T16:00"),
        ("Mo, 4. Mai 2026 16:00:00", "%a, %d. %b %Y %H:%M:%S", "2026-05-04T16:00"),
        ("mar 3 mars 2026 16:00:00", "%a %d %b %Y %H:%M:%S", "2026-03-03T16:00"),
        ("May 4, 2026 8:00:00 PM", "%b %d, %Y %I:%M:%S %p", "2026-05-04T20:00"),
        ("Mon May 04 23:00:00 2026", "%a %b %d %H:%M:%S %Y", "2026-05-04T23:00"),
    ],
)
def test_a_stamp_with_words_is_guessed_and_read_by_its_format(cell: str, form: str, moment: str) -> None:
    assert guess_format([cell]) == form
    assert parse_one(cell, declared_format(form)) == at(moment)


def test_an_abbreviation_may_have_its_dot_or_be_a_whole_word() -> None:
    form = declared_format("%d. %b. %Y")
    assert parse_one("04. Mai 2026", form) == at("2026-05-04")
    assert parse_one("4. Januar 2026", form) == at("2026-01-04")


@pytest.mark.parametrize("cell", ["4. Mai 2026", "4 May 26", "2026 Mai 4", "Mo, 4 de maio de 2026", "04-Mai-2026"])
def test_a_date_with_a_months_name_is_one(cell: str) -> None:
    assert is_worded_date(cell)


@pytest.mark.parametrize("cell", ["Mai", "Mai 2026", "Prog 4 Mai 2026", "O1234", "4 2026", "Mar 3", "T1 Mai 12"])
def test_words_and_numbers_without_a_whole_date_are_none(cell: str) -> None:
    assert not is_worded_date(cell)


def log(tmp_path: Path, days: tuple[str, str], name: str = "Datum") -> Path:
    rows = [f"{day};{8 + k // 60:02d}:{k % 60:02d}:00;2{k % 10},5;0,{k:02d}" for day in days for k in range(60)]
    (tmp_path / "a.csv").write_text("\n".join([f"{name};Uhrzeit;T_vorn [°C];dZ [um]", *rows, ""]), encoding="utf-8")
    return tmp_path / "a.csv"


@pytest.mark.parametrize(
    ("days", "form"),
    [
        (("4. Mai 2026", "6. Mai 2026"), "%d. %b %Y %H:%M:%S"),
        (("04-Mai-2026", "06-Mai-2026"), "%d-%b-%Y %H:%M:%S"),
        (("4 May 2026", "6 May 2026"), "%d %b %Y %H:%M:%S"),
        (("Mo 04.05.2026", "Mi 06.05.2026"), "%a %d.%m.%Y %H:%M:%S"),
        (("124/2026", "126/2026"), "%j/%Y %H:%M:%S"),
    ],
)
def test_a_day_in_words_beside_a_time_of_day_is_asked_and_read_as_declared(
    tmp_path: Path, days: tuple[str, str], form: str
) -> None:
    path = log(tmp_path, days)
    with pytest.raises(QuestionError, match="times that are written in no way") as asked:
        Reader().describe(path, Source())
    said = asked.value.declare
    assert said["time"] == {"column": [1, 2], "format": "unknown" if "%j" in form else form}
    data = load(Reader(), path, Source(timezone="UTC", table={"time": {"column": [1, 2], "format": form}}))
    times = data.t_ns["table"]
    assert int(times[0]) == at("2026-05-04T08:00")
    assert int(times[60] - times[59]) == (47 * 3600 + 60) * NS


@pytest.mark.parametrize(("days", "name"), [(("KW19-1", "KW19-3"), "Datum"), (("124/2026", "126/2026"), "Tag")])
def test_a_day_that_nobody_can_read_is_asked_too(tmp_path: Path, days: tuple[str, str], name: str) -> None:
    path = log(tmp_path, days, name)
    with pytest.raises(QuestionError, match="times that are written in no way"):
        Reader().describe(path, Source())


def test_a_column_that_is_no_day_is_left_out_by_declaring_the_time_alone(tmp_path: Path) -> None:
    path = log(tmp_path, ("Los 7", "Los 7"))
    with pytest.raises(QuestionError, match="times that are written in no way") as asked:
        Reader().describe(path, Source())
    assert "{column: 2} alone where 'Datum' is no day" in str(asked.value.hint)
    assert load(Reader(), path, Source(table={"time": {"column": 2}})).t_ns["table"].size == 120


@pytest.mark.parametrize(("days", "name"), [(("P1", "P1"), "Programm"), (("on", "on"), "Datum")])
def test_words_beside_a_time_of_day_that_are_no_days_are_not_asked(
    tmp_path: Path, days: tuple[str, str], name: str
) -> None:
    assert Reader().describe(log(tmp_path, days, name), Source()).signals


def test_a_months_name_in_one_column_is_asked_with_a_format_that_works(tmp_path: Path) -> None:
    rows = [f"04-Mai-2026 08:{k:02d}:00,2{k}.5" for k in range(10, 40)]
    (tmp_path / "m.csv").write_text("\n".join(["Time,T_vorn", *rows, ""]), encoding="utf-8")
    with pytest.raises(QuestionError) as asked:
        Reader().describe(tmp_path / "m.csv", Source())
    data = load(Reader(), tmp_path / "m.csv", Source(timezone="UTC", table=asked.value.declare))
    assert int(data.t_ns["table"][0]) == at("2026-05-04T08:10")
