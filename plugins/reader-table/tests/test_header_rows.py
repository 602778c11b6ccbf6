"""Rows above a table that say what its columns are: units above the names, statistics of channels, units alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source

from .test_loggers import STAMPS, read


def test_a_row_that_is_called_unit_above_the_names_is_one_of_units(tmp_path: Path) -> None:
    """FANUC's Servo Guide: its first cell is what the row is called, and no unit of the time."""
    path = tmp_path / "guide.csv"
    head = ["Kind,SPEED,THERM", "Unit,min-1,degC", "", "Time(s),SPEED(SP1),THERM(Z)"]
    path.write_text("\n".join([*head, *(f"{10 * i}.000,{i % 3}000,{20 + i / 10}" for i in range(40)), ""]))
    assert read(path)[0] == {"SPEED(SP1)": "min-1", "THERM(Z)": "degC"}
    assert Reader().describe(path, Source()).clock == "relative"


def test_a_unit_row_leaves_the_unit_of_a_time_open(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{i},{20 + i / 10}" for i in range(40)]
    path.write_text("\n".join(["Time,T1", "Einheit,degC", *rows, ""]))
    with pytest.raises(QuestionError, match="has no unit"):
        read(path)
    path.write_text("\n".join(["Time,T1", "min,degC", *rows, ""]))
    assert read(path)[0] == {"T1": "degC"}


@pytest.mark.parametrize("tags", ['"Tag","","","spindle","spindle","bed","bed"', '"Tag","","","spindle","","bed",""'])
def test_minimum_and_maximum_of_channels_whose_names_stand_twice(tmp_path: Path, tags: str) -> None:
    path = tmp_path / "gx.csv"
    head = [
        '"Model","GX20-1E"',
        '"Ch.","","","CH0001","CH0001","CH0002","CH0002"',
        tags,
        '"","","","MIN","MAX","MIN","MAX"',
        '"Unit","","","C","C","um","um"',
        '"Date","Time","ms","","","",""',
    ]
    rows = [f"{t[:10]},{t[11:]},250,{20 + i}.5,{21 + i}.5,{30 + i}.5,{31 + i}.5" for i, t in enumerate(STAMPS)]
    path.write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    units, values = read(path)
    assert units == {"spindle/MIN": "C", "spindle/MAX": "C", "bed/MIN": "um", "bed/MAX": "um"}
    assert values["bed/MIN"][:2].tolist() == [30.5, 31.5]
    assert [s.properties.get("description") for s in Reader().describe(path, Source()).signals][::2] == [
        "CH0001",
        "CH0002",
    ]


def test_a_unit_alone_below_a_name_is_its_unit(tmp_path: Path) -> None:
    path = tmp_path / "sonda.csv"
    head = ["Date;Time;Sonda Z;Sensor;Sensor", ";;[mV];bearing [°C];column [°C]"]
    rows = [f"{t[:10]};{t[11:]};{-5 + i}.5;{20 + i}.5;{30 + i}.5" for i, t in enumerate(STAMPS)]
    path.write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    assert read(path)[0] == {"Sonda Z [mV]": "mV", "bearing [°C]": "°C", "column [°C]": "°C"}


def test_names_that_repeat_and_are_no_statistics_are_numbered_as_before(tmp_path: Path) -> None:
    path = tmp_path / "again.csv"
    head = ["Device,GX,GX,GY,GY", "x,,,,", "Time [s],front,front,rear,rear"]
    path.write_text("\n".join([*head, *(f"{i},{20 + i}.5,21.5,22.5,23.5" for i in range(40)), ""]))
    assert list(read(path)[0]) == ["front", "front#2", "rear", "rear#2"]


@pytest.mark.parametrize("line", ["%% columns:", "# data columns", "% Spalten :", "Messwerte der Spalten:", ""])
def test_a_line_that_announces_the_names_is_no_head_of_groups(tmp_path: Path, line: str) -> None:
    path = tmp_path / "drift.txt"
    rows = [f"   {20 * i}.0   0.{i % 9}00   0.{i % 7}10   26.{i:02d}" for i in range(40)]
    path.write_text("\n".join(["%% start: 2026-05-06 08:00:00", line, "t[s] dX[um] dY[um] Tair[C]", *rows, ""]))
    assert read(path)[0] == {"dX[um]": "um", "dY[um]": "um", "Tair[C]": "C"}
    assert not any(p for s in Reader().describe(path, Source()).signals for p in s.properties)


@pytest.mark.parametrize(
    ("lines", "unit"),
    [
        (["%% columns: t[s]  dX[um]  dY[um]  Tair[C]"], "um"),
        (["# Data columns: t[s]  dX[um]  dY[um]  Tair[C]"], "um"),
        (["Spalten:\tt[s]\tdX[um]\tdY[um]\tTair[C]"], "um"),
        (["%% columns: t  dX[um]  dY[um]  Tair[C]", "%% units: s um um C"], "um"),
    ],
)
def test_what_a_row_of_names_is_called_names_no_column(tmp_path: Path, lines: list[str], unit: str) -> None:
    path, mark = tmp_path / "drift.txt", "\t" if "\t" in lines[0] else "   "
    rows = [mark.join((f"{20 * i}.0", f"0.{i % 9}00", f"0.{i % 7}10", f"26.{i:02d}")) for i in range(40)]
    path.write_text("\n".join(["%% start: 2026-05-06 08:00:00", *lines, *rows, ""]))
    assert read(path)[0] == {"dX[um]": unit, "dY[um]": unit, "Tair[C]": "C"}


def test_other_lines_with_a_label_stay_lines(tmp_path: Path) -> None:
    path = tmp_path / "drift.txt"
    rows = [f"   {20 * i}.0   0.{i % 9}00   0.{i % 7}10" for i in range(40)]
    path.write_text("\n".join(["%% machine: MC7 hall two", "t[s] dX[um] dY[um]", *rows, ""]))
    assert read(path)[0] == {"dX[um]": "um", "dY[um]": "um"}


def test_heads_behind_the_mark_of_a_comment_stay_heads(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{20 * i}.0;2{i % 9}.5;21.{i % 7};26.{i:02d};22.5" for i in range(40)]
    path.write_text("\n".join(["#;Spindle;;Table;", "t [s];T1 [C];T2 [C];T1 [C];T2 [C]", *rows, ""]))
    assert sorted(read(path)[0]) == ["Spindle/T1 [C]", "Spindle/T2 [C]", "Table/T1 [C]", "Table/T2 [C]"]
