"""Sheets of a workbook that count time in different ways: what is asked, what is left out, and what is said of it."""

from __future__ import annotations

import datetime as dt
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source

from .test_sheets import read, seconds, sheet


def test_sheets_of_dates_and_of_seconds_are_asked(tmp_path: Path) -> None:
    dates: list[list[object]] = [["time", "T"], *([46082 + i / 1440, i] for i in range(4))]
    with pytest.raises(FormatError, match="some times are dates"):
        read(tmp_path, {"a": sheet(dates, (1,)), "b": sheet(seconds(4))})


def test_days_that_are_declared_are_read_whether_cells_show_them_as_dates_or_as_numbers(tmp_path: Path) -> None:
    days: list[list[object]] = [["Zeitstempel", "T"], *([46082 + i / 1440, i] for i in range(4))]
    book = {"shown": sheet(days, (1,)), "general": sheet(days)}
    with pytest.raises(QuestionError) as question:
        read(tmp_path, book)
    assert question.value.ask.startswith("sheet 'general': unit of the time: excel")
    data = read(tmp_path, book, Source(timezone="UTC", table={"time": {"unit": "excel"}}))
    expected = np.datetime64("2026-03-01T00:00", "ns").astype(np.int64) + np.arange(4) * 60 * 10**9
    for stream in ("shown", "general"):
        assert np.abs(data.t_ns[stream] - expected).max() < 1000
    assert not data.losses


def test_a_list_of_tests_with_days_beside_sheets_of_seconds_is_left_out_and_said(tmp_path: Path) -> None:
    days: list[list[object]] = [["test", "date"], *([f"V{i}", 46082 + i] for i in range(4))]
    data = read(tmp_path, {"list": sheet(days, (0, 1)), **{f"V{i}": sheet(seconds(4)) for i in range(3)}})
    assert list(data.t_ns) == ["V0", "V1", "V2"]
    assert any(n.startswith("sheet 'list' is not read: its times are of another kind") for n in data.recording.notes)


def _pivot(n: int) -> list[list[object]]:
    return [["Test", "Time", "Z"], *([None, hour, -6.25 - hour] for hour in range(n))]


def _with_serials(n: int, unit: str = "Date") -> list[list[object]]:
    return [[unit, "T1"], *([46_145.25 + i / 8640, 20.5 + i / 10] for i in range(n))]


def test_a_summary_beside_a_sheet_of_dates_asks_nothing_of_the_time(tmp_path: Path) -> None:
    data = read(tmp_path, {"Pivot": sheet(_pivot(12)), "run": sheet(_with_serials(40))})
    assert data.recording.clock == "absolute"
    assert list(data.values) == [("table", "T1")]
    assert any(n.startswith("sheet 'Pivot' is not read as a table: the time 'Time'") for n in data.recording.notes)


def test_a_sheet_of_many_rows_whose_time_has_no_unit_is_asked(tmp_path: Path) -> None:
    with pytest.raises(QuestionError, match="the time 'Time' has no unit"):
        read(tmp_path, {"run": sheet(_pivot(40)), "days": sheet(_with_serials(60))})


def test_a_declared_unit_that_takes_dates_for_a_span_is_told(tmp_path: Path) -> None:
    source = Source(timezone="UTC", table={"time": {"unit": "h"}})
    data = read(tmp_path, {"run": sheet(_with_serials(40))}, source)
    assert any("is read in h, as declared; by itself it counts excel, from 2026-" in n for n in data.recording.notes)


CLOCKS = [(form, f"%Y-%m-%d {form}") for form in ("%H-%M-%S", "%H.%M.%S")] + [("%Hh%Mm%S", "unknown")]


@pytest.mark.parametrize(("clock", "form"), CLOCKS)
def test_dates_beside_times_of_day_that_are_not_read_are_asked(tmp_path: Path, clock: str, form: str) -> None:
    first = dt.datetime(2026, 7, 6, 8)
    rows: list[list[object]] = [[46_209, f"{first + k * dt.timedelta(seconds=10):{clock}}", k] for k in range(40)]
    book = {"a": sheet([["Data", "Ora", "T1"], *rows], (4, 0, 0)), "sum": sheet([["Test", "max", "n"], ["a", 1, 2]])}
    with pytest.raises(QuestionError) as caught:
        read(tmp_path, book)
    assert caught.value.declare == {"time": {"column": [1, 2], "format": form}}
    time = {"column": [1, 2], "format": f"%Y-%m-%d {clock}"}
    data = read(tmp_path, book, Source(timezone="UTC", table={"time": time}))
    (t_ns,) = data.t_ns.values()
    assert (t_ns - t_ns[0]).tolist() == [k * 10**10 for k in range(40)]
    assert data.recording.start_ns == int(np.datetime64("2026-07-06T08:00", "ns").astype(np.int64))
    assert any(note.startswith("sheet 'sum' is not read as a table") for note in data.recording.notes)
