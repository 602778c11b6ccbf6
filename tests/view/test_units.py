"""Units of a query's columns: those that are taken as they are, and no others."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import pytest

import thermodata
from thermodata.errors import UsageError
from thermodata.view import StoreView


@pytest.fixture
def view(build: Callable[..., Any]) -> StoreView:
    b = build()
    b.test("c", "a")
    b.channel("c", "a", "dZ")
    b.channel("c", "a", "T_nut", quantity="temperature", unit="degC")
    b.tidy("c", "a", [0.0, 10.0, 20.0], {"dZ": [1.0, 2.0, 6.0], "T_nut": [20.0, 20.5, 21.0]})
    return thermodata.open(b.store().path)


@pytest.mark.parametrize(
    ("query", "units"),
    [
        ("select dZ, dZ / 2 as half, t_s as x from binned('c', 'a', '10 s')", {"dZ": "um", "x": "s"}),
        ("select dZ / 1000 as dZ from binned('c', 'a', '10 s')", {}),
        ("from (select dZ / 1000 as dZ from binned('c', 'a', '10 s'))", {}),
        ("select *, dZ * 2 as T_nut_twice from binned('c', 'a', '10 s')", {"t_s": "s", "dZ": "um", "T_nut": "degC"}),
        ("select * replace (dZ / 2 as dZ) from binned('c', 'a', '10 s')", {}),
        ("select max(value) as value from displacement", {}),
        ("select t_s, value from displacement", {"t_s": "s"}),
        ("from displacement", {"t_s": "s", "value": "um"}),
        ("from temperature", {"t_s": "s", "value": "degC"}),
        ("from sample", {"t_s": "s"}),  # of two units
        ("select duration_s from test", {"duration_s": "s"}),
        ("with x as (select 1 as dZ) select dZ from x", {}),
        ("select 1 as dZ union all select 2", {}),
        ("describe test", {}),
    ],
)
def test_units_of_what_is_taken_as_it_is(view: StoreView, query: str, units: dict[str, str]) -> None:
    assert view.sql(query).units() == units
    schema = view.sql(query).to_arrow_table().schema
    assert {f.name: f.metadata[b"unit"].decode() for f in schema if f.metadata} == units


def test_a_commit_is_seen(view: StoreView) -> None:
    assert view.binned("c", "a", "10 s").units()["dZ"] == "um"
    with view.store.write() as con:
        con.execute("update channel set unit = 'urad' where channel = 'dZ'")
    assert view.binned("c", "a", "10 s").units()["dZ"] == "urad"


def test_polars_is_an_extra_that_is_named(view: StoreView, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "polars", None)
    with pytest.raises(UsageError, match=r"thermodata\[polars\]"):
        view.tests().pl()


def test_a_notebook_shows_units_and_escapes(view: StoreView) -> None:
    page = view.sql("select t_s, dZ, '<b>' as text from binned('c', 'a', '10 s')")._repr_html_()
    assert "<th>dZ [um]</th>" in page
    assert "&lt;b&gt;" in page


@pytest.fixture
def results(build: Callable[..., Any]) -> StoreView:
    """A displacement dZ, a temperature T_nut and a speed n, with models of the first two."""
    b = build()
    b.test("c", "a")
    b.channel("c", "a", "dZ")
    b.channel("c", "a", "T_nut", quantity="temperature", unit="degC")
    b.channel("c", "a", "n", quantity="rotational_speed", unit="rpm")
    b.tidy("c", "a", [0.0, 10.0], {"dZ": [1.0, 2.0], "T_nut": [20.0, 20.5], "n": [0.0, 10.0]})
    view = thermodata.open(b.store().path)
    with view.store.write() as con:
        for model, response in (("m1", "dZ"), ("m2", "T_nut")):
            con.execute(
                "insert into model values (?, 'm', null, ['c'], ?, '{}', 'v1', false, '2026-03-01', '{}')",
                [model, response],
            )
            con.execute(
                "insert into score_row values ('c', 'a', ?, 'calibration', ?, 'all', 1, 2, 3, 4, 5, 6)",
                [model, response],
            )
            payload = f'{{"campaign": "c", "test": "a", "response": "{response}", "ptp_n": 1.0}}'
            con.execute("insert into finding values ('c', 'a', ?, 'portability', 1, ?, '2026-03-01')", [model, payload])
    return view


@pytest.mark.parametrize(
    ("query", "units"),
    [
        ("select n from score", {}),  # a count, and the name of a channel
        ("select n from binned('c', 'a', '10 s')", {"n": "rpm"}),
        ("select s.n from score s join binned('c', 'a', '10 s') b on true", {}),
        ("select response, rmse_um, n from score where model = 'm1'", {"rmse_um": "um"}),
        ("select response, rmse_um, ptp_um from score where model = 'm2'", {"rmse_um": "K", "ptp_um": "K"}),
        ("select response, rmse_um from score", {}),  # of two units
        ("select rmse_um from score where model = 'm2'", {}),  # nothing says of which
        ("select response, ptp_n from portability where model = 'm2'", {"ptp_n": "K"}),
        ("select response, ptp_n, fit_c from portability where model = 'm1'", {"ptp_n": "um", "fit_c": "%"}),
    ],
)
def test_errors_are_in_the_unit_of_the_response_of_the_rows(
    results: StoreView, query: str, units: dict[str, str]
) -> None:
    assert results.sql(query).units() == units


def test_where_all_models_have_one_unit_an_error_has_it_without_its_response(results: StoreView) -> None:
    with results.store.write() as con:
        con.execute("delete from model where model = 'm2'")
    assert results.sql("select rmse_um from score where model = 'm1'").units() == {"rmse_um": "um"}
