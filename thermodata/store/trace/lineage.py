"""Where a value comes from: raw file, hash, place in it, reader, scaling, calibration, sign."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError, unknown_channel, unknown_name
from thermodata.schema.words.sentences import with_count
from thermodata.store.base.connection import fetch
from thermodata.store.catalogue.models.came_after import came_after
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.catalogue.store import Store
from thermodata.store.ingest.known.file_versions import SUPERSEDED
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.source_file import settled
from thermodata.store.tidy.plan import derive
from thermodata.store.trace.jump_rows import jump_rows
from thermodata.store.trace.replan import read_campaign
from thermodata.store.trace.reread import reread
from thermodata.store.trace.sample import find_sample

Answer = dict[str, Any]
_NAMED = 12  # tests


def trace(
    store: Store,
    campaign: str,
    test: str | None = None,
    channel: str | None = None,
    t_s: float | None = None,
    *,
    verify: bool = False,
) -> Answer:
    """The way back from a model (one name), a test, a channel, or one sample (with t_s, seconds) to the raw files.

    verify: also hashes the source files that are still there, and reads a sample's row in its file again.
    UsageError for a name that isn't there, with the nearest right one.
    """
    if test is None:
        return _model_or_which_test(store, campaign)
    with store.reader() as con:
        campaigns = [r["campaign"] for r in fetch(con, "select campaign from campaign")]
        if campaign not in campaigns:
            raise unknown_name("campaign", campaign, campaigns)
        tests = [r["test"] for r in fetch(con, "select test from test where campaign = ?", [campaign])]
        if test not in tests:
            raise unknown_name("test", test, tests)
        tracer = _Tracer(con, store, campaign, test, verify)
        if channel is None:
            return tracer.test()
        if channel not in tracer.channels:
            raise unknown_channel(channel, list(tracer.channels))
        return tracer.head() | tracer.channel(channel, t_s, at_sample=t_s is not None)


def _model_or_which_test(store: Store, name: str) -> Answer:
    """UsageError with the tests where that is a campaign, and no model."""
    try:
        return _model(store, name)
    except UsageError as error:
        with store.reader() as con:
            tests = [r["test"] for r in fetch(con, "select test from test where campaign = ?", [name])]
        if not tests:
            raise
        raise UsageError(
            f"'{name}' is a campaign: name one of its tests",
            expected=with_count(tests, _NAMED),
            got="no test",
            hint=f"thermodata trace {name} {tests[0]}",
        ) from error


class _Tracer:
    """What the catalogue says about one test."""

    def __init__(self, con: Any, store: Store, campaign: str, test: str, verify: bool) -> None:
        self.con, self.store, self.name, self.of, self.verify = con, store, campaign, test, verify
        here = [campaign, test]
        self.rows = fetch(con, "select * from channel where campaign = ? and test = ?", here)
        self.channels = {r["channel"]: r for r in self.rows}
        self.files = fetch(con, "select * from file where campaign = ? and test = ? order by rowid", here)
        self.sources = fetch(con, "select * from source where campaign = ? and test = ?", here)
        self.calibrations = fetch(con, "select * from calibration where campaign = ?", [campaign])
        self.jumps = fetch(con, "select * from file where campaign = ? and test = ''", [campaign])
        self.kept = fetch(
            con, "select path, ingested_at, spec_hash, data_version from campaign where campaign = ?", [campaign]
        )[0]
        self.spec = read_campaign(con, campaign)
        self._stands: dict[str, str] = {}

    def head(self) -> Answer:
        return {
            "campaign": self.name,
            "test": self.of,
            "campaign_file": self.kept["path"],
            "spec_hash": self.kept["spec_hash"],
            "data_version": self.kept["data_version"],
            "ingested_at": str(self.kept["ingested_at"]),
        }

    def test(self) -> Answer:
        return self.head() | {
            "files": self._files(self.files),
            "tidy": self._tidy(self.files),
            "channels": list(self.channels),
        }

    def channel(self, name: str, t_s: float | None, *, at_sample: bool) -> Answer:
        """at_sample: the rows of jump tests are told too."""
        row = self.channels[name]
        here = [f for f in self.files if (f["source"], f["stream"]) == (row["source"], row["stream"])]
        source = next((s for s in self.sources if (s["source"], s["stream"]) == (row["source"], row["stream"])), None)
        named = [n for n in (row["calibration"] or "").split(", ") if n]
        steps = [
            {k: _decoded(v) for k, v in c.items() if k != "campaign"} | self._jump(c, at_sample=at_sample)
            for n in named
            for c in self.calibrations
            if c["calibration"] == n
        ]
        declared = self.spec.channels.get(name)
        answer: Answer = (
            {"channel": name}
            | {k: row[k] for k in ("quantity", "unit", "sign", "at", "axis", "source", "stream", "signal", "raw_unit")}
            | {
                "derive": declared.derive if declared is not None and row["signal"] is None else None,
                "schedule": None if declared is None or declared.schedule is None else repr(declared.schedule),
                "scaling": _scaling(here, row["signal"]),
                "calibrations": steps,
                "clock": None if source is None else {k: _decoded(source[k]) for k in ("clock", "offset_ns", "notes")},
                "files": self._files(here) if row["signal"] is not None else [],
                "tidy": self._tidy(here),
            }
        )
        if t_s is not None:
            answer["sample"] = find_sample(
                self.con, self.store.path, self.name, self.of, row, t_s, self._read_again if self.verify else None
            )
        if answer["derive"]:
            answer["operands"] = [
                self.channel(n, None, at_sample=at_sample)
                for n in sorted(derive.names(answer["derive"]))
                if n in self.channels
            ]
        return answer

    def _jump(self, calibration: Answer, *, at_sample: bool) -> Answer:
        """The files of a calibration that a jump test gave, and for a sample the rows of its plateaus."""
        name = calibration["calibration"]
        files = [f for f in self.jumps if f["source"] == name]
        raws = [RawStream.from_row(f) for f in files if f["layer"] == "raw"] if at_sample else []
        plateaus = json.loads(calibration["detail"] or "{}").get("plateaus", [])
        return {
            "files": self._files(files),
            "rows": jump_rows(self.store.path, self.spec, name, plateaus, raws) or None,
        }

    def _files(self, rows: list[Answer]) -> list[Answer]:
        earlier = [r for r in rows if r["layer"] == SUPERSEDED]
        files = []
        for row in rows:
            if row["layer"] == "raw":
                older = [_file(r) for r in earlier if all(r[k] == row[k] for k in ("source", "source_path", "stream"))]
                now = {"now": self._stand(row)} if self.verify else {}
                files.append(_file(row) | now | {"earlier": sorted(older, key=lambda f: str(f["superseded_at"]))})
        return files

    def _stand(self, row: Answer) -> str:
        """How the source file stands today against what was ingested."""
        path = row["source_path"]
        if path not in self._stands:
            try:
                same = settled(self._folder() / path).sha256 == row["sha256"]
                self._stands[path] = "unchanged" if same else "changed since: its hash differs"
            except FileNotFoundError:
                self._stands[path] = "not there any more"
            except Exception as error:
                self._stands[path] = "cannot be read: " + "; ".join(str(error).splitlines())
        return self._stands[path]

    def _folder(self) -> Path:
        return Path(self.kept["path"]).parent

    def _read_again(self, raw: RawStream, row: int, signal: str, source: str) -> Answer:
        """A row read in its source file once more, by the reader of today."""
        stand = self._stand({"source_path": raw.source_path, "sha256": raw.sha256})
        if stand != "unchanged":
            return {"file": stand, "value": None}
        return {"file": stand} | reread(
            self._folder() / raw.source_path, raw, row, signal, source, self.spec.sources[source].of_test(self.of)
        )

    @staticmethod
    def _tidy(rows: list[Answer]) -> list[Answer]:
        return [{k: r[k] for k in ("path", "key", "part", "rows")} for r in rows if r["layer"] == "tidy"]


def _model(store: Store, ref: str) -> Answer:
    model = find_model(store, ref)
    with store.reader() as con:
        row = fetch(con, "select data_version, created_at from model where model = ?", [model.model])[0]
        used = fetch(
            con,
            "select distinct s.campaign, s.test, f.source, f.source_path, f.sha256, f.part from "
            "score_row s join file f on f.campaign = s.campaign and f.test = s.test "
            "where s.model = ? and f.layer = 'raw' order by all",
            [model.model],
        )
        now = fetch(
            con,
            "select campaign, data_version from campaign where list_contains(?, campaign)",
            [list(model.spec.campaign_ids)],
        )
    return {
        "model": model.model,
        "name": model.name,
        "parent": model.parent,
        "stale": model.stale,
        "not_fitted_to": came_after(store, model),
        "data_version": row["data_version"],
        "created_at": str(row["created_at"]),
        "campaigns": now,
        "files": used,
    }


def _file(row: Answer) -> Answer:
    raw = RawStream.from_row(row)
    entry = {
        "source_path": raw.source_path,
        "sha256": raw.sha256,
        "bytes": raw.bytes,
        "source": row["source"],
        "stream": raw.stream,
        "reader": f"{raw.reader} {raw.reader_version}".strip(),
        "rows": raw.rows,
        "from_ns": raw.first_ns,
        "to_ns": raw.last_ns,
        "added_at": str(row["added_at"]),
        "raw": raw.path,
        "losses": [loss.reason for loss in raw.losses],
        "notes": list(raw.notes),
    }
    if row["layer"] == SUPERSEDED:
        entry["superseded_at"] = json.loads(row["columns"]).get("superseded_at")
    return entry


def _scaling(files: list[Answer], signal: str | None) -> Answer | None:
    for row in files:
        if row["layer"] == "raw":
            for s in RawStream.from_row(row).signals:
                if s.name == signal and s.scaling is not None:
                    return {"kind": s.scaling.kind, **dict(s.scaling.properties)}
    return None


def _decoded(value: Any) -> Any:
    return json.loads(value) if isinstance(value, str) and value[:1] in ("{", "[") else value


__all__ = ["trace"]
