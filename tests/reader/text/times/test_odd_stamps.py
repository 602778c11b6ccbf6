"""Formats that are guessed: the one that fits, and none where two do, or a part is not understood."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.reader.text.cells.time_forms.time_pattern import declared_format
from thermodata.reader.text.page.first_data import is_data
from thermodata.reader.text.tables.find_table import open_table
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.one_cell.odd_stamps import guess_format

FIRST = datetime(2026, 3, 2, 8)
STEP = timedelta(minutes=5)


def stamps(form: str, step: timedelta) -> list[str]:
    return [f"{FIRST + i * step:{form}}" for i in range(100)]


@pytest.mark.parametrize("step", [timedelta(seconds=10), timedelta(hours=10)])
@pytest.mark.parametrize(
    "form",
    [
        "%d-%b-%Y %H:%M:%S",
        "%d. %B %Y %H:%M:%S",
        "%b %d, %Y %H:%M:%S",
        "%a %b %d %H:%M:%S %Y",
        "%a %d.%m.%Y %H:%M:%S",
        "%Y%m%d%H%M%S",
        "%Y%m%d_%H%M",
        "%Y%m%d",
        "%Y_%m_%d_%H_%M_%S",
        "%Y-%m-%d %H-%M-%S",
        "%d.%m.%Y %H.%M.%S,%f",
        "%d-%b-%y %I.%M.%S.%f %p",
        "%Y %m %d %H:%M",
    ],
)
def test_the_format_that_fits_all_stamps(form: str, step: timedelta) -> None:
    assert guess_format(stamps(form, step)) == form


@pytest.mark.parametrize(
    "form",
    [
        "%Y-%m-%d %H:%M:%S XYZ",
        "%d. Monat %Y %H:%M",
        "%H:%M:%S %d-%m-26",
        "%Y%m%d-0800",
        "%Y-%j",
        "%H%M%S",
        "%S:%M",
        "x%d",
    ],
)
def test_none_where_a_part_is_not_understood(form: str) -> None:
    assert guess_format(stamps(form, timedelta(hours=1))) is None


def test_day_and_month_are_told_by_the_numbers_or_not_at_all() -> None:
    assert guess_format(stamps("%d/%m/%Y %H-%M", timedelta(seconds=10))) is None
    assert guess_format(stamps("%d/%m/%Y %H-%M", timedelta(days=1))) == "%d/%m/%Y %H-%M"
    assert guess_format(stamps("%m/%d/%Y %H-%M", timedelta(days=1))) == "%m/%d/%Y %H-%M"


def test_one_that_fits_too_few_is_none() -> None:
    some = stamps("%d-%b-%Y %H:%M:%S", timedelta(hours=1))
    assert guess_format([*some[:80], *["---"] * 20]) is None
    assert guess_format([]) is None


@pytest.mark.parametrize(
    ("zone", "hours", "gap"),
    [(" EDT", -4, " "), (" CEST", 2, " "), ("+01:00", 1, ""), (" UTC", 0, " "), (" +2", 2, " ")],
)
def test_a_zone_behind_the_time_of_day_is_one(zone: str, hours: float, gap: str) -> None:
    cells = stamps(f"%d-%b-%y %I:%M:%S %p{zone}", timedelta(minutes=5))
    form = guess_format(cells)
    assert form == f"%d-%b-%y %I:%M:%S %p{gap}%z"
    read = timestamp.parse(cells, declared_format(form))
    assert read[0] == (round(FIRST.replace(tzinfo=UTC).timestamp()) - round(hours * 3600)) * 10**9
    assert set(np.diff(read).tolist()) == {300 * 10**9}


def test_a_table_of_few_numbers_whose_dates_name_their_month_is_asked_for_their_format(tmp_path: Path) -> None:
    rows = [f"{cell} EDT,{{ }},{{ok}},{70 + k / 8}" for k, cell in enumerate(stamps("%d-%b-%y %I:%M:%S %p", STEP))]
    (tmp_path / "hall.csv").write_text("\n".join(["history:/HMC/Hall", "Timestamp,Flags,Status,Value", *rows, ""]))
    with pytest.raises(QuestionError) as asked:
        open_table(tmp_path / "hall.csv", Source())
    assert "%d-%b-%y %I:%M:%S %p %z?" in (asked.value.ask or "")
    opened = open_table(tmp_path / "hall.csv", Source(table=asked.value.declare))
    assert opened is not None


@pytest.mark.parametrize("cell", ["12 abc", "Heat 12 Mar", "12-Mar-26", "12 parts 24 x"])
def test_other_words_make_no_row_of_data(cell: str) -> None:
    assert not is_data([cell, "{ }", "{ok}", "OK"], 4)
    assert is_data(["31-Oct-26 10:00:00 PM EDT", "{ }", "{ok}", "70.1"], 4)
