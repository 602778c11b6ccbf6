"""A column that holds the unit of the numbers beside it, row by row."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.tables.row_series import with_series


def _read(path: Path, units: list[str], head: str = "Date/Time,Unit,Value") -> tuple[str | None, int, list[str]]:
    """(unit of the numbers, rows, losses)."""
    more = ",1.5" * (head.count(",") - 2)
    rows = [f"2026-03-14 {k // 3600:02d}:{k // 60 % 60:02d}:{k % 60:02d},{u},{k}.5{more}" for k, u in enumerate(units)]
    path.write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    table = delimited.open_table(path, Source())
    items = list(delimited.blocks(path, table, Source()))
    unit = next(s.unit for s in delimited.signals(table) if s.name == "Value")
    n = sum(i.t_ns.size for i in items if isinstance(i, Block))
    assert all(np.all(np.diff(i.t_ns) > 0) for i in items if isinstance(i, Block))
    return unit, n, [i.reason for i in items if isinstance(i, Loss)]


def test_it_is_their_unit(tmp_path: Path) -> None:
    assert _read(tmp_path / "a.csv", ["C"] * 50) == ("C", 50, [])
    assert _read(tmp_path / "b.csv", ["F"] * 49 + [""]) == ("F", 50, [])


def test_rows_in_another_are_a_loss(tmp_path: Path) -> None:
    unit, n, losses = _read(tmp_path / "a.csv", ["C"] * 60_000 + ["F"] * 3 + ["C"] * 10_000)
    assert (unit, n) == ("C", 70_000)
    assert losses == ["3 rows in another unit than 'C', as 'Unit' says: F"]


def test_several_units_or_columns_leave_it_open(tmp_path: Path) -> None:
    assert _read(tmp_path / "a.csv", ["C", "F"] * 25) == (None, 50, [])
    assert _read(tmp_path / "b.csv", ["C"] * 50, "Date/Time,Unit,Value,Other") == (None, 50, [])
    assert _read(tmp_path / "c.csv", ["lathe"] * 50) == (None, 50, [])


def test_the_letter_of_a_machine_is_no_unit(tmp_path: Path) -> None:
    assert _read(tmp_path / "a.csv", ["A"] * 50) == (None, 50, [])
    assert any("'Unit' says 'A'" in note for note in delimited.open_table(tmp_path / "a.csv", Source()).notes)
    rows = [f"2026-03-14 00:{k // 60:02d}:{k % 60:02d},{unit},{20 + k / 100:.2f}" for k in range(300) for unit in "AC"]
    (tmp_path / "b.csv").write_text("\n".join(["Date/Time,Unit,Temperature", *rows, ""]), encoding="utf-8")
    found = delimited.signals(with_series(delimited.open_table(tmp_path / "b.csv", Source()), Source()))
    assert {s.name: s.unit for s in found} == {"A/Temperature": None, "C/Temperature": None}
