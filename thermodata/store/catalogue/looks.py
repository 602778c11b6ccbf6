"""How often locked tests were looked at: each look makes the next one say less."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime

from thermodata.store.base.connection import insert
from thermodata.store.catalogue.store import Store


def count_locked_look(
    store: Store, model: str, tests: Iterable[tuple[str, str]], reason: str, *, once: bool = False
) -> None:
    """Writes down that the locked tests ((campaign, test)) were looked at, and why. once: what stands there already for
    that model and reason is the same look."""
    now = datetime.now(UTC).replace(tzinfo=None)
    with store.write(views=False) as con:
        asked = "select campaign, test from locked_look where model = ? and reason = ?"
        known = set(con.execute(asked, [model, reason]).fetchall()) if once else set()
        rows = [
            {"campaign": c, "test": t, "model": model, "reason": reason, "at": now}
            for c, t in tests
            if (c, t) not in known
        ]
        insert(con, "locked_look", rows)


def locked_looks(store: Store, campaign: str, test: str) -> int:
    """How often the lock of a test was opened."""
    with store.reader() as con:
        row = con.execute(
            "select count(*) from locked_look where campaign = ? and test = ?", [campaign, test]
        ).fetchone()
    return int(row[0]) if row else 0
