"""The store: one folder with a catalogue and immutable Parquet files. Nothing above this floor opens DuckDB files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.store.catalogue.store import Store

__all__ = ["Store"]
__getattr__ = on_demand(__name__, {"catalogue.store": "Store"})
