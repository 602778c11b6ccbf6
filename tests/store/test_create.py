"""A store that could not be made is no store, and the next ingest makes it; what holds anything stays."""

from __future__ import annotations

from pathlib import Path

import duckdb
import pytest

from tests.no_room import no_file_longer_than
from thermodata.errors import StoreError, UsageError
from thermodata.store import Store

pytestmark = pytest.mark.usefixtures("stores_made_anew")


@pytest.mark.parametrize("most_bytes", [1_000, 20_000, 100_000, 300_000])
def test_a_store_without_room_is_refused_and_made_where_there_is(tmp_path: Path, most_bytes: int) -> None:
    with no_file_longer_than(most_bytes), pytest.raises(StoreError, match="longer than it may be") as error:
        Store(tmp_path / "new", create=True)
    assert "ulimit -f" in str(error.value)
    assert "free" not in str(error.value), "how much is free has nothing to do with it"
    assert not [p.name for p in (tmp_path / "new").iterdir() if "catalog.duckdb" in p.name]
    assert Store(tmp_path / "new", create=True).generation == 0


@pytest.fixture
def empty(tmp_path: Path) -> Path:
    """A folder whose catalogue has no tables."""
    folder = tmp_path / "half"
    folder.mkdir()
    duckdb.connect(str(folder / "catalog.duckdb")).close()
    return folder


def test_a_catalogue_without_tables_is_not_begun(empty: Path) -> None:
    with pytest.raises(UsageError, match="there is no store here"):
        Store(empty)
    assert Store(empty, create=True).generation == 0


def test_a_database_of_something_else_is_never_replaced(empty: Path) -> None:
    with duckdb.connect(str(empty / "catalog.duckdb")) as con:
        con.execute("create table mine as select 1 as x")
    with pytest.raises(StoreError, match="not a store"):
        Store(empty, create=True).generation  # noqa: B018
    with duckdb.connect(str(empty / "catalog.duckdb")) as con:
        assert con.execute("from mine").fetchall() == [(1,)]


@pytest.mark.parametrize("beside", ["raw/a.parquet", "tidy/a.parquet", "model/1/a.parquet", "catalog.duckdb.wal"])
def test_an_empty_catalogue_beside_data_is_not_replaced(empty: Path, beside: str) -> None:
    (empty / beside).parent.mkdir(parents=True, exist_ok=True)
    (empty / beside).write_bytes(b"data")
    before = (empty / "catalog.duckdb").stat().st_ino
    Store(empty, create=True)
    assert (empty / "catalog.duckdb").stat().st_ino == before
    assert (empty / beside).read_bytes() == b"data"
