"""The store's format is raised with what is kept in it; an older one is brought up, a newer document is refused."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Any

import duckdb
import pytest

from thermodata.errors import StoreError
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.store import Store
from thermodata.store.catalogue.format.ddl import FORMAT, TABLES
from thermodata.store.catalogue.format.document import KEPT, read_document
from thermodata.store.catalogue.format.migrate import STEPS
from thermodata.store.ingest.run import ingest

# of the tables and of the documents that they keep, by format
MADE = {7: "691e21167a58b90c"}


def _keys(schema: Any) -> Any:
    """A schema without its words, which may change at any time."""
    if isinstance(schema, dict):
        words = (
            {"title", "description", "examples"} if "type" in schema or "$ref" in schema or "anyOf" in schema else ()
        )
        return {k: _keys(v) for k, v in schema.items() if k not in words or isinstance(v, dict)}
    return [_keys(v) for v in schema] if isinstance(schema, list) else schema


def test_the_format_is_raised_with_what_the_store_keeps() -> None:
    """Else a program that does not know a key meets it in a store that it takes for one of its own."""
    kept = [TABLES, *(json.dumps(_keys(kind.model_json_schema()), sort_keys=True) for kind in KEPT)]
    digest = hashlib.sha256("\n".join(kept).encode()).hexdigest()[:16]
    assert MADE.get(FORMAT) == digest, "raise FORMAT, add its step to STEPS, and put this digest here"


def test_each_format_has_the_step_from_the_one_before() -> None:
    assert sorted(STEPS) == list(range(1, FORMAT))


def of_format_1(store: Store) -> Store:
    with duckdb.connect(str(store.path / "catalog.duckdb")) as con:
        con.execute("update store set format = 1")
    (store.path / "generation").write_text("another")
    return Store(store.path)


def format_of(path: Path) -> object:
    with duckdb.connect(str(path), read_only=True) as con:
        return con.execute("select format from store").fetchall()[0][0]


def test_a_store_of_the_format_before_is_brought_up_by_the_first_write(filled: Store, campaign: Path) -> None:
    ingest(filled, campaign)  # it is there now, and not where the store was made
    store = of_format_1(filled)
    with store.reader() as con:
        assert con.execute("select count(*) from displacement").fetchall() == [(2400,)]
    assert not ingest(store, campaign).changed
    assert format_of(store.path / "catalog.duckdb") == 1
    campaign.write_text(campaign.read_text().replace("role: verification", "role: locked"))
    assert ingest(store, campaign).changed
    assert format_of(store.path / "catalog.duckdb") == FORMAT
    assert format_of(store.path / "catalog.format1.duckdb.backup") == 1
    with store.reader() as con:
        assert con.execute("select role from test order by test").fetchall() == [("calibration",), ("locked",)]


@pytest.mark.skipif(os.name != "posix", reason="rights of files")
def test_a_store_of_the_format_before_is_read_without_the_right_to_write(filled: Store) -> None:
    store = of_format_1(filled)
    for path in (*store.path.rglob("*"), store.path):
        path.chmod(0o555 if path.is_dir() else 0o444)
    try:
        with Store(store.path).reader() as con:
            assert con.execute("select format, count(*) from store group by 1").fetchall() == [(1, 1)]
    finally:
        for path in (store.path, *store.path.rglob("*")):
            path.chmod(0o755)


def test_a_document_with_other_keys_is_of_another_version() -> None:
    known = Confirmed.model_validate(
        {"model": "m", "response": "dZ", "candidate": "lag:t1", "holds": None, "locked_rmse_um_before": None}
        | {"locked_rmse_um_after": None, "parameters": {}, "tests": [], "looks": 0}
    ).model_dump(mode="json")
    assert read_document(Confirmed, json.dumps(known), "the answer").candidate == "lag:t1"
    with pytest.raises(StoreError, match="another version of thermodata wrote it") as refused:
        read_document(Confirmed, json.dumps(known | {"newest_key": 1}), "the answer")
    assert "newest_key" in str(refused.value)
    assert refused.value.exit_code == 4
