"""Which models are stale: those that a test was fitted to which is not as it was then.

Of each such test the state that it was fitted to is kept for as long as it differs, so a model whose data are set back
is as it was. Results of a test that was forgotten went with it: its models stay stale until they are fitted again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.moment import utc_now
from thermodata.store.catalogue.models.fits import BACK, STALE
from thermodata.store.ingest.known.state import VERSION, State, what_differs

if TYPE_CHECKING:
    import duckdb

_FOUND = ("diagnosis", "weak_spot", "candidate", "artefact", "portability")


def is_fitted(con: duckdb.DuckDBPyConnection, campaign: str) -> bool:
    """Whether any model is of this campaign."""
    return bool(con.execute("select 1 from model where list_contains(campaigns, ?) limit 1", [campaign]).fetchone())


def mark_stale(
    con: duckdb.DuckDBPyConnection,
    campaign: str,
    then: Mapping[str, State | None],
    now: Mapping[str, State | None],
    *,
    forgotten: bool = False,
) -> list[str]:
    """Holds the models that used any of these tests against what is stored now, before the results of a test that is
    forgotten are dropped; one that names no tests used the whole campaign. then, now: test -> its state before and
    after. forgotten: whether results of those that are gone go with them. Returns the models that went stale."""
    if not then:
        return []
    rows = fetch(
        con,
        """
        with used as (select distinct model, test from score_row where campaign = $1
                      union select distinct model, test from prediction where campaign = $1),
        own as (select model, list(test) as tests from used group by model),
        open as (select model, list(payload::varchar order by rowid) as kept from finding
                 where campaign = $1 and kind = $2 group by model)
        select m.model, m.stale, m.result, o.tests, f.kept
        from model m left join own o on o.model = m.model left join open f on f.model = m.model
        where list_contains(m.campaigns, $1) and (o.tests is null or list_has_any(o.tests, $3) or f.kept is not null)
        """,
        [campaign, STALE, sorted(then)],
    )
    turned = []
    for row in rows:
        scored = {s["test"] for s in json.loads(row["result"]).get("scores", []) if s["campaign"] == campaign}
        used = {*(row["tests"] or ()), *scored}
        differing = _merged([json.loads(text) for text in row["kept"] or ()])
        before = dict(differing)
        for test in then:
            if test in differing or ((test in used or not used) and then[test] is not None):
                _compare_with_fitted(differing, test, then[test], now.get(test))
                if forgotten and test in differing:
                    differing[test]["forgotten"] = True
        if differing == before:
            continue
        _replace_differences(con, row["model"], campaign, differing, row["stale"] and not before)
        if not row["stale"]:
            turned.append(row["model"])
    return turned


def _merged(kept: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Test -> what is kept of it, in one."""
    found: dict[str, dict[str, Any]] = {}
    for one in kept:
        what = list(dict.fromkeys([*found.get(one["test"], {}).get("what", ()), *one["what"]]))
        found[one["test"]] = {**one, "what": what}
    return found


def _compare_with_fitted(
    differing: dict[str, dict[str, Any]], test: str, then: State | None, now: State | None
) -> None:
    """Holds a test against what was fitted, and keeps what differs, if anything does."""
    kept = differing.get(test, {"test": test, "was": then, "what": []})
    was = kept.get("was")
    if was is None:  # kept by a version that didn't say
        more = [] if then is None else what_differs(then, now)
        differing[test] = {**kept, "what": list(dict.fromkeys([*kept["what"], *more]))}
        return
    same = now is not None and was[VERSION] == now[VERSION]
    back = [BACK] if now is not None and kept.get("forgotten") else []
    what = [*([] if same else what_differs(was, now)), *back]
    if what:
        differing[test] = {**kept, "what": what}
    else:
        differing.pop(test, None)


def _replace_differences(
    con: duckdb.DuckDBPyConnection, model: str, campaign: str, differing: Mapping[str, Mapping[str, Any]], known: bool
) -> None:
    """Keeps what differs in place of what did. known: the model is stale for a reason that nobody kept."""
    of_it = [model, STALE]
    since = fetch(con, "select min(created_at) as at from finding where model = ? and kind = ?", of_it)[0]["at"]
    con.execute("delete from finding where model = ? and campaign = ? and kind = ?", [model, campaign, STALE])
    at = since or utc_now()
    insert(
        con,
        "finding",
        [
            # of no test, so that it outlasts a test that is gone
            {
                "campaign": campaign,
                "test": "",
                "model": model,
                "kind": STALE,
                "rank": None,
                "payload": json.dumps(kept),
                "created_at": at,
            }
            for kept in differing.values()
        ],
    )
    still = known or bool(fetch(con, "select 1 from finding where model = ? and kind = ? limit 1", of_it))
    con.execute("update model set stale = ? where model = ?", [still, model])
    if not still:  # what was found out meanwhile is of other data
        con.execute(
            "delete from finding where model = ? and list_contains(?, kind) and created_at >= ?",
            [model, list(_FOUND), at],
        )
