"""`ingest`: a campaign file and its raw files into the store; safe to repeat, safe to kill."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import StoreError, UsageError
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign
from thermodata.schema.files.locate import located, placed
from thermodata.schema.words.sentences import counted
from thermodata.store.base.moment import utc_now
from thermodata.store.catalogue.format.create import new_mark
from thermodata.store.catalogue.store import Store
from thermodata.store.ingest.another_campaign import is_same_place, refuse_another
from thermodata.store.ingest.catalogue_rows import calibration_row
from thermodata.store.ingest.commit import Difference, Planned, VanishedError, commit, difference, parts_of
from thermodata.store.ingest.known.files_taken_out import files_taken_out
from thermodata.store.ingest.known.inventory import Inventory, Row, generation_of, read_inventory
from thermodata.store.ingest.known.left_alone import LeftAlone, OtherwiseError, TestNote, left_alone
from thermodata.store.ingest.known.unchanged import (
    FirstGlance,
    differing,
    keep,
    known_files,
    noted,
    of_tests,
    summary_of,
)
from thermodata.store.ingest.layers import Layers, make_layers
from thermodata.store.ingest.other_reader import read_by_another, refuse_older_reader
from thermodata.store.ingest.progress import Progress, TextProgress
from thermodata.store.ingest.reading.campaign_files import CampaignFiles
from thermodata.store.ingest.summary import IngestSummary, summarize
from thermodata.store.ingest.told.declared.not_listed import not_listed
from thermodata.store.ingest.told.declared.said_before import said_before
from thermodata.store.ingest.told.declared.taken_out import taken_out
from thermodata.store.tidy.plan.refused import check_derived, check_measuring

if TYPE_CHECKING:
    import duckdb

_ATTEMPTS = 3


def ingest(
    store: Store,
    campaign_path: Path | str,
    progress: Progress | Callable[[str], None] | None = None,
    campaign: Campaign | None = None,
    *,
    in_its_place: bool = False,
) -> IngestSummary:
    """Brings a campaign into the store: raw layer, calibrations, tidy layer, and then one commit.

    The same again changes nothing. After an edit of the campaign file only what the edit touches is made anew,
    and the source files need not be there any more. A file that can't be read is a loss and doesn't stop the
    others. Raises SpecError for a wrong campaign file, CalibrationError for a contradictory calibration, and UsageError
    where the store holds another campaign with that id; then, and when it is interrupted, the store stays as it was.
    progress: is told what is being done, and how far it is. campaign: in place of a file's content; the path then says
    where its logs are. in_its_place: takes the tests and logs of another one with that id out.
    """
    watch = TextProgress(progress or (lambda _: None)) if progress is None or callable(progress) else progress
    every_test, attempts = False, _ATTEMPTS
    while True:
        try:
            return _ingest(store, Path(campaign_path), watch, campaign, every_test, in_its_place)
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


def _ingest(
    store: Store, path: Path, watch: Progress, given: Campaign | None, every_test: bool, in_its_place: bool
) -> IngestSummary:
    """every_test: looks at all of them, whatever an earlier ingest noted; else OtherwiseError may ask for that."""
    began, now = time.monotonic(), utc_now()
    campaign = checked(path) if given is None else given
    if given is not None:
        check_expressions(campaign)
    files = CampaignFiles(store.path, path.absolute().parent, campaign, watch)
    files.survey()
    files_of_tests = files.of_tests()  # of all, before they are narrowed to those that are looked at
    listed = {file for own in files_of_tests.values() for file in own}
    earlier = _look_back(files, path.absolute(), store.mark(), noted_by_path=given is None)
    if (told := earlier.answer) is not None:
        notes_now = _not_listed(store, files, path, listed)
        return replace(told, notes=[*told.notes, *notes_now], seconds=time.monotonic() - began)
    lines = {} if every_test else earlier.lines
    left = left_alone(lines, files.tests_with(earlier.differs))
    with store.marked_reader() as (con, mark):
        inventory = _inventory(con, store, files, left, mark == earlier.kept.get("mark"))
    refuse = partial(refuse_another, files=files, path=path.absolute())
    if not in_its_place and not left.tests:  # which are left alone where the campaign file says what it said
        refuse(inventory)
    refuse_older_reader(inventory, files)
    layers = make_layers(files, inventory, left, now)
    rows = layers.rows(inventory, now)
    notes = layers.notes_of_tests(rows)
    summary = summarize(layers, inventory, rows, notes, path, files_of_tests)
    again = summary.again()
    # where no log stands nothing says whose place it is: a file that was copied for the next tests, which are to come
    place = path.absolute() if listed or inventory.campaign is None else Path(inventory.campaign["path"])
    found = difference(_planned(layers, place, rows, notes), inventory)
    if layers.is_as_stored and found.is_none:
        summary = again
        mark = _keep_place(store, mark, inventory, place)
    else:
        mark = new_mark()
        before = None if in_its_place else refuse
        summary.stale, gone = _commit(store, mark, found, now, left, before)
        summary.changed = True
        summary.notes += said_before(inventory.campaign, found.planned.spec, place)
        summary.notes += [*taken_out(gone), *read_by_another(inventory, rows["file"])]
        if summary.stale:
            one = len(summary.stale) == 1
            models = counted(len(summary.stale), "fitted model", "is", "are")
            summary.notes.append(f"{models} stale now: fit {'it' if one else 'them'} again")
    if not layers.raw.passing and given is None:
        of_each = (lines[name] if name in left.tests else note.to_text() for name, note in notes.items())
        parts = parts_of(rows, "") | {part: size for note in notes.values() for part, size in note.parts.items()}
        keep(earlier.here, mark, files.hashes(), parts, again.to_json(), of_each)
    if given is None:
        summary.notes += _not_listed(store, files, path, listed)
    summary.seconds = time.monotonic() - began
    return summary


def _keep_place(store: Store, mark: str, inventory: Inventory, path: Path) -> str:
    """Keeps where the campaign file stands now, of which nothing else changed; the store's mark then. mark: before.
    A store that is busy or may only be read is left as it is."""
    if inventory.campaign is None or is_same_place(inventory.campaign["path"], path):
        return mark
    moved = new_mark()
    with suppress(StoreError, OSError):
        with store.write(views=False, mark=moved) as con:
            if generation_of(con) != inventory.generation:
                raise StoreError("another commit came meanwhile", where=str(store.path))
            con.execute("update campaign set path = ? where campaign = ?", [str(path), inventory.name])
        return moved
    return mark


def _not_listed(store: Store, files: CampaignFiles, path: Path, listed: Collection[str]) -> list[str]:
    """Of what stands in the folder now, so that no note of an ingest keeps it. path: of the campaign file; listed: the
    source paths of all tests."""

    def taken_out_before() -> set[str]:
        with store.reader() as con:
            return files_taken_out(con, files.campaign.id)

    return not_listed(files.folder, path, files.campaign, listed, taken_out_before)


@dataclass(frozen=True, slots=True)
class _Earlier:
    """What the last ingest of a campaign file noted. here: what stands there now; kept: its note. answer: its own,
    where nothing differs since. differs: files that may be other ones; lines: test -> its line of the note; both where
    nothing but files differs."""

    here: FirstGlance
    kept: Mapping[str, Any]
    answer: IngestSummary | None
    differs: Collection[str] = ()
    lines: Mapping[str, str] = field(default_factory=dict)


def _look_back(files: CampaignFiles, path: Path, mark: str, noted_by_path: bool) -> _Earlier:
    """path: of the campaign file; mark: of the store's last commit; noted_by_path: whether notes are of what stands in
    that file."""
    here = files.seen(path)
    kept = noted(here)
    known = known_files(here, kept)
    differs = differing(here, kept, mark, known) if noted_by_path else None
    files.hashed(known)
    if differs is None:
        return _Earlier(here, kept, None)
    if not differs:
        return _Earlier(here, kept, IngestSummary(**summary_of(kept)))
    return _Earlier(here, kept, None, differs, of_tests(here, kept, [t.id for t in files.campaign.tests]))


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


def _planned(
    layers: Layers, path: Path, rows: dict[str, dict[str, list[Row]]], notes: Mapping[str, TestNote]
) -> Planned:
    campaign = layers.files.campaign
    calibrations = [calibration_row(campaign.id, r) for r in layers.calibrations.values()]
    versions = {name: note.version for name, note in notes.items() if note.version is not None}
    return Planned(campaign, path, rows, calibrations, versions)


def _commit(
    store: Store,
    mark: str,
    found: Difference,
    now: datetime,
    left: LeftAlone,
    refuse: Callable[[Inventory], None] | None,
) -> tuple[list[str], set[str]]:
    """(models gone stale, tests that were taken out). mark: of the commit; refuse: takes no other campaign's place;
    None where it may. OtherwiseError where tests were left alone and another commit came meanwhile."""
    with store.write(mark=mark) as con:
        if generation_of(con) != found.inventory.generation:
            if left.tests:
                raise OtherwiseError("another commit")
            found = difference(found.planned, read_inventory(con, None, found.planned.campaign.id))
            if refuse is not None:
                refuse(found.inventory)
        stale = commit(con, store.path, found, now)
    return stale, found.taken_out


__all__ = ["checked", "ingest", "store_for"]
