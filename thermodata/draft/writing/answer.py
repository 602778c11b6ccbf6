"""A draft as `init --json` tells it: the campaign file's keys, and beside each what it rests on and what is asked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermodata.draft.campaign.parts import Draft, DraftChannel


def as_json(draft: Draft, out: Path, files: int, questions: int, model: Path | None) -> dict[str, Any]:
    """Plain data. model: the drafted model file, or None. Keys that do not apply are None, never absent."""
    return {
        "campaign": str(out),
        "model": None if model is None else str(model),
        "id": draft.campaign,
        "files": files,
        "questions": questions,
        "sources": [
            {
                "name": s.name,
                "reader": s.reader,
                "files": s.files,
                "encoding": s.encoding,
                "table": s.table or None,
                "questions": list(s.questions),
                "clock": None
                if s.align is None
                else {
                    "align_to": s.align.there,
                    "by": [{"here": s.align.by[0], "there": s.align.by[1]}],
                    "offset_s": s.align.offset_s,
                    "uncertainty_s": s.align.uncertainty_s,
                    "test": s.align.test,
                    "refused": s.align.why,
                },
            }
            for s in draft.sources
        ],
        "channels": [_channel(c) for c in draft.channels if c.said.quantity],
        "left_out": [_channel(c) for c in draft.channels if not c.said.quantity],
        "calibrations": [
            {
                "name": j.name,
                "kind": "jump",
                "source": j.source,
                "file": j.file,
                "signal": j.signal,
                "axis": j.axis,
                "dwell_s": j.dwell_s,
                "steps_seen": list(j.seen),
                "unit": j.unit,
                "questions": [j.question],
            }
            for j in draft.jumps
        ]
        + [
            {
                "name": c.calibration,
                "kind": "scale",
                **dict.fromkeys(("source", "file", "signal")),
                "axis": c.said.axis,
                **dict.fromkeys(("dwell_s", "steps_seen")),
                "unit": "um",
                "questions": [],
            }
            for c in draft.channels
            if c.as_exported
        ],
        "tests": [
            {
                "id": t.id,
                "kind": t.kind.kind,
                "role": "none",
                "conditions": t.conditions,
                "start": t.kind.start,
                "measuring": t.measuring,
                "files": t.files,
                "sure": t.kind.comment.startswith("sure"),
                "basis": t.kind.comment or None,
                "questions": [*filter(None, (t.kind.question,)), *t.doubts, "role"],
                "role_hint": t.kind.role_hint,
            }
            for t in draft.tests
        ],
        "table": None if draft.table is None else {"file": draft.table.file, "key": draft.table.key},
        "ignored": [{"file": p, "why": w} for p, w in draft.not_used],
        "failed": [{"file": p, "reader": r} for p, r in draft.failed],
        "damaged": [{"file": p, "what": w} for p, w in draft.damaged],
        "notes": list(draft.notes),
    }


def _channel(c: DraftChannel) -> dict[str, Any]:
    said = c.said
    return {
        "name": c.name if said.quantity else None,
        "source": c.source,
        "signal": c.signal,
        "stream": c.stream,
        "quantity": said.quantity,
        "unit": said.unit,
        "axis": said.axis,
        "at": said.at,
        "calibration": c.calibration,
        "sure": said.sure and not said.questions,
        "basis": list(said.basis),
        "questions": list(said.questions) or ([said.why_not] if said.why_not else []),
        "only_in": list(c.only_in) or None,
        "note": c.note,
    }
