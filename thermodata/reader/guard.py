"""The guard: a reader's blocks, each held against the rules before anything else sees it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from thermodata.errors import FormatError, PluginError, ThermodataError
from thermodata.plugin import Block, Loss, Reader, Recording, Source
from thermodata.reader.archives import packed_by
from thermodata.reader.heeded import Watched
from thermodata.reader.regular import refuse_what_never_ends
from thermodata.reader.rules import RECORDING_RULES, broken_rule, sentence


def described(reader: Reader, path: Path, source: Source) -> Recording:
    """The reader's description, held against the rules. PluginError for a broken rule or an exception that is
    none of ours: a plugin's bug, with the file named; UsageError for a declared sheet that the reader ignores, and for
    what is no file: a reader would wait for ever."""
    refuse_what_never_ends(path)
    watched = Watched(source)
    try:
        recording = reader.describe(path, watched.source)
    except FormatError:
        _refuse_packed(path)  # what a reader says of packed bytes helps nobody
        raise
    except (ThermodataError, OSError, MemoryError):
        raise
    except Exception as error:
        raise PluginError(
            f"reader '{reader.name}' failed to describe a file", where=str(path), got=f"{type(error).__name__}: {error}"
        ) from error
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
    """The reader's blocks and losses; PluginError with file and block where one breaks a rule.

    recording: what describe() said, where the caller has it already.
    """
    said = described(reader, path, source) if recording is None else recording
    count = 0
    items = iter(reader.blocks(path, source))
    while True:
        where = f"{path.name} block {count}"
        try:
            item = next(items, None)
        except (ThermodataError, OSError, MemoryError):
            raise
        except Exception as error:
            raise PluginError(
                f"reader '{reader.name}' failed", where=where, got=f"{type(error).__name__}: {error}"
            ) from error
        if item is None:
            return
        if not isinstance(item, Block | Loss):
            raise PluginError(
                f"reader '{reader.name}' yielded {type(item).__name__}", where=where, expected="a Block or a Loss"
            )
        broken = broken_rule(said, item)
        if broken is not None:
            raise PluginError(f"reader '{reader.name}' broke the rule: {broken[0]}", where=where, got=broken[1])
        if isinstance(item, Block):
            count += 1
            if not item.t_ns.size:
                continue
        yield item
