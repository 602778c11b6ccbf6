"""Folders that hold no logs: stores, with their locks and tables."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

_CATALOGUE = "catalog.duckdb"


def is_store(folder: Path) -> bool:
    """Whether a folder is a store: by its catalogue, or by its name where that is not written yet."""
    return folder.name.endswith(".store") or (folder / _CATALOGUE).is_file()


def within_stores(folder: Path) -> Callable[[Path], bool]:
    """Tells of paths below a folder whether they lie in a store below it; each folder is looked at once."""
    known: dict[Path, bool] = {folder: False}

    def within(path: Path) -> bool:
        parent = path.parent
        if parent not in known:
            known[parent] = is_store(parent) or within(parent)
        return known[parent]

    return within
