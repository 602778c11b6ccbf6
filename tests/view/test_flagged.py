"""What of a channel does not count, as the fit and the diagnosis are told."""

from __future__ import annotations

import duckdb
import pytest

from thermodata.store.catalogue.format.ddl import TABLES
from thermodata.view.grid.flagged import flagged_channels


def told(*events: tuple[str | None, str, int, str | None], rows: int = 1000) -> dict[str, tuple[float, str | None]]:
    """channel -> (share lost, why it is faulty) of a test with two channels."""
    con = duckdb.connect()
    con.execute(TABLES)
    for channel in ("T", "dZ"):
        con.execute(
            "insert into channel (campaign, test, channel, source, stream, quantity, unit, sign, dtype) "
            "values ('c', 'a', ?, 'daq', 'main', 'temperature', 'degC', '+', 'f8')",
            [channel],
        )
    con.execute(
        "insert into file (campaign, test, source, stream, layer, part, key, path, rows, added_at) "
        "values ('c', 'a', 'daq', 'main', 'tidy', 'test', 'k', 'p', ?, now()::timestamp)",
        [rows],
    )
    for channel, flag, n, detail in events:
        con.execute(
            "insert into quality_event (campaign, test, source, stream, channel, flag, from_s, to_s, n, detail) "
            "values ('c', 'a', 'daq', 'main', ?, ?, 0, 1, ?, ?)",
            [channel, flag, n, detail],
        )
    return {c: (round(f.lost, 3), f.faulty) for c, f in flagged_channels(con, ["c"]).get(("c", "a"), {}).items()}


@pytest.mark.parametrize(
    ("flag", "n", "detail", "expected"),
    [
        ("offset", 10, "a step of +30 K", (0.01, "offset")),
        ("stuck", 10, None, (0.01, "stuck")),
        ("held", 200, None, (0.2, None)),
        ("held", 201, None, (0.201, "held")),
        ("out_of_range", 300, "no temperature can be that", (0.3, "out of range")),
        ("spike", 5, None, (0.005, None)),
    ],
)
def test_a_failed_sensor_or_a_fifth_of_a_test_is_a_fault(
    flag: str, n: int, detail: str | None, expected: tuple[float, str | None]
) -> None:
    assert told(("T", flag, n, detail)) == {"T": expected}


@pytest.mark.parametrize(
    ("flag", "detail"),
    [
        ("offset", "overruled: the chiller was on (was: a step)"),
        ("saturated", "only while not measuring"),
        ("spike", "not flagged: 3 % of the samples stand out"),
        ("out_of_range", "no number; 300 stretches"),
        ("gap", "130 s without a sample"),
        ("clock_suspect", "set ahead"),
    ],
)
def test_what_is_overruled_idle_or_information_is_none(flag: str, detail: str) -> None:
    assert told(("T", flag, 900, detail)) == {}


def test_what_concerns_a_stream_concerns_each_of_its_channels_and_shares_add_up() -> None:
    assert told((None, "foreign", 150, "another recording?"), ("T", "held", 60, None)) == {
        "T": (0.21, "foreign"),
        "dZ": (0.15, None),
    }
