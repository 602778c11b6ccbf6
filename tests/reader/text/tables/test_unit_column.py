"""A column that holds the unit of the numbers beside it, row by row."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.tables.row_series import with_series
from thermodata.testing.reader import load


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


@pytest.mark.parametrize("short", ["E", "U", "Einh.", "eh", "UoM"])
def test_a_short_header_says_it_where_each_word_can_be_nothing_else(tmp_path: Path, short: str) -> None:
    head = f"Date/Time,{short},Value"
    assert _read(tmp_path / "a.csv", ["°C"] * 50, head)[0] == "°C"
    assert _read(tmp_path / "b.csv", ["bar"] * 49 + [""], head)[0] == "bar"
    for words in (["A"] * 50, ["C"] * 50, ["in"] * 50, ["-"] * 50, ["OK"] * 50, ["bar"] * 49 + ["ERR"]):
        assert _read(tmp_path / "c.csv", words, head)[0] is None, words[-1]


def test_another_header_says_none_though_its_words_are_units(tmp_path: Path) -> None:
    assert _read(tmp_path / "a.csv", ["bar"] * 50, "Date/Time,Remark,Value")[0] is None


@pytest.mark.parametrize("header", ["Unit", "U", "E"])
def test_each_series_of_a_long_table_has_its_own(tmp_path: Path, header: str) -> None:
    said = {"T_front": "°C", "p_oil": "bar"}
    rows = [
        f"2026-03-14 00:{k // 60:02d}:{k % 60:02d},{name},{unit},{20 + k / 100:.2f}"
        for k in range(300)
        for name, unit in said.items()
    ]
    (tmp_path / "b.csv").write_text("\n".join([f"Date/Time,Place,{header},Temperature", *rows, ""]), encoding="utf-8")
    found = delimited.signals(with_series(delimited.open_table(tmp_path / "b.csv", Source()), Source()))
    assert {s.name: s.unit for s in found if s.dtype != "str"} == {f"{k}/Temperature": v for k, v in said.items()}


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


def _values(path: Path, name: str, *rows: str) -> tuple[str | None, list[float], list[str]]:
    """(unit, values, notes) of a column; rows: the header, and what stands behind the times."""
    stamped = [f"2026-03-14 08:{k // 60:02d}:{k % 60:02d};{row}" for k, row in enumerate(rows[1:])]
    path.write_text("\n".join([rows[0], *stamped, ""]), encoding="utf-8")
    table = delimited.open_table(path, Source())
    found = [b for b in delimited.blocks(path, table, Source()) if isinstance(b, Block)]
    unit = next(s.unit for s in delimited.signals(table) if s.name == name)
    return unit, np.concatenate([b.values[name] for b in found]).tolist(), list(table.notes)


def test_rows_of_a_logger_that_changes_its_range_are_converted_to_one_unit(tmp_path: Path) -> None:
    rows = [f"21.5;{900 + k};mA" for k in range(20)] + [f"21.5;{1 + k};A" for k in range(20)]
    unit, values, notes = _values(tmp_path / "a.csv", "Strom", "Time;T_front [°C];Strom;Einheit", *rows)
    assert unit == "mA"
    assert values == pytest.approx([*range(900, 920), *(1000 * (1 + k) for k in range(20))])
    assert "'Einheit' says the unit of 'Strom' row by row: 'A' is converted to 'mA'" in notes
    rows = ["20.5;°C"] * 20 + ["68.9;°F"] * 20
    assert _values(tmp_path / "b.csv", "T", "Time;T;unit", *rows)[1] == pytest.approx([20.5] * 40)


def test_units_that_differ_and_are_not_taken_are_told(tmp_path: Path) -> None:
    rows = ["21.5;900;mA"] * 20 + ["21.5;1.0;A"] * 20
    notes = _values(tmp_path / "a.csv", "Strom", "Time;T_front;Strom;Einheit", *rows)[2]
    assert any("'Einheit' says several units (mA, A), which are not converted" in note for note in notes)
    rows = ["20.5;°C"] * 20 + ["3.5;bar"] * 20
    notes = _values(tmp_path / "b.csv", "Wert", "Time;Wert;Einheit", *rows)[2]
    assert any("'Einheit' says several units (°C, bar)" in note for note in notes)


def test_each_column_of_units_is_of_the_column_of_values_that_it_is_called_after(tmp_path: Path) -> None:
    """Lutron: Ch1_Value, Ch1_Unit, Ch2_Value, Ch2_Unit; the second changes its unit within the file."""
    rows = [
        f"{k + 1},2026/05/04,23:00:{k:02d},70.{k},Degree F,{'21.5,Degree C' if k < 40 else '212.0,Degree F'}"
        for k in range(60)
    ]
    path = tmp_path / "tmc.csv"
    head = "Position,Date,Time,Ch1_Value,Ch1_Unit,Ch2_Value,Ch2_Unit"
    path.write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    source = Source(timezone="UTC")
    units = {s.name: s.unit for s in Reader().describe(path, source).signals}
    assert (units["Ch1_Value"], units["Ch2_Value"]) == ("Degree F", "Degree C")
    data = load(Reader(), path, source)
    (second,) = [v for (_, name), v in data.values.items() if name == "Ch2_Value"]
    assert second[:40].tolist() == [21.5] * 40
    assert second[40:].tolist() == pytest.approx([100.0] * 20)


@pytest.mark.parametrize("units", ["Degree F", "rainy", "E"])
def test_a_column_called_after_no_column_of_values_is_none_of_units(tmp_path: Path, units: str) -> None:
    rows = [f"2026-05-04 23:00:{k:02d},70.{k},21.5,{units}" for k in range(60)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["time,Ch1_Value,Ch2_Value,Ch3_Unit", *rows, ""]), encoding="utf-8")
    assert {s.unit for s in Reader().describe(path, Source(timezone="UTC")).signals} == {None}
