"""A probe that stands at the end of its range, with the noise of its converter: only that the machine goes on tells
it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.calibration.quality.ends.range import plateau_at_extreme
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Course
from thermodata.draft.signals.guess import guess_of
from thermodata.plugin import Int1D, Signal
from thermodata.reader.times.step_back import in_words

_PROBES = ("displacement", "voltage")
_TURNS = 0.02  # of the largest speed
_MOST = 3  # questions of a test


def range_questions(files: Sequence[RawFile]) -> list[str]:
    """What is asked of each probe of a test that stands on its own extreme while the spindle turns. A test whose speed
    nobody logged is asked nothing: a machine at rest stands as well."""
    courses = [
        (signal, guess_of(signal, file.sample.values.get(key)), course)
        for file in files
        for signal in file.signals
        if (course := file.sample.courses.get(key := (signal.stream, signal.name))) is not None
    ]
    speeds = [course for _, said, course in courses if said.quantity == "rotational_speed"]
    found = [_question(s, said.unit, course, speeds) for s, said, course in courses if said.quantity in _PROBES]
    return list(filter(None, found))[:_MOST]


def _question(signal: Signal, unit: str | None, course: Course, speeds: Sequence[Course]) -> str | None:
    known = np.isfinite(course.values)
    t_ns, x = course.t_ns[known], course.values[known]
    if not t_ns.size or (np.diff(t_ns) <= 0).any():
        return None
    end = plateau_at_extreme((t_ns - t_ns[0]) / 1e9, x)
    if end is None or not any(_goes_on(t_ns[end.start : end.stop], speed) for speed in speeds):
        return None
    level = f"{end.level:.4g} {unit or ''}".rstrip()
    ends = f"[{level}, ...]" if end.side < 0 else f"[..., {level}]"
    return (
        f"{signal.name} stands at {level}, its {'lowest' if end.side < 0 else 'highest'}, within its noise for "
        f"{in_words(round((t_ns[end.stop - 1] - t_ns[end.start]) / 60e9) * 60 * 10**9)} while the spindle turns: the "
        f"end of its range? then sensor: {{range: {ends}}} of its channel flags it"
    )


def _goes_on(t_ns: Int1D, speed: Course) -> bool:
    """Whether the spindle turns through much of a plateau, which no change of its speed began: that shifts a tool at
    once. t_ns: of its rows, shape (n,)."""
    lasts = t_ns[-1] - t_ns[0]
    within = np.abs(speed.values[(speed.t_ns >= t_ns[0] + lasts // 20) & (speed.t_ns <= t_ns[-1] - lasts // 20)])
    about = speed.values[np.abs(speed.t_ns - t_ns[0]) <= lasts // 20]
    most = float(np.nanmax(np.abs(speed.values), initial=0.0))
    if not within.size or not most:
        return False
    turns = float(np.mean(within > _TURNS * most)) > 0.5
    return turns and (about.size < 2 or float(np.ptp(about)) <= _TURNS * most)
