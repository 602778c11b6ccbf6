"""A test that holds a jump test: probes that go up and down in steps while the spindle stands, at its beginning, at its
end, or in a pause."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermodata.calibration.jump.plateaus import Step
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import HEAD_NS, Course, Sample
from thermodata.draft.probes.jumps import TRAVEL_MM, staircase
from thermodata.draft.probes.out_of_range import out_of_range
from thermodata.draft.signals.guess import guess_of
from thermodata.plugin import Float1D
from thermodata.schema.words.sentences import listed, with_count

_LONGEST_S = HEAD_NS / 1e9  # of a jump test at the beginning or the end of a test
_OF_TEST = 0.2  # and of its length
_TURNS_RPM = 20.0
_BACK = 0.15  # of the largest step: what the steps of a probe add up to that comes back
_DIGITS, _OF_RANGE = 5, 0.1  # the largest step at least, and as a share of what the probe goes through in the test
_LEAST_ROWS = 40
_LEAST_PAUSE_S = 5.0  # of an axis between two moves
_SHOWN = 4
_TOGETHER_S = 600.0  # between the moves of two axes of one jump test
_LEAST_ALONE = 4  # steps of one probe that nothing but an axis makes, away from the ends of a test
_PROBES = ("displacement", "voltage")


@dataclass(frozen=True, slots=True)
class _Moved:
    """A probe that went in steps and came back, from the first to the last one [s from the first row of the file]."""

    name: str
    from_s: float
    to_s: float
    steps: int


@dataclass(frozen=True, slots=True)
class _Within:
    """Where the moves of one jump test lie [s from the first row of the file], and the probes that show them."""

    names: tuple[str, ...]
    from_s: float
    to_s: float


def window_behind_jumps(files: Sequence[RawFile]) -> str | None:
    """What to ask of a test whose log holds jump tests; None of another. files: of the test."""
    for file in files:
        first, last = file.sample.first_ns, file.sample.last_ns
        if file.block is not None or first is None or last is None:
            continue
        length_s = (last - first) / 1e9
        at_head = _at_head(file, first, length_s)
        later = list(_later(file, first, length_s, at_head.to_s if at_head else -math.inf))
        found = [*([at_head] if at_head else []), *later]
        if not found:
            continue
        ends = [0.0, *(t for one in found for t in (one.from_s, one.to_s)), length_s]
        a, b = max(zip(ends[::2], ends[1::2], strict=True), key=lambda w: w[1] - w[0])
        names = list(dict.fromkeys(name for one in found for name in one.names))
        return (
            f"window: {with_count([repr(name) for name in names], _SHOWN)} {'goes' if len(names) == 1 else 'go'} up "
            f"and down in steps {listed([_where(one) for one in found])} of {file.path}, as in a jump test? then "
            f"window: [{math.ceil(a)} s, {math.floor(b)} s], and under calibrations {{kind: jump, file: {file.path}, "
            "...}"
        )
    return None


def _where(one: _Within) -> str:
    if one.from_s <= 0:
        return f"in the first {math.ceil(one.to_s)} s"
    return f"from {math.floor(one.from_s)} to {math.ceil(one.to_s)} s"


def _at_head(file: RawFile, first_ns: int, length_s: float) -> _Within | None:
    """The jump test that a file begins with."""
    until_s = min(_rest_s(file, first_ns), _LONGEST_S, _OF_TEST * length_s)
    seen = {
        name: end
        for name, key in _probes(file)
        if (end := _moved_until(file.sample, key, first_ns, until_s)) is not None
    }
    return _Within(tuple(seen), 0.0, math.ceil(max(seen.values()))) if seen else None


def _later(file: RawFile, first_ns: int, length_s: float, behind_s: float) -> Iterator[_Within]:
    """The jump tests in the rest of a file, behind a time: where the axes were moved in turn, or one to and fro, while
    the spindle stands where its speed is logged. At the end of a test, as at its beginning, one move there and back is
    one."""
    moved = [m for name, key in _probes(file) for m in _moved(file, name, key, first_ns) if m.from_s > behind_s]
    moved.sort(key=lambda m: m.from_s)
    ends = [i for i, (a, b) in enumerate(pairwise(moved), 1) if b.from_s - a.to_s > _TOGETHER_S]
    for group in (moved[a:b] for a, b in pairwise([0, *ends, len(moved)])):
        if not group:
            continue
        one = _Within(tuple(dict.fromkeys(m.name for m in group)), group[0].from_s, max(m.to_s for m in group))
        in_turn = any(a.to_s <= b.from_s for a in group for b in group if a.name != b.name)
        at_end = length_s - one.from_s < min(_LONGEST_S, _OF_TEST * length_s)
        if (in_turn or at_end or max(m.steps for m in group) >= _LEAST_ALONE) and _stands(file, first_ns, one):
            yield one


def _moved(file: RawFile, name: str, key: tuple[str, str], first_ns: int) -> Iterator[_Moved]:
    course = file.sample.courses.get(key)
    stretches = file.sample.steps.get(key, ())
    if course is None or not stretches or out_of_range(course.values) is not None:
        return  # between visits to its probe a machine takes it to its rail and back, which is no jump test
    for stretch in stretches:
        found = staircase(stretch)
        if found is not None and _comes_back(found[0]) and _is_large(found[0], course.values):
            began = float(stretch.t_ns[0] - first_ns) / 1e9
            yield _Moved(name, began + found[0][0].from_s, began + found[0][-1].to_s, len(found[0]))


def _stands(file: RawFile, first_ns: int, one: _Within) -> bool:
    """Whether no spindle turns and no axis travels meanwhile, by what is logged."""
    for signal in file.signals:
        course = file.sample.courses.get((signal.stream, signal.name))
        if course is None or not course.t_ns.size:
            continue
        quantity = guess_of(signal).quantity
        t_s = (course.t_ns - first_ns) / 1e9
        # what was logged last before it stands until then
        a, b = int(np.searchsorted(t_s, one.from_s, "right")) - 1, int(np.searchsorted(t_s, one.to_s, "right"))
        during = course.values[max(a, 0) : b]
        during = during[np.isfinite(during)]
        if not during.size:
            continue
        if quantity == "rotational_speed" and np.abs(during).max() > _TURNS_RPM:
            return False
        if quantity == "position" and np.ptp(during) > TRAVEL_MM:
            return False
    return True


def _probes(file: RawFile) -> list[tuple[str, tuple[str, str]]]:
    """(name, (stream, name)) of what an axis may move."""
    return [(s.name, (s.stream, s.name)) for s in file.signals if guess_of(s).quantity in _PROBES]


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
    """Whether steps go up and down to where they began, and stand between them for longer than a hand holds a probe."""
    sizes = [float(s.size) for s in steps]
    if min(b.t_s - a.t_s for a, b in pairwise(steps)) < _LEAST_PAUSE_S:
        return False
    return min(sizes) < 0 < max(sizes) and abs(sum(sizes)) < _BACK * max(map(abs, sizes))
