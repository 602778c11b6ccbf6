"""SQL in a process of its own: what it answers, what it refuses, and where it ends."""

from __future__ import annotations

import io
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from thermodata.errors import ThermodataError, UsageError
from thermodata.store import Store
from thermodata.view.sandbox.ask import Limits, ask, stream
from thermodata.view.sandbox.enclosed import enclosed
from thermodata.view.sandbox.parse import check_select


@pytest.fixture(scope="module")
def small_store(build_once: Callable[[], Any]) -> Path:
    """Two tests of an hour at 1 min: a displacement and a temperature."""
    t_s, builder = np.arange(60) * 60.0, build_once()
    for test, role in (("heat1", "calibration"), ("day1", "verification")):
        builder.test("small", test, role=role)
        builder.channel("small", test, "dZ")
        builder.channel("small", test, "T_nut", "temperature")
        builder.tidy("small", test, t_s, {"dZ": np.sin(t_s / 900), "T_nut": 20 + t_s / 3600})
    return builder.store().path


def test_tables_views_and_macros_answer(small_store: Path) -> None:
    found = ask(small_store, "select test, role from test order by test")
    assert found.columns == (("test", "VARCHAR"), ("role", "VARCHAR"))
    assert found.rows == (("day1", "verification"), ("heat1", "calibration"))
    assert not found.more
    assert ask(small_store, "select count(*) from temperature").rows[0][0] > 0
    assert ask(small_store, "select count(*) from signal('small', 'heat1', 'dZ')").rows == ((60,),)
    assert ask(small_store, "select count(*) from binned('small', 'heat1', '120 s')").rows == ((30,),)
    assert ask(small_store, "with a as (from test) select count(*) from a, range(3)").rows == ((6,),)
    assert ask(small_store, "describe test").rows


REFUSED = {
    "copy": "copy (select 1) to '{out}'",
    "copy without a temporary file": "copy (select 1) to '{out}' (use_tmp_file false)",
    "copy over a file of the store": "copy (select 1) to '{parquet}' (use_tmp_file false)",
    "read_text": "select * from read_text('/etc/hostname')",
    "read_text of the store": "select * from read_text('{parquet}')",
    "read_text within query": "select * from query('select * from read_text(''/etc/hostname'')')",
    "a file as a table": "select * from '/etc/hostname'",
    "read_csv": "select * from read_csv('/etc/hostname')",
    "glob": "select * from glob('/etc/*')",
    "attach": "attach '{out}'",
    "install": "install httpfs",
    "load": "load httpfs",
    "set": "set memory_limit = '100GB'",
    "two statements": "select 1; select 2",
    "nothing": "",
    "insert": "insert into test select * from test",
    "insert within a SELECT": "with a as (insert into locked_look select * from locked_look returning *) from a",
    "update": "update test set role = 'none'",
    "drop": "drop table test",
    "create": "create table mine as select 1",
    "pragma": "pragma database_list",
    "export": "export database '{out}'",
    "explain analyze": "explain analyze copy (select 1) to '{out}'",
    "settings": "select current_setting('home_directory')",
    "secrets": "select * from duckdb_secrets()",
    "settings as a table": "select * from pg_catalog.pg_settings",
    "settings in a corner": "select * from test where exists (select name from pg_settings)",
    "the environment": "select system.main.getenv('HOME')",
    "the environment in a lambda": "select list_transform(['HOME'], x -> getenv(x))",
    "sleep": "select sleep_ms(3600000)",
    "read_text in a subquery": "select (select content from read_text('/etc/hostname'))",
    "a table by its name": "from query_table('test')",
    "a log": "select write_log('x')",
    "call": "call pragma_version()",
    "pivot": "select * from (pivot test on role using count(*))",
}


@pytest.mark.parametrize("query", REFUSED.values(), ids=REFUSED)
def test_everything_but_one_select_is_refused(small_store: Path, tmp_path: Path, query: str) -> None:
    out, parquet = tmp_path / "out", next((small_store / "tidy").glob("*.parquet"))
    before = parquet.read_bytes()
    with pytest.raises(UsageError):
        ask(small_store, query.format(out=out, parquet=parquet))
    assert not out.exists()
    assert parquet.read_bytes() == before


# the parser takes a file for a table, which only the connection can refuse
PARSED = {name: query for name, query in REFUSED.items() if not query.startswith("select * from '")}


