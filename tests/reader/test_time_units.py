"""Times written as numbers."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.reader.text.tables.find_table import open_table
from thermodata.reader.times.since import since
from thermodata.reader.times.time_units import EPOCHS, SECONDS, check_unit, found_epoch, to_ns, with_step
from thermodata.reader.times.zone import NAT

T0 = int(np.datetime64("2026-03-02T08:00:00", "ns").astype(np.int64))


@pytest.mark.parametrize("dtype", [np.int64, np.uint64, np.float64])
@pytest.mark.parametrize(
    ("unit", "count"),
    [
        ("filetime", 134169120000000000),
        ("unix", 1772438400),
        ("unix_ms", 1772438400000),
        ("labview", 3855283200),
    ],
)
def test_a_count_from_a_date_is_a_time(unit: str, count: int, dtype: type) -> None:
    epoch = EPOCHS[unit]
    ns = to_ns(np.array([count, 0], dtype), epoch.seconds, epoch.zero_s)
    assert ns[0] == T0
    assert ns[1] in (epoch.zero_s * 10**9, NAT)  # 1601 is none


def test_a_fraction_keeps_its_digits_and_what_is_no_number_is_no_time() -> None:
    values = np.array([0.002, 1234567.891, np.nan, np.inf, 1e300])
    assert to_ns(values, SECONDS["s"]).tolist() == [2_000_000, 1_234_567_891_000_000, NAT, NAT, NAT]
    assert to_ns(values, SECONDS["ms"])[:2].tolist() == [2_000, 1_234_567_891_000]


@pytest.mark.parametrize(
    ("text", "unit"),
    [("[OLE]", "excel"), ("OADate", "excel"), (" Unix ", "unix"), ("[min]", "min"), ("excel", "excel")],
)
def test_units_of_time_in_other_words(text: str, unit: str) -> None:
    assert check_unit(text, "here") == unit


@pytest.mark.parametrize(
    ("text", "unit"), [("epoch", None), ("[Unix time]", None), (None, None), ("unix", "unix"), ("unix ms", "unix ms")]
)
def test_a_count_since_1970_may_leave_its_step_open(text: str | None, unit: str | None) -> None:
    assert with_step(text) == unit


def test_a_unit_that_is_none_of_time_is_refused() -> None:
    with pytest.raises(FormatError, match="unknown unit of time 'olle'"):
        check_unit("olle", "here")


def test_a_date_that_times_count_from_has_a_fraction_of_a_second() -> None:
    epoch = EPOCHS["s since 2026-03-01t08:00:00.123456789z"]
    start = int(np.datetime64("2026-03-01T08:00:00.123456789", "ns").astype(np.int64))
    assert not epoch.local
    assert epoch.ns(np.array([0.0, 1.5, np.nan])).tolist() == [start, start + 1_500_000_000, NAT]
    found = since("ms since 2026-03-01 08:00:00,25 UTC")
    assert found is not None
    assert found[1].unit("ms") == "ms since 2026-03-01t08:00:00.25z"


def test_seconds_since_1904_are_of_no_day_to_come() -> None:
    now = time.time() - EPOCHS["labview"].zero_s
    assert found_epoch(np.array([now - 600.0, now])) == "labview"
    assert found_epoch(np.array([now, now + 7 * 86400])) is None


def test_seconds_that_may_count_from_1900_are_asked(tmp_path: Path) -> None:
    now = round(time.time()) - EPOCHS["ntp"].zero_s
    log = tmp_path / "log.csv"
    log.write_text("timestamp;T [degC]\n" + "".join(f"{now + 30 * i - 9000};21.{i}\n" for i in range(9)))
    with pytest.raises(QuestionError, match="that count from more than") as asked:
        open_table(log, Source())
    assert "'s since 1900-01-01 UTC'" in (asked.value.ask or "")
    opened = open_table(log, Source(table={"time": {"column": 1, "unit": "ntp"}}))
    assert opened is not None
