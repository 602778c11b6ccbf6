"""05:10 is five minutes or five hours: told by the header, declared, or asked."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.cells.time_forms.time_pattern import declared_format
from thermodata.reader.text.tables.find_table import open_table
from thermodata.reader.text.times.local_clock import DayCount
from thermodata.reader.text.times.one_cell.clock_words import said_clock
from thermodata.reader.text.times.one_cell.timestamp import parse, parse_one
from thermodata.reader.text.times.time_formats import find_formats

S = 1_000_000_000
SHORT = ["00:05", "05:10"]


def minutes(count: int, step_s: int = 5, first_s: int = 0) -> list[str]:
    return [f"{t // 60:02d}:{t % 60:02d}" for t in range(first_s, first_s + count * step_s, step_s)]


def times(tmp_path: Path, header: str, cells: list[str], table: dict[str, object] | None = None) -> list[float]:
    path = tmp_path / "log.csv"
    path.write_text(f"{header},T1 [degC]\n" + "".join(f"{c},20.{i % 10}\n" for i, c in enumerate(cells)))
    source = Source(table=table)
    found = delimited.blocks(path, open_table(path, source), source)
    return [float(t) / S for b in found if isinstance(b, Block) for t in b.t_ns]


@pytest.mark.parametrize(
    ("header", "cells", "said"),
    [
        ("Time (mm:ss)", SHORT, "mm:ss"),
        ("time mm:ss", SHORT, "mm:ss"),
        ("Zeit_[mm]:ss", SHORT, "mm:ss"),
        ("Zeit min:sek", SHORT, "mm:ss"),
        ("t (m:s.0)", ["00:05.5", "05:10.0"], "mm:ss"),
        ("Time [HH:MM]", SHORT, "hh:mm"),
        ("Zeit [h]", SHORT, "hh:mm"),
        ("Time (hh:mm:ss)", SHORT, None),  # three parts are promised, two stand there: asked
        ("Time (mm:ss)", ["00:00:05", "00:05:10"], None),  # three parts leave nothing open
        ("Time", SHORT, None),
        ("Stamm:ss", SHORT, None),
    ],
)
def test_a_header_names_the_parts(header: str, cells: list[str], said: str | None) -> None:
    assert said_clock(header, None, cells) == said


def test_a_row_of_units_names_them_too() -> None:
    assert said_clock("Time", "mm:ss", SHORT) == "mm:ss"


def test_minutes_and_seconds_of_a_header_are_read_so(tmp_path: Path) -> None:
    assert times(tmp_path, "Time (mm:ss)", minutes(200)) == [5.0 * i for i in range(200)]


def test_minutes_go_on_behind_the_hour_or_begin_anew(tmp_path: Path) -> None:
    expected = [60.0 * i for i in range(90)]
    assert times(tmp_path, "Time (mm:ss)", minutes(90, 60)) == expected
    assert times(tmp_path, "Time (mm:ss)", [f"{i % 60:02d}:00" for i in range(90)]) == expected


def test_minutes_that_begin_anew_in_a_later_recording_are_no_turn() -> None:
    assert DayCount(3600 * S).relative(np.array([4500, 0]) * S).tolist() == [0, -4500 * S]
    assert DayCount(3600 * S).relative(np.array([3540, 0]) * S).tolist() == [0, 60 * S]


def test_hours_of_a_header_go_on_behind_a_day(tmp_path: Path) -> None:
    assert times(tmp_path, "Time (hh:mm)", [f"{h}:00" for h in range(20, 30)]) == [3600.0 * i for i in range(10)]
    night = [f"{h % 24:02d}:00" for h in range(20, 30)]
    assert times(tmp_path, "Time (hh:mm)", night) == [3600.0 * i for i in range(10)]


@pytest.mark.parametrize(
    ("name", "cells"),
    [
        ("Time", minutes(400, first_s=480)),  # goes on behind 23
        ("Time", minutes(40)),  # begins at zero
        ("Time [min]", minutes(40, first_s=480)),
        ("Time (hh:mm:ss)", minutes(40, first_s=480)),
    ],
)
def test_two_parts_that_may_be_either_are_asked(name: str, cells: list[str]) -> None:
    with pytest.raises(QuestionError) as caught:
        find_formats([name], [cells], None, "log.csv")
    assert "mm:ss or hh:mm?" in caught.value.ask
    (form,) = find_formats([name], [cells], "mm:ss", "log.csv")
    assert parse_one("05:10", form) == 310 * S


@pytest.mark.parametrize(
    ("name", "cells"),
    [
        ("Time", minutes(40, first_s=490)),  # 08:10, 08:15, ...: a clock on a wall
        ("Time", [*minutes(150, first_s=490), "85:12"]),  # one damaged cell
        ("Uhrzeit", minutes(40)),
        ("Time", ["00:00", "00:05", "00:20", "00:21", "01:10"]),  # uneven
        ("Time", ["00:00:00", "00:00:05", "00:00:10"]),
    ],
)
def test_a_clock_on_the_wall_is_not_asked(name: str, cells: list[str]) -> None:
    (form,) = find_formats([name], [cells], None, "log.csv")
    assert form.text.startswith("HH:MM")


def test_behind_a_date_nothing_is_asked() -> None:
    forms = find_formats(["Date", "Time"], [["02.03.2026"] * 40, minutes(40)], None, "log.csv")
    assert [f.role for f in forms] == ["date", "time"]


def test_letters_of_minutes_and_seconds_are_minutes_and_seconds() -> None:
    form = declared_format("%M:%S")
    assert parse(["05:10", "75:00", "05:61"], form).tolist()[:2] == [310 * S, 4500 * S]
    assert parse_one("05:61", form) == parse_one("later", form)
    assert parse_one("05:10", declared_format("%H:%M")) == 18_600 * S
