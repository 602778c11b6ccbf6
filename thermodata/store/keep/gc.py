"""`gc`: files of a store that nothing refers to any more."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import StoreError
from thermodata.store.base.connection import fetch
from thermodata.store.base.files import TEMPORARY
from thermodata.store.catalogue.format.create import LAYERS
from thermodata.store.catalogue.store import Store

if TYPE_CHECKING:
    import duckdb

_BATCH = 500  # files deleted in one turn at the catalogue: some 20 ms


def gc(store: Store, grace_s: float = 3600.0) -> dict[str, Any]:
    """Deletes the files that nothing refers to and that are older than `grace_s` [s], unfinished ones too.

    The grace protects what an ingest running meanwhile has written and not yet committed; one that outlasts it
    makes such files again. What a commit refers to is never deleted: the catalogue is held while files go.
    """
    limit = time.time() - grace_s
    removed, freed, young = 0, 0, 0
    with store.reader() as con:
        candidates = _files_of_no_row(_files(store.path), store.path, _named_by_rows(con))
    for start in range(0, len(candidates), _BATCH):
        # in turns, so that no writer waits for the whole of it
        with store.standstill() as con:
            for path in _files_of_no_row(candidates[start : start + _BATCH], store.path, _named_by_rows(con)):
                try:
                    size = _deleted(path, limit)
                except FileNotFoundError:
                    continue
                if size is None:
                    young += 1
                else:
                    removed, freed = removed + 1, freed + size
    for folder in [*(store.path / "model").glob("*/"), *(store.path / "raw").glob(".*.growing.tmp/")]:
        with contextlib.suppress(OSError):  # not empty, or filled again meanwhile
            folder.rmdir()
    return {"removed": removed, "bytes": freed, "too_young": young}


def _deleted(path: Path, limit: float) -> int | None:
    """Deletes a file; its size in bytes. None: it was written after `limit` [s since 1970] and stays. StoreError where
    it can't be deleted; FileNotFoundError where somebody else did it."""
    try:
        status = path.stat()
        if status.st_mtime > limit:
            return None
        path.unlink()
    except FileNotFoundError:
        raise
    except OSError as error:
        raise StoreError(
            "a file cannot be deleted",
            where=str(path),
            got=str(error),
            hint="close what has it open, or give yourself the right, and run it again",
        ) from error
    return status.st_size


def _files_of_no_row(paths: list[Path], store: Path, kept: set[str]) -> list[Path]:
    return [p for p in paths if p.relative_to(store).as_posix() not in kept]


def _named_by_rows(con: duckdb.DuckDBPyConnection) -> set[str]:
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
