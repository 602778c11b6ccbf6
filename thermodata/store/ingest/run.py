"""`ingest`: a campaign file and its raw files into the store; safe to repeat, safe to kill."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.calibration.limits import with_limits
from thermodata.errors import StoreError, UsageError
from thermodata.schema.campaign import Campaign
from thermodata.schema.left_out import left_out_for_a_fault
from thermodata.schema.load import load_campaign
from thermodata.schema.locate import located, placed
from thermodata.store.catalogue.create import new_mark
from thermodata.store.catalogue.store import Store
from thermodata.store.ingest.bare_conditions import conditions_without_unit
from thermodata.store.ingest.beside_each_other import odd_clocks
from thermodata.store.ingest.campaign_files import CampaignFiles
from thermodata.store.ingest.catalogue_rows import calibration_row, raw_row
from thermodata.store.ingest.commit import Planned, VanishedError, changes, commit, nothing_new, parts_of
from thermodata.store.ingest.empty_channels import nothing_brought
from thermodata.store.ingest.file_versions import keep_earlier
from thermodata.store.ingest.inventory import BY_TEST, Inventory, Row, generation_of, read_inventory
from thermodata.store.ingest.left_alone import LeftAlone, OtherwiseError, TestNote, left_alone
from thermodata.store.ingest.losses import loss_row, told_once
from thermodata.store.ingest.progress import Progress, TextProgress
from thermodata.store.ingest.raw_layer import RawIngest
from thermodata.store.ingest.same_content import same_content
from thermodata.store.ingest.spec_lines import with_lines
from thermodata.store.ingest.state import version_of
from thermodata.store.ingest.taken_out import taken_out
from thermodata.store.ingest.tidy_layer import TidyLayer, tidy_tests
from thermodata.store.ingest.unanswered import unanswered
from thermodata.store.ingest.unchanged import differing, keep, known_files, noted, of_tests, summary_of
from thermodata.store.tidy.calibrations import evaluate
from thermodata.store.tidy.check_derived import check_derived
from thermodata.store.tidy.check_measuring import check_measuring
from thermodata.store.tidy.plan import bind

if TYPE_CHECKING:
    import duckdb

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
    every_test, attempts = False, _ATTEMPTS
    while True:
        try:
            return _ingest(store, Path(campaign_path), watch, campaign, every_test)
        except OtherwiseError:
            every_test = True  # which raises it no more, and is no attempt
        except UsageError as error:  # what only the files, or the plugins, show is wrong in the campaign file
            found = placed(error, Path(campaign_path)) if campaign is None else error
            if found is error:
                raise
            raise found from error
        except VanishedError as error:
            attempts -= 1
            if not attempts:
                raise StoreError(
                    "files of the store vanish while they are being made",
                    where=str(store.path),
                    got=str(error),
                    hint="end the other program that cleans this store",
                ) from error


def checked(path: Path) -> Campaign:
    """A campaign file as far as it can be judged by itself. SpecError, or UsageError, with its line."""
    campaign = load_campaign(path)
    try:
        check_expressions(campaign)
    except UsageError as error:
        raise located(placed(error, path), path) from error  # of `tests_from`, a test stands in no line of its own
    return campaign


def check_expressions(campaign: Campaign) -> None:
    """UsageError at the first expression that could be evaluated in no test."""
    check_derived(campaign)
    check_measuring(campaign)


def store_for(path: Path, campaign_path: Path) -> Store:
    """The store in a folder; made where there is none, and only for a campaign file that can be ingested: an empty one
    would be taken for a store in which something stands."""
    if not Store.is_at(path):
        checked(campaign_path)
    return Store(path, create=True)


def _ingest(store: Store, path: Path, watch: Progress, given: Campaign | None, every_test: bool) -> IngestSummary:
    """every_test: looks at all of them, whatever an earlier ingest noted; else OtherwiseError may ask for that."""
    began, now = time.monotonic(), datetime.now(UTC).replace(tzinfo=None)
    campaign = checked(path) if given is None else given
    if given is not None:
        check_expressions(campaign)
    files = CampaignFiles(store.path, path.absolute().parent, campaign, watch)
    files.survey()
    here = files.seen(path.absolute())
    kept = noted(here)
    hashed = known_files(here, kept)
    differs = differing(here, kept, store.mark(), hashed) if given is None else None
    if differs is not None and not differs:
        return replace(IngestSummary(**summary_of(kept)), seconds=time.monotonic() - began)
    files.hashed(hashed)
    files_of_tests = files.of_tests()
    lines = of_tests(here, kept, [t.id for t in campaign.tests]) if differs is not None and not every_test else {}
    left = left_alone(lines, files.tests_with(differs or ()))
    with store.marked_reader() as (con, mark):
        inventory = _inventory(con, store, files, left, mark == kept.get("mark"))
    raw_layer = RawIngest(files, inventory)
    raw_layer.read_ahead()
    jumps = raw_layer.jump_files()
    results, problems = evaluate(store.path, campaign, jumps)
    plans = [raw_layer.plan(test) for test in campaign.tests if test.id not in left.tests]
    for plan in plans:
        bind(plan)
    tidy_layer = tidy_tests(store.path, campaign, plans, results, inventory, now, watch.say, left)
    rows: dict[str, dict[str, list[Row]]] = {t: dict(tidy_layer.rows[t]) for t in BY_TEST}
    rows["file"][""] = [
        raw_row(campaign.id, "", name, raw, "calibration", now) for name, raws in jumps.items() for raw in raws
    ]
    keep_earlier(rows["file"], inventory, now)
    if left.tests:
        # its rows stand in the order of the campaign file, so a commit may write all of them
        rows["test"] = {
            t.id: r
            for t in campaign.tests
            if (r := (rows if t.id not in left.tests else inventory.rows)["test"].get(t.id))
        }
    notes = _notes_of_tests(campaign, raw_layer, tidy_layer, rows, left)
    calibration_rows = [calibration_row(campaign.id, r) for r in results.values()]
    versions = {name: note.version for name, note in notes.items() if note.version is not None}
    planned = Planned(campaign, path.absolute(), rows, calibration_rows, versions)
    losses = [
        *raw_layer.said[""].losses,
        *told_once(row for note in notes.values() for row in note.losses),  # lines are of this campaign file
        *tidy_layer.losses,
        *raw_layer.empty_sources(list(notes.values())),
        *nothing_brought(campaign, notes),
        *(loss_row(p) for p in problems),
    ]
    said = [*raw_layer.said[""].notes, *(n for note in notes.values() for n in note.notes), *tidy_layer.notes]
    parts = {
        path: size for own in (parts_of(rows, ""), *(n.parts for n in notes.values())) for path, size in own.items()
    }
    sources = {name: own for name, own in inventory.sources.items() if name in left.tests} | rows["source"]
    summary = IngestSummary(
        campaign.id,
        tests=len(campaign.tests),
        files=len({r["source_path"] for r in rows["file"][""]}.union(*(n.files for n in notes.values()))),
        samples=sum(n.samples for n in notes.values()),
        flags=_summed(n.flags for n in notes.values()),
        read=raw_layer.read,
        made=tidy_layer.new_streams,
        calibrations=[_told(r.row(campaign.id), r.name) for r in results.values()],
        losses=with_lines(losses, path),
        notes=list(
            dict.fromkeys(
                same_content(files_of_tests, files.hashes())
                + _odd_ends(campaign, sources)
                + unanswered(campaign)
                + conditions_without_unit(campaign, path)
                + _left_out(path, files_of_tests)
                + said
            )
        ),
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
                if left.tests:
                    raise OtherwiseError("another commit")
                inventory = read_inventory(con, None, campaign.id)
                changed = changes(planned, inventory)
            summary.stale = commit(con, store.path, planned, inventory, changed, now)
        summary.changed = True
        summary.notes += taken_out(changed["test"] - {t.id for t in campaign.tests})
        if summary.stale:
            summary.notes.append(f"{len(summary.stale)} fitted models are stale now: fit them again")
    if not raw_layer.passing and given is None:
        of_each = (lines[name] if name in left.tests else note.to_text() for name, note in notes.items())
        keep(here, mark, files.hashes(), parts, again.to_json(), of_each)
    summary.seconds = time.monotonic() - began
    return summary


def _odd_ends(campaign: Campaign, sources: Mapping[str, list[Row]]) -> list[str]:
    declared = {t.id: t.clocks for t in campaign.tests}
    odd = odd_clocks({t.id: sources.get(t.id, []) for t in campaign.tests})
    return [said for one in odd for said in one.beside(declared)]


def _left_out(path: Path, files_of_tests: Mapping[str, Collection[str]]) -> list[str]:
    """A note on files that the draft left out for a fault. path: of the campaign file."""
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    said = left_out_for_a_fault(text, {file for files in files_of_tests.values() for file in files})
    return [said] if said else []


def _inventory(
    con: duckdb.DuckDBPyConnection, store: Store, files: CampaignFiles, left: LeftAlone, noted_now: bool
) -> Inventory:
    """What the store holds of the tests that are looked at. noted_now: whether no commit came since the note."""
    campaign = files.campaign
    if not left.tests:
        return read_inventory(con, store.path, campaign.id)
    if not noted_now:
        raise OtherwiseError("another commit")
    looked_at = {t.id for t in campaign.tests if t.id not in left.tests}
    files.narrow(looked_at)
    return read_inventory(con, store.path, campaign.id, looked_at, files.keys())


def _notes_of_tests(
    campaign: Campaign,
    raw_layer: RawIngest,
    tidy_layer: TidyLayer,
    rows: Mapping[str, Mapping[str, list[Row]]],
    left: LeftAlone,
) -> dict[str, TestNote]:
    """What is told of each test, in the order of the campaign file."""
    for name, note in tidy_layer.tests.items():
        note.losses[:0], note.notes[:0] = raw_layer.said[name].losses, raw_layer.said[name].notes
        note.parts = parts_of(rows, name)
        note.version = version_of(rows, name) if name in rows["test"] else None
    return {t.id: left.tests.get(t.id) or tidy_layer.tests[t.id] for t in campaign.tests}


def _summed(counts: Iterable[Mapping[str, int]]) -> dict[str, int]:
    """Flag -> how many samples, in the order of their names."""
    total: Counter[str] = Counter()
    for some in counts:
        total.update(some)
    return dict(sorted(total.items()))


def _told(row: dict[str, Any], name: str) -> dict[str, Any]:
    """A calibration as the answer of an ingest has it."""
    return {**row, "name": name, "checks": with_limits(row["checks"])}


__all__ = ["IngestSummary", "checked", "ingest", "store_for"]