@pytest.mark.parametrize("query", PARSED.values(), ids=PARSED)
def test_the_parser_alone_refuses_it_too(small_store: Path, tmp_path: Path, query: str) -> None:
    # two walls: each must hold without the other
    con = Store(small_store).private_copy()
    with pytest.raises(UsageError):
        check_select(con, query.format(out=tmp_path / "out", parquet=tmp_path / "x.parquet"))


@pytest.mark.parametrize(
    "name", ["copy", "copy without a temporary file", "read_text", "a file as a table", "read_csv", "glob", "attach"]
)
def test_the_connection_alone_refuses_files(small_store: Path, tmp_path: Path, name: str) -> None:
    import duckdb

    con = enclosed(Store(small_store), 256)
    with pytest.raises(duckdb.Error):
        con.execute(REFUSED[name].format(out=tmp_path / "out", parquet="")).fetchall()
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("query", ["install httpfs", "load httpfs", "set threads = 8", "set memory_limit = '99GB'"])
def test_the_connection_alone_keeps_its_configuration(small_store: Path, query: str) -> None:
    import duckdb

    with pytest.raises(duckdb.Error):
        enclosed(Store(small_store), 256).execute(query)


@pytest.mark.parametrize("name", ["request", "con", "relation", "head", "sink"])
def test_variables_of_the_program_are_no_tables(small_store: Path, name: str) -> None:
    with pytest.raises(UsageError, match="does not exist"):
        ask(small_store, f"select * from {name}", Limits(60))


def test_a_recursion_without_an_end_is_ended(small_store: Path) -> None:
    query = "with recursive t as (select 1 a union all select a from t) select count(*) from t"
    with pytest.raises(ThermodataError, match=r"too long|memory"):
        ask(small_store, query, Limits(seconds=4, memory_mb=128))


def test_no_module_of_the_working_folder_is_imported(
    small_store: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("json", "duckdb", "numpy", "thermodata"):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'run')!r}, 'w').write('{name}')\n")
    monkeypatch.chdir(tmp_path)
    assert ask(small_store, "select count(*) from test", Limits(60)).rows == ((2,),)
    assert not (tmp_path / "run").exists()


def test_rows_are_limited_and_it_is_said(small_store: Path) -> None:
    found = ask(small_store, "from range(1000)", Limits(rows=10))
    assert len(found.rows) == 10
    assert found.more


def test_time_is_limited(small_store: Path) -> None:
    began = time.monotonic()
    with pytest.raises(UsageError, match="too long"):
        ask(
            small_store,
            "select max(xor(hash(a.range), hash(b.range))) from range(10000000) a, range(10000000) b",
            Limits(3),
        )
    assert time.monotonic() - began < 10


@pytest.mark.parametrize(
    "query",
    [
        "select list(a.range order by hash(a.range)) from range(100000000) a",
        "select repeat('x', 4000000000)",
        "select repeat('x', 20000000 + range::int) from range(500)",
    ],
)
def test_memory_is_limited(small_store: Path, query: str) -> None:
    with pytest.raises(ThermodataError, match=r"memory|query fails"):
        ask(small_store, query, Limits(seconds=30, memory_mb=128))


def test_a_long_text_is_cut_in_a_table(small_store: Path) -> None:
    assert len(ask(small_store, "select repeat('x', 100000)").rows[0][0]) < 3000


def test_csv_and_parquet(small_store: Path) -> None:
    query = "select test, t_s, value from signal('small', 'heat1', 'dZ') order by t_s"
    text = b"".join(stream(small_store, query, "csv")).decode()
    assert text.splitlines()[0] == '"test","t_s","value"'
    assert len(text.splitlines()) == 61
    table = pq.read_table(io.BytesIO(b"".join(stream(small_store, query, "parquet"))))
    assert table.column_names == ["test", "t_s", "value"]
    assert table.num_rows == 60


def test_what_is_refused_comes_before_the_first_byte(small_store: Path) -> None:
    with pytest.raises(UsageError):
        next(stream(small_store, "copy (select 1) to 'x'", "csv"))


def test_the_store_is_as_it_was(small_store: Path) -> None:
    before = {p: p.stat().st_mtime_ns for p in small_store.rglob("*") if p.is_file()}
    ask(small_store, "from test")
    assert {p: p.stat().st_mtime_ns for p in small_store.rglob("*") if p.is_file()} == before
