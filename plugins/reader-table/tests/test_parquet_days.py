"""Parquet whose days and times of day stand in columns of their own."""

from __future__ import annotations

import datetime as dt
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader import load

_ROWS = 30
_MOMENTS = [dt.datetime(2026, 3, 2, 23, 58) + dt.timedelta(seconds=10 * k) for k in range(_ROWS)]
_NS = [int(np.datetime64(m, "ns").astype(np.int64)) for m in _MOMENTS]
_DAYS = [m.date() for m in _MOMENTS]
_CLOCKS = [m.time() for m in _MOMENTS]
_MIDNIGHTS = [dt.datetime(d.year, d.month, d.day) for d in _DAYS]


def _written(folder: Path, **columns: Any) -> Path:
    pq.write_table(pa.table({**columns, "T": np.arange(float(_ROWS))}), folder / "x.parquet")
    return folder / "x.parquet"


@pytest.mark.parametrize(
    "columns",
    [
        {"Date": pa.array(_DAYS, pa.date32()), "Time": pa.array(_CLOCKS, pa.time64("us"))},
        {"Time": pa.array(_CLOCKS, pa.time32("ms")), "Date": pa.array(_DAYS, pa.date64())},
        {"day": pa.array(_MIDNIGHTS, pa.timestamp("us")), "clock": pa.array(_CLOCKS, pa.time64("ns"))},
        {"Date": [f"{d:%d.%m.%Y}" for d in _DAYS], "Time": [str(c) for c in _CLOCKS]},
        {"Date": pa.array(_DAYS, pa.date32()), "Time": [str(c) for c in _CLOCKS]},
    ],
    ids=["date32 and time64", "time32 before date64", "midnights", "texts", "date and text"],
)
def test_days_and_times_of_day_are_one_time(tmp_path: Path, columns: dict[str, Any]) -> None:
    path = _written(tmp_path, **columns)
    found = load(Reader(), path, Source())
    assert [s.name for s in found.recording.signals] == ["T"]
    assert found.recording.clock == "absolute"
    assert found.t_ns["table"].tolist() == _NS


def test_a_declared_day_and_time_of_day_are_joined(tmp_path: Path) -> None:
    columns = {"a": [f"{d:%m/%d/%Y}" for d in _DAYS], "b": [f"{c:%H-%M-%S}" for c in _CLOCKS]}
    path = _written(tmp_path, **columns)
    table = {"time": {"column": ["a", "b"], "format": "%m/%d/%Y %H-%M-%S"}}
    assert load(Reader(), path, Source(table=table)).t_ns["table"].tolist() == _NS


def test_days_beside_what_is_not_read_are_asked(tmp_path: Path) -> None:
    path = _written(tmp_path, Date=pa.array(_DAYS, pa.date32()), Time=[f"{c:%H-%M-%S}" for c in _CLOCKS])
    with pytest.raises(QuestionError, match="written in no way that is read") as asked:
        Reader().describe(path, Source())
    table = {"time": {"column": [1, 2], "format": "%Y-%m-%d %H-%M-%S"}}
    assert asked.value.declare == table
    assert load(Reader(), path, Source(table=table)).t_ns["table"].tolist() == _NS


@pytest.mark.parametrize("at", [20, 200])
@pytest.mark.parametrize("words", [True, False])
def test_a_header_among_the_rows_is_no_date_of_them(tmp_path: Path, at: int, words: bool) -> None:
    """A text that goes on under its header, written as Parquet; words: whether its numbers stayed texts, too."""
    moments = [dt.datetime(2026, 3, 2, 8) + dt.timedelta(days=k >= at, seconds=10 * k) for k in range(400)]
    dated = [f"{m:%d.%m.%Y}" if k in (0, at) else "" for k, m in enumerate(moments)]
    clocks, values = [f"{m:%H:%M:%S}" for m in moments], [f"{k}.5" for k in range(400)]
    dated[at:at], clocks[at:at], values[at:at] = ["Datum"], ["Uhrzeit"], ["T"]
    column = values if words else [None if v == "T" else float(v) for v in values]
    pq.write_table(pa.table({"Datum": dated, "Uhrzeit": clocks, "T": column}), tmp_path / "x.parquet")
    found = load(Reader(), tmp_path / "x.parquet", Source(timezone="UTC"))
    assert found.t_ns["table"].tolist() == [int(np.datetime64(m, "ns").astype(np.int64)) for m in moments]
    assert [loss.reason for loss in found.losses] == ["1 row without a time"]


def test_times_of_day_alone_count_over_midnight(tmp_path: Path) -> None:
    found = load(Reader(), _written(tmp_path, Time=pa.array(_CLOCKS, pa.time64("us"))), Source())
    assert found.recording.clock == "relative"
    assert np.diff(found.t_ns["table"]).tolist() == [10_000_000_000] * (_ROWS - 1)


def test_stamps_that_tell_the_hour_take_no_other_column(tmp_path: Path) -> None:
    """A shift's begin beside full stamps is a column of words, and so is one beside days of a row each."""
    shift = pa.array([dt.time(6, 0)] * _ROWS, pa.time64("us"))
    found = load(Reader(), _written(tmp_path, ts=pa.array(_MOMENTS, pa.timestamp("us")), shift=shift), Source())
    assert {s.name for s in found.recording.signals} == {"shift", "T"}
    assert found.t_ns["table"].tolist() == _NS


def test_a_day_a_row_is_a_time(tmp_path: Path) -> None:
    days = [dt.date(2026, 3, 1) + dt.timedelta(days=k) for k in range(_ROWS)]
    found = load(Reader(), _written(tmp_path, Date=pa.array(days, pa.date32())), Source())
    assert np.diff(found.t_ns["table"]).tolist() == [86_400 * 10**9] * (_ROWS - 1)
