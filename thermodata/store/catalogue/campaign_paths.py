"""Which ids of campaigns a store holds, and the files that they came from."""

from __future__ import annotations

from pathlib import Path

from thermodata.errors import ThermodataError
from thermodata.store.catalogue.store import Store


def campaign_paths(folder: Path) -> dict[str, str]:
    """Id -> path of its campaign file; none where there is no store, or it can't be read: who drafts needs none."""
    if not Store.is_at(folder):
        return {}
    try:
        with Store(folder).reader() as con:
            return {
                str(name): str(path or "")
                for name, path in con.execute("select campaign, path from campaign").fetchall()
            }
    except ThermodataError:
        return {}
