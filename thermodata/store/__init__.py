"""The store: one folder with a catalogue and immutable Parquet files. Nothing above this floor opens DuckDB files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.store.catalogue.store import Store

__all__ = ["Store"]


def __getattr__(name: str) -> Any:
    if name == "Store":
        from thermodata.store.catalogue.store import Store

        return Store
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
