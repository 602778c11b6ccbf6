"""What the checks are given, what a reading gave, and how a check says what is wrong."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from thermodata.errors import PluginError, ThermodataError
from thermodata.plugin import HEAD_BYTES, Block, Head, Loss, Reader, Recording, Source
from thermodata.reader.contract.guard import described, guarded

Mutate = Callable[[bytes, random.Random], bytes]


@dataclass(frozen=True)
class Case:
    """What the kit knows of a reader.

    make: its class. files: good files with what a campaign file would declare. claims: which of the kit's impostors
    are its own formats. block_rows: the option by which blocks can be made smaller, where it has one.
    mutate: makes a hostile file of a good one (huge counts and lengths); None: the kit's own ways only.
    unordered: rows of these files are sorted by design, as of a reader that says so of all that it reads.
    """

    make: Callable[[], Reader]
    files: tuple[tuple[Path, Source], ...]
    claims: tuple[str, ...] = ()
    block_rows: str | None = None
    mutate: Mutate | None = None
    unordered: bool = False


@dataclass(frozen=True)
class Data:
    """All that a file gave: stream -> time and columns, joined; and what was lost."""

    recording: Recording
    t_ns: dict[str, Any]
    values: dict[tuple[str, str], Any]
    flags: dict[tuple[str, str], Any]
    losses: tuple[Loss, ...]


def load(reader: Reader, path: Path, source: Source) -> Data:
    """A whole file through the guard."""
    recording = described(reader, path, source)
    return gathered(recording, list(guarded(reader, path, source, recording)))


def gathered(recording: Recording, items: list[Block | Loss]) -> Data:
    """Blocks joined by stream and signal."""
    times: dict[str, list[Any]] = {}
    values: dict[tuple[str, str], list[Any]] = {}
    flags: dict[tuple[str, str], list[Any]] = {}
    losses = []
    for item in items:
        if isinstance(item, Loss):
            losses.append(item)
            continue
        times.setdefault(item.stream, []).append(item.t_ns)
        for name, column in item.values.items():
            values.setdefault((item.stream, name), []).append(column)
            none = np.zeros(column.shape, np.uint16)
            flags.setdefault((item.stream, name), []).append((item.flags or {}).get(name, none))
    return Data(
        recording,
        {k: np.concatenate(v) for k, v in times.items()},
        {k: np.concatenate(v) for k, v in values.items()},
        {k: np.concatenate(v) for k, v in flags.items()},
        tuple(losses),
    )


def fault(what: str, do: str) -> NoReturn:
    """AssertionError with what is wrong, and what the plugin's author does about it."""
    raise AssertionError(f"{what}\ntry: {do}")


def equal(a: Any, b: Any) -> bool:
    """Whether two arrays hold the same, NaN being NaN."""
    if a.dtype.kind in "fc" and b.dtype.kind in "fc":
        return bool(np.array_equal(a, b, equal_nan=True))
    return bool(np.array_equal(a, b))


def difference(a: Data, b: Data) -> str | None:
    """The first difference of two readings in streams, times, signals, values and flags, or None."""
    if a.t_ns.keys() != b.t_ns.keys():
        return f"streams {sorted(a.t_ns)} and {sorted(b.t_ns)}"
    for stream in a.t_ns:
        if not equal(a.t_ns[stream], b.t_ns[stream]):
            return f"the times of stream '{stream}' differ ({a.t_ns[stream].size} and {b.t_ns[stream].size} rows)"
    if a.values.keys() != b.values.keys():
        return f"other signals: {sorted(n for _, n in a.values.keys() ^ b.values.keys())}"
    for key in a.values:
        if not equal(a.values[key], b.values[key]):
            return f"the values of '{key[1]}' differ"
        if not equal(a.flags[key], b.flags[key]):
            return f"the flags of '{key[1]}' differ"
    return None


def tells(whole: Data, data: Data) -> bool:
    """Whether a reader says anything of a changed file that it does not say of the whole one."""
    return (
        len(data.losses) > len(whole.losses)
        or data.recording.complete is not whole.recording.complete
        or data.recording.notes != whole.recording.notes
        or any(bool(f.any()) and not equal(f, whole.flags.get(key, f[:0])) for key, f in data.flags.items())
    )


def head(path: Path) -> Head:
    with path.open("rb") as file:
        return Head(path.name, path.stat().st_size, file.read(HEAD_BYTES))


def refused_or_read(case: Case, path: Path, source: Source, what: str) -> Data | None:
    """What the reader gives of a bad file; None where it refuses it with one of our errors."""
    try:
        return load(case.make(), path, source)
    except PluginError as error:
        fault(
            f"{what}: {error}",
            "raise thermodata.errors.FormatError where a file cannot be read, and yield a Loss "
            "where only a part of it cannot; check every length, count and number of the file before using it",
        )
    except ThermodataError:
        return None
    except (OSError, MemoryError) as error:
        fault(
            f"{what}: {type(error).__name__}: {error}",
            "check lengths, counts and offsets against the file's size before reading or allocating by them",
        )
