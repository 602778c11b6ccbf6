"""AM, PM, offsets and zones in cells of their own are part of the time beside them, or asked for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader import load

HOURS = [(11, "AM"), (12, "PM"), (1, "PM"), (2, "PM")]
NOON = np.datetime64("2026-03-14T11:00:00", "ns").astype(np.int64) + np.arange(12) * 1200 * 10**9


def written(tmp_path: Path, head: str, row: str, **said: object) -> list[int]:
    words = {"AM": ("vorm.", "dop.", "午前"), "PM": ("nachm.", "odp.", "午後")}
    rows = [
        row.format(h=h, m=m, half=half, de=words[half][0], cs=words[half][1], ja=words[half][2], T=f"{20 + m / 60:.2f}")
        for h, half in HOURS
        for m in (0, 20, 40)
    ]
    (tmp_path / "a.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC", table=said or None))
    ((_, name),) = data.values
    assert name == "T_front"
    return data.t_ns["table"].tolist()


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Date,Time,AM/PM,T_front", "3/14/2026,{h}:{m:02d}:00,{half},{T}"),
        ("Date;Time;;T_front", "3/14/2026;{h}:{m:02d}:00;{half};{T}"),
        ("Date Time AM/PM T_front", "3/14/2026 {h}:{m:02d}:00 {half} {T}"),
        ("Date Time T_front", "3/14/2026 {h}:{m:02d}:00 {half} {T}"),
        ("Timestamp T_front", "3/14/2026 {h}:{m:02d} {half} {T}"),
        ("Timestamp,AM/PM,T_front", "3/14/2026 {h}:{m:02d}:00,{half},{T}"),
        ("Date;Half;Time;T_front", "2026-03-14;{half};{h}:{m:02d}:00;{T}"),
        ("日付,午前/午後,時刻,T_front", "2026-03-14,{ja},{h}:{m:02d}:00,{T}"),
        ("Datum;Uhrzeit;Tageszeit;T_front", "14.03.2026;{h:02d}:{m:02d}:00;{de};{T}"),
        ("Datum;Čas;;T_front", "14.03.2026;{h:02d}:{m:02d}:00;{cs};{T}"),
    ],
)
def test_a_half_of_the_day_in_a_cell_of_its_own_is_part_of_the_time(tmp_path: Path, head: str, row: str) -> None:
    assert written(tmp_path, head, row) == NOON.tolist()


def test_times_of_day_alone_too(tmp_path: Path) -> None:
    found = written(tmp_path, "Time T_front", "{h}:{m:02d}:00 {half} {T}")
    assert found == (NOON - NOON[0]).tolist()


@pytest.mark.parametrize("form", [None, "mdy", "%m/%d/%Y %I:%M:%S %p"])
def test_declared_columns_say_the_same(tmp_path: Path, form: str | None) -> None:
    said = {"column": [1, 2, 3]} | ({} if form is None else {"format": form})
    found = written(tmp_path, "Date,Time,AM/PM,T_front", "3/14/2026,{h}:{m:02d}:00,{half},{T}", time=said)
    assert found == NOON.tolist()


def test_a_half_alone_is_no_time(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"reads none of the times|holds no times"):
        written(tmp_path, "Half,T_front", "{half},{T}", time={"column": 1, "format": "%p"})


def test_a_row_without_its_half_has_no_time(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(
        "Date,Time,AM/PM,T\n" + "".join(f"3/14/2026,1:{m:02d}:00,{'PM' if m != 5 else ''},{m}.5\n" for m in range(30))
    )
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert data.t_ns["table"].size == 29
    assert [loss.where for loss in data.losses] == ["a.csv line 7"]


def test_a_half_in_words_that_are_not_known_is_refused(tmp_path: Path) -> None:
    row = "2026-03-14;{h}:{m:02d}:00;p{half};{T}"
    with pytest.raises(FormatError) as refused:
        written(tmp_path, "Date;Time;AM/PM;T_front", row)
    assert refused.value.what == "a half of the day in words that are not known"
    assert "{time: {column: [1, 2]}}" in str(refused.value.hint)


ZONES = ["CEST", "+02:00", "+0200", "UTC+2", "(UTC+02:00)"]


@pytest.mark.parametrize("zone", ZONES)
@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Date;Time;TZ;T", "2026-07-14;08:{m:02d}:00;{z};{m}.5"),
        ("Stamp,UTC offset,T", "2026-07-14 08:{m:02d}:00,{z},{m}.5"),
    ],
)
def test_a_zone_in_a_cell_of_its_own_is_part_of_the_time(tmp_path: Path, zone: str, head: str, row: str) -> None:
    rows = [row.format(m=m, z=zone) for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join([head, *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source())
    assert data.t_ns["table"][0] == np.datetime64("2026-07-14T06:00:00", "ns").astype(np.int64)
    assert [name for _, name in data.values] == ["T"]
    assert not any("taken as UTC" in note for note in data.recording.notes)
    (noted,) = [note for note in data.recording.notes if "the zone in" in note]
    assert noted.endswith("is used, not the declared one")


@pytest.mark.parametrize(("name", "cells"), [("", ("CET",)), ("Zone", ("CET",)), ("UTC", ("Z",)), ("Zeitzone", ("Z",))])
def test_a_zone_is_taken_under_its_name_or_under_none(tmp_path: Path, name: str, cells: tuple[str, ...]) -> None:
    found, notes = beside(tmp_path, name, cells)
    assert found == ["T"]
    assert f"the zone in '{name or 'column 3'}' is used, not the declared one" in notes


@pytest.mark.parametrize(
    ("name", "cells"),
    [
        ("Axis", ("Z",)),
        ("", ("Z",)),
        ("Tool", ("EST",)),
        ("dX", ("+01:30",)),
        ("Offset", ("+0100",)),
        ("", ("+01:30", "-00:45")),
        ("TZ", ("+01:00", "+02:00", "+03:00")),
    ],
)
def test_a_channel_in_the_shape_of_a_zone_is_kept(tmp_path: Path, name: str, cells: tuple[str, ...]) -> None:
    found, notes = beside(tmp_path, name, cells)
    assert found == [name or "column 3", "T"]
    assert not any("the zone in" in note for note in notes)


def beside(tmp_path: Path, name: str, cells: tuple[str, ...]) -> tuple[list[str], tuple[str, ...]]:
    """The channels beside a time, and the notes."""
    rows = [f"2026-03-02;08:{m:02d}:00;{cells[m % len(cells)]};{m}.5" for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join([f"Date;Time;{name};T", *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="Europe/Prague"))
    return [channel for _, channel in data.values], data.recording.notes


def test_a_zone_that_changes_within_the_file_is_followed(tmp_path: Path) -> None:
    rows = [f"2026-10-25;02:{m % 60:02d}:00;{'CEST' if m < 60 else 'CET'};{m}.5" for m in range(120)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time;TZ;T", *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source())
    assert (np.diff(data.t_ns["table"]) == 60 * 10**9).all()


def test_a_zone_of_several_meanings_is_asked(tmp_path: Path) -> None:
    rows = [f"2026-07-14;08:{m:02d}:00;CST;{m}.5" for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time;TZ;T", *rows, ""]))
    with pytest.raises(QuestionError) as asked:
        load(Reader(), tmp_path / "a.csv", Source())
    assert "America/Chicago or Asia/Shanghai" in asked.value.ask
    load(Reader(), tmp_path / "a.csv", Source(timezone="Asia/Shanghai", table=asked.value.declare))


def test_numbers_beside_a_time_are_no_offset(tmp_path: Path) -> None:
    rows = [f"2026-07-14;08:{m:02d}:00;+{m:04d};{m}.5" for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join(["Date;Time;Z;T", *rows, ""]))
    assert [name for _, name in load(Reader(), tmp_path / "a.csv", Source()).values] == ["Z", "T"]


def test_days_of_ole_automation_are_those_of_a_sheet(tmp_path: Path) -> None:
    rows = [f"{46086 + m / 1440:.8f};{m}.5".replace(".", ",") for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join(["Data/Ora;T", "[OLE];°C", *rows, ""]))
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert data.recording.clock == "absolute"
    assert abs(data.t_ns["table"][0] - np.datetime64("2026-03-05", "ns").astype(np.int64)) < 10**6
