"""Rows with two times: which of them they stand at is told until one is declared."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.plugin import Source
from thermodata.reader.text import delimited

BEGAN = datetime(2026, 3, 12, 8)


def _written(folder: Path, head: str, shift_s: int, form: str = "%d.%m.%Y %H:%M:%S") -> Path:
    """Rows of 60 s whose second time is by shift_s after the first."""
    starts = [BEGAN + timedelta(minutes=k) for k in range(40)]
    rows = [
        f"{t:{form}};{t + timedelta(seconds=shift_s):{form}};{20 + k / 9:.2f};{20 + k / 7:.2f}"
        for k, t in enumerate(starts)
    ]
    (folder / "a.csv").write_text("\n".join([f"{head};T1 [degC];T2 [degC]", *rows, ""]))
    return folder / "a.csv"


def _notes(path: Path, column: int | None = None) -> list[str]:
    source = Source(timezone="UTC", table={"time": {"column": column}} if column else None)
    return [n for n in delimited.open_table(path, source).notes if "which one is it?" in n]


@pytest.mark.parametrize(
    ("head", "shift_s", "which"),
    [
        ("Ende;Start", -60, "end, 'Ende'"),
        ("Start;Ende", 60, "beginning, 'Start'"),
        ("time;time 2", 60, "beginning, 'time'"),
        ("von;bis", 50, "beginning, 'von'"),
    ],
)
def test_rows_from_one_time_to_another_say_at_which_they_stand(
    tmp_path: Path, head: str, shift_s: int, which: str
) -> None:
    path = _written(tmp_path, head, shift_s)
    (note,) = _notes(path)
    assert f"it stands at its {which}" in note
    assert not _notes(path, 1)
    assert not _notes(path, 2)


@pytest.mark.parametrize(("head", "shift_s"), [("time;time of the control", 1), ("time;UTC time", -3600)])
def test_two_clocks_of_one_row_are_no_interval(tmp_path: Path, head: str, shift_s: int) -> None:
    assert not _notes(_written(tmp_path, head, shift_s))


@pytest.mark.parametrize(
    ("head", "row", "declared"),
    [
        ("Datum;Start;Ende", "12.03.2026;{0:%H:%M:%S};{1:%H:%M:%S}", "[1, 2]}} or [1, 3]"),
        ("Start;Ende", "{0:%H:%M:%S};{1:%H:%M:%S}", "1}} or 2"),
        ("Datum;Start;Datum Ende;Ende", "12.03.2026;{0:%H:%M:%S};12.03.2026;{1:%H:%M:%S}", "[1, 2]}} or [3, 4]"),
        ("Start;Ende", "{0:%d.%m.%Y %H:%M:%S};{1:%H:%M:%S}", "1}}"),
        ("Start;Ende", "{0:%d.%m.%Y %H:%M:%S};{1:%d.%m.%Y %H:%M:%S}", "1}} or 2"),
    ],
)
def test_what_is_to_be_declared_keeps_the_date(tmp_path: Path, head: str, row: str, declared: str) -> None:
    starts = [BEGAN + timedelta(minutes=k) for k in range(40)]
    rows = [row.format(t, t + timedelta(minutes=1)) + f";{20 + k / 9:.2f}" for k, t in enumerate(starts)]
    (tmp_path / "a.csv").write_text("\n".join([f"{head};T1 [degC]", *rows, ""]))
    (note,) = _notes(tmp_path / "a.csv")
    assert note.endswith("declare table: {time: {column: " + declared)


def test_the_declared_end_of_a_row_has_its_date(tmp_path: Path) -> None:
    starts = [BEGAN + timedelta(minutes=k) for k in range(40)]
    rows = [f"12.03.2026;{t:%H:%M:%S};{t + timedelta(minutes=1):%H:%M:%S};{20 + t.minute / 9:.2f}" for t in starts]
    (tmp_path / "a.csv").write_text("\n".join(["Datum;Start;Ende;T1 [degC]", *rows, ""]))
    source = Source(timezone="UTC", table={"time": {"column": [1, 3]}})
    table = delimited.open_table(tmp_path / "a.csv", source)
    began = delimited.describe(table, source).start_ns
    assert began == int((BEGAN + timedelta(minutes=1)).replace(tzinfo=UTC).timestamp()) * 10**9


def test_a_draft_asks_which_it_is(tmp_path: Path) -> None:
    _written(tmp_path, "Ende;Start", -60)
    draft_files(tmp_path)
    assert "from 'Start' to 'Ende': it stands at its end" in (tmp_path / "campaign.yaml").read_text("utf-8")
