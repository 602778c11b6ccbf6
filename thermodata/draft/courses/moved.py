"""What a test's recordings show: what turned, what moved, and what was switched."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.calibration.quality.ends.limit import no_values
from thermodata.draft.courses.cuts import feeds_with_spindle, is_loaded
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Course
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.implied_speed import is_implied
from thermodata.errors import UsageError
from thermodata.plugin import Float1D, Int1D
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import canonical
from thermodata.schema.words.places import is_spindle
from thermodata.schema.words.sentences import with_count
from thermodata.store.tidy.rows.on_change import come_at_no_rate

_PUMPED = ("coolant", "hydraulics", "pump")  # fans, chillers and lubrication come and go by themselves
_BY_ITSELF = ("fan", "pump", "chiller", "coolant", "hydraulics", "lubrication")
_SWITCHED = 0.8  # of its largest reading: it was off as well as on
_TURNS_RPM, _SAME = 20.0, 0.02
_FEEDS_M_MIN = 0.05
_MOVES_MM = 5.0
_STAYS, _LEAST_ROWS = 0.02, 3  # of the time in which it turns, and rows: else it passes
_FEW_ROWS, _OF_FEW = 5, 0.1  # of fewer rows, each tells, where they are as much of the whole


@dataclass(slots=True)
class Moved:
    """What a test's recordings show. speeds: plateaus of the spindle [rpm]; fed: whether a feed ran whose axis is not
    told; implied: whether nothing says the unit of these speeds; turning: of what turns beside spindle and table, as a
    lathe's driven tools, by its place; seen: whether a speed, a feed or a position was logged at all. with_spindle: the
    axes feed only while the spindle turns; loaded: that takes its power; None where that was not logged."""

    speeds: tuple[float, ...] = ()
    axes: set[str] = field(default_factory=set)
    fed: bool = False
    rotary: bool = False
    turning: dict[str, tuple[float, ...]] = field(default_factory=dict)
    switched: bool = False
    seen: bool = False
    whole: bool = True
    implied: bool = False
    with_spindle: bool = False
    loaded: bool | None = None

    def __str__(self) -> str:
        """'spindle at 3000, 6000 rpm, X moves'; 'nothing moves'."""
        said = []
        if self.speeds:
            said.append(f"spindle at {_rpm(self.speeds)}")
        if self.axes:
            cuts = " while the spindle turns under load" if self.with_spindle and self.loaded else ""
            said.append(f"{'/'.join(sorted(self.axes)).upper()} moves{cuts}")
        if self.rotary:
            said.append("the table turns")
        if self.fed and not said:
            said.append("a feed runs, whose axis is not told")
        said += [f"{at} at {_rpm(speeds)}" for at, speeds in self.turning.items()]
        return ", ".join(said) or ("switches change, nothing moves" if self.switched else "nothing moves")


def _rpm(speeds: tuple[float, ...]) -> str:
    """'3000, 6000 rpm', no more than four of them."""
    return f"{with_count([f'{s:g}' for s in speeds], 4)} rpm"


def moved_in(files: Sequence[RawFile]) -> Moved:
    """All recordings of a test, of all sources."""
    found = Moved(whole=all(f.sample.whole for f in files))
    for file in files:
        work = _Work()
        for signal in file.signals:
            key = (signal.stream, signal.name)
            seen, course = file.sample.values.get(key), file.sample.courses.get(key)
            if seen is None:
                continue
            said = guess_of(signal, seen)
            if said.quantity == "position" and said.questions:
                continue  # it may be a probe's, and shows no axis that stands still
            factor = _factor(said.quantity, said.unit)
            low, high = file.sample.extents.get(key, (seen.low, seen.high))
            course = None if course is None else _read(course, said.quantity or "")
            before = found.speeds
            if (tells := _TELLS.get(said.quantity)) is not None:
                scaled = None if course is None else Course(course.t_ns, factor * course.values)
                largest, span = factor * max(abs(low), abs(high)), factor * (high - low)
                tells(found, _Logged(said.at or "", largest, span, scaled))
            if found.speeds is not before:
                found.implied = is_implied(said)
            if course is not None and course.t_ns.size:
                work.add(said.quantity, said.at or "", Course(course.t_ns, factor * course.values))
        work.tell(found)
    return found


def _read(course: Course, quantity: str) -> Course:
    """Without a logger's codes for no value: 65535 is no speed."""
    coded = no_values(course.values, quantity)
    return Course(course.t_ns[~coded], course.values[~coded]) if coded.any() else course


@dataclass(slots=True)
class _Work:
    """Of a file, the courses of the spindle's speed and power, and of the feeds."""

    speed: Course | None = None
    power: Course | None = None
    feeds: list[Course] = field(default_factory=list)

    def add(self, quantity: str | None, at: str, course: Course) -> None:
        if quantity == "feed":
            self.feeds.append(course)
        elif quantity == "rotational_speed" and at == "spindle":
            self.speed = course
        elif quantity == "power" and at == "spindle":
            self.power = course

    def tell(self, found: Moved) -> None:
        if self.speed is None or not self.feeds:
            return
        found.with_spindle = feeds_with_spindle(self.speed, self.feeds)
        found.loaded = None if self.power is None else is_loaded(self.speed, self.power)


