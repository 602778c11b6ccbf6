"""Times of day in halves and in East Asian words, and days whose rows nothing tells apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.time_formats import find_format

DAY = "2026-03-22"


@pytest.mark.parametrize(
    ("cells", "clocks"),
    [
        (["8:00:00 a. m.", "12:30:00 p. m.", "12:05:00 a. m."], ["08:00:00", "12:30:00", "00:05:00"]),
        (["08:00:00 a.m.", "01:00:00 p.m."], ["08:00:00", "13:00:00"]),
        (["8:00:00\u00a0a.\u00a0m.", "1:30:00\u202fp.\u202fm."], ["08:00:00", "13:30:00"]),
        (["AM 08:00:00", "PM 01:00:00"], ["08:00:00", "13:00:00"]),
        (["8:00:00 vorm.", "1:30:00 nachm."], ["08:00:00", "13:30:00"]),
        (["8:00:00 vormittags", "1:30:00 nachmittags"], ["08:00:00", "13:30:00"]),
        (["上午 7:00:00", "下午 12:30:00"], ["07:00:00", "12:30:00"]),
        (["午前0:30:00", "午後0:30:00", "午後 11:00:00"], ["00:30:00", "12:30:00", "23:00:00"]),
        (["오전 9:00:00", "오후 9:00:00"], ["09:00:00", "21:00:00"]),
        (["07時00分00秒", "23時59分01秒"], ["07:00:00", "23:59:01"]),
    ],
)
def test_a_half_day_and_words_for_the_hour_are_read_alone_and_behind_a_date(
    cells: list[str], clocks: list[str]
) -> None:
    for day in ("", "2026/03/22 ", "22/03/2026 ", "2026年03月22日 "):
        whole = [day + c for c in cells]
        form = find_format(whole, "here")
        wanted = [np.datetime64(f"{DAY if day else '1970-01-01'}T{c}", "ns").astype(np.int64) for c in clocks]
        assert timestamp.parse(whole, form).tolist() == wanted
        assert [timestamp.parse_one(c, form) for c in whole] == wanted


@pytest.mark.parametrize("cells", [["13:00:00 p. m."], ["0:30:00 a. m."], ["中午 12:00:00"], ["12:30:00 m."]])
def test_what_is_no_hour_of_a_half_day_is_no_time(cells: list[str]) -> None:
    with pytest.raises(FormatError):
        find_format(cells, "here")


def test_p_m_with_a_blank_does_not_say_that_the_month_comes_first() -> None:
    with pytest.raises(QuestionError, match="day and month"):
        find_format(["02/03/2026 7:00:00 p. m."], "here")


@pytest.mark.parametrize("cell", ["R8/03/22 07:00:00", "R8.3.22 7:00:00", "令和8年3月22日 07時00分00秒"])
def test_years_of_an_emperor(cell: str) -> None:
    wanted = [np.datetime64(f"{DAY}T07:00", "ns").astype(np.int64)]
    form = find_format([cell], "here")
    assert [timestamp.parse_one(cell, form)] == timestamp.parse([cell], form).tolist() == wanted


def read(folder: Path, rows: list[str]) -> list[int]:
    path = folder / "a.csv"
    path.write_text("\n".join([*rows, ""]), "utf-8")
    table = delimited.open_table(path, Source())
    found = delimited.blocks(path, table, Source())
    return [int(t) for b in found if isinstance(b, Block) for t in b.t_ns]


def test_a_spanish_clock_in_a_column_of_its_own_is_joined_to_its_day(tmp_path: Path) -> None:
    rows = [
        f"22/03/2026;{(i // 6) % 12 or 12:02d}:{10 * (i % 6):02d}:00 {'ap'[i // 72]}. m.;2{i % 9}.5;1"
        for i in range(144)
    ]
    t_ns = read(tmp_path, ["Fecha;Hora;T1 [°C];n", *rows])
    start = np.datetime64(f"{DAY}T00:00", "ns").astype(np.int64)
    assert t_ns == [int(start) + i * 600 * 10**9 for i in range(144)]


@pytest.mark.parametrize(("clock", "asked"), [("viertel {}", True), ("{}", False), ("ok", False)])
def test_days_of_many_rows_beside_an_unread_text_are_asked(tmp_path: Path, clock: str, asked: bool) -> None:
    rows = ["Fecha;Hora;T1 [°C];n", *(f"22/03/2026;{clock.format(i)};2{i % 9}.5;1" for i in range(60))]
    rows += [r.replace("22/03", "23/03") for r in rows[1:]]
    if not asked:
        assert len(read(tmp_path, rows)) == 120
        return
    with pytest.raises(QuestionError, match="beside 'Hora'") as question:
        read(tmp_path, [*rows[:61], *(r.replace("viertel ", "viertel 1") for r in rows[61:])])
    assert question.value.declare == {"time": {"column": [1, 2], "format": "unknown"}}


@pytest.mark.parametrize(
    ("head", "cell", "time"),
    [
        ("Part", "P-{0:04d}", {"period": "unknown"}),
        ("Part", "12-{0}", {"period": "unknown"}),
        ("Logged", "{1:02d}h{2:02d}", {"column": [1, 2], "format": "unknown"}),
        ("Zeit", "Takt {0}", {"column": [1, 2], "format": "unknown"}),
    ],
)
def test_only_what_looks_like_a_time_is_offered_beside_days(
    tmp_path: Path, head: str, cell: str, time: dict[str, object]
) -> None:
    rows = [f"0{2 + i // 20}.03.2026;{cell.format(i, i // 60 + 8, i % 60)};2{i % 9}.5" for i in range(120)]
    with pytest.raises(QuestionError, match="dates without a time of day") as question:
        read(tmp_path, [f"Date;{head};T1 [°C]", *rows])
    assert question.value.declare == {"time": time}
