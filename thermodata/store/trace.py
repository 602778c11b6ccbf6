"""Where a value comes from: raw file, hash, place in it, reader, scaling, calibration, sign."""

from __future__ import annotations

import json
from typing import Any

from thermodata.errors import UsageError, unknown_name
from thermodata.store.connection import fetch
from thermodata.store.models import find_model
from thermodata.store.raw import RawStream
from thermodata.store.rawread import read_column
from thermodata.store.store import Store

Found = dict[str, Any]


def trace(store: Store, campaign: str, test: str | None = None, channel: str | None = None,
          t_s: float | None = None) -> Found:
    """The way back from a model (one name), a test, a channel, or one sample (with t_s, seconds) to the raw files.

    UsageError for a name that isn't there, with the nearest right one.
    """
    if test is None:
        return _model(store, campaign)
    with store.reader() as con:
        campaigns = [r["campaign"] for r in fetch(con, "select campaign from campaign")]
        if campaign not in campaigns:
            raise unknown_name("campaign", campaign, campaigns)
        tests = [r["test"] for r in fetch(con, "select test from test where campaign = ?", [campaign])]
        if test not in tests:
            raise unknown_name("test", test, tests)
        channels = fetch(con, "select * from channel where campaign = ? and test = ?", [campaign, test])
        files = fetch(con, "select * from file where campaign = ? and test = ?", [campaign, test])
        sources = fetch(con, "select * from source where campaign = ? and test = ?", [campaign, test])
        calibrations = fetch(con, "select * from calibration where campaign = ?", [campaign])
        jumps = fetch(con, "select * from file where campaign = ? and test = '' and layer = 'raw'", [campaign])
        spec = fetch(con, "select path, ingested_at, spec_hash from campaign where campaign = ?", [campaign])[0]
        value = _value(con, campaign, test, channel, t_s)
    head: Found = {"campaign": campaign, "test": test, "campaign_file": spec["path"], "spec_hash": spec["spec_hash"],
                   "ingested_at": str(spec["ingested_at"])}
    if channel is None:
        return head | {"files": [_file(f) for f in files if f["layer"] == "raw"],
                       "tidy": [_tidy(f) for f in files if f["layer"] == "tidy"],
                       "channels": [c["channel"] for c in channels]}
    row = next((c for c in channels if c["channel"] == channel), None)
    if row is None:
        raise unknown_name("channel", channel, [c["channel"] for c in channels])
    here = [f for f in files if (f["source"], f["stream"]) == (row["source"], row["stream"])]
    source = next((s for s in sources if (s["source"], s["stream"]) == (row["source"], row["stream"])), None)
    named = (row["calibration"] or "").split(", ")
    steps = [{k: _decoded(v) for k, v in c.items() if k != "campaign"} |
             {"files": [_file(f) for f in jumps if f["source"] == c["calibration"]]}
             for n in named for c in calibrations if c["calibration"] == n]
    found = head | {
        "channel": channel, "quantity": row["quantity"], "unit": row["unit"], "sign": row["sign"],
        "source": row["source"], "stream": row["stream"], "signal": row["signal"], "raw_unit": row["raw_unit"],
        "scaling": _scaling(here, row["signal"]), "calibrations": steps,
        "clock": None if source is None else {k: _decoded(source[k]) for k in ("clock", "offset_ns", "notes")},
        "files": [_file(f) for f in here if f["layer"] == "raw"],
        "tidy": [_tidy(f) for f in here if f["layer"] == "tidy"]}
    if t_s is not None:
        found["sample"] = value and value | {"raw": _place(store, here, source, row["signal"], value["t_ns"])}
    return found


def _model(store: Store, ref: str) -> Found:
    model = find_model(store, ref)
    with store.reader() as con:
        row = fetch(con, "select data_version, created_at from model where model = ?", [model.model])[0]
        used = fetch(con, "select distinct s.campaign, s.test, f.source, f.source_path, f.sha256, f.part from "
                          "score_row s join file f on f.campaign = s.campaign and f.test = s.test "
                          "where s.model = ? and f.layer = 'raw' order by all", [model.model])
        now = fetch(con, "select campaign, data_version from campaign where list_contains(?, campaign)",
                    [list(model.spec.campaign_ids)])
    return {"model": model.model, "name": model.name, "parent": model.parent, "stale": model.stale,
            "data_version": row["data_version"], "created_at": str(row["created_at"]), "campaigns": now,
            "files": used}


def _value(con: Any, campaign: str, test: str, channel: str | None, t_s: float | None) -> Found | None:
    if t_s is None or channel is None:
        return None
    found = fetch(con, "select epoch_ns(t) as t_ns, t_s, value, flag from signal(?, ?, ?) "
                       "order by abs(t_s - ?) limit 1", [campaign, test, channel, t_s])
    if not found:
        raise UsageError(f"channel '{channel}' has no numeric samples in test '{test}'")
    return found[0]


def _place(store: Store, files: list[Found], source: Found | None, signal: str | None, t_ns: int) -> Found | None:
    """The raw row nearest to a time: file, hash, row number and raw value."""
    import numpy as np

    if source is None or signal is None:
        return None
    best: tuple[int, Found] | None = None
    for row in files:
        if row["layer"] != "raw":
            continue
        raw = RawStream.from_row(row)
        t = read_column(store.path / raw.path, "t_ns", 0, raw.rows)
        base = raw.start_ns or 0 if raw.clock == "relative" else 0
        wanted = t_ns - source["offset_ns"] - base
        i = int(np.argmin(np.abs(t - wanted)))
        column = raw.columns.get(signal)
        if column is not None and (best is None or abs(int(t[i]) - wanted) < best[0]):
            value = read_column(store.path / raw.path, column, i, i + 1)[0]
            best = abs(int(t[i]) - wanted), {
                "source_path": raw.source_path, "sha256": raw.sha256, "row": i, "t_ns": int(t[i]),
                "raw_value": value.item() if hasattr(value, "item") else value}
    return best[1] if best else None


def _file(row: Found) -> Found:
    raw = RawStream.from_row(row)
    return {"source_path": raw.source_path, "sha256": raw.sha256, "bytes": raw.bytes, "source": row["source"],
            "stream": raw.stream, "reader": f"{raw.reader} {raw.reader_version}".strip(), "rows": raw.rows,
            "from_ns": raw.first_ns, "to_ns": raw.last_ns, "raw": raw.path,
            "losses": [loss.reason for loss in raw.losses]}


def _tidy(row: Found) -> Found:
    return {"path": row["path"], "key": row["key"], "part": row["part"], "rows": row["rows"]}


def _scaling(files: list[Found], signal: str | None) -> Found | None:
    for row in files:
        if row["layer"] == "raw":
            for s in RawStream.from_row(row).signals:
                if s.name == signal and s.scaling is not None:
                    return {"kind": s.scaling.kind, **dict(s.scaling.properties)}
    return None


def _decoded(value: Any) -> Any:
    return json.loads(value) if isinstance(value, str) and value[:1] in ("{", "[") else value
