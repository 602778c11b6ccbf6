"""Brings the files of a campaign into the raw layer; one bad file doesn't stop the others."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from thermodata.archive.members import is_there
from thermodata.errors import FormatError, StoreError, ThermodataError, nearest
from thermodata.plugin import Reader, Source
from thermodata.schema.files.campaign import JumpCalibration, SourceSpec, Test
from thermodata.store.base.files import is_whole, with_room_for, write_error
from thermodata.store.ingest.known.file_versions import pinned, read_otherwise, twins
from thermodata.store.ingest.known.inventory import Inventory
from thermodata.store.ingest.known.left_alone import TestNote
from thermodata.store.ingest.progress import counted
from thermodata.store.ingest.reading.campaign_files import CampaignFiles
from thermodata.store.ingest.reading.resolve import file_inside
from thermodata.store.ingest.reading.side_by_side import read_side_by_side, workers_for
from thermodata.store.ingest.reading.wanted import WantedFile
from thermodata.store.ingest.reading.worker import Task
from thermodata.store.ingest.told.losses import Losses, ToldOfTest, add_unread, loss_row, tell, unread_signals
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.source_file import ChangedError, SourceFile, frozen
from thermodata.store.raw.streams import raw_key, read_raw
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan


@dataclass(slots=True)
class RawIngest:
    """Reads each file once, however many tests share it."""

    files: CampaignFiles
    inventory: Inventory
    # test -> what is said of it ('': of what belongs to none)
    said: dict[str, ToldOfTest] = field(default_factory=lambda: {"": ToldOfTest()})
    read: int = 0
    _test: str = ""
    # what was said of this time only, and not when the same is ingested again
    passing: bool = False
    _told: set[str] = field(default_factory=set)
    _streams: dict[str, list[RawStream] | ThermodataError | OSError] = field(default_factory=dict)

    @property
    def losses(self) -> Losses:
        """Those of the test that is being planned."""
        return self.said[self._test].losses

    @property
    def notes(self) -> list[str]:
        """Those of the test that is being planned."""
        return self.said[self._test].notes

    def read_ahead(self) -> None:
        """Reads what the store doesn't hold yet, several files side by side where that pays. What can't be read so is
        left to whoever asks for it."""
        known = {
            (row["source_path"], row["bytes"])
            for rows in self.inventory.rows.get("file", {}).values()
            for row in rows
            if row["layer"] == "raw"
        }
        new = [(p, size) for p, size in self.files.sizes().items() if (p, size) not in known]
        workers = workers_for(len(new), sum(size for _, size in new))
        if not workers:
            return
        self.files.watch.say(f"reading {workers} files at a time")
        for task, found in read_side_by_side(self._tasks(), workers, self.files.watch.samples):
            if isinstance(found, StoreError):
                raise with_room_for(found, task.path, task.file.bytes)
            if isinstance(found, list | ThermodataError | OSError):
                self._streams[task.key] = found
                self.read += isinstance(found, list)
                self.files.done(task.path)
            elif found is not None:
                raise found

    def _tasks(self) -> Iterator[Task]:
        """Each file once that an installed reader is to read, in the order in which it will be asked for."""
        asked: set[str] = set()
        for task in self.files.tasks():
            if task.key in asked or task.key in self.inventory.raws or not self.files.is_installed(task.reader):
                continue
            asked.add(task.key)
            yield task

    def plan(self, test: Test) -> TestPlan:
        """A test with the raw streams of all its sources."""
        self._test, self.said[test.id] = test.id, ToldOfTest()
        plan = TestPlan(self.files.campaign, test)
        for name, spec in self.files.campaign.sources.items():
            plan.sources[name] = self._source(test, name, spec.of_test(test.id).with_clock(test.clocks.get(name)))
        missing = [n for n, s in plan.sources.items() if not s.raws]
        if len(missing) == len(plan.sources):
            self.losses.append(loss_row("no data: no file of any source was found or could be read", test=test.id))
        for name in test.files:
            if name not in self.files.campaign.sources:
                plan.problems.append(f"test '{test.id}': files names an unknown source '{name}'")
        return plan

    def _source(self, test: Test, name: str, spec: SourceSpec) -> SourcePlan:
        files = self.files.of_source(test, name)
        plan = SourcePlan(name, spec, shared=files.shared)
        for path, why in files.refused:
            self.losses.append(loss_row(f"refused: {why}", test=test.id, source=name, file=path))
        before: dict[str, list[RawStream]] = {}
        for raw in self.inventory.raw_rows(test.id, name):
            before.setdefault(raw.source_path, []).append(raw)
        there = set(files.paths)
        same = twins(files.paths, self.files.hashes_of(files.paths, name, spec))
        for path in files.in_order({*there, *(p for p in before if p not in there and files.claims(p))}):
            if path in same:
                self.notes.append(f"{path}: left out, its content is that of {same[path]}")
                self.files.done(path)
            elif path not in there and (new := self.files.renamed_to(before[path], files.paths)):
                self.notes.append(f"{path}: is {new} now, with the same content")
                self.passing = True
            else:
                kept = before.get(path, [])
                plan.raws += self._file(WantedFile(path, name, spec, test.id, (test.id, name), kept, path not in there))
        if not files.paths and not plan.raws and files.patterns:
            text = f"test '{test.id}': no file of source '{name}' ({', '.join(files.patterns)})"
            if files.explicit:
                self.losses.append(loss_row("no such file", test=test.id, source=name, file=files.patterns[0]))
            else:
                self.notes.append(text)
        return plan

    def empty_sources(self, tests: Collection[TestNote]) -> Losses:
        """A loss for each source that channels need and that has no file in any test: a pattern is wrong then."""
        found: Losses = []
        needed = {c.source for c in self.files.campaign.channels.values()}
        every = (self.said[""].losses, *(t.losses for t in tests))
        told = {source for losses in every for row in losses for source in (row["source"], *row.get("sources", ()))}
        for name, spec in self.files.campaign.sources.items():
            if name in needed - told and tests and not any(name in t.sources for t in tests):
                patterns = [spec.files] if isinstance(spec.files, str) else spec.files or ["no 'files'"]
                found.append(
                    loss_row(
                        f"no file in any test ({', '.join(patterns)}); try: correct 'files' of the source", source=name
                    )
                )
        return found

    def jump_files(self) -> dict[str, list[RawStream]]:
        """Calibration -> the raw streams of its jump test."""
        self._test = ""
        streams: dict[str, list[RawStream]] = {}
        for name, spec in self.files.campaign.calibrations.items():
            if not isinstance(spec, JumpCalibration):
                continue
            path = file_inside(self.files.folder, spec.file, f"calibrations.{name}.file")
            # a copy of another file is of another probe, or of another day
            before = [r for r in self.inventory.raw_rows("", name) if r.source_path == spec.file]
            source = self.files.campaign.sources[spec.source]
            if is_there(path) or before:
                gone = not is_there(path)
                streams[name] = self._file(
                    WantedFile(spec.file, spec.source, source, f"calibration {name}", ("", name), before, gone)
                )
            else:
                near = nearest(path.name, [p.name for p in path.parent.glob("*")] if path.parent.is_dir() else [])
                self.losses.append(
                    loss_row(
                        "no such file: the calibration can't be evaluated"
                        + (f"; did you mean '{near}'?" if near else ""),
                        file=spec.file,
                        test=f"calibration {name}",
                        source=spec.source,
                    )
                )
        return streams

    def _file(self, wanted: WantedFile) -> list[RawStream]:
        """The raw streams of one file; [] and a loss where it can't be read."""
        path, reader = wanted.path, self.files.reader(wanted.spec.reader, wanted.source)
        if path in self.files.campaign.versions:
            raws = pinned(self.inventory, *wanted.kept_as, path, self.files.campaign.versions[path])
            self.notes.append(f"{path}: version {raws[0].sha256[:12]}, as the campaign file wants")
        elif wanted.gone:
            raws = self._copy(wanted, reader)
        else:
            raws = self._read_or_former(wanted, reader)
        self.files.done(path)
        fresh = {r.key for r in raws} - self._told  # of a workbook each sheet is raw data of its own
        self._told |= fresh
        if any(r.losses for r in raws):
            unread, every = unread_signals(self.files.campaign, wanted.source, raws), list(self.said.values())
            tell(raws, unread, self.said[self._test], every, wanted.as_read, again=not fresh)
        return raws

    def _read_or_former(self, wanted: WantedFile, reader: Reader) -> list[RawStream]:
        """What is read of a file, or where that fails what was read of it before, and why."""
        try:
            return self._read_or_reuse(wanted, reader)
        except StoreError:
            raise
        except (ThermodataError, OSError) as error:
            if isinstance(error, OSError) and str(error.filename).startswith(str(self.files.store)):
                raise write_error(Path(error.filename), error) from error
            self.passing = True  # the next time it may be read
            add_unread(self.losses, "; ".join(str(error).splitlines()), wanted.as_read)
            return self._former(wanted)

    def _copy(self, wanted: WantedFile, reader: Reader) -> list[RawStream]:
        """The store's own copy of a file that isn't there any more."""
        path, before = wanted.path, list(wanted.before)
        if before and not all(is_whole(self.files.store / r.path) for r in before):
            raise StoreError(
                "a raw file of the store is gone or cut, and its source is gone",
                where=before[0].path,
                got=f"no {path}",
                hint="put the source file back, or forget the test",
            )
        if before:
            self.notes.append(f"{path}: not there any more; the store's raw copy is used")
            why = read_otherwise(before[0], reader, wanted.declaration)
            if why is not None:
                self.losses.append(loss_row(f"not there to be read again: the store's raw copy was {why}", file=path))
        return before

    def _former(self, wanted: WantedFile) -> list[RawStream]:
        """What the store holds of a file that can't be read now: what was read once isn't lost by that."""
        path, before = wanted.path, list(wanted.before)
        if not before or not all(is_whole(self.files.store / r.path) for r in before):
            return []
        with suppress(ThermodataError, OSError):  # a huge one may have been refused before it was hashed
            if self.files.settle(path).sha256 == before[0].sha256:
                return []  # a reader that refuses the bytes that an older one took has its reason
        self.notes.append(f"{path}: the version that was read before is used ({before[0].sha256[:12]})")
        return before

    def _read_or_reuse(self, wanted: WantedFile, reader: Reader) -> list[RawStream]:
        path, declaration = wanted.path, wanted.declaration
        file = self.files.settle_readable(path, reader, declaration)
        key = raw_key(file.sha256, reader, declaration)
        if key not in self._streams:
            if key in self.inventory.raws:
                self._streams[key] = self.inventory.raws[key]
            else:
                self.files.watch.say(f"reading {path}")
                try:
                    self._streams[key] = self._read_settled(path, file, reader, declaration)
                    self.read += 1
                except StoreError as error:
                    raise with_room_for(error, path, file.bytes) from error
                except (ThermodataError, OSError) as error:
                    self._streams[key] = error
        streams = self._streams[key]
        if isinstance(streams, Exception):
            raise streams
        # the same bytes may stand under another name, in another test or campaign
        return [r if r.source_path == path else _renamed(r, path) for r in streams]

    def _read_settled(self, path: str, file: SourceFile, reader: Reader, declaration: Source) -> list[RawStream]:
        """Reads a file so that hash and rows agree: where it changes meanwhile, from a copy of what is there now."""
        try:
            try:
                return read_raw(
                    self.files.store,
                    file.path,
                    path,
                    file.sha256,
                    counted(reader, self.files.watch),
                    declaration,
                    file.check,
                )
            except FormatError:
                file.check()  # half of a file that is being written may look like a damaged one
                raise
        except ChangedError:
            with frozen(self.files.full(path), self.files.store / "raw") as copy:
                raws = self.inventory.raws.get(raw_key(copy.sha256, reader, declaration)) or read_raw(
                    self.files.store, copy.path, path, copy.sha256, counted(reader, self.files.watch), declaration
                )
            self.files.instead(path, copy)
            self.notes.append(f"{path}: {copy.note}")
            self.passing = True
            return [replace(r, notes=tuple(dict.fromkeys((*r.notes, copy.note or "")))) for r in raws]


def _renamed(raw: RawStream, path: str) -> RawStream:
    return replace(raw, source_path=path)
