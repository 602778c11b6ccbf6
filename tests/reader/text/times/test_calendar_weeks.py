"""Days by their calendar week: of ISO 8601 with the year, and as labs write them (KW19-1), without one."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.reader.text import delimited
from thermodata.reader.text.times.several_cells.days_without_year import is_week_without_year


def log(folder: Path, head: str, *days: str) -> Path:
    """25 minutes of each day."""
    rows = [f"{day},08:{k:02d}:00,{20 + k / 9:.2f}" for day in days for k in range(25)]
    (folder / "log.csv").write_text("\n".join([f"{head},Uhrzeit,T_Lager [°C]", *rows, ""]), "utf-8")
    return folder / "log.csv"


@pytest.mark.parametrize("head", ["Datum", "KW", "Messung"])
@pytest.mark.parametrize("day", ["KW19-1", "CW 19", "kw19/1"])
def test_the_year_of_a_calendar_week_is_asked_whatever_its_column_is_called(
    tmp_path: Path, head: str, day: str
) -> None:
    log(tmp_path, head, day)
    draft_files(tmp_path)
    drafted = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert f"'{head}' says days without a year, '{day}'" in drafted
    assert "which year is it? Give each test its start: YYYY-MM-DD 08:00:00" in drafted


@pytest.mark.parametrize("head", ["Datum", "KW"])
def test_several_days_of_weeks_are_asked_for_a_weekend_is_no_night(tmp_path: Path, head: str) -> None:
    """By times of day alone the Monday would follow on the Friday."""
    path = log(tmp_path, head, "KW19-5", "KW20-1")
    with pytest.raises(QuestionError, match="written in no way that is read") as asked:
        delimited.open_table(path, Source())
    assert "they begin with 'KW19-5 08:00:00'" in asked.value.ask
    assert f"{{column: 2}} alone where '{head}' is no day" in str(asked.value)


def test_a_day_of_an_iso_week_is_proposed_as_such_and_read(tmp_path: Path) -> None:
    path = log(tmp_path, "Woche", "2026-W19-5", "2026-W20-1")
    with pytest.raises(QuestionError) as asked:
        delimited.open_table(path, Source())
    assert "is '2026-W19-5 08:00:00' %G-W%V-%u %H:%M:%S?" in asked.value.ask
    source = Source(timezone="UTC", table=asked.value.declare)
    found = [b for b in delimited.blocks(path, delimited.open_table(path, source), source) if hasattr(b, "t_ns")]
    days = {datetime.fromtimestamp(t // 10**9, UTC).strftime("%Y-%m-%d") for b in found for t in b.t_ns.tolist()}
    assert days == {"2026-05-08", "2026-05-11"}


@pytest.mark.parametrize(
    ("cell", "is_week"),
    [
        ("KW19-1", True),
        ("KW 53", True),
        ("W19-1", True),
        ("W12", False),  # a workpiece
        ("KW54", False),
        ("KW19-8", False),
        ("19-1", False),
        ("2026-W19-1", False),  # which says its year
        ("22 kW", False),
    ],
)
def test_what_a_calendar_week_is(cell: str, is_week: bool) -> None:
    assert is_week_without_year(cell) is is_week
