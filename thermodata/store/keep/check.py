"""Is what the store holds what was written? Every file that the catalogue names, page by page."""

from __future__ import annotations

import contextlib
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from thermodata.schema.words.sentences import counted
from thermodata.store.base.connection import fetch
from thermodata.store.base.files import is_whole, write_error
from thermodata.store.catalogue.store import Store


@dataclass(frozen=True, slots=True)
class Damaged:
    """A file of the store that isn't what was written, and whose it is (one of them, where several share it)."""

    path: str
    layer: str
    campaign: str
    test: str
    problem: str
    source_path: str | None


@dataclass(slots=True)
class Checked:
    """files and bytes: how many were looked at. removed: damaged files that a repair has put out of the way."""

    files: int = 0
    bytes: int = 0
    damaged: list[Damaged] = field(default_factory=list)
    removed: int = 0

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def check_store(store: Store, *, repair: bool = False) -> Checked:
    """Reads every Parquet file that the catalogue names, with the checksums of its pages.

    repair: removes the damaged files, so that the next `ingest` makes them anew: tidy files from the raw layer, raw
    files from their source files.
    """
    with store.reader() as con:
        rows = fetch(
            con,
            "select path, first(layer order by rowid) as layer, first(campaign order by rowid) as "
            "campaign, first(test order by rowid) as test, first(rows order by rowid) as rows, "
            "first(source_path order by rowid) as source_path, "
            "max(case when layer = 'tidy' then bytes end) as bytes from file group by path order by path",
        )
        rows += fetch(
            con,
            "select path, 'model' as layer, campaign, test, rows, null as source_path, "
            "null as bytes from prediction order by path",
        )
    checked = Checked()
    for row in rows:
        path = store.path / row["path"]
        problem = _problem(path, row["rows"], row["bytes"])
        checked.files += 1
        with contextlib.suppress(OSError):
            checked.bytes += path.stat().st_size
        if problem is not None:
            checked.damaged.append(
                Damaged(row["path"], row["layer"], row["campaign"], row["test"], problem, row["source_path"])
            )
            if repair and path.exists():
                try:
                    path.unlink()
                except OSError as error:
                    raise write_error(path, error) from error
                checked.removed += 1
    return checked


def _problem(path: Path, rows: int, size_bytes: int | None) -> str | None:
    if not path.exists():
        return "gone"
    if not is_whole(path, size_bytes):
        return "cut, or overwritten"
    return altered(path, rows)


def altered(path: Path, rows: int | None = None) -> str | None:
    """What is wrong with the pages of a Parquet file, by their checksums; None: nothing. rows: how many it should
    have."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with pq.ParquetFile(path, page_checksum_verification=True, memory_map=False) as file:
            if rows is not None and file.metadata.num_rows != rows:
                return f"{counted(file.metadata.num_rows, 'row')} instead of {rows}"
            for i in range(file.num_row_groups):
                file.read_row_group(i, use_threads=False)
    except (OSError, ValueError, pa.ArrowException) as error:  # a name that is no UTF-8 any more is a ValueError
        return "altered: " + (str(error).splitlines() or [type(error).__name__])[0]
    return None


__all__ = ["Checked", "Damaged", "check_store"]
