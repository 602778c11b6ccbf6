"""Times of day of a sheet, and the date that stands above them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_sheets import sheet, workbook

DAY, HOUR, MINUTE = 46097, 1 / 24, 1 / 1440  # 2026-03-16, as a sheet counts
DATE, CLOCK, PLAIN = 4, 3, 0  # formats of cells
MIDNIGHT = int(np.datetime64("2026-03-16T00:00", "ns").astype(np.int64))
MINUTE_NS = 60 * 10**9


def rows(label: str, day: object, *, first: float = 8 * HOUR, texts: bool = False) -> list[list[Any]]:
    """50 rows of times of day, a minute apart, below a line with a date: a cell of a date, or a text."""
    head = [[label, day] if isinstance(day, str) else [f"{label}", None, None, day], ["Čas", "T1 [degC]"]]
    clocks = [first + k * MINUTE for k in range(50)]
    cells: list[Any] = [_text(c) if texts else c % 1 for c in clocks]
    return [*head, *([cell, 20.5 + k % 7] for k, cell in enumerate(cells))]


def _text(days: float) -> str:
    minutes = round(days * 1440) % 1440
    return f"{minutes // 60:02d}:{minutes % 60:02d}:00"


def read(folder: Path, sheets: dict[str, list[list[Any]]], zone: str = "UTC", **table: Any) -> Data:
    written = {name: sheet(cells, (CLOCK, PLAIN, PLAIN, DATE)) for name, cells in sheets.items()}
    path = workbook(folder / "a.xlsx", written)
    return load(Reader(), path, Source(timezone=zone, table=table or None))


@pytest.mark.parametrize("texts", [False, True])
@pytest.mark.parametrize(("label", "day"), [("Datum měření:", DAY), ("Data misure: 16/03/2026", ""), ("Date", DAY)])
def test_a_date_above_times_of_day_is_theirs(tmp_path: Path, label: str, day: object, texts: bool) -> None:
    data = read(tmp_path, {"data": rows(label, day, texts=texts)})
    assert data.recording.clock == "absolute"
    assert data.t_ns["table"].tolist() == [MIDNIGHT + (480 + k) * MINUTE_NS for k in range(50)]
    assert any("times of day are of the date that stands above" in n for n in data.recording.notes)
    assert not any("without a date" in n for n in data.recording.notes)


def test_times_of_day_below_a_date_go_on_over_midnight_and_over_the_change_of_daylight_saving(tmp_path: Path) -> None:
    data = read(tmp_path, {"data": rows("Datum měření:", DAY + 12, first=23.75 * HOUR)}, "Europe/Prague")
    first = MIDNIGHT + 12 * 1440 * MINUTE_NS + (22 * 60 + 45) * MINUTE_NS  # 2026-03-28 23:45 in Prague
    assert data.t_ns["table"].tolist() == [first + k * MINUTE_NS for k in range(50)]
    summer = read(tmp_path, {"data": rows("Datum měření:", DAY + 13, first=1.5 * HOUR)}, "Europe/Prague")
    before, behind = (
        summer.t_ns["table"][0],
        read(tmp_path, {"data": rows("Datum měření:", DAY + 13, first=3.5 * HOUR)}, "Europe/Prague").t_ns["table"][0],
    )
    assert behind - before == 60 * MINUTE_NS  # from 01:30 to 03:30 on the day on which the clock is put ahead


def test_what_is_declared_of_the_start_counts(tmp_path: Path) -> None:
    either = {"data": rows("Data misure: 03/04/2026", "")}
    for order, day in (("dmy", "2026-04-03"), ("mdy", "2026-03-04")):
        found = read(tmp_path, either, time={"start": order})
        assert found.recording.start_ns == int(np.datetime64(f"{day}T08:00", "ns").astype(np.int64))
    none = read(tmp_path, {"data": rows("Datum měření:", DAY)}, time={"start": "none"})
    assert none.recording.clock == "relative"
    with pytest.raises(FormatError, match="either way round"):
        read(tmp_path, either, time={"start": "head"})


def test_a_declared_start_that_finds_no_use_is_said(tmp_path: Path) -> None:
    dated: list[list[Any]] = [["time", "T1 [degC]"], *([f"2026-03-16 08:{k:02d}:00", 20.5] for k in range(50))]
    found = read(tmp_path, {"data": dated}, time={"start": "head"})
    assert any("time.start is not used" in n for n in found.recording.notes)
    bare = read(tmp_path, {"data": rows("Messstelle", "Halle 4")}, time={"start": "head"})
    assert any("no start stands above the rows" in n for n in bare.recording.notes)


@pytest.mark.parametrize("label", ["Kalibrierdatum", "Gültig bis", "Calibration date"])
def test_another_date_above_times_of_day_is_none_of_theirs(tmp_path: Path, label: str) -> None:
    assert read(tmp_path, {"data": rows(label, DAY)}).recording.clock == "relative"


def test_sheets_of_which_only_one_has_a_date_above_it_count_all_from_their_first_row(tmp_path: Path) -> None:
    data = read(tmp_path, {"a": rows("Datum měření:", DAY), "b": rows("Místo", "hala")})
    assert data.recording.clock == "relative"
    assert any("of no other" in n for n in data.recording.notes)


def test_durations_below_a_date_are_no_times_of_day(tmp_path: Path) -> None:
    assert read(tmp_path, {"data": rows("Datum měření:", DAY, first=0.0)}).recording.clock == "relative"


@pytest.mark.parametrize("blank", [True, False])
def test_blocks_beside_each_other_have_the_dates_of_their_titles(tmp_path: Path, blank: bool) -> None:
    between = [None] if blank else []
    one, other = (rows(f"Messung {day}", "") for day in ("16.03.2026", "18.03.2026"))
    beside = [[*a[:2], *between, *b[:2]] for a, b in zip(one, other, strict=True)]
    path = workbook(tmp_path / "a.xlsx", {"data": sheet(beside, (CLOCK, PLAIN, *([PLAIN] * blank), CLOCK, PLAIN))})
    data = load(Reader(), path, Source(timezone="UTC"))
    assert [t_ns[0] - MIDNIGHT for t_ns in data.t_ns.values()] == [480 * MINUTE_NS, (2 * 1440 + 480) * MINUTE_NS]
    assert data.recording.start_ns == MIDNIGHT + 480 * MINUTE_NS
    assert not any("another start" in note for note in data.recording.notes)
    one[0][0], other[0][0] = "Messung 16.03.2026", "Messung"  # one title alone dates nothing of the other's
    beside = [[*a[:2], *between, *b[:2]] for a, b in zip(one, other, strict=True)]
    path = workbook(tmp_path / "b.xlsx", {"data": sheet(beside, (CLOCK, PLAIN, *([PLAIN] * blank), CLOCK, PLAIN))})
    assert len({int(t_ns[0]) for t_ns in load(Reader(), path, Source(timezone="UTC")).t_ns.values()}) == 1


@pytest.mark.parametrize(
    ("one", "other", "days"),
    [
        ("Prova S4000  16/03/2026", "Prova S8000  18/03/2026", [0, 2]),
        ("Prova 1  16/03/2026", "Prova 2  18/03/2026", [0, 2]),
        ("Kalibriert 16.03.2026", "Kalibriert 18.03.2026", None),
    ],
)
def test_a_title_may_name_its_test_beside_the_date(
    tmp_path: Path, one: str, other: str, days: list[int] | None
) -> None:
    beside = [[*a[:2], None, *b[:2]] for a, b in zip(rows(one, ""), rows(other, ""), strict=True)]
    path = workbook(tmp_path / "a.xlsx", {"data": sheet(beside, (CLOCK, PLAIN, PLAIN, CLOCK, PLAIN))})
    data = load(Reader(), path, Source(timezone="UTC"))
    assert data.recording.clock == ("relative" if days is None else "absolute")
    if days is not None:
        firsts = [t_ns[0] - MIDNIGHT - 480 * MINUTE_NS for t_ns in data.t_ns.values()]
        assert firsts == [d * 1440 * MINUTE_NS for d in days]
