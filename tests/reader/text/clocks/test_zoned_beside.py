"""A time in UTC beside the local one is the time where both are one clock; a clock of a server beside it is not."""

from __future__ import annotations

import pytest

from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.table_time import time_of
from thermodata.reader.text.clocks.time_columns import find_time

LOCAL = [f"2026-03-02 08:{m:02d}:00" for m in range(40)]
UTC = [f"2026-03-02 07:{m:02d}:00" for m in range(40)]
ZONED = [f"{c}Z" for c in UTC]
LATE = [f"{c[:-2]}03Z" for c in UTC]
LATER = [f"{c[:-2]}{3 + k % 2:02d}Z" for k, c in enumerate(UTC)]
CHANGE = ([f"2026-10-25 02:{m:02d}:00" for m in range(0, 60, 5)] * 2)[:24]
CHANGE_UTC = [f"2026-10-25 {h:02d}:{m:02d}:00Z" for h in (0, 1) for m in range(0, 60, 5)]


@pytest.mark.parametrize(
    ("names", "stamps", "column"),
    [
        (["Local time", "UTC time"], (LOCAL, UTC), 1),
        (["UTC time", "Local time"], (UTC, LOCAL), 0),
        (["Time", "Time 2"], (LOCAL, ZONED), 1),
        (["Time", "Time 2"], ([c[:-3] for c in LOCAL], ZONED), 1),  # without seconds
        (["Time", "Time 2"], (LOCAL, [f"{c}.123Z" for c in UTC]), 1),
        (["Time", "Time 2"], (CHANGE, CHANGE_UTC), 1),
        (["Time", "Time 2"], (LOCAL, UTC), 0),
        (["Time", "Time 2"], (LOCAL, LATE), 0),
        (["Time", "Time 2"], (LOCAL, LATER), 0),
        (["Time", "Received"], (LOCAL, ZONED), 0),
        (["Time", "Server time UTC"], (LOCAL, UTC), 0),
        (["Time", "UTC"], (LOCAL, UTC[:1] * 20 + UTC[20:21] * 20), 0),  # not of each row
    ],
)
def test_a_time_in_utc_beside_a_local_one_is_the_time(
    names: list[str], stamps: tuple[list[str], ...], column: int
) -> None:
    data = [[*pair, "21.5"] for pair in zip(*stamps, strict=True)]
    seen = FirstRows([*names, "T"], [None] * 3, data, "here")
    assert find_time(seen) == (column,)
    notes = time_of({}, seen).notes
    same = {"Local time", "UTC time"} == {*names} or column == 1
    assert any("is not used" in note for note in notes) is same
    if same:
        assert f"the time is '{names[column]}'" in notes[0]


def test_a_declared_time_is_taken_without_a_word() -> None:
    data = [[*pair, "21.5"] for pair in zip(LOCAL, ZONED, strict=True)]
    time = time_of({"column": 1}, FirstRows(["Time", "Time 2", "T"], [None] * 3, data, "here"))
    assert (time.columns, time.notes) == ((0,), ())
