"""A log that goes on under a header with its columns in another order, or with more of them: read on by the names."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.reader.text.file.lines import chunks
from thermodata.testing.reader import Data, load

HEAD = ("Time", "T_front", "dZ", "state")


def cells(k: int) -> dict[str, str]:
    at = f"2026-03-{2 + k // 36000:02d} {8 + k // 3600 % 10:02d}:{k // 60 % 60:02d}:{k % 60:02d}"
    return {"Time": at, "T_front": f"{20 + k / 1000:.3f}", "dZ": f"{-k}", "state": "on" if k % 2 else "off", "": "9"}


def log(*parts: tuple[Sequence[str], int]) -> str:
    """Parts of a log, each with its header and how many rows it has, one behind the other."""
    lines, k = list[str](), 0
    for head, rows in parts:
        lines.append(",".join(head))
        for _ in range(rows):
            row = cells(k)
            lines.append(",".join(row.get(name.split(" [")[0], "7") for name in head))
            k += 1
    return "\n".join([*lines, ""])


def read(tmp_path: Path, text: str) -> Data:
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    return load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))


def holds_all(data: Data, rows: int) -> None:
    assert data.t_ns["table"].size == rows
    for name in HEAD[1:]:
        got = data.values["table", name].tolist()
        expected = [cells(k)[name] for k in range(rows)]
        assert got == (expected if name == "state" else [float(c) for c in expected])


MOVED = ("Time", "dZ", "state", "T_front")


@pytest.mark.parametrize("sizes", [(40, 40), (700, 30), (3, 700), (3000, 60_000)])
def test_columns_in_another_order_are_read_on_by_their_names(tmp_path: Path, sizes: tuple[int, int]) -> None:
    data = read(tmp_path, log((HEAD, sizes[0]), (MOVED, sizes[1])))
    holds_all(data, sum(sizes))
    assert not data.losses


def test_the_first_order_may_come_again_and_headers_may_repeat(tmp_path: Path) -> None:
    data = read(tmp_path, log((HEAD, 30), (MOVED, 10), (MOVED, 10), (HEAD, 10), (HEAD, 10), (MOVED, 1), (HEAD, 1)))
    holds_all(data, 72)
    assert not data.losses


@pytest.mark.parametrize("size", [64, 500, 4000])
def test_a_header_may_stand_where_a_part_of_the_file_begins(
    tmp_path: Path, size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("thermodata.reader.text.delimited.chunks", partial(chunks, size=size))
    holds_all(read(tmp_path, log((HEAD, 30), (MOVED, 30), (HEAD, 30), (MOVED, 30))), 120)


@pytest.mark.parametrize("more", [(*HEAD, "T_hall"), ("Time", "T_hall", "dZ", "T_front", "state")])
@pytest.mark.parametrize("rows", [20, 700])
def test_a_column_more_is_told_as_not_read_and_the_others_go_on(
    tmp_path: Path, more: tuple[str, ...], rows: int
) -> None:
    data = read(tmp_path, log((HEAD, rows), (more, 50), (HEAD, 50)))
    holds_all(data, rows + 100)
    (loss,) = data.losses
    assert loss.where == f"a.csv line {rows + 2}"
    assert loss.reason == (
        "columns begin here that the first header does not name, they are not read: 'T_hall'; split the file there"
    )


def test_a_row_below_is_held_against_its_own_header(tmp_path: Path) -> None:
    """One with as many cells as the first header is damaged where the second has more."""
    text = log((HEAD, 20), ((*HEAD, "T_hall"), 20)).splitlines()
    text[30] = text[30].rpartition(",")[0]
    data = read(tmp_path, "\n".join([*text, ""]))
    assert data.t_ns["table"].size == 39
    assert [loss.reason for loss in data.losses][1].startswith("expected 5 cells, got 4")
    text[30] += ",,"
    data = read(tmp_path, "\n".join([*text, ""]))
    assert data.t_ns["table"].size == 39


@pytest.mark.parametrize(("below", "size"), [("°C,µm", 60), ("degC,um", 60), ("µm,°C", 30), ("°C,mm", 30), (None, 60)])
def test_units_below_the_names_have_moved_with_them(tmp_path: Path, below: str | None, size: int) -> None:
    rows = [f"2026-03-02 {h:02d}:{m:02d}:00,{a},{b}" for h, a, b in ((8, 21, 0.5), (9, 0.5, 21)) for m in range(10, 40)]
    again = ["Time,dZ,T_front", *([",".join(["", *reversed(below.split(","))])] if below else [])]
    data = read(tmp_path, "\n".join(["Time,T_front,dZ", ",°C,µm", *rows[:30], *again, *rows[30:], ""]))
    assert data.t_ns["table"].size == size
    assert {*data.values["table", "T_front"].tolist()} == {21.0}
    assert len(data.losses) == (size == 30)


@pytest.mark.parametrize(
    ("first", "again", "size"),
    [
        (("Time", "T_front [°C]", "dZ [µm]"), ("Time", "dZ [um]", "T_front [degC]"), 60),
        (("Time", "T_front [°C]", "dZ [µm]"), ("Time", "dZ [mm]", "T_front [degC]"), 30),
        (("Time", "T_front [°C]", "dZ [µm]"), ("Time", "dZ", "T_front"), 60),
        (("Time", "T_front", "dZ"), ("Time", "dZ [mm]", "T_front"), 30),
        (("Time", "T_front", "dZ", "n"), ("Time", "n", "dZ", "T_front", "n"), 30),
        (("Time", "T_front", "dZ", "n"), ("Time", "n", "dZ", "T_front", "n2"), 60),
    ],
)
def test_a_unit_or_a_name_that_is_not_sure_ends_the_reading(
    tmp_path: Path, first: tuple[str, ...], again: tuple[str, ...], size: int
) -> None:
    data = read(tmp_path, log((first, 30), (again, 30)))
    assert data.t_ns["table"].size == size


def test_one_column_more_where_rows_count_from_a_start_ends_the_reading(tmp_path: Path) -> None:
    """Rows of another width don't show whether they count from the same start."""
    head = "Start: 2026-03-02 08:00:00\n"
    rows = [f"{k},2{k % 9}.5,0.{k}" for k in range(10, 40)]
    more = [f"{row},7" for row in rows]
    again = "Start: 2026-03-02 12:00:00"
    text = "\n".join(["t [s],T_front,dZ", *rows, again, "t [s],T_front,dZ,T_hall", *more, ""])
    (tmp_path / "a.csv").write_text(head + text, encoding="utf-8")
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    (times,) = data.t_ns.values()
    assert times.size == 30
    assert any("another header" in loss.reason for loss in data.losses)


def test_after_twenty_changes_of_the_order_reading_ends_and_says_so(tmp_path: Path) -> None:
    """Each has all rows behind it parsed anew: a file of nothing but headers took minutes."""
    turns = [(MOVED if k % 2 else HEAD, 4) for k in range(22)]
    whole = read(tmp_path, log(*turns[:21]))
    holds_all(whole, 84)
    assert not whole.losses
    data = read(tmp_path, log(*turns))
    holds_all(data, 84)
    [loss] = data.losses
    assert "named in another order here, as 20 times before, reading ends: split the file there" in loss.reason
    assert "line 106" in loss.where or loss.where.endswith("106")
