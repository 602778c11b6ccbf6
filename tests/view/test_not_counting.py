"""Of which queries it is said that they take values of flagged samples: of those that can, and of no other."""

from __future__ import annotations

import duckdb
import pytest

from thermodata.store.catalogue.format.ddl import TABLES
from thermodata.view.query.not_counting import values_that_do_not_count


@pytest.fixture
def con() -> duckdb.DuckDBPyConnection:
    """In lab3/a a temperature is flagged; lab/a and all displacements are as they should be."""
    con = duckdb.connect()
    con.execute(TABLES)
    for campaign in ("lab", "lab3"):
        for channel, quantity in (("T", "temperature"), ("dZ", "displacement"), ("n", "rotational_speed")):
            con.execute(
                "insert into channel (campaign, test, channel, source, stream, quantity, unit, sign, dtype) "
                "values (?, 'a', ?, 'daq', 'main', ?, '', '+', 'f8')",
                [campaign, channel, quantity],
            )
    con.execute(
        "insert into quality_event (campaign, test, source, stream, channel, flag, from_s, to_s, n, detail) "
        "values ('lab3', 'a', 'daq', 'main', 'T', 'OFFSET', 0, 1, 9, null)"
    )
    return con


@pytest.mark.parametrize(
    ("query", "said"),
    [
        ("select max(value) from displacement", False),
        ("select max(value) from temperature", True),
        ("select max(value) from driver", True),
        ("select max(value) from temperature where campaign = 'lab'", False),
        ("select max(value) from temperature where campaign = 'lab3' and t_s > 3", True),
        ("select max(value) from sample s where s.campaign in ('lab', 'lab2')", False),
        ("select max(value) from sample where channel = 'dZ'", False),
        ("select max(value) from sample where channel in ('dZ', 'T')", True),
        ("select max(value) from temperature where campaign = 'lab' or t_s > 3", True),
        ("select max(value) from temperature where campaign <> 'lab3'", True),
        ("select max(value) from temperature where campaign = (select 'lab')", True),
        ("select max(value) from temperature where campaign = 'lab' and campaign = 'lab3'", False),
        ("select max(value) from signal('lab', 'a', 'T')", False),
        ("select max(value) from signal('lab3', 'a', 'T')", True),
        ("with x as (from temperature where campaign = 'lab') select max(value) from x", False),
        ("with x as (from temperature) select max(value) from x where campaign = 'lab'", True),
        ("select a.value from displacement a join temperature b using (test) where a.campaign = 'lab'", True),
        ("summarize select value from temperature where campaign = 'lab'", False),
        ("pivot temperature on channel using max(value)", True),
        ("select max(value) from temperature where valid(flag)", False),
    ],
)
def test_it_is_said_where_the_samples_that_are_read_are_flagged(
    con: duckdb.DuckDBPyConnection, query: str, said: bool
) -> None:
    assert (values_that_do_not_count(con, query, ()) is not None) == said


def test_an_event_of_a_stream_is_of_each_of_its_channels(con: duckdb.DuckDBPyConnection) -> None:
    con.execute(
        "insert into quality_event (campaign, test, source, stream, channel, flag, from_s, to_s, n, detail) "
        "values ('lab', 'a', 'daq', 'main', null, 'FOREIGN', 0, 1, 9, null)"
    )
    told = values_that_do_not_count(con, "select value from displacement", ())
    assert told is not None
    assert "(foreign)" in told


@pytest.mark.parametrize(
    ("query", "said"),
    [
        ("select avg(residual) from residual", True),
        ("select residual from residual where test = 'a' and campaign = 'lab3'", True),
        ("select max(measured) from residual", True),
        ("select avg(residual) from residual where campaign = 'lab'", False),
        ("select avg(residual) from residual where valid", False),
        ("select count(*) from residual", False),
        ("select max(r.predicted) from residual r", False),
        ("select avg(r.residual) from residual r join test using (campaign, test)", True),
        ("pivot residual on test using avg(residual)", True),
        ("select name as residual from model", False),
    ],
)
def test_it_is_said_where_the_residuals_that_are_read_do_not_count(
    con: duckdb.DuckDBPyConnection, query: str, said: bool
) -> None:
    """A sample that was not measured is NaN there, and so is the mean over it."""
    con.execute("create table residual (campaign varchar, test varchar, measured double, residual double, valid bool)")
    con.execute("insert into residual values ('lab', 'a', 1, 1, true), ('lab3', 'a', 'nan', 'nan', false)")
    told = values_that_do_not_count(con, query, ())
    assert (told is not None) == said
    assert values_that_do_not_count(con, query, ("valid",)) is None
    assert told is None or "'where valid'" in told
