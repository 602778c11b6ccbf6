"""A test that begins with a jump test: probes that go up and down in steps before the spindle turns."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from thermodata.calibration.jump.plateaus import Step
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import HEAD_NS, Course, Sample
from thermodata.draft.probes.jumps import staircase
from thermodata.draft.probes.out_of_range import out_of_range
from thermodata.draft.signals.guess import guess_of
from thermodata.plugin import Float1D
from thermodata.schema.words.sentences import with_count

_LONGEST_S = HEAD_NS / 1e9  # of a jump test at the beginning of a test
_OF_TEST = 0.2  # and of its length
_TURNS_RPM = 20.0
_BACK = 0.15  # of the largest step: what the steps of a probe add up to that comes back
_DIGITS, _OF_RANGE = 5, 0.1  # the largest step at least, and as a share of what the probe goes through in the test
_LEAST_ROWS = 40
_SHOWN = 4


def window_behind_jumps(files: Sequence[RawFile]) -> str | None:
    """What to ask of a test whose log begins with a jump test; None of another. files: of the test."""
    for file in files:
        first, last = file.sample.first_ns, file.sample.last_ns
        if file.block is not None or first is None or last is None:
            continue
        length_s = (last - first) / 1e9
        until_s = min(_rest_s(file, first), _LONGEST_S, _OF_TEST * length_s)
        seen = {
            s.name: end
            for s in file.signals
            if guess_of(s).quantity in ("displacement", "voltage")
            and (end := _moved_until(file.sample, (s.stream, s.name), first, until_s)) is not None
        }
        if seen:
            end = math.ceil(max(seen.values()))
            names = with_count([f"'{name}'" for name in seen], _SHOWN)
            return (
                f"window: {names} {'goes' if len(seen) == 1 else 'go'} up and down in steps in the first {end} s of "
                f"{file.path}, as in a jump test? then window: [{end} s, {math.floor(length_s)} s], and under "
                f"calibrations {{kind: jump, file: {file.path}, ...}}"
            )
    return None


def _rest_s(file: RawFile, first_ns: int) -> float:
    """How long the spindle stands, where the file says [s]."""
    starts = [
        float(course.t_ns[turning[0]] - first_ns) / 1e9
        for s in file.signals
        if guess_of(s).quantity == "rotational_speed"
        and (course := file.sample.courses.get((s.stream, s.name))) is not None
        and (turning := np.flatnonzero(np.abs(course.values) > _TURNS_RPM)).size
    ]
    return min(starts, default=math.inf)


def _moved_until(sample: Sample, key: tuple[str, str], first_ns: int, until_s: float) -> float | None:
    """When the last step of a probe ended that went in steps and came back [s]; None of another."""
    course = sample.courses.get(key)
    if course is None:
        return None
    out = out_of_range(course.values)
    away = np.zeros(0, np.int64) if out is None else np.flatnonzero(out & np.isfinite(course.values))
    # between visits to its probe a machine takes it to its rail and back, which is no jump test
    until_ns = float(course.t_ns[away[0]]) if away.size else math.inf
    head = sample.heads.get(key, course)
    early = ((head.t_ns - first_ns) / 1e9 < until_s) & (head.t_ns < until_ns)
    if np.count_nonzero(early) < _LEAST_ROWS:
        return None
    found = staircase(Course(head.t_ns[early], head.values[early]))
    if found is None or not _comes_back(found[0]) or not _is_large(found[0], course.values):
        return None
    return float(head.t_ns[early][0] - first_ns) / 1e9 + found[0][-1].to_s


def _is_large(steps: Sequence[Step], values: Float1D) -> bool:
    """Whether the steps are more than the last digit of a quiet probe that flickers. values: of the whole test."""
    levels = np.unique(values[np.isfinite(values)])
    largest = max(abs(float(s.size)) for s in steps)
    return largest >= max(_DIGITS * float(np.diff(levels).min()), _OF_RANGE * float(np.ptp(levels)))


def _comes_back(steps: Sequence[Step]) -> bool:
    sizes = [float(s.size) for s in steps]
    return min(sizes) < 0 < max(sizes) and abs(sum(sizes)) < _BACK * max(map(abs, sizes))
