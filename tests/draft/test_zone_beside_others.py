"""What is asked of the zone of local times beside a source in UTC: what is known of it, and no more."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.make import draft_files

BEGAN = datetime(2026, 11, 26, 5, tzinfo=UTC)


def asked(folder: Path, hours: int, time: str = "Zeit", back_at: int = 999, began: datetime = BEGAN) -> str:
    """The question of the zone of times that are so many hours ahead, and an hour less from a row on."""
    rows = [began + timedelta(minutes=k) for k in range(200)]
    local = [t + timedelta(hours=hours - (k >= back_at)) for k, t in enumerate(rows)]
    lines = [f"{t:%d.%m.%Y %H:%M:%S};{20 + k / 50:.2f}" for k, t in enumerate(local)]
    (folder / "shop.csv").write_text("\n".join([f"{time};T_Spindel [°C]", *lines, ""]))
    utc = [f"{t:%Y-%m-%dT%H:%M:%SZ},{k / 10:.2f}" for k, t in enumerate(rows)]
    (folder / "probe_utc.csv").write_text("\n".join(["time_utc,disp_z_um", *utc, ""]))
    draft = draft_files(folder).draft
    return next(q for s in draft.sources for q in s.questions if q.startswith("timezone?"))


def test_an_offset_alone_tells_no_zone(tmp_path: Path) -> None:
    said = asked(tmp_path, 2)
    assert "+2 h from the other sources' UTC: so are Europe/Helsinki and others" in said
    assert "fits" not in said


def test_the_zone_that_the_file_names_is_proposed_where_it_fits(tmp_path: Path) -> None:
    said = asked(tmp_path, 1, "Zeit (MEZ)")
    assert "+1 h from the other sources' UTC, as those of Etc/GMT-1 are" in said
    assert "timezone: Etc/GMT-1?" in said


def test_and_told_of_where_it_does_not(tmp_path: Path) -> None:
    said = asked(tmp_path, 2, "Zeit (MEZ)")
    assert "those of Etc/GMT-1 were +1 h ahead then: was the clock set otherwise?" in said
    assert "Helsinki" not in said


def test_a_clock_that_is_set_back_tells_no_zone(tmp_path: Path) -> None:
    said = asked(tmp_path, 2, back_at=140)
    assert "its clock is set back later, so that they tell no zone" in said
    assert "Europe" not in said


def test_one_that_is_set_back_where_summer_time_ends_still_has_its_zones(tmp_path: Path) -> None:
    said = asked(tmp_path, 2, back_at=60, began=datetime(2026, 10, 25, 0, tzinfo=UTC))
    assert "+2 h from the other sources' UTC: so are Europe/Prague, Europe/Berlin and others" in said


@pytest.mark.parametrize("hours", [-9, 13])
def test_hours_of_rare_zones_may_be_of_a_clock(tmp_path: Path, hours: int) -> None:
    assert "of what zone, or is the clock wrong by whole hours?" in asked(tmp_path, hours)
