"""Times that are counts of small units since a date, and dates and times of day in one number each."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import QuestionError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata.reader.text import delimited

SEVEN = 1772434800 * 10**9  # 2026-03-02 07:00 UTC


def read(folder: Path, rows: list[str], source: Source) -> tuple[Recording, list[int], list[Loss]]:
    path = folder / "a.csv"
    path.write_text("\n".join([*rows, ""]))
    table = delimited.open_table(path, source)
    parts = list(delimited.blocks(path, table, source))
    times = [int(t) for b in parts if isinstance(b, Block) for t in b.t_ns]
    return delimited.describe(table, source), times, [p for p in parts if isinstance(p, Loss)]


@pytest.mark.parametrize(
    ("first", "each_ns"),
    [(SEVEN + 7, 1), (116444736000000000 + SEVEN // 100, 100), (621355968000000000 + SEVEN // 100, 100)],
)
def test_counts_too_long_for_a_float_are_read_exactly(tmp_path: Path, first: int, each_ns: int) -> None:
    counts = [str(first + i * 10**9 // each_ns + i) for i in range(60)]
    counts[20], counts[21] = "", "torn"
    rows = ["Time,T1 [degC],n", *(f"{c},2{i % 9}.5,{i}" for i, c in enumerate(counts))]
    said, times, losses = read(tmp_path, rows, Source())
    start = SEVEN + first % 10 * (each_ns == 1)
    assert said.clock == "absolute"
    assert times == [start + i * (10**9 + each_ns) for i in range(60) if i not in (20, 21)]
    assert [loss.where for loss in losses] == ["a.csv line 22", "a.csv line 23"]


def test_ticks_are_in_the_time_of_the_place(tmp_path: Path) -> None:
    ticks = [621355968000000000 + (SEVEN + i * 10**9) // 100 for i in range(60)]
    rows = ["Time,T1 [degC],n", *(f"{c},2{i % 9}.5,{i}" for i, c in enumerate(ticks))]
    assert "no time zone declared: times are taken as UTC" in read(tmp_path, rows, Source())[0].notes
    assert read(tmp_path, rows, Source(timezone="Europe/Prague"))[1][0] == SEVEN - 3600 * 10**9


@pytest.mark.parametrize(("width", "letters"), [(6, "%H%M%S"), (4, "%H%M")])
def test_a_date_and_a_time_of_day_in_one_number_each_are_offered(tmp_path: Path, width: int, letters: str) -> None:
    clocks = [f"07{i:02d}00"[:width] for i in range(60)]
    rows = ["Date,Time,T1 [degC]", *(f"20260302,{c},2{i % 9}.5" for i, c in enumerate(clocks))]
    with pytest.raises(QuestionError) as asked:
        read(tmp_path, rows, Source())
    assert asked.value.declare == {"time": {"column": [1, 2], "format": f"%Y%m%d {letters}"}}
    assert read(tmp_path, rows, Source(table=asked.value.declare))[1] == [SEVEN + i * 60 * 10**9 for i in range(60)]
    with pytest.raises(QuestionError, match="no unit"):
        read(tmp_path, [r.replace(",07", ",77") for r in rows], Source())


@pytest.mark.parametrize("word", ["epoch", "unix time"])
@pytest.mark.parametrize("each_ns", [10**9, 10**6, 10**3])
@pytest.mark.parametrize("declared", [False, True])
def test_an_epoch_is_in_what_its_size_says(tmp_path: Path, word: str, each_ns: int, declared: bool) -> None:
    head = "Time" if declared else f"Time [{word}]"
    rows = [f"{head};T1 [degC]", *(f"{(SEVEN + i * 10**9) // each_ns};2{i % 9}.5" for i in range(60))]
    source = Source(table={"time": {"column": 1, "unit": word}} if declared else None)
    said, times, losses = read(tmp_path, rows, source)
    assert (said.clock, losses) == ("absolute", [])
    assert times == [SEVEN + i * 10**9 for i in range(60)]
    assert any("by its size it is unix" in note for note in said.notes)


def test_an_epoch_of_no_size_is_asked(tmp_path: Path) -> None:
    rows = ["Time [epoch];T1 [degC]", *(f"{i * 10};2{i % 9}.5" for i in range(60))]
    with pytest.raises(QuestionError) as asked:
        read(tmp_path, rows, Source())
    assert asked.value.declare == {"time": {"unit": "unknown"}}
    assert read(tmp_path, rows, Source(table={"time": {"column": 1, "unit": "s"}}))[0].clock == "relative"
