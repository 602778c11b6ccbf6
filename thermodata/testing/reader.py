"""The conformance kit of readers: the rules that the house applies, as tests for a plugin's author.

    import pytest
    from functools import partial
from pathlib import Path
    from thermodata.plugin import Source
    from thermodata.testing.reader import reader_checks
    from my_plugin import Reader

    FILES = [(Path(__file__).parent / "sample.log", Source(timezone="Europe/Prague"))]

    @pytest.mark.parametrize("check", reader_checks(Reader, FILES), ids=str)
    def test_reader(check):
        check()

Every check is a function with a sentence for a name. One that fails raises AssertionError with file and place.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import PluginError, ThermodataError
from thermodata.plugin import HEAD_BYTES, Head, Loss, Reader, Recording, Source
from thermodata.reader.guard import described, guarded
from thermodata.reader.rules import sentence
from thermodata.schema.flag import INVALID
from thermodata.testing.impostors import IMPOSTORS

Files = Sequence[tuple[Path, Source]]
MAX_CUTS = 60


@dataclass(frozen=True)
class Case:
    """What the kit knows of a reader. claims: which of the kit's impostors are its own formats. block_rows: the
    option by which blocks can be made smaller, where the reader has one."""

    make: Callable[[], Reader]
    files: tuple[tuple[Path, Source], ...]
    claims: tuple[str, ...] = ()
    block_rows: str | None = None


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
    times: dict[str, list[Any]] = {}
    values: dict[tuple[str, str], list[Any]] = {}
    flags: dict[tuple[str, str], list[Any]] = {}
    losses = []
    for item in guarded(reader, path, source, recording):
        if isinstance(item, Loss):
            losses.append(item)
            continue
        times.setdefault(item.stream, []).append(item.t_ns)
        for name, column in item.values.items():
            values.setdefault((item.stream, name), []).append(column)
            none = np.zeros(column.shape, np.uint16)
            flags.setdefault((item.stream, name), []).append((item.flags or {}).get(name, none))
    return Data(recording, {k: np.concatenate(v) for k, v in times.items()},
                {k: np.concatenate(v) for k, v in values.items()},
                {k: np.concatenate(v) for k, v in flags.items()}, tuple(losses))


def _equal(a: Any, b: Any) -> bool:
    if a.dtype.kind in "fc" and b.dtype.kind in "fc":
        return bool(np.array_equal(a, b, equal_nan=True))
    return bool(np.array_equal(a, b))


def _same(a: Data, b: Data, what: str) -> None:
    assert a.t_ns.keys() == b.t_ns.keys(), f"{what}: streams {sorted(a.t_ns)} and {sorted(b.t_ns)}"
    for stream in a.t_ns:
        assert _equal(a.t_ns[stream], b.t_ns[stream]), f"{what}: the times of stream '{stream}' differ"
    assert a.values.keys() == b.values.keys(), f"{what}: other signals"
    for key in a.values:
        assert _equal(a.values[key], b.values[key]), f"{what}: the values of {key[1]} differ"


# ---- the checks: each takes the case, and a file where it needs one ------------------------------


def it_is_made_without_arguments_and_has_a_name(case: Case) -> None:
    try:
        reader = case.make()
    except TypeError as error:
        raise AssertionError(f"not made without arguments: {error}") from error
    assert isinstance(reader, Reader), "a reader has name, sniff, describe and blocks"
    assert isinstance(reader.name, str), "name is text"
    assert reader.name, "name is empty"


def it_claims_its_own_file_and_says_why(case: Case, path: Path, source: Source) -> None:
    reason = case.make().sniff(_head(path))
    assert isinstance(reason, str), f"{path.name}: not claimed"
    assert len(reason) > 3, f"{path.name}: the reason is {reason!r}"


def it_claims_no_file_of_another_format(case: Case) -> None:
    reader = case.make()
    for name, start in IMPOSTORS.items():
        if name.split(" ")[0] in case.claims:
            continue
        suffix = case.files[0][0].suffix if case.files else ".dat"
        for size in (len(start), 10_000_000):
            reason = reader.sniff(Head(f"file{suffix}", size, start))
            assert reason is None, f"claims a file of {name}: {reason}"


def a_sniff_survives_any_head(case: Case, path: Path, source: Source) -> None:
    reader, whole = case.make(), _head(path)
    rng = np.random.default_rng(0)
    for n in sorted({0, 1, 2, 3, 4, 7, 16, 27, 28, 100, 1000, len(whole.start) // 2}):
        for start in (whole.start[:n], whole.start[:n] + rng.bytes(200), rng.bytes(n)):
            try:
                reason = reader.sniff(Head(path.name, len(start), start))
            except Exception as error:
                raise AssertionError(f"sniff raised {error!r} at a head of {len(start)} bytes") from error
            assert reason is None or isinstance(reason, str), f"sniff returned {type(reason).__name__}"


def its_data_follow_the_rules(case: Case, path: Path, source: Source) -> None:
    try:
        data = load(case.make(), path, source)
    except PluginError as error:
        raise AssertionError(str(error)) from error
    assert data.t_ns, f"{path.name}: no data"


def every_declared_signal_arrives(case: Case, path: Path, source: Source) -> None:
    data = load(case.make(), path, source)
    missing = [s.name for s in data.recording.signals if (s.stream, s.name) not in data.values]
    assert not missing, f"{path.name}: declared, never delivered: {missing}"


def an_absolute_recording_starts_when_it_says(case: Case, path: Path, source: Source) -> None:
    data = load(case.make(), path, source)
    if data.recording.clock == "absolute":
        first = min(int(t[0]) for t in data.t_ns.values())
        start = data.recording.start_ns
        assert start is not None, f"{path.name}: absolute without start_ns"
        assert abs(first - start) < 86_400_000_000_000, \
            f"{path.name}: says {np.datetime64(start, 'ns')}, starts {np.datetime64(first, 'ns')}"


def reading_again_gives_the_same(case: Case, path: Path, source: Source) -> None:
    reader = case.make()
    _same(load(reader, path, source), load(reader, path, source), f"{path.name} read twice")


def threads_read_the_same(case: Case, path: Path, source: Source) -> None:
    reader = case.make()
    alone = load(reader, path, source)
    with ThreadPoolExecutor(4) as pool:
        for other in pool.map(lambda _: load(reader, path, source), range(4)):
            _same(alone, other, f"{path.name} read by four threads")


def the_size_of_blocks_changes_nothing(case: Case, path: Path, source: Source) -> None:
    if case.block_rows is None:
        return
    whole = load(case.make(), path, source)
    for rows in (1, 3, 7, 1000):
        if rows == 1 and max(t.size for t in whole.t_ns.values()) > 2000:
            continue
        small = replace(source, options={**source.options, case.block_rows: rows})
        _same(whole, load(case.make(), path, small), f"{path.name} in blocks of {rows}")


def the_file_and_its_folder_stay_as_they_were(case: Case, path: Path, source: Source) -> None:
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "měření 1" / f"soubor č. 1{path.suffix}"
        copy.parent.mkdir()
        shutil.copy(path, copy)
        before = hashlib.sha256(copy.read_bytes()).digest()
        load(case.make(), copy, source)
        assert hashlib.sha256(copy.read_bytes()).digest() == before, f"{path.name} was changed"
        assert sorted(os.listdir(copy.parent)) == [copy.name], f"left behind: {os.listdir(copy.parent)}"


def an_empty_file_is_refused_or_holds_nothing(case: Case, path: Path, source: Source) -> None:
    with tempfile.TemporaryDirectory() as folder:
        empty = Path(folder) / path.name
        empty.write_bytes(b"")
        _refused_or(case, empty, source, lambda data: _assert(not data.t_ns, "data out of an empty file"))


def garbage_is_refused_or_holds_nothing(case: Case, path: Path, source: Source) -> None:
    rng = np.random.default_rng(1)
    start = path.read_bytes()[:64]
    with tempfile.TemporaryDirectory() as folder:
        for number, content in enumerate((rng.bytes(5000), b"\0" * 5000, start + rng.bytes(5000), b"x\n" * 50)):
            garbage = Path(folder) / f"{number}{path.suffix}"
            garbage.write_bytes(content)
            _refused_or(case, garbage, source, lambda data: None)


def a_cut_file_keeps_its_good_part_and_says_what_is_gone(case: Case, path: Path, source: Source) -> None:
    """At a sample of byte positions (every one, of a file up to MAX_CUTS bytes): what is still delivered stands
    at the same place in the whole file, and a reader that can tell says that something is missing."""
    content = path.read_bytes()
    whole = load(case.make(), path, source)
    with tempfile.TemporaryDirectory() as folder:
        cut_path = Path(folder) / path.name
        readable = 0
        for cut in _cuts(len(content)):
            cut_path.write_bytes(content[:cut])
            data = _refused_or(case, cut_path, source, partial(_part, whole=whole, what=f"{path.name} cut at {cut}"))
            assert data is not None or not readable, \
                f"{path.name} cut at {cut} is refused, though a file cut at {readable} is read"
            readable = cut if data is not None and data.t_ns else readable


def damage_never_escapes_as_a_foreign_error(case: Case, path: Path, source: Source) -> None:
    """Bytes overwritten at random places: our errors, a Loss, or other data; never a crash of another kind."""
    content = path.read_bytes()
    rng = np.random.default_rng(2)
    with tempfile.TemporaryDirectory() as folder:
        for number in range(40):
            changed = bytearray(content)
            for at in rng.integers(0, max(1, min(len(content), 4000)), 1 + number % 3):
                changed[int(at)] = int(rng.integers(256))
            damaged = Path(folder) / path.name
            damaged.write_bytes(bytes(changed))
            _refused_or(case, damaged, source, lambda data: None)


# ---- helpers -------------------------------------------------------------------------------------


def _assert(holds: bool, what: str) -> None:
    assert holds, what


def _head(path: Path) -> Head:
    with path.open("rb") as file:
        return Head(path.name, path.stat().st_size, file.read(HEAD_BYTES))


def _cuts(size: int) -> list[int]:
    if size <= MAX_CUTS:
        return list(range(1, size))
    rng = np.random.default_rng(3)
    near = [size - k for k in (1, 2, 3, 5, 9, 17)] + list(range(1, 12))
    return sorted({c for c in [*near, *rng.integers(1, size, MAX_CUTS - len(near)).tolist()] if 0 < c < size})


def _refused_or(case: Case, path: Path, source: Source, then: Callable[[Data], None]) -> Data | None:
    """The reader refuses the file with one of our errors (None), or `then` judges what it gave."""
    try:
        data = load(case.make(), path, source)
    except PluginError as error:
        raise AssertionError(f"{path.name} ({path.stat().st_size} bytes): {error}") from error
    except ThermodataError:
        return None
    then(data)
    return data


def _part(part: Data, whole: Data, what: str) -> None:
    fewer = False
    for stream, t_ns in whole.t_ns.items():
        got = part.t_ns.get(stream, np.zeros(0, np.int64))
        assert got.size <= t_ns.size, f"{what}: more rows than the whole file has"
        assert _equal(got, t_ns[: got.size]), f"{what}: other times in stream '{stream}'"
        fewer = fewer or got.size < t_ns.size
    for key, values in part.values.items():
        assert key in whole.values, f"{what}: a new signal {key}"
        good = (part.flags[key] & np.uint16(INVALID)) == 0
        fewer = fewer or not bool(good.all())
        same_rows = whole.values[key][: values.size]
        if same_rows.dtype.kind == values.dtype.kind:
            assert _equal(values[good], same_rows[good]), f"{what}: other values in {key[1]}"
    can_tell = whole.recording.complete is not None
    if fewer and can_tell:
        assert part.losses, f"{what}: rows are gone and no Loss says so"
        assert part.recording.complete is False, f"{what}: rows are gone and complete is {part.recording.complete}"


CASE_CHECKS: tuple[Callable[[Case], None], ...] = (
    it_is_made_without_arguments_and_has_a_name,
    it_claims_no_file_of_another_format,
)
FILE_CHECKS: tuple[Callable[[Case, Path, Source], None], ...] = (
    it_claims_its_own_file_and_says_why,
    a_sniff_survives_any_head,
    its_data_follow_the_rules,
    every_declared_signal_arrives,
    an_absolute_recording_starts_when_it_says,
    reading_again_gives_the_same,
    threads_read_the_same,
    the_size_of_blocks_changes_nothing,
    the_file_and_its_folder_stay_as_they_were,
    an_empty_file_is_refused_or_holds_nothing,
    garbage_is_refused_or_holds_nothing,
    a_cut_file_keeps_its_good_part_and_says_what_is_gone,
    damage_never_escapes_as_a_foreign_error,
)


@dataclass(frozen=True)
class Check:
    """One check, ready to call."""

    run: Callable[..., None]
    case: Case
    file: tuple[Path, Source] | None = None

    def __call__(self) -> None:
        self.run(self.case, *(self.file or ()))

    def __str__(self) -> str:
        return sentence(self.run) + (f" [{self.file[0].name}]" if self.file else "")


def reader_checks(
    make: Callable[[], Reader], good_files: Files, *, claims: Sequence[str] = (), block_rows: str | None = None
) -> list[Check]:
    """All checks of a reader, for pytest.mark.parametrize(..., ids=str).

    make: the reader's class. good_files: complete files of its format, small ones (each is read about a hundred
    times), with what a campaign file would declare. claims: names in `impostors.IMPOSTORS` that are its own.
    """
    case = Case(make, tuple((Path(p), s) for p, s in good_files), tuple(claims), block_rows)
    return [Check(run, case) for run in CASE_CHECKS] + \
        [Check(run, case, file) for file in case.files for run in FILE_CHECKS]


def check_reader(
    make: Callable[[], Reader], good_files: Files, *, claims: Sequence[str] = (), block_rows: str | None = None
) -> None:
    """Runs all checks; AssertionError with every one that failed."""
    failed = []
    for check in reader_checks(make, good_files, claims=claims, block_rows=block_rows):
        try:
            check()
        except Exception as error:
            failed.append(f"{check}: {error if isinstance(error, AssertionError) else repr(error)}")
    assert not failed, "\n".join(failed)


__all__ = ["CASE_CHECKS", "FILE_CHECKS", "Case", "Check", "Data", "check_reader", "load", "reader_checks"]
