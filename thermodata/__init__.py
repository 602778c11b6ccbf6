"""thermodata: thermal test logs of machine tools, from raw files to the missing physical effect."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.version import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from thermodata.view import StoreView

__all__ = ["__version__", "open"]


def open(path: str | Path = "thermodata.store") -> StoreView:
    """Open a store for reading and querying: `thermodata.open("store").sql("select * from test")`."""
    from thermodata.view import StoreView

    return StoreView(path)
