"""Dates that may be either way round are told by other files of their source, or by another source beside it; where
these do not agree, or nothing tells, they are asked."""

from __future__ import annotations

import os
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path, PurePosixPath

import pytest

from thermodata.draft.campaign.drafted_tests import _length_s
from thermodata.draft.campaign.parts import DraftSource
from thermodata.draft.files.described_file import sampled_file
from thermodata.draft.files.file_question import FileQuestion
from thermodata.draft.make import draft_files

ORDERS = {"dmy": "%d/%m/%Y", "mdy": "%m/%d/%Y"}


def log(path: Path, first: datetime, form: str, column: str = "T_bearing [degC],Z [um]") -> None:
    values = [",".join(f"{20 + k / 50 + i:.2f}" for i in range(column.count(",") + 1)) for k in range(120)]
    rows = [f"{first + timedelta(minutes=k):{form} %H:%M:%S},{v}" for k, v in enumerate(values)]
    path.write_text("\n".join([f"time,{column}", *rows, ""]), "utf-8")


def drafted(folder: Path) -> dict[str, DraftSource]:
    return {s.name: s for s in draft_files(folder).draft.sources}


@pytest.mark.parametrize("order", list(ORDERS))
def test_a_file_whose_day_leaves_no_choice_tells_that_of_the_others(tmp_path: Path, order: str) -> None:
    for name, day in (("a", 3), ("b", 4), ("c", 18)):
        log(tmp_path / f"{name}.csv", datetime(2025, 11, day, 8), ORDERS[order])
    made = draft_files(tmp_path)
    (source,) = made.draft.sources
    assert source.table == {"time": {"format": order}}
    said = f"dates {order}: c.csv can only be; a.csv, b.csv alone may be either"
    assert source.told == (said,)
    assert not any("dmy or mdy" in q for q in source.questions)
    (line,) = [x for x in made.campaign.read_text("utf-8").splitlines() if "files:" in x]
    assert line.endswith(said)


def test_files_that_can_only_be_one_and_only_the_other_leave_the_rest_open(tmp_path: Path) -> None:
    log(tmp_path / "a.csv", datetime(2025, 11, 3, 8), ORDERS["dmy"])
    log(tmp_path / "b.csv", datetime(2025, 11, 18, 8), ORDERS["dmy"])
    log(tmp_path / "c.csv", datetime(2025, 11, 19, 8), ORDERS["mdy"])
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"format": "unknown"}}
    (asked,) = [q for q in source.questions if "dmy or mdy" in q]
    assert asked.endswith("b.csv only dmy, c.csv only mdy: its files are of two sources, each with its format")


def test_where_nothing_tells_it_is_asked(tmp_path: Path) -> None:
    for name, day in (("a", 3), ("b", 4)):
        log(tmp_path / f"{name}.csv", datetime(2025, 11, day, 8), ORDERS["dmy"])
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"format": "unknown"}}
    assert source.told == ()


@pytest.mark.parametrize("order", list(ORDERS))
@pytest.mark.parametrize("agrees", [True, False])
def test_a_source_with_other_dates_tells_it_where_one_order_fits(tmp_path: Path, order: str, agrees: bool) -> None:
    for name, day in (("a", 3), ("b", 4)):
        first = datetime(2025, 11, day, 8)
        log(tmp_path / f"{name}_nc.csv", first, ORDERS[order])
        later = timedelta(hours=-1 if agrees else 24 * 400)
        log(tmp_path / f"{name}_daq.csv", first + later, "%Y-%m-%d", "Column [degC],Hall [degC]")
    found = drafted(tmp_path)
    (source,) = [s for s in found.values() if s.table]
    assert source.table == {"time": {"format": order if agrees else "unknown"}}
    (beside,) = [s.name for s in found.values() if not s.table]
    said = f"dates {order}: it fits the dates of '{beside}'; a_nc.csv, b_nc.csv alone may be either"
    assert source.told == ((said,) if agrees else ())


@pytest.mark.parametrize("order", list(ORDERS))
@pytest.mark.parametrize(("days", "told"), [(((3, 3), (3, 4)), True), (((3, 3), (4, 4)), False)])
def test_a_date_that_fits_both_ways_tells_nothing(
    tmp_path: Path, order: str, days: tuple[tuple[int, int], ...], told: bool
) -> None:
    """3 March is 03/03 either way; beside it another test does tell it."""
    for name, (month, day) in zip("abcd", days, strict=False):
        first = datetime(2026, month, day, 8)
        log(tmp_path / f"{name}_nc.csv", first, ORDERS[order])
        log(tmp_path / f"{name}_daq.csv", first, "%Y-%m-%d", "Column [degC],Hall [degC]")
    (source,) = [s for s in drafted(tmp_path).values() if s.table]
    assert source.table == {"time": {"format": order if told else "unknown"}}


