"""A row that says the type of each column, or how it was sampled, names none of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.plugin import Source
from thermodata.reader.text import delimited

NAMES, UNITS = "Time;dX;T_front;speed", ";um;degC;rpm"


def signals(folder: Path, head: list[str]) -> dict[str, str | None]:
    path = folder / "log.csv"
    rows = [f"2026-03-13 08:{k:02d}:00;{k / 7:.3f};{20 + k / 50:.2f};{4000 + k % 2}" for k in range(60)]
    path.write_text("\n".join([*head, *rows, ""]), "utf-8")
    table = delimited.open_table(path, Source())
    found = delimited.describe(table, Source()).signals
    assert not any("group" in s.properties for s in found)
    return {s.name: s.unit for s in found}


@pytest.mark.parametrize(
    "row",
    ["DATE_AND_TIME;REAL;REAL;INT", ";REAL;REAL;REAL", ";LREAL;REAL;DINT", "Inst;Inst;Inst;Inst", ";Inst;Avg;Inst"],
)
def test_a_row_of_types_is_no_row_of_names_and_no_group(tmp_path: Path, row: str) -> None:
    without, with_units = dict.fromkeys(("dX", "T_front", "speed")), {"dX": "um", "T_front": "degC", "speed": "rpm"}
    assert signals(tmp_path, [NAMES, row]) == without
    assert signals(tmp_path, [row, NAMES]) == without
    for head in ([row, NAMES, UNITS], [NAMES, row, UNITS], [NAMES, UNITS, row]):
        assert signals(tmp_path, head) == with_units


def test_what_tells_names_apart_that_repeat_stays(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"2026-03-13 08:{k:02d}:00;{k / 7:.3f};{k / 5:.3f};{20 + k / 50:.2f};{21 + k / 50:.2f}" for k in range(60)]
    path.write_text("\n".join(["Time;dX;dX;T;T", ";Inst;Max;Inst;Max", *rows, ""]), "utf-8")
    table = delimited.open_table(path, Source())
    assert [s.name for s in delimited.describe(table, Source()).signals] == ["dX/Inst", "dX/Max", "T/Inst", "T/Max"]


def test_columns_that_are_called_so_keep_their_names(tmp_path: Path) -> None:
    assert list(signals(tmp_path, ["Time;Real;Int;Word"])) == ["Real", "Int", "Word"]
