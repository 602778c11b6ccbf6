"""Makes the tidy files of a campaign's tests, those that are not there yet, and the catalogue's rows of all."""

from __future__ import annotations

import dataclasses
import json
import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from thermodata.calibration.result import CalibrationResult
from thermodata.errors import SpecError, StoreError, ThermodataError
from thermodata.plugin import Loss
from thermodata.store import rows as make_rows
from thermodata.store.clocks import clocks_of
from thermodata.store.files import is_whole
from thermodata.store.gather import loss_row
from thermodata.store.keys import member_key
from thermodata.store.known import BY_TEST, Known, Row
from thermodata.store.plan import SCHEDULE, TestPlan
from thermodata.store.series import Member, TestSeries
from thermodata.store.tidy import TidyResult, write_member
from thermodata.store.timeline import span

Columns = list[tuple[str, bool]]


@dataclass(slots=True)
class Made:
    """rows: table -> test -> rows. samples and flags count the whole campaign, kept streams included."""

    rows: dict[str, dict[str, list[Row]]] = field(default_factory=lambda: {t: {} for t in BY_TEST})
    samples: int = 0
    flags: Counter[str] = field(default_factory=Counter)
    losses: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    made: int = 0


def make_tests(store: Path, plans: Sequence[TestPlan], calibrations: Mapping[str, CalibrationResult], known: Known,
               now: datetime, say: Callable[[str], None]) -> Made:
    """Tidies every stream of every test that isn't there under its content key."""
    made = Made()
    columns = _columns(plans)
    for plan in plans:
        try:
            _make_test(store, plan, columns, calibrations, known, now, say, made)
        except (StoreError, SpecError):
            raise
        except ThermodataError as error:
            made.losses.append(loss_row("; ".join(str(error).splitlines()), test=plan.test.id))
        made.losses += [loss_row(p, test=plan.test.id) for p in plan.problems]
        made.notes += plan.notes
    return made


def _columns(plans: Sequence[TestPlan]) -> dict[Member, Columns]:
    """The channels of each (source, stream) over all tests, in the campaign's order."""
    found: dict[Member, dict[str, bool]] = {}
    for plan in plans:
        for bound in plan.bound.values():
            found.setdefault((bound.source, bound.stream), {})[bound.name] = bound.is_text
    order = {name: i for plan in plans[:1] for i, name in enumerate(plan.campaign.channels)}
    return {m: sorted(c.items(), key=lambda item: order[item[0]]) for m, c in found.items()}


def _make_test(store: Path, plan: TestPlan, columns: Mapping[Member, Columns],
               calibrations: Mapping[str, CalibrationResult], known: Known, now: datetime,
               say: Callable[[str], None], made: Made) -> None:
    clocks = clocks_of(store, plan, calibrations, known.clocks)
    where = span(plan, clocks)
    series = TestSeries(store, plan, clocks, where, calibrations)
    test, campaign = plan.test.id, plan.campaign.id
    files, events = make_rows.raw_rows(plan, now), []
    for member in plan.members():
        if member[0] == SCHEDULE and not any(s.raws for s in plan.sources.values()):
            continue
        key = member_key(plan, member, columns[member], clocks, where, calibrations)
        kept = known.tidy(test, key)
        if kept and all(_still_there(store / row["path"], row["bytes"]) for row in kept):
            files += kept
            events += [r for r in known.rows["quality_event"].get(test, [])
                       if (r["source"], r["stream"]) == member]
            _count_kept(made, kept, test)
            continue
        say(f"{test}: {member[0]}/{member[1]}")
        result = write_member(series, member, columns[member], key)
        made.made += 1
        files += _tidy_rows(campaign, test, member, result, store, now)
        events += [{"campaign": campaign, "test": test, "source": member[0], "stream": member[1],
                    **dataclasses.asdict(e)} for e in result.events]
        _count_new(made, result, test, member)
    for row in files:
        # the same clock for all of one ingest, and for a kept file the moment at which it was made
        row.setdefault("added_at", now)
    _add(made, test, "file", files)
    _add(made, test, "quality_event", events)
    _add(made, test, "test", [make_rows.test_row(plan, where, _duration(plan, files))])
    _add(made, test, "machine", [make_rows.machine_row(plan.campaign, plan)])
    _add(made, test, "source", make_rows.source_rows(plan, clocks))
    _add(made, test, "channel", make_rows.channel_rows(plan, calibrations))
    made.notes += [f"{test}, {name}: {n}" for name, clock in clocks.items() for n in clock.notes]
    made.notes += [f"{r.source_path}: {n}" for s in plan.sources.values() for r in s.raws for n in r.notes]
    made.losses += [loss_row(n, test=test, source=name) for name, clock in clocks.items()
                    for n in clock.notes if clock.suspect]


def _still_there(path: Path, size_bytes: int) -> bool:
    if not is_whole(path, size_bytes):
        return False
    try:
        os.utime(path)       # so that a gc which runs meanwhile sees a young file
    except OSError:
        return False
    return True


def _duration(plan: TestPlan, files: Sequence[Row]) -> float | None:
    """How long the recording is [s]: that of its reference sources, as far as they were tidied."""
    ends = {r["source"]: json.loads(r["columns"])["to_s"] for r in files
            if r["layer"] == "tidy" and r["part"] == "test"}
    if plan.test.window is not None and ends:
        a, b = plan.test.window
        return float(min(b - a, max(ends.values())))
    wanted = [ends[s.name] for s in plan.reference if s.name in ends] or list(ends.values())
    return max(wanted, default=None)


def _tidy_rows(campaign: str, test: str, member: Member, result: TidyResult, store: Path, now: datetime) -> list[Row]:
    rows: list[Row] = []
    for file in result.files:
        meta: dict[str, Any] = {"channels": file.columns, "to_s": file.to_s}
        if file is result.files[-1]:
            meta |= {"samples": result.samples, "flags": dict(result.flags), "problems": result.problems}
        rows.append({
            "campaign": campaign, "test": test, "source": member[0], "stream": member[1], "layer": "tidy",
            "part": file.part, "key": file.key, "path": file.path, "source_path": None, "sha256": None,
            "bytes": (store / file.path).stat().st_size, "rows": file.rows, "columns": json.dumps(meta, sort_keys=True),
            "losses": json.dumps([dataclasses.asdict(x) for x in result.losses] if file is result.files[-1] else []),
            "added_at": now})
    return rows


def _count_new(made: Made, result: TidyResult, test: str, member: Member) -> None:
    made.samples += result.samples
    made.flags.update(result.flags)
    made.losses += [loss_row(p, test=test) for p in result.problems]
    made.losses += [loss_row(x.reason, test=test, source=member[0], loss=x) for x in result.losses]


def _count_kept(made: Made, kept: Sequence[Row], test: str) -> None:
    for row in kept:
        meta = json.loads(row["columns"])
        made.samples += meta.get("samples", 0)
        made.flags.update(meta.get("flags", {}))
        made.losses += [loss_row(p, test=test) for p in meta.get("problems", [])]
        for item in json.loads(row["losses"] or "[]"):
            made.losses.append(loss_row(item["reason"], test=test, source=row["source"], loss=Loss(**item)))


def _add(made: Made, test: str, table: str, rows: list[Row]) -> None:
    made.rows[table][test] = rows


__all__ = ["Made", "make_tests"]