@pytest.mark.parametrize("order", list(ORDERS))
@pytest.mark.parametrize(
    ("days", "asked"),
    [
        (((4, 3), (4, 5), (5, 4), (6, 8), (7, 18)), False),
        (((4, 3), (4, 5), (8, 5), (6, 8), (7, 18)), True),  # 5 August in the row of its names is 8 May
        (((4, 3), (4, 5), (11, 5), (6, 8), (7, 18)), True),
        (((4, 3), (8, 5), (4, 5), (3, 8), (7, 18)), False),  # they do not ascend anyway
        (((4, 5), (4, 5), (7, 18)), True),  # two at once: one may be of 4 May
        (((4, 4), (4, 4), (7, 18)), False),  # at once either way
        (((4, 5), (4, 5), (7, 18), (7, 18)), False),  # two loggers, in each test
    ],
)
def test_a_file_that_leaves_the_row_of_the_others_is_asked(
    tmp_path: Path, order: str, days: tuple[tuple[int, int], ...], asked: bool
) -> None:
    for name, (month, day) in zip("abcde", days, strict=False):
        log(tmp_path / f"{name}.csv", datetime(2025, month, day, 8, ord(name) % 7), ORDERS[order])
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"format": "unknown" if asked else order}}
    assert any("dmy or mdy" in q for q in source.questions) is asked


@pytest.mark.parametrize("order", list(ORDERS))
@pytest.mark.parametrize(
    ("written", "asked"),
    [
        (datetime(2025, 3, 2, 10, 30), False),  # right after its last row
        (datetime(2025, 2, 3, 10, 30), True),  # right after it the other way round
        (datetime(2025, 12, 24), False),  # copied later
        (datetime(2024, 12, 24), False),  # of a wrong clock: before its rows either way
    ],
)
def test_a_file_that_was_written_when_the_other_order_says_is_asked(
    tmp_path: Path, order: str, written: datetime, asked: bool
) -> None:
    log(tmp_path / "a.csv", datetime(2025, 3, 2, 8), ORDERS[order])
    log(tmp_path / "b.csv", datetime(2025, 3, 18, 8), ORDERS[order])
    seconds = written.replace(tzinfo=UTC).timestamp()
    os.utime(tmp_path / "a.csv", (seconds, seconds))
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"format": "unknown" if asked else order}}
    other = next(o for o in ORDERS if o != order)
    assert any(f"a.csv was last written when {other} says" in q for q in source.questions) is asked


@pytest.mark.parametrize("order", list(ORDERS))
@pytest.mark.parametrize(("name", "asked"), [("run_20250302", False), ("run_20250203", True), ("run_7", False)])
def test_a_day_in_the_name_that_only_the_other_order_has_is_asked(
    tmp_path: Path, order: str, name: str, asked: bool
) -> None:
    log(tmp_path / f"{name}.csv", datetime(2025, 3, 2, 8), ORDERS[order])
    log(tmp_path / "run_20250318.csv", datetime(2025, 3, 18, 8), ORDERS[order])
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"format": "unknown" if asked else order}}
    assert any(f"the day in the name of {name}.csv fits" in q for q in source.questions) is asked


def begun(path: Path, start: str) -> None:
    rows = [f"{k},{5 * k}.000,{0.01 * k:.3f},{20 + k / 100:.3f}" for k in range(120)]
    path.write_text("\n".join([f"Start Time,{start}", "Scan,Elapsed (s),Z drift (um),Bed (C)", *rows, ""]), "utf-8")


def test_am_and_pm_leave_day_and_month_of_a_start_open(tmp_path: Path) -> None:
    """British and Australian loggers write the day first with them."""
    begun(tmp_path / "a.csv", "03/06/2026 08:00:00 AM")
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"start": "unknown"}}
    (asked,) = [q for q in source.questions if "dmy or mdy" in q]
    assert asked.startswith("start: dmy or mdy? the head says 'Start Time: 03/06/2026 08:00:00 AM'")
    (tmp_path / "sure").mkdir()
    begun(tmp_path / "sure" / "a.csv", "13/06/2026 08:00:00 AM")
    (source,) = drafted(tmp_path / "sure").values()
    assert not source.table


@pytest.mark.parametrize("day", [3, 18])
def test_am_and_pm_of_dates_are_no_evidence(tmp_path: Path, day: int) -> None:
    log(tmp_path / "a.csv", datetime(2025, 11, day, 8), "%d/%m/%Y")
    log(tmp_path / "b.csv", datetime(2025, 11, 4, 8), "%d/%m/%Y")
    text = (tmp_path / "b.csv").read_text("utf-8").splitlines()
    stamped = [f"{t} AM,{rest}" for t, rest in (line.split(",", 1) for line in text[1:] if " 08:" in line)]
    (tmp_path / "b.csv").write_text("\n".join([text[0], *stamped, ""]), "utf-8")
    (source,) = drafted(tmp_path).values()
    assert source.table == {"time": {"format": "unknown" if day == 3 else "dmy"}}


def test_a_test_over_midnight_has_no_length_while_its_days_are_asked(tmp_path: Path) -> None:
    log(tmp_path / "a.csv", datetime(2025, 11, 16, 23, 30), ORDERS["mdy"])
    log(tmp_path / "b.csv", datetime(2025, 11, 16, 8), ORDERS["mdy"])
    over, within = (sampled_file(tmp_path, PurePosixPath(name)) for name in ("a.csv", "b.csv"))
    assert over is not None
    assert within is not None
    order = FileQuestion("format of the dates: dmy or mdy?", {"time": {"format": "unknown"}})
    asked, asked_within = replace(over, asked=(order,)), replace(within, asked=(order,))
    assert _length_s([[asked]], None) is None
    assert _length_s([[asked], [over]], None) == 119 * 60.0, "by the log whose days are known"
    assert _length_s([[asked_within]], None) == 119 * 60.0
    assert _length_s([[replace(over, asked=(replace(order, told=True),))]], None) == 119 * 60.0
