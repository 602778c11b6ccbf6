"""A draft as `init --json` tells it: the campaign file's keys, and beside each what it rests on and what is asked."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from thermodata.draft.campaign.parts import Draft, DraftChannel, DraftJump, DraftSource, DraftTest
from thermodata.draft.times.clocks import Alignment


def as_json(draft: Draft, out: Path, files: int, questions: int, model: Path | None) -> dict[str, Any]:
    """Plain data. out: the campaign file; files: how many the folder has; questions: how many stand in the campaign
    file; model: the drafted model file, or None. Keys that do not apply are None, never absent."""
    scales = [_scale(c) for c in draft.channels if c.as_exported]
    return {
        "campaign": str(out),
        "model": None if model is None else str(model),
        "id": draft.campaign,
        "files": files,
        "questions": questions,
        "sources": [_source(s) for s in draft.sources],
        "channels": [_channel(c) for c in draft.channels if c.said.quantity],
        "derived": [asdict(c) for c in draft.derived],
        "left_out": [_channel(c) for c in draft.channels if not c.said.quantity],
        "calibrations": [_jump(j) for j in draft.jumps] + scales,
        "tests": [_test(t) for t in draft.tests],
        "table": None if draft.table is None else {"file": draft.table.file, "key": draft.table.key},
        "ignored": [{"file": p, "why": w} for p, w in draft.not_used],
        "failed": [{"file": p, "reader": r} for p, r in draft.failed],
        "damaged": [{"file": p, "what": w} for p, w in draft.damaged],
        "notes": list(draft.notes),
    }


def _source(source: DraftSource) -> dict[str, Any]:
    return {
        "name": source.name,
        "reader": source.reader,
        "files": source.files,
        "encoding": source.encoding,
        "table": source.table or None,
        "questions": list(source.questions),
        "clock": None if source.align is None else _clock(source.align),
    }


def _clock(align: Alignment) -> dict[str, Any]:
    return {
        "align_to": align.there,
        "by": [{"here": align.by[0], "there": align.by[1]}],
        "offset_s": align.offset_s,
        "uncertainty_s": align.uncertainty_s,
        "test": align.test,
        "refused": align.why,
    }


def _jump(jump: DraftJump) -> dict[str, Any]:
    return {
        "name": jump.name,
        "kind": "jump",
        "source": jump.source,
        "file": jump.file,
        "signal": jump.signal,
        "axis": jump.axis,
        "dwell_s": jump.dwell_s,
        "steps_seen": list(jump.seen),
        "unit": jump.unit,
        "questions": [jump.question],
    }


def _scale(channel: DraftChannel) -> dict[str, Any]:
    """The calibration of a displacement that counts along its axis as it stands in the file [um]."""
    return {
        "name": channel.calibration,
        "kind": "scale",
        "source": None,
        "file": None,
        "signal": None,
        "axis": channel.said.axis,
        "dwell_s": None,
        "steps_seen": None,
        "unit": "um",
        "questions": [],
    }


def _test(test: DraftTest) -> dict[str, Any]:
    return {
        "id": test.id,
        "kind": test.kind.kind,
        "role": "none",
        "conditions": test.conditions,
        "start": test.kind.start,
        "measuring": test.measuring.when if test.measuring else None,
        "files": test.files,
        "sure": test.kind.comment.startswith("sure"),
        "basis": test.kind.comment or None,
        "questions": [*filter(None, (test.kind.question,)), *test.doubts, "role"],
        "role_hint": test.kind.role_hint,
    }


def _channel(channel: DraftChannel) -> dict[str, Any]:
    """A channel, or with the name None a signal that is left out."""
    said = channel.said
    return {
        "name": channel.name if said.quantity else None,
        "source": channel.source,
        "signal": channel.signal,
        "stream": channel.stream,
        "quantity": said.quantity,
        "unit": said.unit,
        "axis": said.axis,
        "at": said.at,
        "calibration": channel.calibration,
        "sure": said.sure and not said.questions,
        "basis": list(said.basis),
        "questions": list(said.questions) or ([said.why_not] if said.why_not else []),
        "only_in": list(channel.only_in) or None,
        "note": channel.note,
    }
