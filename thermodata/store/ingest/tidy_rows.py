"""The catalogue's rows of tidy files, what they tell of a test, and how long it is."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from thermodata.plugin import Loss
from thermodata.store.ingest.known.inventory import Row, meta_of
from thermodata.store.ingest.known.left_alone import TestNote
from thermodata.store.ingest.told.clocks.repeated_times import said_of_repeats
from thermodata.store.ingest.told.losses import loss_row
from thermodata.store.tidy.plan.plan import TestPlan
from thermodata.store.tidy.writer import TidyResult


@dataclass(frozen=True, slots=True)
class StreamOfTest:
    """A stream of a test, as rows of the catalogue name it."""

    campaign: str
    test: str
    source: str
    stream: str


def tidy_rows(
    of: StreamOfTest, result: TidyResult, store: Path, now: datetime, base: str, verdict: Mapping[str, Any]
) -> list[Row]:
    """Rows of `file` of what was written of a stream; what concerns all of it stands with the last."""
    rows: list[Row] = []
    for file in result.files:
        meta: dict[str, Any] = {"channels": file.columns, "to_s": file.to_s, "base": base}
        meta |= {"held": list(file.held)} if file.held else {}
        meta |= {"levels": file.levels} if file.levels else {}
        meta |= {"notes": list(result.notes)} if result.notes and file is result.files[-1] else {}
        meta |= {"verdict": dict(verdict)} if verdict else {}
        if file is result.files[-1]:
            meta |= {"samples": result.samples, "flags": dict(result.flags), "problems": result.problems}
            meta |= {"filled": sorted(result.filled), "not_counting": result.not_counting}
            meta |= {"counting": result.counting} if result.counting else {}
        rows.append(
            {
                **dataclasses.asdict(of),
                "layer": "tidy",
                "part": file.part,
                "key": file.key,
                "path": file.path,
                "source_path": None,
                "sha256": None,
                "bytes": (store / file.path).stat().st_size,
                "rows": file.rows,
                "columns": json.dumps(meta, sort_keys=True),
                "losses": json.dumps(
                    [dataclasses.asdict(x) for x in result.losses] if file is result.files[-1] else []
                ),
                "added_at": now,
            }
        )
    return rows


def count(note: TestNote, files: Sequence[Row], test: str) -> None:
    """Adds to a test's note what its tidy files tell: samples, flags, losses."""
    for row in files:
        meta = meta_of(row)
        note.samples += meta.get("samples", 0)
        for flag, count in meta.get("flags", {}).items():
            note.flags[flag] = note.flags.get(flag, 0) + count
        note.losses += [loss_row(p, test=test) for p in meta.get("problems", [])]
        note.notes += said_of_repeats(test, row["source"], meta, row["rows"])
        note.notes += [f"{test}, {row['source']}: {n}" for n in meta.get("notes", [])]
        for item in json.loads(row["losses"]) if row["losses"] not in (None, "", "[]") else ():
            note.losses.append(loss_row(item["reason"], test=test, source=row["source"], loss=Loss(**item)))


def duration_s(plan: TestPlan, files: Sequence[Row]) -> float | None:
    """How long the recording is [s]: that of its reference sources, as far as they were tidied."""
    ends = {r["source"]: meta_of(r)["to_s"] for r in files if r["layer"] == "tidy" and r["part"] == "test"}
    if plan.test.window is not None and ends:
        a, b = plan.test.window
        return float(min(b - a, max(ends.values())))
    wanted = [ends[s.name] for s in plan.reference if s.name in ends] or list(ends.values())
    return max(wanted, default=None)


def step_s(files: Sequence[Row]) -> float:
    """From one sample to the next in the stream that goes on longest [s]; 0 where nothing tells it."""
    parts = [(meta_of(r)["to_s"], r["rows"]) for r in files if r["layer"] == "tidy" and r["part"] == "test"]
    ends, rows = max(parts, default=(0.0, 0))
    return float(ends / (rows - 1)) if rows > 1 else 0.0
