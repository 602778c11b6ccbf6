"""A counter that is full is counted on in every format, and a logger that was started again counts from its start."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from thermodata_reader_table import Reader

from thermodata.plugin import Int1D, Source
from thermodata.testing.reader import load

from .test_sheets import sheet, workbook

ROWS, FULL = 3000, 1 << 16
TRUE = 60_000 + 1000 * np.arange(ROWS)  # ms
T1 = 20 + np.arange(ROWS) % 7 / 10


def xlsx(folder: Path, counts: Int1D) -> Path:
    rows = [["tick [ms]", "T1 [degC]"], *([int(n), float(t)] for n, t in zip(counts, T1, strict=True))]
    return workbook(folder / "a.xlsx", {"data": sheet(rows)})


def parquet(folder: Path, counts: Int1D) -> Path:
    pq.write_table(pa.table({"tick [ms]": counts, "T1 [degC]": T1}), folder / "a.parquet", row_group_size=700)
    return folder / "a.parquet"


def mat(folder: Path, counts: Int1D) -> Path:
    scipy.io.savemat(folder / "a.mat", {"time_ms": counts.astype(float)[:, None], "T1": T1[:, None]})
    return folder / "a.mat"


@pytest.mark.parametrize("write", [xlsx, parquet, mat])
def test_a_counter_that_is_full_is_counted_on(tmp_path: Path, write: Callable[[Path, Int1D], Path]) -> None:
    data = load(Reader(), write(tmp_path, TRUE % FULL), Source(options={"block_rows": 450}))
    (t_ns,) = data.t_ns.values()
    assert ((t_ns - t_ns[0]) // 10**6).tolist() == (TRUE - TRUE[0]).tolist()
    assert any(f"begins anew at {FULL}" in n for n in data.recording.notes)


@pytest.mark.parametrize("write", [xlsx, parquet, mat])
def test_a_clock_that_is_set_back_is_no_counter(tmp_path: Path, write: Callable[[Path, Int1D], Path]) -> None:
    counts = np.where(np.arange(ROWS) < 2000, TRUE, TRUE - TRUE[2000])
    data = load(Reader(), write(tmp_path, counts), Source())
    (t_ns,) = data.t_ns.values()
    assert (t_ns // 10**6).tolist() == counts.tolist()
    assert not any("begins anew" in n for n in data.recording.notes)


def started_again(folder: Path, second: list[object], behind: int = 0) -> tuple[list[int], tuple[str, ...], list[str]]:
    """(minutes of the rows since the first, notes, what is lost) of a sheet of 40 rows and 20 behind a second start."""
    header: list[object] = ["Zeit [s]", "T1 [degC]"]
    first: list[list[object]] = [[60 * k, 20.5] for k in range(40)]
    again: list[list[object]] = [[behind + 60 * k, 21.5] for k in range(20)]
    rows = [["Messbeginn: 02.03.2026 07:00:00"], header, *first, second, header, *again]
    data = load(Reader(), workbook(folder / "a.xlsx", {"data": sheet(rows, (0, 0))}), Source(timezone="UTC"))
    t_ns = data.t_ns["table"]
    return ((t_ns - t_ns[0]) // (60 * 10**9)).tolist(), data.recording.notes, [x.reason for x in data.losses]


@pytest.mark.parametrize(
    "second",
    [["Messbeginn: 02.03.2026 08:00:00"], ["Messbeginn:", "02.03.2026 08:00:00"], ["Start", "02.03.2026 08:00"]],
)
def test_rows_behind_a_second_start_of_a_sheet_count_from_it(tmp_path: Path, second: list[object]) -> None:
    minutes, notes, lost = started_again(tmp_path, second)
    assert minutes == [*range(40), *range(60, 80)]
    assert any("count anew from the start in a further head: 'Messbeginn" in n or "'Start" in n for n in notes)
    assert lost == []


def test_a_start_between_rows_of_a_sheet_that_count_on_changes_nothing(tmp_path: Path) -> None:
    minutes, notes, _ = started_again(tmp_path, ["Messbeginn: 02.03.2026 08:00:00"], behind=2400)
    assert minutes == list(range(60))
    assert not any("anew" in n for n in notes)
