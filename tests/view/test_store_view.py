"""`thermodata.open(folder)`: SQL and the common answers."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from typing import Any

import pyarrow as pa
import pytest

import thermodata
from thermodata.errors import StoreError, UsageError
from thermodata.view import StoreView

Build = Callable[..., Any]


@pytest.fixture
def view(build: Build) -> StoreView:
    b = build()
    b.test("it's", "a")
    b.channel("it's", "a", "dZ")
    b.tidy("it's", "a", [0.0, 10.0, 20.0], {"dZ": [1.0, 2.0, 6.0]})
    for model, name, day in (("aa11", "base", 1), ("aa22", "base", 2), ("bb33", "other", 3)):
        b.model(model, name, created_at=datetime(2026, 1, day))
        b.prediction(
            "it's",
            "a",
            model,
            "dZ",
            {
                "t_s": [0.0, 30.0],
                "measured": [1.0, 2.0],
                "predicted": [0.0, 0.0],
                "residual": [1.0, 2.0],
                "valid": [True, True],
            },
        )
    return thermodata.open(b.store().path)


def test_sql_gives_relations(view: StoreView) -> None:
    relation = view.sql("select t_s, value from sample where test = ? order by t", ["a"])
    assert relation.fetchall() == [(0.0, 1.0), (10.0, 2.0), (20.0, 6.0)]
    table = view.sql("select t, value from sample").to_arrow_table()
    assert isinstance(table, pa.Table)
    assert table.schema.field("t").type == pa.timestamp("ns")
    assert view.sql("select sum(value) as s from sample where channel = $c", {"c": "dZ"}).df()["s"].tolist() == [9.0]


def test_relations_outlive_a_commit(view: StoreView) -> None:
    before = view.tests()
    with view.store.write() as con:
        con.execute("delete from test")
    assert len(before.fetchall()) == 1
    assert view.tests().fetchall() == []


@pytest.mark.parametrize(
    ("query", "word"),
    [("select * from samples", "sample"), ("selec 1", "syntax"), ("select dX from binned('it''s', 'a')", "dX")],
)
def test_a_wrong_query_is_a_usage_error(view: StoreView, query: str, word: str) -> None:
    with pytest.raises(UsageError, match=word):
        view.sql(query)


def test_common_answers(view: StoreView) -> None:
    assert [r[-1] for r in view.binned("it's", "a", 30).fetchall()] == [3.0]
    assert view.aligned("it's", "a", "10 s").columns[-2:] == ["dZ", "dZ__flag"]
    assert len(view.signal("it's", "a", "dZ").fetchall()) == 3
    assert view.channels("it's").fetchall()[0][2] == "dZ"
    assert view.channels("none").fetchall() == []
    assert view.dataset("it's", 10).tests[0].values["dZ"].tolist() == [1.0, 2.0, 6.0]


def test_models_are_found_by_id_prefix_and_newest_name(view: StoreView) -> None:
    assert [view.model_id(r) for r in ("aa11", "b", "base", "other")] == ["aa11", "bb33", "aa22", "bb33"]
    assert {r[2] for r in view.residual("base").fetchall()} == {"aa22"}
    assert len(view.residual("bb", "it's", "a", "dZ").fetchall()) == 2
    with pytest.raises(UsageError, match="begins several models"):
        view.model_id("aa")
    with pytest.raises(UsageError, match="did you mean 'other'"):
        view.model_id("othr")
    with pytest.raises(UsageError, match="no model ''"):
        view.model_id("")


def test_no_store_and_a_lost_file(view: StoreView, tmp_path: Any) -> None:
    with pytest.raises(UsageError, match="no store here"):
        thermodata.open(tmp_path / "none")
    for file in (view.path / "tidy").iterdir():
        file.unlink()
    with pytest.raises(StoreError, match="can't be read"):
        view.sql("select * from sample")


@pytest.mark.parametrize(
    "query",
    [
        "drop view sample",
        "delete from test",
        "select 1; delete from test",
        "create table mine as from test",
        "set threads = 1",
    ],
)
def test_a_query_cannot_write(view: StoreView, query: str) -> None:
    before = view.sql("from test").fetchall()
    with pytest.raises(UsageError, match="only reads"):
        view.sql(query)
    assert view.sql("from test").fetchall() == before
    assert len(view.sql("from sample").fetchall()) == 3


def test_all_ways_to_read_are_open(view: StoreView) -> None:
    for query in (
        "show tables",
        "describe sample",
        "summarize test",
        "pivot test on kind using count(*)",
        "values (1)",
        "explain from test",
    ):
        assert view.sql(query).fetchall()
