"""What the other signals of a test read at the times of a probe, in its own file and in those of other sources."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Course
from thermodata.draft.times.clocks import Named
from thermodata.draft.times.one_clock import OneClock
from thermodata.plugin import Bool1D, Float1D, Int1D

_HALF_HOUR_NS = 1_800_000_000_000
_ZONES = 28  # half hours that a zone may be from UTC, and more
_COVERED = 0.9  # of the probe's rows, by a log of another source
_NO_CLOCKS: Mapping[int, OneClock] = MappingProxyType({})
_PAUSE = 3.0  # times its usual step, and a log of another source stood between two rows: it is written on change


@dataclass(frozen=True, slots=True)
class SignalBeside:
    """A signal at the times of a probe. before, after: its rows about each of these times, shape (n,); the same where
    it has a row there, or is held from row to row. elsewhere: logged by another source."""

    quantity: str
    place: str | None
    channel: str
    before: Float1D
    after: Float1D
    elsewhere: bool

    def told(self, rule: Callable[[Float1D], Bool1D]) -> tuple[Bool1D, Bool1D]:
        """(what a rule says at the times of the probe, where it says it for sure): between two rows of another log that
        differ nobody knows."""
        before, after = rule(self.before), rule(self.after)
        return before, before == after


def signals_beside(
    files: Sequence[RawFile],
    named: Mapping[int, Named],
    home: RawFile,
    t_ns: Int1D,
    clocks: Mapping[int, OneClock] = _NO_CLOCKS,
) -> Iterator[tuple[SignalBeside, ...]]:
    """The signals of a probe's own file at its times t_ns, shape (n,); then with those of the files of other sources:
    by what is guessed of their clocks, then as if their local times were off by whole half hours. Nothing of what is
    not dated or does not run beside it. clocks: id of a file -> its clock."""
    own = _of(home, named.get(id(home), {}), t_ns, False)
    yield own
    dated = [f for f in files if f is not home and f.recording.clock == home.recording.clock == "absolute"]
    if not dated or not t_ns.size:
        return
    here = clocks.get(id(home))
    guessed = {id(f): here.to(there) for f in dated if here and (there := clocks.get(id(f)))}
    local = home.local or any(f.local for f in dated)
    half_hours = sorted(range(-_ZONES, _ZONES + 1), key=abs) if local else (0,)
    plain = [dict.fromkeys(map(id, dated), k * _HALF_HOUR_NS) for k in half_hours]
    told = {key: shift for key, shift in guessed.items() if shift is not None}
    for shifts in [*([{**plain[0], **told}] if told else []), *plain]:
        if others := [b for f in dated for b in _of(f, named.get(id(f), {}), t_ns + shifts[id(f)], True)]:
            yield (*own, *others)


def _of(file: RawFile, names: Named, t_ns: Int1D, elsewhere: bool) -> tuple[SignalBeside, ...]:
    found = []
    for key, course in file.sample.courses.items():
        if key in names and (rows := _rows(course, t_ns, elsewhere)) is not None:
            found.append(SignalBeside(*names[key], course.values[rows[0]], course.values[rows[1]], elsewhere))
    return tuple(found)


def _rows(course: Course, t_ns: Int1D, elsewhere: bool) -> tuple[Int1D, Int1D] | None:
    """The rows of a course before and behind each time; of the own file that before alone. None where it has none, or
    runs at another time."""
    there = course.t_ns
    if not there.size:
        return None
    before = np.searchsorted(there, t_ns, side="right") - 1
    if not elsewhere:
        before = np.clip(before, 0, there.size - 1)
        return before, before
    if there.size < 2 or np.mean((t_ns >= there[0]) & (t_ns <= there[-1])) < _COVERED:
        return None
    before = np.clip(before, 0, there.size - 2)
    stood = (there[before + 1] - there[before]) > _PAUSE * np.median(np.diff(there))
    return before, np.where(stood | (there[before] == t_ns), before, before + 1)
