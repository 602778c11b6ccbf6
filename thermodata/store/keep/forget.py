"""`forget`: a campaign, one test of it, or versions of models, out of the catalogue, with all that derives from it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError, unknown_name
from thermodata.store.base.connection import fetch
from thermodata.store.catalogue.store import Store
from thermodata.store.ingest.known.inventory import BY_TEST, read_inventory
from thermodata.store.ingest.known.looks_of_gone import keep_looks
from thermodata.store.ingest.known.mark_stale import mark_stale
from thermodata.store.ingest.known.state import states

if TYPE_CHECKING:
    import duckdb

_SAID_OF_TESTS = ("prediction", "score_row", "finding")
_OF_MODEL = ("fit", *_SAID_OF_TESTS, "model")


def forget(
    store: Store, campaign: str, test: str | None = None, *, earlier: bool = False, models: bool = False
) -> dict[str, Any]:
    """Removes a campaign, or one test of it, with all that derives from it: calibrations, results, and (with the
    campaign) the models fitted to it. Models that used a forgotten test are marked stale. How often the locks of these
    tests were opened (`looks`) stays, and counts on where the same data are ingested again.

    earlier: removes nothing but the earlier versions of files that changed. models: with a campaign, models go that
    span other campaigns too; without it these are a UsageError, and nothing is removed.
    The bytes go with the next `gc`. Source files outside the store are never touched. UsageError for a name that
    isn't there.
    """
    with store.write() as con:
        names = [r["campaign"] for r in fetch(con, "select campaign from campaign")]
        if campaign not in names:
            raise unknown_name("campaign", campaign, names)
        tests = [r["test"] for r in fetch(con, "select test from test where campaign = ? order by 1", [campaign])]
        if test is not None and test not in tests:
            raise unknown_name("test", test, tests)
        if earlier:
            n = forget_earlier(con, campaign, None if test is None else [test])
            return _what_was_forgotten(campaign, test, versions=n)
        gone = tests if test is None else [test]
        if test is None and not models:
            _refuse_models_of_others(con, campaign)
        looks = keep_looks(con, campaign, gone)
        if test is None:
            return _what_was_forgotten(campaign, test, tests=gone, models=_forget_campaign(con, campaign), looks=looks)
        return _what_was_forgotten(campaign, test, tests=gone, stale=_forget_test(con, campaign, test), looks=looks)


def forget_models(store: Store, models: Sequence[str]) -> dict[str, Any]:
    """Removes versions of models with their parameters, scores, predictions and diagnoses. How often locks were opened
    for them stays counted: what was seen is not unseen.

    models: ids. UsageError, and nothing is removed, where another version was made from one of them: without it, nobody
    could tell what that one has learnt.
    """
    with store.write() as con:
        rows = fetch(
            con,
            "with recursive made as (select model, name, parent from model where list_contains($1, parent) union "
            "select m.model, m.name, m.parent from model m join made on m.parent = made.model) "
            "select * from made where not list_contains($1, model)",
            [list(models)],
        )
        if rows:
            raise UsageError(
                f"{rows[0]['name']} {rows[0]['model']} was made from {rows[0]['parent']}",
                expected="versions that no other one was made from",
                got=", ".join(models),
                hint=f"forget these too: {', '.join(r['model'] for r in rows)}",
            )
        held = "list_contains(?, model)"
        looks = fetch(con, f"select count(*) as n from locked_look where {held}", [list(models)])[0]["n"]
        for table in _OF_MODEL:
            con.execute(f"delete from {table} where {held}", [list(models)])
        return {"models": list(models), "looks": looks}


def _forget_campaign(con: duckdb.DuckDBPyConnection, campaign: str) -> list[str]:
    """Returns the models that went with it."""
    fitted = [r["model"] for r in fetch(con, "select model from model where list_contains(campaigns, ?)", [campaign])]
    for table in (*BY_TEST, "calibration", "campaign", *_SAID_OF_TESTS):
        con.execute(f"delete from {table} where campaign = ?", [campaign])
    for model in fitted:
        for table in _OF_MODEL:
            con.execute(f"delete from {table} where model = ?", [model])
    return fitted


def _forget_test(con: duckdb.DuckDBPyConnection, campaign: str, test: str) -> list[str]:
    """Returns the models that went stale."""
    was = read_inventory(con, None, campaign, {test})
    then = states(was.rows, was.calibrations, {test})
    stale = mark_stale(con, campaign, then, {test: None}, forgotten=True)
    for table in BY_TEST:
        con.execute(f"delete from {table} where campaign = ? and test = ?", [campaign, test])
    _drop_results(con, campaign, test)
    con.execute("update campaign set data_version = data_version || '-' where campaign = ?", [campaign])
    return stale


def _drop_results(con: duckdb.DuckDBPyConnection, campaign: str, test: str) -> None:
    """Removes what models said about a test, wherever it stands; that its locks were opened stays."""
    for table in _SAID_OF_TESTS:
        con.execute(f"delete from {table} where campaign = ? and test = ?", [campaign, test])
    for row in fetch(con, "select model, result from model where list_contains(campaigns, ?)", [campaign]):
        result = json.loads(row["result"])
        for scored in ("scores", "before"):
            if result.get(scored):
                result[scored] = [s for s in result[scored] if (s["campaign"], s["test"]) != (campaign, test)]
        con.execute("update model set result = ? where model = ?", [json.dumps(result), row["model"]])


def _refuse_models_of_others(con: duckdb.DuckDBPyConnection, campaign: str) -> None:
    """UsageError for models that are of this campaign and of others, which would be lost there, too."""
    rows = fetch(
        con,
        "select model, name, list_filter(campaigns, lambda c: c != $1) as others from model "
        "where list_contains(campaigns, $1) and len(campaigns) > 1 order by created_at",
        [campaign],
    )
    if rows:
        named = "; ".join(f"{r['name']} {r['model']} (of {', '.join(r['others'])} too)" for r in rows)
        raise UsageError(
            f"models of '{campaign}' span other campaigns, and go with it",
            expected="--models, which says that they may go",
            got=named,
            hint="thermodata model export MODEL --to yaml --out FOLDER keeps what is fitted; with the campaign's new "
            "id in it, fit it before the old id is forgotten",
        )


def _what_was_forgotten(campaign: str, test: str | None, **gone: Any) -> dict[str, Any]:
    nothing = {"tests": [], "models": [], "stale": [], "versions": 0, "looks": 0}
    return {"campaign": campaign, "test": test, **nothing, **gone}


def forget_earlier(con: duckdb.DuckDBPyConnection, campaign: str, tests: list[str] | None) -> int:
    """Removes the earlier versions of changed files (of some tests; None: of all); returns how many."""
    fits = "campaign = ? and layer = 'superseded'" + ("" if tests is None else " and list_contains(?, test)")
    params = [campaign] if tests is None else [campaign, tests]
    versions = fetch(con, f"select distinct source_path, sha256 from file where {fits}", params)
    con.execute(f"delete from file where {fits}", params)
    return len(versions)
