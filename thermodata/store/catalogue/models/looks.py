"""How often locked tests were looked at: each look makes the next one say less."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from thermodata.store.base.connection import insert
from thermodata.store.base.moment import utc_now
from thermodata.store.catalogue.store import Store


@dataclass(frozen=True, slots=True)
class Look:
    """model: id of that which it was opened for."""

    model: str
    reason: str


def count_locked_look(
    store: Store, model: str, tests: Iterable[tuple[str, str]], reason: str, *, once: bool = False
) -> None:
    """Writes down that the locked tests ((campaign, test)) were looked at, and why. once: what stands there already for
    that model and reason is the same look."""
    now = utc_now()
    with store.write(views=False) as con:
        asked = "select campaign, test from locked_look where model = ? and reason = ?"
        known = set(con.execute(asked, [model, reason]).fetchall()) if once else set()
        rows = [
            {"campaign": c, "test": t, "model": model, "reason": reason, "at": now}
            for c, t in tests
            if (c, t) not in known
        ]
        insert(con, "locked_look", rows)


def looked_for(store: Store, model: str, asked: str, of: str, *, with_others: bool) -> set[tuple[str, str]]:
    """The locked tests that were opened for a candidate, by a claim or by choice. of: what the reason says of the
    response. with_others: whether those count in which it was asked with others; its errors alone are not told there as
    a rule."""
    with store.reader() as con:
        rows = con.execute("select campaign, test, reason from locked_look where model = ?", [model]).fetchall()
    found = set()
    for campaign, test, reason in rows:
        said = reason.removeprefix("confirming ").removesuffix(", by choice")
        names = said.removesuffix(of).split(", ") if said.endswith(of) else []
        if names == [asked] or (with_others and asked in names):
            found.add((campaign, test))
    return found


def looks_of(store: Store, campaigns: Iterable[str]) -> dict[tuple[str, str], list[Look]]:
    """Each test of the campaigns whose lock was opened -> its looks, the first one first. They are the test's, for
    whichever model it was opened."""
    with store.reader() as con:
        rows = con.execute(
            "select campaign, test, model, reason from locked_look where list_contains(?, campaign) "
            'order by campaign, test, "at", rowid',
            [list(campaigns)],
        ).fetchall()
    found: dict[tuple[str, str], list[Look]] = {}
    for campaign, test, model, reason in rows:
        found.setdefault((campaign, test), []).append(Look(model, reason))
    return found


def locked_looks(store: Store, campaign: str, test: str) -> int:
    """How often the lock of a test was opened."""
    return len(looks_of(store, [campaign]).get((campaign, test), []))


def open_in(store: Store, campaigns: Iterable[str]) -> dict[tuple[str, str], list[str]]:
    """Each locked test of the campaigns that a model was fitted to or checked on while it was open -> 'name id' of
    those models, the first of them first."""
    with store.reader() as con:
        rows = con.execute(
            "select distinct s.campaign, s.test, m.name, m.model, m.created_at from score_row s join test t using "
            "(campaign, test) join model m on m.model = s.model where list_contains($1, s.campaign) "
            "and t.role = 'locked' and s.role not in ('locked', 'none') order by s.campaign, s.test, m.created_at",
            [list(campaigns)],
        ).fetchall()
    found: dict[tuple[str, str], list[str]] = {}
    for campaign, test, name, model, _ in rows:
        found.setdefault((campaign, test), []).append(f"{name} {model}")
    return found
