"""Channels that a campaign file calls otherwise than when a model was fitted: the same signal of the same source."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thermodata.schema.files.model import Model, Response
from thermodata.store.base.connection import fetch

if TYPE_CHECKING:
    import duckdb

CHANNELS = "channels"
"""Of what is kept of a test as a model was fitted to it: where each channel came from, as `origins` has it."""

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def origins(channels: Sequence[Mapping[str, Any]]) -> str:
    """Rows of channels as JSON: name -> [source, signal], of those that are read from a file."""
    found = {r["channel"]: [r["source"], r["signal"]] for r in channels if r["signal"] is not None}
    return json.dumps(found, sort_keys=True)


def renamed(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str], model: str | None = None) -> dict[str, str]:
    """Name in a fit -> name now, of channels whose name is gone; of one model, or of all that are stale. A name that
    leads to several is left out."""
    kept = fetch(
        con,
        "select distinct campaign, payload::varchar as kept from finding where kind = 'stale' "
        "and list_contains($1, campaign) and ($2 is null or model = $2)",
        [list(campaigns), model],
    )
    was = [(r["campaign"], one["test"], origin) for r in kept if (origin := _origins_in(one := json.loads(r["kept"])))]
    if not was:
        return {}
    now: dict[tuple[str, str], dict[str, str]] = {}
    names: set[str] = set()
    for row in fetch(
        con,
        "select campaign, test, channel, source, signal from channel where list_contains(?, campaign)",
        [list(campaigns)],
    ):
        names.add(row["channel"])
        now.setdefault((row["campaign"], row["test"]), {})[json.dumps([row["source"], row["signal"]])] = row["channel"]
    found: dict[str, set[str]] = {}
    for campaign, test, origin in was:
        there = now.get((campaign, test), {})
        for name, at in origin.items():
            if name not in names and json.dumps(at) in there:
                found.setdefault(name, set()).add(there[json.dumps(at)])
    return {name: hits.pop() for name, hits in found.items() if len(hits) == 1}


def _origins_in(kept: Mapping[str, Any]) -> dict[str, list[str]]:
    return json.loads((kept.get("was") or {}).get(CHANNELS, "{}"))  # type: ignore[no-any-return]


def with_names(spec: Model, names: Mapping[str, str]) -> Model:
    """The same model with channels called as they are now."""

    def text(given: str) -> str:
        return _NAME.sub(lambda found: names.get(found[0], found[0]), given)

    def of(response: Response) -> Response:
        named = response.channel is not None
        return response.model_copy(
            update={"channel": names.get(response.channel or "", response.channel)} if named else {}
        )

    effects = [
        e.model_copy(
            update={
                "drivers": {role: text(d) if isinstance(d, str) else d for role, d in e.drivers.items()},
                "response": None if e.response is None else of(e.response),
                "acts_on": None if e.acts_on is None else [of(r) for r in e.acts_on],
                "inside": None
                if e.inside is None
                else with_names(Model.model_validate(e.inside), names).model_dump(mode="json", by_alias=True),
            }
        )
        for e in spec.effects
    ]
    response = [of(r) for r in spec.response] if isinstance(spec.response, list) else of(spec.response)
    return spec.model_copy(update={"effects": effects, "response": response})


def renamings(names: Mapping[str, str]) -> str:
    """'T_a is called T_b now', of each."""
    return ", ".join(f"{old} is called {new} now" for old, new in names.items())
