"""`ingest`: a campaign file and its raw files into the store; safe to repeat, safe to kill."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from thermodata.errors import StoreError
from thermodata.schema.campaign import Campaign
from thermodata.schema.load import load_campaign
from thermodata.store.catalogue.store import Store, new_mark
from thermodata.store.ingest.catalogue_rows import calibration_row, raw_row
from thermodata.store.ingest.commit import Planned, VanishedError, changes, commit, nothing_new
from thermodata.store.ingest.file_versions import keep_earlier
from thermodata.store.ingest.inventory import BY_TEST, Inventory, Row, generation_of, read_inventory
from thermodata.store.ingest.progress import Progress, TextProgress
from thermodata.store.ingest.raw_layer import RawIngest, loss_row
from thermodata.store.ingest.spec_lines import with_lines
from thermodata.store.ingest.tidy_layer import tidy_tests
from thermodata.store.ingest.unanswered import unanswered
from thermodata.store.ingest.unchanged import answer, keep, known_files, noted
from thermodata.store.tidy.calibrations import evaluate
from thermodata.store.tidy.plan import bind

_ATTEMPTS = 3
NOTHING = "nothing changed: the store holds these files and this campaign file already"


@dataclass(slots=True)
class IngestSummary:
    """What the store now holds of the campaign. losses: what could not be read or made, each with its reason.

    changed: whether anything was written. read: source files that were read; made: streams that were made anew.
    stale: models whose data changed.
    """

    campaign: str
    tests: int = 0
    files: int = 0
    samples: int = 0
    flags: dict[str, int] = field(default_factory=dict)
    losses: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    calibrations: list[dict[str, Any]] = field(default_factory=list)
    changed: bool = False
    read: int = 0
    made: int = 0
    stale: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Plain data, one key a field."""
        return asdict(self)


def ingest(
    store: Store,
    campaign_path: Path | str,
    progress: Progress | Callable[[str], None] | None = None,
    campaign: Campaign | None = None,
) -> IngestSummary:
    """Brings a campaign into the store: raw layer, calibrations, tidy layer, and then one commit.

    The same again changes nothing. After an edit of the campaign file only what the edit touches is made anew,
    and the source files need not be there any more. A file that can't be read is a loss and doesn't stop the
    others. Raises SpecError for a wrong campaign file and CalibrationError for a contradictory calibration; then,
    and when it is interrupted, the store stays as it was. progress: is told what is being done, and how far it is.
    campaign: in place of a file's content; the path then says where its logs are.
    """
    watch = TextProgress(progress or (lambda _: None)) if progress is None or callable(progress) else progress
    for attempt in range(_ATTEMPTS):
        try:
            return _ingest(store, Path(campaign_path), watch, campaign)
        except VanishedError as error:
            if attempt == _ATTEMPTS - 1:
                raise StoreError(
                    "files of the store vanish while they are being made",
                    where=str(store.path),
                    got=str(error),
                    hint="end the other program that cleans this store",
                ) from error
    raise AssertionError("unreachable")


def _ingest(store: Store, path: Path, watch: Progress, given: Campaign | None) -> IngestSummary:
    began, now = time.monotonic(), datetime.now(UTC).replace(tzinfo=None)
    campaign = load_campaign(path) if given is None else given
    raw_layer = RawIngest(store.path, path.absolute().parent, campaign, Inventory(), watch)
    raw_layer.survey()
    here = raw_layer.seen(path.absolute())
    kept = noted(here)
    known = answer(here, kept, store.mark()) if given is None else None
    if known is not None:
        return replace(IngestSummary(**known), seconds=time.monotonic() - began)
    raw_layer.hashed(known_files(here, kept))
    with store.marked_reader() as (con, mark):
        inventory = raw_layer.inventory = read_inventory(con, store.path, campaign.id)
    raw_layer.read_ahead()
    jumps = raw_layer.jump_files()
    results, problems = evaluate(store.path, campaign, jumps)
    plans = []
    for test in campaign.tests:
        plan = raw_layer.plan(test)
        bind(plan)
        plans.append(plan)
    raw_layer.empty_sources(plans)
    tidy_layer = tidy_tests(store.path, plans, results, inventory, now, watch.say)
    rows: dict[str, dict[str, list[Row]]] = {t: dict(tidy_layer.rows[t]) for t in BY_TEST}
    rows["file"][""] = [
        raw_row(campaign.id, "", name, raw, "calibration", now) for name, raws in jumps.items() for raw in raws
    ]
    keep_earlier(rows["file"], inventory, now)
    calibration_rows = [calibration_row(campaign.id, r) for r in results.values()]
    planned = Planned(campaign, path.absolute(), rows, calibration_rows)
    summary = IngestSummary(
        campaign.id,
        tests=len(plans),
        files=len(raw_layer.files),
        samples=tidy_layer.samples,
        flags=dict(sorted(tidy_layer.flags.items())),
        read=raw_layer.read,
        made=tidy_layer.new_streams,
        calibrations=[{**r.row(campaign.id), "name": r.name} for r in results.values()],
        losses=with_lines(raw_layer.losses + tidy_layer.losses + [loss_row(p) for p in problems], path),
        notes=list(dict.fromkeys(unanswered(campaign) + raw_layer.notes + tidy_layer.notes)),
    )
    again = replace(summary, read=0, made=0, notes=[*summary.notes, NOTHING])
    # what was damaged and is made anew has the same rows: the views must see it all the same
    changed = changes(planned, inventory)
    if nothing_new(planned, inventory, changed) and not tidy_layer.new_streams and not raw_layer.read:
        summary = again
    else:
        mark = new_mark()
        with store.write(mark=mark) as con:
            if generation_of(con) != inventory.generation:
                inventory = read_inventory(con, None, campaign.id)
                changed = changes(planned, inventory)
            summary.stale = commit(con, store.path, planned, inventory, changed, now)
        summary.changed = True
        if summary.stale:
            summary.notes.append(f"{len(summary.stale)} fitted models are stale now: fit them again")
    if not raw_layer.passing and given is None:
        keep(here, mark, raw_layer.hashes(), planned.parts(), again.to_json())
    summary.seconds = time.monotonic() - began
    return summary


__all__ = ["IngestSummary", "ingest"]
