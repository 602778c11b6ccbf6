"""Logs that go on over tests and are cut by the clock: a file an hour or a day, which tests run across."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.draft.files.raw_file import RawFile

_HOUR_NS = 3_600_000_000_000
_NEAR_NS = 15 * 60 * 1_000_000_000  # by which one clock may be off another
_PAUSE = 0.25  # of a file at most, to the next one
_SHORTEST_NS = 60_000_000_000
Span = tuple[int, int]


def runs_across(files: Sequence[RawFile], spans: Mapping[str, Span], local: bool) -> bool:
    """Whether files are parts of one log that covers all tests at one number of hours, some tests across more than one
    of them. Not where at some number of hours a file each begins and ends with its test. spans: test -> its first and
    last time [ns]; local: whether times of one of the two may be whole hours ahead."""
    own = sorted((f.start_ns or 0, max(f.sample.last_ns or 0, f.start_ns or 0)) for f in files)
    ahead = sorted(range(-13, 15), key=abs) if local else [0]
    moved = [[(a + h * _HOUR_NS, b + h * _HOUR_NS) for a, b in spans.values()] for h in ahead]
    if any(all(any(_alike(test, file) for file in own) for test in tests) for tests in moved):
        return False
    whole = _logs(own)
    return any(all(_inside(test, whole) for test in tests) and _crosses(tests, own) for tests in moved)


def _logs(own: Sequence[Span]) -> list[Span]:
    """What the files cover, those that follow each other without a pause put together. own: in order."""
    found: list[Span] = []
    for begin, end in own:
        if found and begin - found[-1][1] <= max(_PAUSE * (end - begin), _SHORTEST_NS):
            found[-1] = (found[-1][0], max(end, found[-1][1]))
        else:
            found.append((begin, end))
    return found


def _alike(test: Span, file: Span) -> bool:
    return abs(test[0] - file[0]) < _NEAR_NS and abs(test[1] - file[1]) < _NEAR_NS


def _inside(test: Span, logs: Sequence[Span]) -> bool:
    return any(begin - _NEAR_NS <= test[0] and test[1] <= end + _NEAR_NS for begin, end in logs)


def _crosses(tests: Sequence[Span], own: Sequence[Span]) -> bool:
    """Whether one file ends and another begins well within a test."""
    return any(a + _NEAR_NS < begin < b - _NEAR_NS for a, b in tests for begin, _ in own)
