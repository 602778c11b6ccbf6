"""One log that was recorded through several tests, as the part of each that a list of the tests says: when they began
and ended."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from thermodata.draft.files.raw_file import RawFile, RowsOfTest
from thermodata.draft.folder.beside.listed_times import ListedTime, to_the_minute
from thermodata.draft.folder.into_tests.over_tests import within
from thermodata.draft.words.filenames import normal

_FEWEST = 2  # tests of one log
_NEAR_NS = 300 * 10**9  # by which a log may begin behind its first test, or end before its last


def parted_by_lists(
    files: Sequence[RawFile], lists: Sequence[Mapping[str, ListedTime]]
) -> tuple[tuple[RawFile, ...], list[str]]:
    """(the files, each that holds several tests of a list as that many; a note on each). Times of the list must be of
    the clock of the log: both local, or both in UTC."""
    found: list[RawFile] = []
    notes: list[str] = []
    whole = [listed for listed in lists if not _has_own_logs(files, listed)]
    for file in files:
        times = next((own for listed in whole if (own := _held(file, listed))), None)
        if times is None:
            found.append(file)
            continue
        found += [_part(file, test, listed) for test, listed in times.items()]
        of = next(iter(times.values())).file
        notes.append(
            f"{file.path} goes on through {len(times)} tests, and is cut to each where {of} says that it began and "
            "ended; what lies between them is of none"
        )
    return tuple(found), notes


def _has_own_logs(files: Sequence[RawFile], listed: Mapping[str, ListedTime]) -> bool:
    """Whether tests of a list have logs of their own, by name or by time: what goes on beside these is theirs."""
    names = {normal(test) for test in listed}
    for file in files:
        if any(normal(piece) in names for piece in (file.path.stem, *file.path.parts[:-1], file.part or "")):
            return True
        first, last = file.start_ns, file.sample.last_ns
        during = [at for at in listed.values() if _overlaps(at, first, last)]
        if during and _held(file, listed) is None:
            return True
    return False


def _overlaps(at: ListedTime, first: int | None, last: int | None) -> bool:
    return first is not None and last is not None and at.begin_ns < last and first < (at.end_ns or at.begin_ns)


def _held(file: RawFile, listed: Mapping[str, ListedTime]) -> dict[str, ListedTime] | None:
    """The tests of a list that a log holds; None where these are few, some lie partly in it, or two ran at once."""
    first, last = file.start_ns, file.sample.last_ns
    if file.part is not None or first is None or last is None or not file.sample.whole:
        return None
    own: dict[str, ListedTime] = {}
    for test, at in listed.items():
        if at.zoned is file.local or at.end_ns is None:
            return None
        if first - _NEAR_NS <= at.begin_ns and at.end_ns <= last + _NEAR_NS:
            own[test] = at
        elif _overlaps(at, first, last):
            return None
    spans = sorted((at.begin_ns, at.end_ns or 0) for at in own.values())
    apart = all(a[1] <= b[0] for a, b in pairwise(spans))
    return own if len(own) >= _FEWEST and apart else None


def _part(file: RawFile, test: str, at: ListedTime) -> RawFile:
    first = file.start_ns or 0
    begin, end = max(at.begin_ns, first), at.end_ns or 0
    window = ((begin - first) / 1e9, (end - first) / 1e9)
    return replace(
        within(file, begin, end),
        block=RowsOfTest(test, window, f"{at.file} says {to_the_minute(begin)} to {to_the_minute(end)}"),
    )


__all__ = ["parted_by_lists"]
