"""What an ingest says of a test: what was lost, and what is worth knowing."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from typing import Any

from thermodata.errors import UsageError
from thermodata.plugin import Loss
from thermodata.reader.text import split_unit
from thermodata.schema.files.campaign import Campaign, JumpCalibration
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.rows.in_parts import find_signal

Losses = list[dict[str, Any]]


@dataclass(slots=True)
class ToldOfTest:
    """Of one test, or ('' as its name) of what belongs to none."""

    losses: Losses = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class FileRead:
    """A file as it is read once: for which test, by which source."""

    test: str
    source: str
    file: str


def loss_row(
    reason: str,
    *,
    test: str | None = None,
    source: str | None = None,
    file: str | None = None,
    loss: Loss | None = None,
) -> dict[str, Any]:
    """A loss as the summary tells it; times in seconds of the file's own clock. tests, sources: all that miss what was
    lost, `test` and `source` the first of them; several may read one file."""
    return {
        "test": test,
        "tests": [] if test is None else [test],
        "source": source,
        "sources": [] if source is None else [source],
        "file": file,
        "where": loss.where if loss else None,
        "from_ns": loss.from_ns if loss else None,
        "to_ns": loss.to_ns if loss else None,
        "fraction": loss.fraction if loss else None,
        "reason": reason,
    }


def add_unread(losses: Losses, reason: str, read: FileRead) -> None:
    """A file that a source can't read: one loss of all sources that fail alike."""
    before = _by_place(losses).get((read.file, None, reason))
    if before is None:
        losses.append(loss_row(reason, test=read.test, source=read.source, file=read.file))
    elif read.source not in before["sources"]:
        before["sources"].append(read.source)


def told_once(losses: Iterable[dict[str, Any]]) -> Losses:
    """What a file lost, once for all tests that are cut from it. Each row is a new one; what is of no file stays."""
    once: Losses = []
    of_files: dict[tuple[Any, ...], dict[str, Any]] = {}
    for row in losses:
        first = of_files.get((row["file"], row["where"], row["reason"])) if row["file"] else None
        tests = row.get("tests", [row["test"]] if row["test"] else [])  # an earlier version noted no list
        if first is None:
            once.append({**row, "tests": list(tests), "sources": list(row.get("sources", []))})
            of_files[row["file"], row["where"], row["reason"]] = once[-1]
        else:
            first["tests"] += [t for t in tests if t not in first["tests"]]
            first["sources"] += [s for s in row.get("sources", []) if s not in first["sources"]]
    return once


def _by_place(losses: Losses) -> dict[tuple[Any, Any, Any], dict[str, Any]]:
    return {(row["file"], row["where"], row["reason"]): row for row in losses}


def unread_signals(campaign: Campaign, source: str, raws: Iterable[RawStream]) -> set[str]:
    """The signals of a file of a source that no channel and no jump test reads: what is lost of them, nobody misses."""
    raws = list(raws)
    channels = [c for c in campaign.channels.values() if c.source == source]
    wanted = {c.signal for c in channels} | {c.signal for t in campaign.tests for c in t.channels.values()}
    wanted |= {c.signal for c in campaign.calibrations.values() if isinstance(c, JumpCalibration)}
    read: set[str] = set()
    for name in wanted - {None}:
        try:
            read.add(find_signal(raws, str(name))[1].name)
        except UsageError:  # another file of the test may have it in another unit
            read |= {
                s.name for r in raws for s in r.signals if _name_without_unit(s.name) == _name_without_unit(str(name))
            }
    return {s.name for r in raws for s in r.signals} - read


def _name_without_unit(name: str) -> str:
    return split_unit(name)[0].casefold()


def tell(
    raws: Iterable[RawStream],
    unread: Collection[str],
    own: ToldOfTest,
    every: Iterable[ToldOfTest],
    read: FileRead,
    *,
    again: bool,
) -> None:
    """Says of a test what a file lost. unread: signals that the source's channels do not read; own: of the test; every:
    of all tests; again: the file was told of before, and what its other sources did not miss may be missed now. A loss
    is told once of a file, with all tests and sources that miss it, whether these read it alike or each in its own
    way."""
    told = _by_place(own.losses)
    every = list(every)
    of_all = [_by_place(said.losses) for said in every] if again else []
    for loss in (x for r in raws for x in r.losses):
        note = f"{loss.where}: {loss.reason}; no channel reads that column"
        noted = [said for said in every if note in said.notes]
        before = told.get((read.file, loss.where, loss.reason))
        if loss.signal in unread:
            if not again and before is None and own not in noted:
                own.notes.append(note)
        elif before is not None:
            if read.source not in before["sources"]:
                before["sources"].append(read.source)
        elif noted or not again:
            for said in noted:
                said.notes.remove(note)
            row = loss_row(loss.reason, test=read.test, source=read.source, file=read.file, loss=loss)
            own.losses.append(row)
        else:
            of_others = (rows.get((read.file, loss.where, loss.reason)) for rows in of_all)
            for row in (row for row in of_others if row is not None and read.test not in row["tests"]):
                row["tests"].append(read.test)
