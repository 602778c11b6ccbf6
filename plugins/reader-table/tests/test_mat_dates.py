"""Dates as MATLAB's datestr and datevec write them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

N = 90
AT = np.datetime64("2026-03-02T22:59:00", "ms") + np.arange(N) * np.timedelta64(60_500, "ms")
DATES = AT.astype("datetime64[us]").astype(object)
VECTORS = np.array([[d.year, d.month, d.day, d.hour, d.minute, d.second + d.microsecond / 1e6] for d in DATES])
WAVE = {"T1": np.arange(N) * 0.5, "T2": np.arange(N) * 0.25}


def read(folder: Path, variables: dict[str, Any], **table: Any) -> Data:
    scipy.io.savemat(folder / "x.mat", variables)
    return load(Reader(), folder / "x.mat", Source(timezone="UTC", table=table or None))


@pytest.mark.parametrize("name", ["t", "clock", "stamps"])
def test_rows_of_a_date_vector_are_the_time(tmp_path: Path, name: str) -> None:
    data = read(tmp_path, {name: VECTORS, **WAVE})
    assert data.recording.clock == "absolute"
    np.testing.assert_array_equal(data.t_ns[name], AT.astype("datetime64[ns]").astype(np.int64))
    assert [s.name for s in data.recording.signals] == ["T1", "T2"]


def test_dates_with_names_of_months_are_read(tmp_path: Path) -> None:
    data = read(tmp_path, {"t": np.array([f"{d:%d-%b-%Y %H:%M:%S}" for d in DATES]), **WAVE})
    np.testing.assert_array_equal(data.t_ns["t"], AT.astype("datetime64[s]").astype("datetime64[ns]").astype(np.int64))
    assert "dates read as '%d-%b-%Y %H:%M:%S'" in data.recording.notes


@pytest.mark.parametrize("broken", [(3, 1, 13.0), (4, 3, 24.0), (5, 0, 2026.5), (6, 5, np.nan)])
def test_a_matrix_that_is_no_date_in_a_row_is_none(tmp_path: Path, broken: tuple[int, int, float]) -> None:
    row, column, value = broken
    vectors = VECTORS.copy()
    vectors[row, column] = value
    data = read(tmp_path, {"seconds": vectors, "t": np.arange(N) * 1.0, **WAVE})
    assert data.recording.clock == "relative"
    assert len(data.recording.signals) == 8


def test_a_time_of_its_own_counts_before_a_date_vector_of_its_length(tmp_path: Path) -> None:
    data = read(tmp_path, {"began": VECTORS, "t": np.arange(N) * 1.0, **WAVE}, time={"unit": "s"})
    assert data.recording.clock == "relative"
