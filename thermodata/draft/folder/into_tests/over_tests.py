"""Logs that go on over several tests of another source: a control's file a day, beside a recording a test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Course

_HOUR_NS = 3_600_000_000_000
_NEAR_NS = 60_000_000_000  # by which a log may begin after the test, or end before it


def over_tests(
    files: Sequence[RawFile], spans: Mapping[str, tuple[int, int]], local: bool
) -> dict[str, tuple[RawFile, ...]] | None:
    """Test -> the one file that runs from its beginning to its end, its courses being those of the test; empty where
    another than one does for any test, or for each test another one; None where it is another by another zone. spans:
    test -> its first and last time [ns]; local: whether times of one of the two may be whole hours ahead."""
    fits: list[dict[str, tuple[RawFile, RawFile]]] = []  # for each number of hours: the file, and the part of it
    for hours in range(-13, 15) if local else (0,):
        found: dict[str, tuple[RawFile, RawFile]] = {}
        for test, (begin, end) in spans.items():
            first, last = begin + hours * _HOUR_NS, end + hours * _HOUR_NS
            running = [f for f in files if _runs(f, first, last)]
            if len(running) != 1:
                break
            found[test] = running[0], within(running[0], first, last)
        if len(found) == len(spans) and len({whole.path for whole, _ in found.values()}) < len(found):
            fits.append(found)
    if not fits:
        return {}
    if len({tuple(whole.path for whole, _ in found.values()) for found in fits}) > 1:
        return None
    # a day's file holds a test at many hours: which part of it is the test's nobody knows before its zone
    return {test: (part if len(fits) == 1 else whole,) for test, (whole, part) in fits[0].items()}


def _runs(file: RawFile, first: int, last: int) -> bool:
    begin, end = file.start_ns, file.sample.last_ns
    return begin is not None and end is not None and begin - _NEAR_NS <= first and last <= end + _NEAR_NS


def within(file: RawFile, first: int, last: int) -> RawFile:
    """The file with the courses of a part of it. first, last: of that [ns]."""
    courses, extents = {}, {}
    for key, course in file.sample.courses.items():
        inside = (course.t_ns >= first) & (course.t_ns <= last)
        courses[key] = Course(course.t_ns[inside], course.values[inside])
        if (part := course.values[inside][np.isfinite(course.values[inside])]).size:
            extents[key] = (float(part.min()), float(part.max()))
    begin, end = max(file.sample.first_ns or first, first), min(file.sample.last_ns or last, last)
    part_of = replace(file.sample, courses=courses, heads={}, extents=extents, first_ns=begin, last_ns=end)
    return replace(file, sample=part_of)


__all__ = ["over_tests", "within"]
