"""Days and starts of a sheet's rows: a date in the first row only, a start above the table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_sheets import sheet, workbook

DAY, HOUR = 46083.0, 21 / 24  # 2026-03-02 21:00, as a sheet counts
DATE, CLOCK, PLAIN = 4, 3, 0  # formats of cells
T0 = int(np.datetime64("2026-03-02T21:00", "ns").astype(np.int64))
MINUTE = 60 * 10**9


def read(folder: Path, rows: list[list[Any]], styles: tuple[int, ...] = (), **table: Any) -> Data:
    path = workbook(folder / "a.xlsx", {"data": sheet(rows, styles)})
    return load(Reader(), path, Source(timezone="UTC", table=table or None))


@pytest.mark.parametrize("again", [[], [36]])
@pytest.mark.parametrize("texts", [False, True])
def test_a_date_in_the_first_row_is_that_of_the_rows_behind_it(tmp_path: Path, again: list[int], texts: bool) -> None:
    rows: list[list[Any]] = [["Datum", "Zeit", "T1 [degC]"]]
    for i in range(400):
        days, clock = divmod(21 * 60 + 5 * i, 1440)
        day = (f"{2 + days:02d}.03.2026" if texts else DAY + days) if i in (0, *again) else None
        rows.append([day, clock / 1440, 20.5 + i % 7])
    data = read(tmp_path, rows, (DATE, CLOCK, PLAIN))
    assert data.t_ns["table"].tolist() == [T0 + 5 * i * MINUTE for i in range(400)]
    assert not data.losses


@pytest.mark.parametrize("again", [20, 250])
def test_a_header_that_stands_again_is_no_date_of_its_rows(tmp_path: Path, again: int) -> None:
    head = ["Datum", "Zeit", "T1 [degC]"]
    rows: list[list[Any]] = [[None, (21 * 3600 + 20 * i) / 86400, 20.5 + i % 7] for i in range(2 * again)]
    rows[0][0], rows[again][0] = DAY, DAY + 1
    data = read(tmp_path, [head, *rows[:again], head, *rows[again:]], (DATE, CLOCK, PLAIN))
    assert data.t_ns["table"].tolist() == [T0 + (i // again * 1440 * 3 + i) * MINUTE // 3 for i in range(2 * again)]
    assert not data.losses


@pytest.mark.parametrize("start", ["2026-03-02 21:00:00", "02.03.2026 21:00"])
def test_rows_count_from_the_start_above_them(tmp_path: Path, start: str) -> None:
    numbers = [[60.0 * i, 20.5 + i % 7, 1.0 * i] for i in range(40)]
    data = read(tmp_path, [["Start time", start], [], ["Time [s]", "T1 [degC]", "T2 [degC]"], *numbers])
    assert data.recording.clock == "absolute"
    assert data.t_ns["table"].tolist() == [T0 + i * MINUTE for i in range(40)]


def test_a_start_that_may_be_of_two_days_is_asked(tmp_path: Path) -> None:
    numbers = [[60.0 * i, 20.5 + i % 7, 1.0 * i] for i in range(40)]
    rows: list[list[Any]] = [
        ["Start time", "02/03/2026 21:00:00"],
        [],
        ["Time [s]", "T1 [degC]", "T2 [degC]"],
        *numbers,
    ]
    found = read(tmp_path, rows).recording
    assert found.clock == "relative"
    assert any("whose day and month may be either way round" in n for n in found.notes)
    assert read(tmp_path, rows, time={"start": "dmy"}).t_ns["table"][0] == T0
    assert read(tmp_path, rows, time={"start": "none"}).recording.clock == "relative"


@pytest.mark.parametrize("styles", [(PLAIN,), (DATE, PLAIN, PLAIN)])
def test_a_half_of_the_day_in_a_cell_of_its_own_is_part_of_the_time(tmp_path: Path, styles: tuple[int, ...]) -> None:
    day: Any = "2026-03-02" if len(styles) == 1 else DAY
    rows: list[list[Any]] = [["Date", "Time", "AM/PM", "T1 [degC]"]]
    rows += [[day, f"9:{i:02d}:00", "PM" if i != 7 else None, 20.5 + i] for i in range(40)]
    data = read(tmp_path, rows, styles)
    assert data.t_ns["table"].tolist() == [T0 + i * MINUTE for i in range(40) if i != 7]
    assert list(data.values) == [("table", "T1 [degC]")]
    assert [loss.reason for loss in data.losses] == ["1 row without a time"]


@pytest.mark.parametrize(("units", "rows"), [(["", "degC", "mm"], 60), (["", "degC", "um"], 30)])
def test_other_units_below_a_repeated_header_end_the_sheet(tmp_path: Path, units: list[str], rows: int) -> None:
    head: list[list[Any]] = [["Time", "T1", "dZ"], ["", "degC", "mm"]]
    parts = [[[f"2026-03-02 {h}:{i:02d}:00", 20.5 + i, 0.1 * i] for i in range(30)] for h in (21, 22)]
    data = read(tmp_path, [*head, *parts[0], head[0], units, *parts[1]])
    assert data.t_ns["table"].size == rows
    told = [loss.reason for loss in data.losses if "other units begin here" in loss.reason]
    assert [("'dZ' in um, in mm before" in t) for t in told] == [True] * (rows == 30)


def test_hours_and_minutes_beside_a_date_are_its_time_of_day(tmp_path: Path) -> None:
    rows: list[list[Any]] = [["Date", "Hour", "Minute", "T1 [degC]"]]
    rows += [[DAY, 21 + i // 60, i % 60, 20.5 + i] for i in range(90)]
    data = read(tmp_path, rows, (DATE, PLAIN, PLAIN, PLAIN))
    assert data.t_ns["table"].tolist() == [T0 + i * MINUTE for i in range(90)]
