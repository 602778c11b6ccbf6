"""All that was flagged and lost in a store, as rows: what `quality` prints, and the workbench's page of it shows."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from thermodata.errors import unknown_name
from thermodata.reader.text import split_unit
from thermodata.schema.flag import Flag
from thermodata.store.base.connection import fetch
from thermodata.store.views.result import OF_ITS_TEST
from thermodata.view.lists.not_measured import OUTSIDE, not_measured

if TYPE_CHECKING:
    from thermodata.store import Store

Row = dict[str, Any]


def flag_rows(store: Store, campaign: str | None = None) -> list[Row]:
    """Rows as those of `quality_event`, of one campaign where one is named: the events of sensors and clocks, what lies
    outside of its test's `measuring` (a row a source, without times), and what a log itself says it did not measure.
    UsageError for a campaign that there is not."""
    events = _rows(store, f"select * from quality_event e where {OF_ITS_TEST}", campaign, "source, channel, from_s")
    said_by_log = not_measured(store, campaign)
    told = {(row["campaign"], row["test"]) for row in said_by_log}
    return [*events, *_outside(_files(store, campaign), told), *said_by_log]


def lost(store: Store, campaign: str | None = None) -> list[Row]:
    """What could not be read or made, each once: campaign, test, file, where, reason, and the tests and sources that
    miss it."""
    signals = _signals(store, campaign)
    once: dict[str, Row] = {}
    for row in _files(store, campaign):
        place = {"campaign": row["campaign"], "test": row["test"] or None, "file": row["source_path"]}
        found = [{**place, **loss} for loss in json.loads(row["losses"] or "[]")]
        found += [{**place, "reason": p} for p in row["meta"].get("problems", [])]
        for loss in found:
            key = json.dumps([loss.get(k) for k in ("campaign", "file", "where", "reason")])
            one = once.setdefault(key, {**loss, "tests": [], "sources": []})
            if row["test"] and row["test"] not in one["tests"]:
                one["tests"].append(row["test"])
            signal = loss.get("signal")
            read = (
                signal is None or (row["campaign"], row["test"], row["source"], _name_without_unit(signal)) in signals
            )
            if row["source"] and row["source"] not in one["sources"] and (read or not row["test"]):
                one["sources"].append(row["source"])
    for one in once.values():
        if one.get("signal") and one["test"] and not one["sources"]:
            one["reason"] += "; no channel reads that column"
    return list(once.values())


def faults_told(store: Store, campaign: str | None = None) -> list[Row]:
    """Faults of the logs that no flag tells, one for each model beside which `diagnose` told it: campaign, test, kind,
    at_s, size_um, response, name, model, stale."""
    query = (
        "select a.campaign, a.test, a.kind, a.at_s, a.size_um, a.response, m.name, m.model, m.stale from artefact a "
        "join model m using (model) where not list_contains(['sensor', 'parameters'], a.kind)"
    )  # the one is what flags say, the other no fault of a log
    return _rows(store, query, campaign, "at_s, name, model")


def _rows(store: Store, query: str, campaign: str | None, order: str) -> list[Row]:
    """By campaign and test."""
    with store.reader() as con:
        names = [row["campaign"] for row in fetch(con, "select campaign from campaign order by 1")]
        if campaign is not None and campaign not in names:
            raise unknown_name("campaign", campaign, names)
        where = "" if campaign is None else " where campaign = ?"
        params = None if campaign is None else [campaign]
        return fetch(con, f"select * from ({query}){where} order by campaign, test, {order}", params)


def _files(store: Store, campaign: str | None) -> list[Row]:
    """Rows of `file`, with what is kept of each beside its columns."""
    query = "select campaign, test, source, source_path, losses, columns from file where layer <> 'superseded'"
    files = _rows(store, query, campaign, "source")
    for row in files:
        meta = json.loads(row["columns"] or "{}")
        row["meta"] = meta if isinstance(meta, dict) else {}
    return files


def _outside(files: list[Row], said_by_log: set[tuple[str, str]]) -> list[Row]:
    """As events: what lies outside of its test's `measuring` is no event of a sensor, and counts as little.
    said_by_log: tests without `measuring`, in which a log said that nothing was measured."""
    return [
        {
            **{key: row[key] for key in ("campaign", "test", "source")},
            **dict.fromkeys(("stream", "channel", "from_s", "to_s")),
            "flag": Flag.NOT_MEASURING.word,
            "n": n,
            "detail": OUTSIDE,
        }
        for row in files
        if (n := row["meta"].get("flags", {}).get(Flag.NOT_MEASURING.word, 0))
        and (row["campaign"], row["test"]) not in said_by_log
    ]


def _signals(store: Store, campaign: str | None) -> set[tuple[str, str, str, str]]:
    """(campaign, test, source, signal without its unit) of every channel."""
    query = "select distinct campaign, test, source, signal from channel where signal is not null"
    return {
        (row["campaign"], row["test"], row["source"], _name_without_unit(row["signal"]))
        for row in _rows(store, query, campaign, "source")
    }


def _name_without_unit(signal: str) -> str:
    return split_unit(signal)[0].casefold()
