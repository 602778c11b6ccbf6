"""The guard: a reader's blocks, each held against the rules before anything else sees it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import replace
from pathlib import Path

from thermodata.archive.packed_by import packed_by
from thermodata.archive.regular import opened, refuse_what_never_ends
from thermodata.archive.unpacked import PACKED, cut_off, held
from thermodata.errors import FAILED, FormatError, PluginError, ThermodataError
from thermodata.plugin import HEAD_BYTES, Block, Head, Loss, Reader, Recording, Source
from thermodata.reader.contract.heeded import Watched
from thermodata.reader.contract.rules import RECORDING_RULES, broken_rule, sentence

_CUT = "what stands before the cut is read"


@contextmanager
def asking(said: str, where: str) -> Iterator[None]:
    """PluginError, `said` where, for what a reader raises that is none of ours: a plugin's bug; sys.exit() among it,
    which would end the command without a word. Damaged or missing files and Ctrl-C pass."""
    try:
        yield
    except (ThermodataError, OSError, MemoryError):
        raise
    except FAILED as error:
        raise PluginError(said, where=where, got=f"{type(error).__name__}: {error}") from error


def described(reader: Reader, path: Path, source: Source) -> Recording:
    """The reader's description, held against the rules. PluginError for a broken rule or an exception that is
    none of ours: a plugin's bug, with the file named; UsageError for a declared sheet that the reader ignores, and for
    what is no file: a reader would wait for ever. A packed log is shown to its reader as it was before that; of
    one that is cut off, it says so."""
    refuse_what_never_ends(path)
    with held_for(reader, path) as real:
        recording = _checked_recording(reader, real, source)
    if (said := _cut_off_for(reader, path)) is not None:
        return replace(recording, complete=False, notes=(f"{said}: {_CUT}", *recording.notes))
    return recording


def _checked_recording(reader: Reader, path: Path, source: Source) -> Recording:
    watched = Watched(source)
    try:
        with asking(f"reader '{reader.name}' failed to describe a file", str(path)):
            recording = reader.describe(path, watched.source)
    except FormatError:
        _refuse_packed(path)  # what a reader says of packed bytes helps nobody
        raise
    if not isinstance(recording, Recording):
        raise PluginError(
            f"reader '{reader.name}' describes with {type(recording).__name__}", where=str(path), expected="a Recording"
        )
    watched.refuse_ignored(reader, path, recording)
    for rule in RECORDING_RULES:
        wrong = rule(recording)
        if wrong is not None:
            raise PluginError(f"reader '{reader.name}' broke the rule: {sentence(rule)}", where=str(path), got=wrong)
    return recording


def _cut_off_for(reader: Reader, path: Path) -> str | None:
    return None if path.is_file() and takes_packed(reader, path) else cut_off(path)


def held_for(reader: Reader, path: Path) -> AbstractContextManager[Path]:
    """The file that a reader is to read: a packed log as it was before that, but where the reader's own format is
    packed."""
    return nullcontext(path) if path.is_file() and takes_packed(reader, path) else held(path)


def takes_packed(reader: Reader, path: Path) -> bool:
    """Whether a reader claims a file that is packed as it stands."""
    if path.suffix.lower() not in PACKED:
        return False
    with opened(path) as file, suppress(*FAILED):
        return reader.sniff(Head(path.name, path.stat().st_size, file.read(HEAD_BYTES))) is not None
    return False


def _refuse_packed(path: Path) -> None:
    """FormatError for a file that is packed, which its reader could not read."""
    with path.open("rb") as file:
        packer = packed_by(file.read(16))
    if packer is not None:
        raise FormatError(
            "the file is packed",
            where=path.name,
            expected="the log as it was written",
            got=packer,
            hint="unpack it beside the others and name it in their place, or leave it out of 'files' (no glob that "
            "catches it)",
        ) from None


def guarded(reader: Reader, path: Path, source: Source, recording: Recording | None = None) -> Iterator[Block | Loss]:
    """The reader's blocks and losses; PluginError with file, block and row where one breaks a rule. Rows are counted
    from 0 over all blocks of the stream, as `locate` and `thermodata trace` count them.

    recording: what describe() said, where the caller has it already.
    """
    said = described(reader, path, source) if recording is None else recording
    with held_for(reader, path) as real:
        yield from _guarded(reader, real, source, said)
    if (cut := _cut_off_for(reader, path)) is not None:
        yield Loss(f"the end of {path.name}", None, None, None, f"{cut}: {_CUT}")


def _guarded(reader: Reader, path: Path, source: Source, said: Recording) -> Iterator[Block | Loss]:
    count = 0
    rows: dict[str, int] = {}  # of each stream, so far
    items: Iterator[Block | Loss] | None = None
    while True:
        where = f"{path.name} block {count}"
        with asking(f"reader '{reader.name}' failed", where):
            if items is None:
                items = iter(reader.blocks(path, source))
            item = next(items, None)
        if item is None:
            return
        if not isinstance(item, Block | Loss):
            raise PluginError(
                f"reader '{reader.name}' yielded {type(item).__name__}", where=where, expected="a Block or a Loss"
            )
        broken = broken_rule(said, item)
        if broken is not None:
            if isinstance(item, Block):
                where += f" row {rows.get(item.stream, 0) + broken.row}"
            raise PluginError(f"reader '{reader.name}' broke the rule: {broken.rule}", where=where, got=broken.got)
        if isinstance(item, Block):
            count += 1
            rows[item.stream] = rows.get(item.stream, 0) + len(item.t_ns)
            if not item.t_ns.size:
                continue
        yield item
