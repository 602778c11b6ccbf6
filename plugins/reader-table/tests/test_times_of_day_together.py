"""Columns and sheets of one file that tell times of day without a date: one clock, each from its own first row on."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_sheets import read as read_sheets
from .test_sheets import sheet

HOUR, MIN = 3600 * 10**9, 60 * 10**9


def blocks(tmp_path: Path, *firsts_h: float, form: str = "{h:02d}:{m:02d}:00") -> Data:
    """Columns of a time and a value for each first hour, 20 rows of a minute, side by side."""
    header = ";".join(f"Zeit;T{k + 1}" for k in range(len(firsts_h)))
    lines = [header]
    for n in range(20):
        minutes = [round(h * 60) + n for h in firsts_h]
        lines.append(";".join(f"{form.format(h=m // 60 % 24, m=m % 60)};{20 + n / 10}" for m in minutes))
    path = tmp_path / "x.csv"
    path.write_text("\n".join([*lines, ""]))
    return load(Reader(), path, Source())


def begins_min(data: Data) -> list[float]:
    return [int(t[0]) / MIN for t in data.t_ns.values()]


@pytest.mark.parametrize(
    ("firsts_h", "begins", "of_day_h"),
    [
        ((8.0, 8 + 1 / 3), [0, 20], 8.0),
        ((8 + 1 / 3, 8.0), [20, 0], 8.0),
        ((8.0, 9.5), [0, 90], 8.0),
        ((8.0, 8.0), [0, 0], 8.0),
        ((23.0, 23.5, 0.25), [0, 30, 75], 23.0),
        ((8.0, 14.0, 22.0), [0, 360, 840], 8.0),  # tests side by side, each after the one before
    ],
)
def test_columns_keep_what_lies_between_their_times_of_day(
    tmp_path: Path, firsts_h: tuple[float, ...], begins: list[float], of_day_h: float
) -> None:
    data = blocks(tmp_path, *firsts_h)
    assert begins_min(data) == begins
    assert data.recording.of_day_ns == round(of_day_h * HOUR)


def test_a_column_of_durations_beside_times_of_day_counts_from_its_own_start(tmp_path: Path) -> None:
    data = blocks(tmp_path, 8.0, 0.0)
    assert begins_min(data) == [0, 0]
    assert data.recording.of_day_ns is None


def cells(first_h: float) -> str:
    """A sheet of 20 minutes from an hour of the day on."""
    return sheet([["Zeit", "T"], *([(first_h / 24 + n / 1440), 20 + n / 10] for n in range(20))], (3, 0))


@pytest.mark.parametrize(
    ("firsts_h", "begins", "of_day_h"),
    [((8.0, 8 + 1 / 3), [0, 20], 8.0), ((8.5, 8.0), [30, 0], 8.0), ((8.0, 0.0), [0, 0], None), ((8.0,), [0], 8.0)],
)
def test_sheets_keep_what_lies_between_their_times_of_day(
    tmp_path: Path, firsts_h: tuple[float, ...], begins: list[float], of_day_h: float | None
) -> None:
    data = read_sheets(tmp_path, {f"s{k}": cells(h) for k, h in enumerate(firsts_h)}, Source())
    assert [round(x, 3) for x in begins_min(data)] == begins
    assert data.recording.of_day_ns == pytest.approx(None if of_day_h is None else of_day_h * HOUR)


def test_blocks_of_a_sheet_under_a_row_of_units_have_times_of_their_own(tmp_path: Path) -> None:
    head: list[list[object]] = [["Ora", "dZ", "Ora", "dZ"], ["hh:mm:ss", "µm", "hh:mm:ss", "µm"]]
    rows: list[list[object]] = [[1 / 3 + n / 1440, n / 10, 9.5 / 24 + n / 720, n / 5] for n in range(20)]
    data = read_sheets(tmp_path, {"s": sheet([*head, *rows], (3, 0, 3, 0))}, Source())
    assert [round(x, 3) for x in begins_min(data)] == [0, 90]
    assert {s.name: s.stream for s in data.recording.signals} == {"dZ": "Ora", "dZ#2": "Ora#2"}
