"""Columns with times of their own whose row of units says how these are written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

S = 1_000_000_000
VA = [20 + i / 4 for i in range(12)]


def rows(*columns: list[Any]) -> str:
    return "".join(";".join(map(str, row)) + "\n" for row in zip(*columns, strict=True))


def minutes(first: int, step: int, form: str) -> list[str]:
    return [form.format(h=m // 60, m=m % 60) for m in range(first, first + 12 * step, step)]


def undeclared(tmp_path: Path, text: str) -> Data:
    path = tmp_path / "x.csv"
    path.write_text(text, encoding="utf-8")
    return load(Reader(), path, Source(timezone="UTC"))


@pytest.mark.parametrize(
    ("unit", "form"),
    [
        ("hh:mm:ss", "{h:02d}:{m:02d}:00"),
        ("[HH:MM:SS.fff]", "{h:02d}:{m:02d}:00.000"),
        ("TT.MM.JJJJ hh:mm:ss", "15.06.2026 {h:02d}:{m:02d}:00"),
        ("gg/mm/aaaa hh:mm", "15/06/2026 {h:02d}:{m:02d}"),
        ("-", "{h:02d}:{m:02d}:00"),
    ],
)
def test_a_row_of_units_may_say_how_times_are_written(tmp_path: Path, unit: str, form: str) -> None:
    one, two = minutes(480, 1, form), minutes(570, 2, form)
    body = rows(one, VA, VA, two, VA, [100 - i for i in range(12)])
    data = undeclared(tmp_path, f"Zeit;dZ;T_bed;Zeit;dZ;T_bed\n{unit};um;°C;{unit};um;°C\n{body}")
    begin, later = (t for t in data.t_ns.values())
    assert (later - begin[0]).tolist() == [(90 + 2 * i) * 60 * S for i in range(12)]
    held_by = {s.name: s.stream for s in data.recording.signals}
    assert held_by == {"dZ": "Zeit", "T_bed": "Zeit", "dZ#2": "Zeit#2", "T_bed#2": "Zeit#2"}


def test_a_row_of_units_may_hold_as_many_forms_of_times_as_units(tmp_path: Path) -> None:
    one, two = (minutes(first, 1, "{h:02d}:{m:02d}:00") for first in (480, 570))
    data = undeclared(tmp_path, "Zeit;dZ;Zeit;T\nHH:MM:SS;um;HH:MM:SS;°C\n" + rows(one, VA, two, VA))
    assert [(s.name, s.stream, s.unit) for s in data.recording.signals] == [("dZ", "Zeit", "um"), ("T", "Zeit#2", "°C")]


def test_numbers_of_another_unit_than_that_of_a_time_are_no_time(tmp_path: Path) -> None:
    body = rows(minutes(480, 1, "{h:02d}:{m:02d}:00"), VA, list(range(12)), VA)
    data = undeclared(tmp_path, f"Zeit;dZ;Zeit;T\nhh:mm:ss;um;V;°C\n{body}")
    assert list(data.t_ns) == ["table"]
    assert {s.name for s in data.recording.signals} == {"dZ", "Zeit#2", "T"}
