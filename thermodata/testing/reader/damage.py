"""Checks: what a reader makes of files that are empty, cut, damaged or hostile."""

from __future__ import annotations

import random
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from thermodata.plugin import Source
from thermodata.schema.flag import INVALID
from thermodata.testing.reader.apart import together
from thermodata.testing.reader.case import Case, Data, equal, fault, load, refused_or_read, tells

EVERY_CUT_BYTES = 1024  # a file up to this size is cut at every byte, a larger one at so many places:
SAMPLED_CUTS = 150
HOSTILE_FILES = 60
HOSTILE_MIB = 512  # what a hostile header may make a reader allocate


def an_empty_file_is_refused_or_holds_nothing(case: Case, path: Path, source: Source) -> None:
    with tempfile.TemporaryDirectory() as folder:
        empty = Path(folder) / path.name
        empty.write_bytes(b"")
        data = refused_or_read(case, empty, source, "an empty file")
        if data is not None and data.t_ns:
            fault("data out of an empty file", "raise FormatError('... is empty') in describe")


def garbage_is_refused_or_holds_nothing(case: Case, path: Path, source: Source) -> None:
    rng = np.random.default_rng(1)
    start = path.read_bytes()[:64]
    contents = {
        "random bytes": rng.bytes(5000),
        "zeros": b"\0" * 5000,
        "fifty lines 'x'": b"x\n" * 50,
        "the first 64 bytes of a good file, then random ones": start + rng.bytes(5000),
    }
    with tempfile.TemporaryDirectory() as folder:
        for number, (what, content) in enumerate(contents.items()):
            garbage = Path(folder) / f"{number}{path.suffix}"
            garbage.write_bytes(content)
            refused_or_read(case, garbage, source, f"a file of {what}")


def a_cut_file_keeps_its_good_part_and_says_what_is_gone(case: Case, path: Path, source: Source) -> None:
    """Cut at every byte (of a file up to EVERY_CUT_BYTES; at SAMPLED_CUTS places above): what is still delivered
    stands at the same place in the whole file, and a reader that can tell says that something is missing."""
    content = path.read_bytes()
    whole = load(case.make(), path, source)
    with tempfile.TemporaryDirectory() as folder:
        cut_path = Path(folder) / path.name
        readable = 0
        for cut in cuts(len(content)):
            cut_path.write_bytes(content[:cut])
            what = f"{path.name} cut at byte {cut} of {len(content)}"
            data = refused_or_read(case, cut_path, source, what)
            if data is None:
                if readable:
                    fault(
                        f"{what} is refused, though its first {readable} bytes alone are read",
                        "keep the good part: yield the blocks before the damage, then a Loss",
                    )
                continue
            _stands_in(data, whole, what)
            # from a row or two a layout cannot be told, so that much may be refused
            readable = cut if max((t.size for t in data.t_ns.values()), default=0) >= 3 else readable


def a_file_cut_within_a_record_is_told(case: Case, path: Path, source: Source) -> None:
    """Also of a format that can't tell a whole file from one cut between two records: most cuts go through one."""
    content = path.read_bytes()
    whole = load(case.make(), path, source)
    silent = []
    with tempfile.TemporaryDirectory() as folder:
        cut_path = Path(folder) / path.name
        for cut in cuts(len(content)):
            cut_path.write_bytes(content[:cut])
            data = refused_or_read(case, cut_path, source, f"{path.name} cut at byte {cut}")
            if data is not None and _lacks_rows(data, whole):
                if tells(whole, data) or not _all_numbers(data, whole):
                    return
                silent.append(cut)
    if silent:
        fault(
            f"{path.name} cut at byte {silent[-1]} of {len(content)}, and at {len(silent) - 1} places more\n"
            "expected: a Loss where a record or line is cut through\n"
            "got: fewer rows at each of them, and no word of it",
            "yield a Loss(where, reason=...) for a last record or line that is not whole; describe with complete=None "
            "where a cut between two of them can't be told",
        )


def damage_never_escapes_as_a_foreign_error(case: Case, path: Path, source: Source) -> None:
    """Bytes overwritten at random places: our errors, a Loss, or other data; never a crash of another kind."""
    content = path.read_bytes()
    rng = np.random.default_rng(2)
    with tempfile.TemporaryDirectory() as folder:
        damaged = Path(folder) / path.name
        for number in range(60):
            changed = bytearray(content)
            places = rng.integers(0, max(1, min(len(content), 4000)), 1 + number % 3) if content else ()
            for at in places:
                changed[int(at)] = int(rng.integers(256))
            damaged.write_bytes(bytes(changed))
            refused_or_read(case, damaged, source, f"{path.name} with other bytes at {sorted(map(int, places))}")


