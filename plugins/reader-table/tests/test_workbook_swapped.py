"""Dates of a workbook whose day and month a spreadsheet exchanged."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_sheets import sheet, workbook

DATE = (1, 0)
HOURS = [dt.datetime(2026, 3, 1, 8) + dt.timedelta(hours=k) for k in range(200)]
LATER = [t + dt.timedelta(days=9) for t in HOURS]  # to the 18th
SESSIONS = [dt.datetime(2026, 3, 2 + d, 8) + dt.timedelta(minutes=k) for d in range(5) for k in range(60)]


def _serial(t: dt.datetime) -> float:
    return (t - dt.datetime(1899, 12, 30)) / dt.timedelta(days=1)


def _opened_as(t: dt.datetime) -> Any:
    """What a spreadsheet that puts the day first makes of a text that puts the month first."""
    return _serial(t.replace(month=t.day, day=t.month)) if t.day <= 12 else f"{t.month}/{t.day}/{t:%Y %H:%M:%S}"


def _read(folder: Path, cells: Iterable[Any], form: str | None = None) -> Data:
    rows = [["Zeit", "T_bed [degC]"], *([c, 20.5 + k % 7] for k, c in enumerate(cells))]
    path = workbook(folder / "a.xlsx", {"data": sheet(rows, DATE)})
    return load(Reader(), path, Source(timezone="UTC", table={"time": {"format": form}} if form else None))


def _are(data: Data, times: list[dt.datetime]) -> None:
    wanted = np.array([t.isoformat() for t in times], "datetime64[ns]").view(np.int64)
    assert np.abs(data.t_ns["table"] - wanted).max() < 10**6
    assert not data.losses


@pytest.mark.parametrize("times", [HOURS, SESSIONS])
def test_dates_that_go_on_only_with_day_and_month_exchanged_are_asked(tmp_path: Path, times: list[dt.datetime]) -> None:
    cells = [_opened_as(t) for t in times]
    with pytest.raises(QuestionError) as asked:
        _read(tmp_path, cells)
    assert "swapped or shown" in asked.value.ask
    _are(_read(tmp_path, cells, "swapped"), times)
    assert _read(tmp_path, cells, "shown").t_ns["table"][-1] != _read(tmp_path, cells, "swapped").t_ns["table"][-1]
    with pytest.raises(FormatError, match="not answered"):
        _read(tmp_path, cells, "unknown")
    turned = _read(tmp_path, cells, "mdy")
    _are(turned, times)
    assert any("turned" in n for n in turned.recording.notes)


def test_texts_beside_dates_tell_which_way_round_these_were_read(tmp_path: Path) -> None:
    cells = [_opened_as(t) for t in LATER]
    with pytest.raises(QuestionError) as asked:
        _read(tmp_path, cells)
    assert "swapped or mdy? 64 cells are dates, 136 are text such as '3/13/2026 00:00:00'" in asked.value.ask
    _are(_read(tmp_path, cells, "mdy"), LATER)
    _are(_read(tmp_path, cells, "%m/%d/%Y %H:%M:%S"), LATER)
    _are(_read(tmp_path, cells, "swapped"), LATER)
    alike = [_serial(t) if k % 2 else f"{t:%m/%d/%Y %H:%M:%S}" for k, t in enumerate(LATER)]
    with pytest.raises(FormatError, match="not exchanged"):
        _read(tmp_path, alike, "swapped")


DAY = [dt.datetime(2026, 4, 8, 8) + dt.timedelta(minutes=k) for k in range(60)]


@pytest.mark.parametrize("form", ["mdy", "dmy", "%m/%d/%Y %H:%M:%S"])
def test_an_order_declared_for_texts_asks_of_dates_alone(tmp_path: Path, form: str) -> None:
    cells = [_opened_as(t) for t in DAY]
    turned = _read(tmp_path, cells, form)
    assert any("2026-08-04 or 2026-04-08? declare table" in n for n in turned.recording.notes)
    _are(_read(tmp_path, cells, "swapped"), DAY)
    assert not any("declare" in n for n in _read(tmp_path, cells, "shown").recording.notes)


MONTHLY = [dt.datetime(2026, m, 3) for m in range(1, 13)]
PAUSES = [dt.datetime(2026, m, d, 8) + dt.timedelta(hours=k) for m, d in ((1, 3), (2, 5), (4, 7)) for k in range(10)]


@pytest.mark.parametrize("times", [HOURS, LATER, SESSIONS, MONTHLY, PAUSES, HOURS[::-1]])
def test_sound_dates_are_taken_as_they_stand(tmp_path: Path, times: list[dt.datetime]) -> None:
    _are(_read(tmp_path, map(_serial, times)), times)


def test_texts_in_the_order_of_dates_beside_them_are_no_exchange(tmp_path: Path) -> None:
    cells = [_serial(t) if k % 2 else f"{t:%Y-%m-%d %H:%M:%S}" for k, t in enumerate(LATER)]
    _are(_read(tmp_path, cells), LATER)
