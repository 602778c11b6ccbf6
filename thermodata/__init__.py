"""thermodata: thermal test logs of machine tools, from raw files to the missing physical effect."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.version import __version__

if TYPE_CHECKING:
    from pathlib import Path

    from thermodata.notebook.opened import OpenStore

__all__ = ["__version__", "open"]


def open(path: str | Path = "thermodata.store") -> OpenStore:
    """Open a store, to query it and to work on it; docs/python.md shows all of it.

    `store.sql("select * from test")`; `store.fit("model.yaml").diagnose().add(1).plot()`.
    """
    from thermodata.notebook.opened import OpenStore

    return OpenStore(path)
