"""The end of things in a store: forgetting what was ingested, and cleaning up the files that nothing refers to."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import StoreError, UsageError, unknown_name
from thermodata.store.base.connection import fetch
from thermodata.store.base.files import TEMPORARY
from thermodata.store.catalogue.create import LAYERS
from thermodata.store.catalogue.store import Store
from thermodata.store.ingest.commit import drop_results
from thermodata.store.ingest.known.inventory import BY_TEST, read_inventory
from thermodata.store.ingest.known.looks_of_gone import keep_looks
from thermodata.store.ingest.known.mark_stale import mark_stale
from thermodata.store.ingest.known.state import states

if TYPE_CHECKING:
    import duckdb

_BATCH = 500  # files deleted in one turn at the catalogue: some 20 ms

_OF_MODEL = ("fit", "score_row", "prediction", "finding")


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
            return _answer(campaign, test, versions=n)
        gone = tests if test is None else [test]
        if test is None and not models:
            _refuse_models_of_others(con, campaign)
        stale: list[str] = []
        fitted: list[str] = []
        looks = keep_looks(con, campaign, gone)
        if test is None:
            fitted = [
                r["model"] for r in fetch(con, "select model from model where list_contains(campaigns, ?)", [campaign])
            ]
            for table in (*BY_TEST, "calibration", "campaign"):
                con.execute(f"delete from {table} where campaign = ?", [campaign])
            for table in ("prediction", "score_row", "finding"):
                con.execute(f"delete from {table} where campaign = ?", [campaign])
            for model in fitted:
                for table in (*_OF_MODEL, "model"):
                    con.execute(f"delete from {table} where model = ?", [model])
        else:
            was = read_inventory(con, None, campaign, {test})
            then = states(was.rows, was.calibrations, {test})
            stale = mark_stale(con, campaign, then, {test: None}, forgotten=True)
            for table in BY_TEST:
                con.execute(f"delete from {table} where campaign = ? and test = ?", [campaign, test])
            drop_results(con, campaign, {test})
            con.execute("update campaign set data_version = data_version || '-' where campaign = ?", [campaign])
    return _answer(campaign, test, tests=gone, models=fitted, stale=stale, looks=looks)


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


def _answer(campaign: str, test: str | None, **gone: Any) -> dict[str, Any]:
    nothing = {"tests": [], "models": [], "stale": [], "versions": 0, "looks": 0}
    return {"campaign": campaign, "test": test, **nothing, **gone}


def forget_earlier(con: duckdb.DuckDBPyConnection, campaign: str, tests: list[str] | None) -> int:
    """Removes the earlier versions of changed files (of some tests; None: of all); returns how many."""
    fits = "campaign = ? and layer = 'superseded'" + ("" if tests is None else " and list_contains(?, test)")
    params = [campaign] if tests is None else [campaign, tests]
    versions = fetch(con, f"select distinct source_path, sha256 from file where {fits}", params)
    con.execute(f"delete from file where {fits}", params)
    return len(versions)


def gc(store: Store, grace_s: float = 3600.0) -> dict[str, Any]:
    """Deletes the files that nothing refers to and that are older than `grace_s` [s], unfinished ones too.

    The grace protects what an ingest running meanwhile has written and not yet committed; one that outlasts it
    makes such files again. What a commit refers to is never deleted: the catalogue is held while files go.
    """
    limit = time.time() - grace_s
    removed, freed, young = 0, 0, 0
    with store.reader() as con:
        kept = _kept(con)
    candidates = [p for p in _files(store.path) if p.relative_to(store.path).as_posix() not in kept]
    for start in range(0, len(candidates), _BATCH):
        # in turns, so that no writer waits for the whole of it
        with store.standstill() as con:
            kept = _kept(con)
            for path in candidates[start : start + _BATCH]:
                if path.relative_to(store.path).as_posix() in kept:
                    continue
                try:
                    status = path.stat()
                    if status.st_mtime > limit:
                        young += 1
                        continue
                    path.unlink()
                except FileNotFoundError:
                    continue
                except OSError as error:
                    raise StoreError(
                        "a file cannot be deleted",
                        where=str(path),
                        got=str(error),
                        hint="close what has it open, or give yourself the right, and run it again",
                    ) from error
                removed, freed = removed + 1, freed + status.st_size
    for folder in [*(store.path / "model").glob("*/"), *(store.path / "raw").glob(".*.growing.tmp/")]:
        with contextlib.suppress(OSError):  # not empty, or filled again meanwhile
            folder.rmdir()
    return {"removed": removed, "bytes": freed, "too_young": young}


def _kept(con: duckdb.DuckDBPyConnection) -> set[str]:
    return {r["path"] for r in fetch(con, "select path from file union select path from prediction")}


def _files(store: Path) -> list[Path]:
    """Files of the layers, and unfinished ones at the top; never a link, never what isn't ours."""
    files = [p for p in store.iterdir() if TEMPORARY.match(p.name) and p.is_file() and not p.is_symlink()]
    for layer in LAYERS:
        for path in (store / layer).rglob("*"):
            ours = path.suffix == ".parquet" or TEMPORARY.match(path.name) or TEMPORARY.match(path.parent.name)
            if ours and path.is_file() and not path.is_symlink():
                files.append(path)
    return files


__all__ = ["forget", "gc"]
