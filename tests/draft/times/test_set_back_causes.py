"""Init and ingest name what set a clock back: a clock of 12 hours, the end of summer time, or somebody."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest


@pytest.mark.parametrize(
    ("start", "row", "back", "cause", "by"),
    [
        (datetime(2026, 3, 22, 8), 300, timedelta(hours=12), "a clock of 12 hours", "11 h 59 min"),
        (datetime(2026, 10, 24, 22), 300, timedelta(hours=1), "the end of summer time", "59 min"),
        (datetime(2026, 10, 24, 22), 200, timedelta(hours=2), "was the clock set back", "1 h 59 min"),
    ],
)
def test_the_cause_is_told(tmp_path: Path, start: datetime, row: int, back: timedelta, cause: str, by: str) -> None:
    times = [start + timedelta(minutes=k) - (back if k >= row else timedelta()) for k in range(600)]
    rows = [f"{t:%Y-%m-%d %H:%M:%S},{20 + k / 100:.2f}" for k, t in enumerate(times)]
    (tmp_path / "a.csv").write_text("\n".join(["time,T_bed [degC]", *rows, ""]))
    (source,) = draft_files(tmp_path).draft.sources
    (asked,) = [q for q in source.questions if "goes back" in q]
    assert f"the clock of a.csv goes back by {by} (from " in asked
    assert cause in asked
    (loss,) = ingest(Store(tmp_path / "s", create=True), tmp_path / "campaign.yaml").losses
    assert f"clock goes backwards by {by} (from {times[row - 1]} to {times[row]}); " in loss["reason"]
    assert cause in loss["reason"] or cause.startswith("was the clock")
    assert " ns" not in loss["reason"]


@pytest.mark.parametrize(
    ("first", "row", "cause", "by"),
    [
        ("10:00", 180, "a clock of 12 hours", "11 h 59 min (from 12:59:00 to 01:00:00)"),
        ("10:20", 180, "was the clock set back", "11 h 59 min (from 13:19:00 to 01:20:00)"),
    ],
)
def test_the_cause_is_told_of_times_of_day_without_dates(
    tmp_path: Path, first: str, row: int, cause: str, by: str
) -> None:
    begin = datetime.fromisoformat(f"2026-03-22T{first}")
    times = [begin + timedelta(minutes=k) - (timedelta(hours=12) if k >= row else timedelta()) for k in range(400)]
    rows = [f"{t:%H:%M:%S},{20 + k / 100:.2f}" for k, t in enumerate(times)]
    (tmp_path / "a.csv").write_text("\n".join(["time,T_bed [degC]", *rows, ""]))
    (source,) = draft_files(tmp_path).draft.sources
    (asked,) = [q for q in source.questions if "goes back" in q]
    assert f"goes back by {by}" in asked
    assert cause in asked
    assert ("resets: allow" in asked) is (cause == "was the clock set back")


def test_of_a_log_that_all_tests_share_no_test_is_split(tmp_path: Path) -> None:
    """Two recordings of the hall, the second an hour before the end of the first, one behind the other."""
    begin = datetime(2026, 3, 3, 8)
    for k, test in enumerate(("a", "b")):
        times = [begin + timedelta(hours=5 * k, minutes=i) for i in range(240)]
        rows = [f"{t:%Y-%m-%d %H:%M:%S},{20 + i / 100:.2f}" for i, t in enumerate(times)]
        (tmp_path / f"{test}.csv").write_text("\n".join(["time,T_bed [degC]", *rows, ""]))
    minutes = [*((m, 18.0) for m in range(-30, 330)), *((m, 18.1) for m in range(270, 600))]
    rows = [f"{begin + timedelta(minutes=m):%Y-%m-%d %H:%M:%S},{level + m / 200:.3f}" for m, level in minutes]
    (tmp_path / "hall.csv").write_text("\n".join(["time,Hall [degC]", *rows, ""]))
    sources = draft_files(tmp_path).draft.sources
    (asked,) = [q for s in sources for q in s.questions if "goes back" in q]
    losses = [x["reason"] for x in ingest(Store(tmp_path / "s", create=True), tmp_path / "campaign.yaml").losses]
    lost = [x for x in losses if "clock goes backwards by 59 min" in x]
    assert lost
    for said in (asked, *lost):
        assert "all tests share this log" in said
        assert "sort its rows by their time" in said
        assert "split the test" not in said
