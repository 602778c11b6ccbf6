"""Checks: the same file gives the same, however and by whom it is read."""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

from thermodata.plugin import Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.testing.reader.apart import together
from thermodata.testing.reader.case import Case, difference, fault, gathered, load

_STATE = "keep nothing of a reading on the reader, its class or the module; let blocks() hold it in local variables"


def reading_again_gives_the_same(case: Case, path: Path, source: Source) -> None:
    reader = case.make()
    first, again, other = load(reader, path, source), load(reader, path, source), load(case.make(), path, source)
    for what, data in (("read twice", again), ("read by a second reader", other)):
        differs = difference(first, data)
        if differs is None and repr((first.recording, first.losses)) != repr((data.recording, data.losses)):
            differs = "describe or the losses say something else"
        if differs is not None:
            fault(f"{path.name} {what}: {differs}", _STATE + "; use no clock, no random number and no order of a set")


def two_readings_at_once_do_not_mix(case: Case, path: Path, source: Source) -> None:
    """One reader, two files open, a block of each in turn: as when sources are read side by side."""
    reader = case.make()
    small = source if case.block_rows is None else replace(source, options={**source.options, case.block_rows: 5})
    alone, recording = load(reader, path, small), described(reader, path, small)
    pairs = list(zip_longest(guarded(reader, path, small, recording), guarded(reader, path, small, recording)))
    for items in zip(*pairs, strict=True):
        differs = difference(alone, gathered(recording, [item for item in items if item is not None]))
        if differs is not None:
            fault(f"{path.name} read twice at once, a block in turn: {differs}", _STATE)


def threads_read_the_same(case: Case, path: Path, source: Source) -> None:
    reader = case.make()
    alone = load(reader, path, source)
    with ThreadPoolExecutor(4) as pool:
        for other in pool.map(lambda _: load(reader, path, source), range(4)):
            differs = difference(alone, other)
            if differs is not None:
                fault(f"{path.name} read by four threads: {differs}", _STATE)


def processes_read_the_same(case: Case, path: Path, source: Source) -> None:
    """Two processes read the file again and again at the same time."""
    alone = load(case.make(), path, source)

    def read_for_a_while() -> str | None:
        reader, begin = case.make(), time.monotonic()
        for turn in range(50):
            differs = difference(alone, load(reader, path, source))
            if differs is not None:
                return differs
            if turn >= 4 and time.monotonic() - begin > 0.3:
                break
        return None

    for wrong in together(read_for_a_while, 2):
        if wrong is not None:
            fault(
                f"{path.name} read by two processes: {wrong}",
                "write no scratch or lock file at a fixed place, and open the file for reading only; where scratch "
                "is needed, tempfile.TemporaryDirectory gives each reading its own",
            )


def the_size_of_blocks_changes_nothing(case: Case, path: Path, source: Source) -> None:
    if case.block_rows is None:
        return
    whole = load(case.make(), path, source)
    for rows in (1, 2, 3, 7, 1000):
        if rows < 3 and max((t.size for t in whole.t_ns.values()), default=0) > 2000:
            continue
        small = replace(source, options={**source.options, case.block_rows: rows})
        differs = difference(whole, load(case.make(), path, small))
        if differs is not None:
            fault(
                f"{path.name} in blocks of {rows} rows: {differs}",
                "carry over the seam what the next block needs (the last time, a step-held value, a half line)",
            )