def a_hostile_header_costs_no_memory(case: Case, path: Path, source: Source) -> None:
    """Huge counts, lengths and offsets, and whatever the author's `mutate` makes: refused or read, within bounds."""
    content = path.read_bytes()

    def read_them() -> str | None:
        with tempfile.TemporaryDirectory() as folder:
            hostile = Path(folder) / path.name
            for what, data in _hostile(content, case):
                hostile.write_bytes(data)
                refused_or_read(case, hostile, source, f"{path.name} {what}")
        return None

    wrong = together(read_them, memory_mib=HOSTILE_MIB)[0]
    if wrong is not None and "\ntry: " not in wrong:
        fault(
            f"{path.name} with a hostile header: {wrong}",
            "hold every declared count and length against the file's size before you allocate or loop by it; "
            "read in blocks",
        )
    if wrong is not None:
        raise AssertionError(wrong)


def cuts(size: int) -> list[int]:
    """The places to cut a file at, rising."""
    if size <= EVERY_CUT_BYTES:
        return list(range(1, size))
    rng = np.random.default_rng(3)
    ends = [*range(1, 20), *(size - k for k in range(1, 20))]
    return sorted({*ends, *rng.integers(1, size, SAMPLED_CUTS - len(ends)).tolist()})


def _hostile(content: bytes, case: Case) -> Iterator[tuple[str, bytes]]:
    rng = random.Random(4)
    for number in range(HOSTILE_FILES):
        at = rng.randrange(max(1, min(len(content), 400 if number % 2 else 48)))
        wide = rng.choice((2, 4, 8))
        value = rng.choice((b"\xff" * wide, b"\xff" * (wide - 1) + b"\x7f", b"\x7f" + b"\xff" * (wide - 1)))
        yield f"with {value.hex()} at byte {at}", content[:at] + value + content[at + wide :]
    numbers = list(re.finditer(rb"\d+", content[:2000]))
    for match in rng.sample(numbers, min(len(numbers), HOSTILE_FILES // 2)):
        for huge in (b"999999999999999999", b"-1", b"1e308"):
            yield (
                f"with {huge.decode()} at byte {match.start()}",
                content[: match.start()] + huge + content[match.end() :],
            )
    for number in range(HOSTILE_FILES if case.mutate is not None else 0):
        assert case.mutate is not None
        yield f"as mutate(..., random.Random({number})) makes it", case.mutate(content, random.Random(number))


def _lacks_rows(data: Data, whole: Data) -> bool:
    return any(data.t_ns.get(stream, t_ns[:0]).size < t_ns.size for stream, t_ns in whole.t_ns.items())


def _all_numbers(data: Data, whole: Data) -> bool:
    """Whether no value is missing that the whole file has, as of a row whose last cells were cut off."""
    return all(
        equal(np.isfinite(column), np.isfinite(whole.values[key][: column.size]))
        for key, column in data.values.items()
        if column.dtype.kind == "f" and key in whole.values and whole.values[key].dtype.kind == "f"
    )


def _stands_in(part: Data, whole: Data, what: str) -> None:
    fewer = False
    other = "take no half record: drop a last record or line that is not whole, and yield a Loss for it"
    for stream, t_ns in whole.t_ns.items():
        got = part.t_ns.get(stream, np.zeros(0, np.int64))
        if got.size > t_ns.size:
            fault(f"{what}: {got.size} rows in stream '{stream}', the whole file has {t_ns.size}", other)
        if not equal(got, t_ns[: got.size]):
            fault(f"{what}: other times in stream '{stream}' than in the whole file", other)
        fewer = fewer or got.size < t_ns.size
    for key, values in part.values.items():
        if key not in whole.values:
            fault(
                f"{what}: signal '{key[1]}' in stream '{key[0]}', which the whole file does not have",
                "refuse a header that is not whole with FormatError",
            )
        good = (part.flags[key] & np.uint16(INVALID)) == 0
        fewer = fewer or not bool(good.all())
        same_rows = whole.values[key][: values.size]
        if same_rows.dtype.kind == values.dtype.kind and not equal(values[good], same_rows[good]):
            fault(f"{what}: other values in '{key[1]}' than in the whole file", other)
    if fewer and whole.recording.complete is not None:
        if not part.losses:
            fault(
                f"{what}: rows are gone and no Loss says so",
                "yield Loss(where, fraction=..., reason=...) behind the last good block; where the format cannot "
                "tell a cut file, describe with complete=None",
            )
        if part.recording.complete is not False:
            fault(
                f"{what}: rows are gone and complete is {part.recording.complete}",
                "let describe compare what the header promises with the file's size, and set complete=False",
            )
