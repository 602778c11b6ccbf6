"""A file over a change of daylight saving: what it does to the rows is said as it is, in autumn and in spring."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from thermodata.plugin import Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import readers


@pytest.mark.parametrize(
    ("night", "said"),
    [
        ((2026, 3, 28), "; it skips an hour, no row"),
        ((2026, 10, 24), "; rows of the repeated hour are told apart by their order"),
        ((2026, 6, 24), None),
    ],
)
@pytest.mark.parametrize("reader", ["cnc", "table"])
def test_what_a_change_does_is_said(tmp_path: Path, night: tuple[int, int, int], said: str | None, reader: str) -> None:
    zone = ZoneInfo("Europe/Prague")
    began = datetime(*night, 18, tzinfo=ZoneInfo("UTC"))
    times = [(began + timedelta(minutes=5 * i)).astimezone(zone) for i in range(144)]
    path = tmp_path / "x.csv"
    path.write_text("time;T\n" + "".join(f"{t:%Y-%m-%d %H:%M:%S};{20 + i / 50}\n" for i, t in enumerate(times)))
    notes = described(readers()[reader], path, Source(timezone="Europe/Prague")).notes
    found = [n for n in notes if "daylight saving" in n]
    assert [n.partition("in this file")[2] for n in found] == ([] if said is None else [said])


@pytest.mark.parametrize("reader", ["cnc", "table"])
@pytest.mark.parametrize("first", ["01:30", "02:05", "00:30"])
def test_times_in_the_hour_that_is_skipped_are_told(tmp_path: Path, first: str, reader: str) -> None:
    began = datetime.fromisoformat(f"2026-03-29 {first}")
    times = [began + timedelta(minutes=4 * i) for i in range(21) if (began + timedelta(minutes=4 * i)).hour < 3]
    inside = sum(t.hour == 2 for t in times)
    path = tmp_path / "x.csv"
    path.write_text("time;T\n" + "".join(f"{t:%Y-%m-%d %H:%M:%S};{20 + i / 50}\n" for i, t in enumerate(times)))
    notes = described(readers()[reader], path, Source(timezone="Europe/Berlin")).notes
    told = [n for n in notes if f"{inside} local times in the hour that Europe/Berlin skips" in n]
    assert bool(told) == bool(inside)
    assert not any("it skips an hour, no row" in n for n in notes) or not inside
    assert not any("skips" in n for n in described(readers()[reader], path, Source(timezone="Etc/GMT-1")).notes)
