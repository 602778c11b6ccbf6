"""Logs of changed cells and columns of quality give the same in text, in workbooks and in Parquet."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError, UsageError
from thermodata.plugin import Source
from thermodata.reader.typed_columns import Columns, Related, related, rows_looked_at
from thermodata.schema.flag import Flag
from thermodata.testing.reader import load

from .test_sheets import sheet, workbook

N = 600
K = np.arange(N)
SPEED = np.where((K > 60) & (K < 480), 4000.0, 0.0)
WARM = np.round(20 + 8 * (1 - np.exp(-K / 200)) + np.random.default_rng(2).normal(0, 0.1, N), 1)
Column = Sequence[float | str | None]


def text(path: Path, columns: dict[str, Column]) -> Path:
    cells = [["" if v is None else str(v) for v in column] for column in columns.values()]
    lines = [";".join(row) for row in zip(*cells, strict=True)]
    path.write_text("\n".join([";".join(columns), *lines, ""]), encoding="utf-8")
    return path


def book(path: Path, columns: dict[str, Column]) -> Path:
    return workbook(path, {"Data": sheet([list(columns), *map(list, zip(*columns.values(), strict=True))])})


def parquet(path: Path, columns: dict[str, Column]) -> Path:
    pq.write_table(pa.table({name: list(column) for name, column in columns.items()}), path, row_group_size=100)
    return path


WRITERS = pytest.mark.parametrize(
    ("write", "name"), [(text, "a.csv"), (book, "a.xlsx"), (parquet, "a.parquet")], ids=["text", "workbook", "parquet"]
)
Write = Callable[[Path, dict[str, Column]], Path]


def changed(values: Sequence[float] | np.ndarray) -> list[float | None]:  # type: ignore[type-arg]
    return [float(v) if not k or v != values[k - 1] else None for k, v in enumerate(values)]


def seconds() -> list[float | str | None]:
    return [10.0 * k for k in range(N)]


@WRITERS
@pytest.mark.parametrize("block_rows", [None, 7])
def test_each_value_stands_over_the_empty_cells_behind_it(
    tmp_path: Path, write: Write, name: str, block_rows: int | None
) -> None:
    path = write(tmp_path / name, {"time [s]": seconds(), "T": changed(WARM), "n": changed(SPEED)})
    options = {} if block_rows is None else {"block_rows": block_rows}
    data = load(Reader(), path, Source(options=options))
    (stream,) = data.t_ns
    np.testing.assert_array_equal(data.values[stream, "n"], SPEED)
    np.testing.assert_array_equal(data.values[stream, "T"], WARM)
    assert all(s.held for s in data.recording.signals)
    assert any("stands over the empty cells" in note for note in data.recording.notes)


@WRITERS
def test_what_is_declared_has_the_last_word(tmp_path: Path, write: Write, name: str) -> None:
    path = write(tmp_path / name, {"time [s]": seconds(), "T": list(WARM), "n": changed(SPEED)})
    left = load(Reader(), path, Source(table={"stands": "none"}))
    (stream,) = left.t_ns
    assert np.isnan(left.values[stream, "n"]).sum() == N - 3
    assert not any(s.held for s in left.recording.signals)
    taken = load(Reader(), path, Source(table={"stands": ["n"]}))
    np.testing.assert_array_equal(taken.values[stream, "n"], SPEED)
    assert {s.name: s.held for s in taken.recording.signals} == {"T": False, "n": True}
    for other in ("m", "33"):
        with pytest.raises(UsageError, match=f"no column '{other}'"):
            load(Reader(), path, Source(table={"stands": [other]}))


@WRITERS
def test_holes_of_a_log_at_a_rate_stay_holes(tmp_path: Path, write: Write, name: str) -> None:
    torn = [None if 100 <= k < 140 else float(v) for k, v in enumerate(WARM)]
    data = load(Reader(), write(tmp_path / name, {"time [s]": seconds(), "T": torn, "n": list(SPEED)}), Source())
    (stream,) = data.t_ns
    assert np.isnan(data.values[stream, "T"]).sum() == 40


@WRITERS
def test_a_quality_flags_what_it_is_of(tmp_path: Path, write: Write, name: str) -> None:
    codes: Column = [0 if k % 50 == 3 else 192 for k in range(N)]
    columns: dict[str, Column] = {"time [s]": seconds(), "T": list(WARM), "T.Quality": codes, "n": list(SPEED)}
    data = load(Reader(), write(tmp_path / name, columns), Source())
    (stream,) = data.t_ns
    np.testing.assert_array_equal(data.flags[stream, "T"], np.where(K % 50 == 3, Flag.NOT_MEASURING, 0))
    assert not np.any(data.flags.get((stream, "n"), 0))
    assert {s.name: s.properties.get("quality_of") for s in data.recording.signals}["T.Quality"] == "T"
    with pytest.raises(QuestionError, match="code 0"):
        load(Reader(), write(tmp_path / name, {**columns, "T.Quality": [0] * N}), Source())


def test_columns_of_one_sheet_among_several_are_declared_by_their_own_names(tmp_path: Path) -> None:
    rows = zip(seconds(), list(WARM), changed(SPEED), strict=True)
    other = sheet([["time [s]", "T_hall"], *([10 * k, 20 + k / 100] for k in range(N))])
    path = workbook(tmp_path / "a.xlsx", {"A": sheet([["time [s]", "T", "n"], *map(list, rows)]), "B": other})
    for name in ("n", "A/n"):
        data = load(Reader(), path, Source(table={"stands": [name]}))
        np.testing.assert_array_equal(data.values["A", "A/n"], SPEED)
        assert {s.name for s in data.recording.signals if s.held} == {"A/n"}


def test_of_a_wide_table_fewer_rows_are_looked_at_and_no_cells_of_columns_without_gaps(tmp_path: Path) -> None:
    assert [rows_looked_at(n) for n in (10, 100, 5000)] == [20_000, 4000, 2000]
    values = {f"T{k}": np.arange(20_000.0) + k for k in range(200)}
    began = time.process_time()
    found = related({}, Columns(values, {}, np.arange(20_000)), "a.parquet")
    assert found == Related()
    assert time.process_time() - began < 1  # every cell as a text took ten times as long


@pytest.mark.parametrize(("write", "name"), [(text, "a.csv"), (book, "a.xlsx")], ids=["text", "workbook"])
def test_an_error_with_a_unit_is_a_reading_and_no_code(tmp_path: Path, write: Write, name: str) -> None:
    """Whole micrometres beside the axis whose error they are: good rows of it stay good."""
    error: list[float | str | None] = ["um", *(3.0 if k % 5 == 0 else 0.0 for k in range(100))]
    made = write(
        tmp_path / name,
        {"t [s]": ["", *map(float, range(100))], "X": ["mm", *np.arange(0.5, 100.5).tolist()], "X_Error": error},
    )
    data = load(Reader(), made, Source())
    (stream,) = data.t_ns
    assert not np.any(data.flags.get((stream, "X"), 0))
    assert {s.name: s.properties.get("quality_of") for s in data.recording.signals}["X_Error"] is None
