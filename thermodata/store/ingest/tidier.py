"""Makes the tidy files of one test at a time, those that are not there yet under their content key."""

from __future__ import annotations

import dataclasses
import errno
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from thermodata.calibration.result import CalibrationResult
from thermodata.store.base.files import is_whole, key_of
from thermodata.store.ingest.known.inventory import Inventory, meta_of
from thermodata.store.ingest.known.left_alone import TestNote
from thermodata.store.ingest.tidied import TidiedTest
from thermodata.store.ingest.tidy_rows import StreamOfTest, tidy_rows
from thermodata.store.ingest.told.losses import loss_row
from thermodata.store.tidy.clock.cut_short import cut_short
from thermodata.store.tidy.clock.source_clock import Clock, span
from thermodata.store.tidy.flags.beside.between import Verdict
from thermodata.store.tidy.keys import ChannelTexts, member_key
from thermodata.store.tidy.plan.plan import SCHEDULE, TestPlan
from thermodata.store.tidy.values.series import Member, TestSeries
from thermodata.store.tidy.writer import write_member

Columns = list[tuple[str, bool]]


@dataclass(frozen=True, slots=True)
class Making:
    """What the streams of an ingest are made with. store: its folder; inventory: what that holds; now: of the ingest;
    say: tells how far it is."""

    store: Path
    calibrations: Mapping[str, CalibrationResult]
    inventory: Inventory
    now: datetime
    say: Callable[[str], None]


@dataclass(slots=True)
class Tidier:
    """columns: the channels of each stream over all tests. notes: test -> what is told of it, which keeps what no file
    does. new_streams: made now."""

    making: Making
    columns: Mapping[Member, Columns]
    notes: Mapping[str, TestNote]
    texts: ChannelTexts
    new_streams: int = 0

    def tidy(self, plan: TestPlan, clocks: dict[str, Clock]) -> TidiedTest:
        """Every stream of a test, kept where the store has it already. clocks: of its sources."""
        test = TidiedTest(plan, clocks, span(plan, clocks))
        plan.notes.extend(said for said in cut_short(plan, clocks) if said not in plan.notes)
        series = self._series(test)
        for member in plan.members():
            if member[0] == SCHEDULE and not any(s.raws for s in plan.sources.values()):
                continue
            base = self._base(test, member)
            kept = self.making.inventory.tidy(plan.test.id, base)
            if kept and all(_kept_alive(os.path.join(self.making.store, row["path"]), row["bytes"]) for row in kept):
                test.files[member] = kept
                test.events[member] = [
                    r
                    for r in self.making.inventory.rows["quality_event"].get(plan.test.id, [])
                    if (r["source"], r["stream"]) == member
                ]
            else:
                self._write(test, series, member, base, Verdict())
        return test

    def mark(self, test: TidiedTest, verdict: Verdict) -> None:
        """Makes those streams again whose files were made with another verdict in mind."""
        series = None
        for member, rows in test.files.items():
            meta = [meta_of(r) for r in rows]
            wanted = verdict.of(c for m in meta for c in m["channels"])
            if wanted.to_json() != next((m["verdict"] for m in meta if "verdict" in m), {}):
                series = series or self._series(test)
                self._write(test, series, member, self._base(test, member), wanted)

    def _series(self, test: TidiedTest) -> TestSeries:
        return TestSeries(self.making.store, test.plan, test.clocks, test.where, self.making.calibrations)

    def _base(self, test: TidiedTest, member: Member) -> str:
        return member_key(test.plan, member, self.columns[member], test.clocks, test.where, self.texts)

    def _write(self, test: TidiedTest, series: TestSeries, member: Member, base: str, verdict: Verdict) -> None:
        making, name = self.making, test.plan.test.id
        making.say(f"{name}: {member[0]}/{member[1]}")
        said = verdict.to_json()
        key = key_of(base, json.dumps(said, sort_keys=True)) if said else base
        result = write_member(series, member, self.columns[member], key, verdict)
        if not result.files:  # told here, for no file is there to keep it
            self.notes[name].losses += [loss_row(p, test=name, source=member[0]) for p in result.problems]
            test.files[member] = test.events[member] = []
            return
        self.new_streams += 1
        of = StreamOfTest(test.plan.campaign.id, name, *member)
        test.files[member] = tidy_rows(of, result, making.store, making.now, base, said)
        test.events[member] = [dataclasses.asdict(of) | dataclasses.asdict(e) for e in result.events]


def _kept_alive(path: str, size_bytes: int) -> bool:
    if not is_whole(path, size_bytes):
        return False
    try:
        os.utime(path)  # so that a gc which runs meanwhile sees a young file
    except OSError as error:
        # where nothing can be written, no gc runs either
        return error.errno in (errno.EROFS, errno.EACCES, errno.EPERM)
    return True
