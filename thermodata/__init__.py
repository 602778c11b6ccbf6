"""thermodata: thermal test logs of machine tools, from raw files to the missing physical effect."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from thermodata.view import StoreView

__version__ = "0.1.0"


def open(path: str | Path = "thermodata.store") -> StoreView:
    """Open a store for reading and querying: `thermodata.open("store").sql("select * from test")`."""
    from thermodata.view import StoreView

    return StoreView(path)
