"""Which files are one test where summer time begins or ends between them."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from tests.draft.folder.test_grouping import drafted, log
from tests.draft.labs import START, local, numbers, speeds, text, warm


@pytest.mark.parametrize("backup", [False, True])
def test_local_times_before_and_after_summer_time_began_join_the_same_recordings(tmp_path: Path, backup: bool) -> None:
    """By folder, and by time where names tell nothing. Copies in a folder of their own are no tests of theirs, and no
    template finds them."""
    n = 300
    for k in range(4):
        (tmp_path / f"T{k}").mkdir()
        log(tmp_path / f"T{k}" / f"T{k}.tdms", 24 + k)
        at = START + timedelta(days=24 + k)
        columns = [local(n, 10, at, "Europe/Berlin", "%d.%m.%Y %H:%M:%S"), numbers(speeds(n, [3000]), 0)]
        text(tmp_path / f"T{k}" / f"NC_T{k}.csv", ["Zeit", "Drehzahl [1/min]"], columns)
        if backup:
            (tmp_path / "backup").mkdir(exist_ok=True)
            (tmp_path / "backup" / f"T{k}.tdms").write_bytes((tmp_path / f"T{k}" / f"T{k}.tdms").read_bytes())
    found, made = drafted(tmp_path)
    assert [t.id for t in made.tests] == ["T0", "T1", "T2", "T3"]
    assert len([x for x in found.not_used if "a copy of" in x[1]]) == 4 * backup
    daq = made.sources["daq"].files
    assert daq == "*/{test}.tdms" if not backup else daq is None


@pytest.mark.parametrize(
    ("night", "parts"),
    [
        (datetime(2026, 10, 24, 23, 20, tzinfo=UTC), True),  # summer time ends within a part
        (datetime(2026, 10, 24, 23, 0, tzinfo=UTC), True),  # and between two
        (datetime(2026, 3, 28, 23, 0, tzinfo=UTC), True),  # it begins between two
        (datetime(2026, 10, 17, 23, 0, tzinfo=UTC), True),
        (datetime(2026, 10, 17, 23, 0, tzinfo=UTC), False),  # an hour of pause on another night
    ],
)
def test_local_parts_of_a_night_in_which_the_clock_changes_are_one_test(
    tmp_path: Path, night: datetime, parts: bool
) -> None:
    for k in range(2):
        (tmp_path / f"N{k}").mkdir()
        for part in range(6):
            n, gap = 240, timedelta(hours=1 if part > 2 and not parts else 0)
            rows = [night + gap + timedelta(days=k, minutes=40 * part, seconds=10 * i) for i in range(n)]
            stamps = [f"{t.astimezone(ZoneInfo('Europe/Berlin')):%d.%m.%Y %H:%M:%S}" for t in rows]
            columns = [stamps, numbers(warm(n, 20, 1, 1, part), 2)]
            text(tmp_path / f"N{k}" / f"teil{part}.csv", ["Zeit", "T_Lager [degC]"], columns)
    _, made = drafted(tmp_path)
    assert len(made.tests) == (2 if parts else 12)
