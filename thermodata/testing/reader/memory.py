"""Checks: what a reader holds in memory of a file that grows."""

from __future__ import annotations

import gc
import tempfile
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from thermodata.plugin import Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.testing.reader.case import Case, fault, load
from thermodata.testing.reader.records import Record, not_looked_at, two_records

MIB = 2**20
ROWS = 1000  # of a block, where its size can be set
FIRST, LAST = MIB // 4, 32 * MIB  # sizes of the growing file
SURE = 4 * MIB  # that large a file tells, if a reader is too slow for more
LONG_ENOUGH_S = 12.0  # of processor time: a slow reader's file is not made larger after so long
QUIET_S = 0.05  # in which the threads of a library end what they do
HELD = 0.75  # of what the file is larger: whoever reads all of it at once holds more


def memory_does_not_grow_with_the_file(case: Case, path: Path, source: Source) -> None:
    """A row in the middle is written again and again, twice as often each time, until no more is held: a reader may
    well keep some MiB at once. Of what Python and numpy allocate."""
    record, _ = two_records(case, path, source, load(case.make(), path, source))
    if case.block_rows is not None:
        source = replace(source, options={**source.options, case.block_rows: ROWS})
    begin, size, held, flat = time.process_time(), FIRST, [0], 0
    with tempfile.TemporaryDirectory() as folder, _traced():
        grown = Path(folder) / path.name
        while size <= LAST:
            held.append(_most_held(case, _grow(record, grown, size), source))
            took_s = time.process_time() - begin
            flat = flat + 1 if size > FIRST and held[-1] - held[-2] < HELD * size / 2 else 0
            # once may be by a block that is larger than the file
            if flat > 1 or (flat and took_s > LONG_ENOUGH_S / 2):
                return
            size *= 2
            if size > 2 * FIRST and took_s > LONG_ENOUGH_S:
                break
    if not flat and size // 2 < min(SURE, LAST):
        not_looked_at(
            f"{path.name}: a reader that takes {took_s:.0f} s of {size / 2 / MIB:g} MiB is too slow to be tried"
        )
    if not flat:
        _fault(path, record, size, held)


def _fault(path: Path, record: Record, size: int, held: list[int]) -> None:
    fault(
        f"{path.name} with {record.where} written until it has {size / 2 / MIB:g} MiB\n"
        f"expected: about the memory that {size / 4 / MIB:g} MiB of it take, {held[-2] / MIB:.1f} MiB\n"
        f"got: {held[-1] / MIB:.1f} MiB",
        "read a part of the file, yield its block, and let it go before the next (itertools.islice of a file's lines, "
        "file.read(n)): logs are larger than memory; where blocks are large, give the kit block_rows",
    )


def _grow(record: Record, path: Path, size: int) -> Path:
    times = max(1, (size - len(record.content)) // len(record.own))
    path.write_bytes(record.replaced(record.own * times))
    return path


def _most_held(case: Case, path: Path, source: Source) -> int:
    """[bytes] at once, of a reading that keeps no block."""
    gc.collect()
    tracemalloc.clear_traces()
    reader = case.make()
    for _ in guarded(reader, path, source, described(reader, path, source)):
        pass
    return tracemalloc.get_traced_memory()[1]


@contextmanager
def _traced() -> Iterator[None]:
    """While what Python allocates is traced. A library's thread that allocates just when tracing begins or ends takes
    the whole process down (CPython 3.11), so these get the time to end what they do."""
    _let_threads_end()
    tracemalloc.start()
    try:
        yield
    finally:
        _let_threads_end()
        tracemalloc.stop()


def _let_threads_end() -> None:
    gc.collect()
    time.sleep(QUIET_S)
