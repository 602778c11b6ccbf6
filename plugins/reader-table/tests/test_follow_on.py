"""A workbook of the hall with a sheet a week or a day: one log. Sheets that are tests stay apart."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_sheets import sheet, workbook

DAY = 46097.0  # 2026-03-16, as a sheet counts
STEP = 1 / 24 / 6


def rows(first: int, count: int, step: float = STEP, names: tuple[str, ...] = ("T_hall [°C]", "RH [%]")) -> list[Any]:
    at = [DAY + (first + k) * step for k in range(count)]
    return [["Datum", *names], *([t, 20 + (first + k) / 100, 50.0] for k, t in enumerate(at))]


def read(folder: Path, sheets: dict[str, list[Any]], **table: Any) -> Data:
    path = workbook(folder / "hall.xlsx", {name: sheet(cells, (1, 0, 0)) for name, cells in sheets.items()})
    return load(Reader(), path, Source(timezone="UTC", table=table or None))


@pytest.mark.parametrize(
    "names",
    [("KW 12", "KW 13", "KW 14"), ("Mo", "Di", "Mi"), ("16.03.", "17.03.", "18.03."), ("Sheet1", "Sheet2", "Sheet3")],
)
def test_sheets_that_go_on_are_one_stream(tmp_path: Path, names: tuple[str, ...]) -> None:
    parts = {name: rows(144 * k, 144) for k, name in enumerate(names)}
    data = read(tmp_path, dict(reversed(parts.items())))
    assert [s.name for s in data.recording.signals] == ["T_hall [°C]", "RH [%]"]
    (t_ns,) = data.t_ns.values()
    assert t_ns.size == 432
    assert np.all(np.diff(t_ns) > 0)
    assert np.allclose(data.values["table", "T_hall [°C]"], 20 + np.arange(432) / 100)
    assert any("follow each other without a gap" in n for n in data.recording.notes)
    where = Reader().locate(tmp_path / "hall.xlsx", Source(timezone="UTC"), "table", 150)
    assert where == f"sheet '{names[1]}', row 8"
    alone = read(tmp_path, parts, sheet=names[1])
    assert alone.t_ns["table"].size == 144


@pytest.mark.parametrize(
    ("sheets", "why"),
    [
        ({"S4000": rows(0, 144), "S8000": rows(144, 144)}, "called as tests"),
        ({"warm up": rows(0, 144), "cool down": rows(144, 144)}, "called as tests"),
        ({"1": rows(0, 144), "2": rows(144, 144)}, "numbers alone may be tests"),
        ({"KW 12": rows(0, 144), "KW 14": rows(288, 144)}, "a week between them"),
        ({"KW 12": rows(0, 144), "KW 13": rows(100, 144)}, "both at once"),
        ({"KW 12": rows(0, 144), "KW 13": rows(144, 144, names=("T_bed [°C]", "RH [%]"))}, "other columns"),
        ({"KW 12": rows(0, 144), "KW 13": rows(72, 72, step=2 * STEP)}, "other steps"),
    ],
)
def test_sheets_that_do_not_stay_a_stream_each(tmp_path: Path, sheets: dict[str, list[Any]], why: str) -> None:
    data = read(tmp_path, sheets)
    assert len(data.t_ns) == 2, why
    assert any("each a stream" in n for n in data.recording.notes)