def _factor(quantity: str | None, unit: str | None) -> float:
    """From a signal's unit to that of its quantity, rpm, m/min or mm; 1 where it is not known or does not convert."""
    if quantity not in ("rotational_speed", "feed", "position") or unit is None:
        return 1.0
    try:
        return linear_conversion(unit, canonical(quantity))[0]
    except UsageError:
        return 1.0


@dataclass(frozen=True, slots=True)
class _Logged:
    """One signal of a test. at: its place, '' where that is not known; largest: of the sizes of its values; span: from
    its lowest to its highest. All in rpm, m/min or mm where the signal's unit is known."""

    at: str
    largest: float
    span: float
    course: Course | None

    @property
    def axis(self) -> str | None:
        """'x' of 'axis.x', and of no part of it."""
        return self.at.split(".")[1] if self.at.startswith("axis.") and self.at.count(".") == 1 else None


def _by_speed(found: Moved, signal: _Logged) -> None:
    at, turns = signal.at, signal.largest > _TURNS_RPM
    found.seen = True
    if is_spindle(at):
        if turns and signal.course is not None:
            found.speeds = max(found.speeds, _plateaus(signal.course), key=len)
    elif at.startswith(("table", "rotary")):
        found.rotary |= signal.largest > 1
    elif at.startswith("axis."):  # of its motor
        found.axes |= {at.split(".")[1]} if turns else set()
    elif turns and not at.startswith(_BY_ITSELF) and (speeds := _turns(signal.largest, signal.course)):
        found.turning[at or "what has no place"] = speeds


def _by_feed(found: Moved, signal: _Logged) -> None:
    feeds = signal.largest > _FEEDS_M_MIN
    found.seen |= feeds or signal.axis is not None
    found.fed |= feeds and signal.axis is None
    found.axes |= {signal.axis} if feeds and signal.axis is not None else set()


def _by_position(found: Moved, signal: _Logged) -> None:
    if signal.axis is None:
        return
    found.seen = True
    if signal.span > _MOVES_MM:
        found.axes.add(signal.axis)


def _by_state(found: Moved, signal: _Logged) -> None:
    found.switched |= signal.span > 0 and not signal.at.startswith("hall")


def _by_what_is_driven(found: Moved, signal: _Logged) -> None:
    found.switched |= signal.at.startswith(_PUMPED) and signal.span > _SWITCHED * signal.largest


_TELLS: dict[str | None, Callable[[Moved, _Logged], None]] = {
    "rotational_speed": _by_speed,
    "feed": _by_feed,
    "position": _by_position,
    "state": _by_state,
    **dict.fromkeys(("flow", "pressure", "power", "load", "current"), _by_what_is_driven),
}
"""What each quantity tells of a test; the others tell nothing."""


def _turns(largest: float, course: Course | None) -> tuple[float, ...]:
    """The speeds at which it stayed; the largest, where no course tells."""
    return (float(f"{largest:.3g}"),) if course is None else _plateaus(course)


def _plateaus(speed: Course) -> tuple[float, ...]:
    """The speeds at which it stayed, the lower ones first; to 2 %."""
    fine = np.isfinite(speed.values)
    x, t_ns = np.abs(speed.values[fine]), speed.t_ns[fine]
    on_change = come_at_no_rate(t_ns)
    lasts = _until_the_next(t_ns) if on_change else np.ones(x.size)
    turns = x > _TURNS_RPM
    whole, x, lasts = float(lasts.sum()), x[turns], lasts[turns]
    few = x.size < _FEW_ROWS
    if not x.size or (few and lasts.sum() < _OF_FEW * whole):
        return ()  # a glitch
    least_rows = 1 if few or on_change else _LEAST_ROWS
    found: list[float] = []
    cells = np.round(np.log(x) / _SAME).astype(np.int64)
    for cell in np.unique(cells):
        there = cells == cell
        if np.count_nonzero(there) < least_rows or lasts[there].sum() < _STAYS * lasts.sum():
            continue
        level = float(np.median(x[np.abs(np.log(x) / _SAME - cell) <= 1.5]))
        if not any(abs(level - f) < 2 * _SAME * f for f in found):
            found.append(level)
    return tuple(float(f"{f:.3g}") if f >= 1000 else round(f) for f in found)


def _until_the_next(t_ns: Int1D) -> Float1D:
    """How long each row stands [ns]; the last one as long as rows do."""
    lasts = np.maximum(np.diff(t_ns), 0).astype(np.float64)
    return np.append(lasts, np.median(lasts))
