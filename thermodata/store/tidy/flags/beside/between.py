"""What is known of a test only beside others, or as a whole: enough is kept of each channel to tell it, a verdict comes
back, and the streams that it touches are made again."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.calibration.between_tests.dead import dead_throughout
from thermodata.calibration.between_tests.failing import offsets_between_tests
from thermodata.calibration.between_tests.foreign import foreign_part
from thermodata.calibration.between_tests.levels import POINTS, Course, Levels
from thermodata.calibration.quality.ends.range import Limits, ends_of_ranges
from thermodata.calibration.quality.ends.still import Reading, read_elsewhere
from thermodata.plugin import Array, Float1D
from thermodata.schema.flag import INVALID, Flag
from thermodata.schema.units.quantity import PROBED
from thermodata.schema.words.places import is_at_tool
from thermodata.store.tidy.flags.beside.flicker import Flicker
from thermodata.store.tidy.flags.beside.readings import as_read, reading_with

if TYPE_CHECKING:
    from thermodata.store.tidy.plan.plan import Bound
    from thermodata.store.tidy.values.chunk import Column

_QUANTITIES = PROBED | {"temperature", "humidity"}
HELD = PROBED  # of which a test as a whole tells where their range ends
_MOST_PAUSES = 20
# a sensor that is off is seen as it reads: whether a part of the test is foreign shows in all channels alike
_SEEN = np.uint16(INVALID & ~Flag.OFFSET)


@dataclass(frozen=True, slots=True)
class Verdict:
    """What other tests, and the test as a whole, say of its channels.

    offsets: channel -> (by how much its sensor is off [K], since when [s] or None: throughout). foreign: (from, to) [s]
    of another recording, and why. readings: channel -> how it reads in other tests (step, finest, chance, alternates).
    dead: channels that stand still throughout. limits: channel -> lower and upper end of its range, where it comes
    there. constant: of those that are off, by one number.
    """

    offsets: Mapping[str, tuple[float, float | None]] = field(default_factory=dict)
    foreign: tuple[float | None, float | None, str] | None = None
    readings: Mapping[str, tuple[float, float, float, float]] = field(default_factory=dict)
    dead: tuple[str, ...] = ()
    limits: Mapping[str, Limits] = field(default_factory=dict)
    constant: tuple[str, ...] = ()

    def of(self, channels: Iterable[str]) -> Verdict:
        """What concerns these channels."""
        names = set(channels)
        return Verdict(
            {c: o for c, o in self.offsets.items() if c in names},
            self.foreign,
            {c: r for c, r in self.readings.items() if c in names},
            tuple(c for c in self.dead if c in names),
            {c: ends for c, ends in self.limits.items() if c in names},
            tuple(c for c in self.constant if c in names),
        )

    def to_json(self) -> dict[str, Any]:
        """Plain data; empty where there is nothing to say."""
        if not (self.offsets or self.foreign or self.readings or self.dead or self.limits):
            return {}
        return json.loads(json.dumps({k: v for k, v in asdict(self).items() if v}))  # type: ignore[no-any-return]

    def reading(self, channel: str) -> Reading | None:
        """How a channel reads in other tests; None where the test tells it itself."""
        known = self.readings.get(channel)
        return None if known is None else Reading(*known, moving=0, stood_s=0.0)


class Sampler:
    """Picks POINTS samples of each slow channel, evenly over rows start to stop, and the pauses between rows, while a
    stream is walked through."""

    def __init__(self, bounds: Sequence[Bound], start: int, stop: int) -> None:
        self._rows = np.unique(np.linspace(start, max(stop - 1, start), POINTS).astype(np.int64))
        self._start = start
        self._t_s = np.full(len(self._rows), np.nan)
        mine = [b for b in bounds if b.channel.derive is None and b.channel.quantity in _QUANTITIES]
        self._points = {
            b.name: np.full(len(self._rows), np.nan)
            for b in mine
            if not (b.channel.quantity == "temperature" and is_at_tool(b.channel.at))
        }
        self._off = {name: np.zeros(len(self._rows), dtype=bool) for name in self._points}
        self._flickers = {b.name: Flicker() for b in mine if b.channel.quantity == "temperature"}
        self._readings: dict[str, Reading | None] = {b.name: None for b in mine if b.channel.quantity in HELD}
        self._pauses: list[tuple[float, float]] = []
        self._last_s: float | None = None

    def take(self, first: int, t_s: Float1D, columns: Mapping[str, Column]) -> None:
        """The next chunk: its first row, times from the test's start, and its channels with their own flags."""
        if first < self._start or not len(t_s):
            return
        here = (self._rows >= first) & (self._rows < first + len(t_s))
        at = self._rows[here] - first
        self._t_s[here] = t_s[at]
        for name in self._points:
            if name in columns:
                flags = columns[name].flags[at]
                self._points[name][here] = np.where((flags & _SEEN) == 0, columns[name].values[at], np.nan)
                self._off[name][here] = (flags & np.uint16(Flag.OFFSET)) != 0
        for name, flicker in self._flickers.items():
            if name in columns:
                flicker.take(as_read(columns[name]))
        for name in self._readings:
            if name in columns:
                self._readings[name] = reading_with(self._readings[name], columns[name], t_s)
        self._add_pauses(t_s, columns)

    def _add_pauses(self, t_s: Float1D, columns: Mapping[str, Column]) -> None:
        """Pauses of the stream: where every channel has the flag."""
        if columns:
            gap: Array = np.bitwise_and.reduce([c.flags & np.uint16(Flag.GAP) for c in columns.values()])
            for row in np.flatnonzero(gap).tolist():
                before = t_s[row - 1] if row else self._last_s
                if before is not None:
                    self._pauses.append((float(before), float(t_s[row])))
        self._last_s = float(t_s[-1])

    def levels(self) -> dict[str, Any]:
        """Ready for JSON: t_s, values (None where nothing valid is), off (points at which the channel is flagged as
        off), pauses, readings, flickers (temperature -> how far the next reading lies that it shows often). Empty where
        no channel is slow."""
        values = {n: _rounded(p) for n, p in self._points.items() if np.isfinite(p).any()}
        if not values:
            return {}
        readings = {n: asdict(r) for n, r in self._readings.items() if r is not None}
        longest = sorted(sorted(self._pauses, key=lambda p: p[0] - p[1])[:_MOST_PAUSES])
        return {
            "t_s": _rounded(self._t_s),
            "values": values,
            "off": {n: np.flatnonzero(o).tolist() for n, o in self._off.items() if o.any()},
            "pauses": longest,
            "readings": readings,
            "flickers": {n: tread for n, f in self._flickers.items() if (tread := f.tread) is not None},
        }


def _rounded(x: Float1D) -> list[float | None]:
    return [round(float(v), 3) if np.isfinite(v) else None for v in x]


@dataclass(frozen=True, slots=True)
class KnownOfTest:
    """What is known of a test beside its levels. start_s: on the absolute clock; None where it has none. warm: the
    campaign file says that it started so. quantities: of its channels. powered: those that stay warm or cold while the
    machine is on. around: those that are not of the machine, or nobody says where they are."""

    test: str
    start_s: float | None
    warm: bool
    quantities: Mapping[str, str]
    powered: Container[str]
    around: Container[str]


def levels_of(known: KnownOfTest, courses: Iterable[Sequence[Any]]) -> tuple[Levels, dict[str, Reading]] | None:
    """What a test's channels were like, and how they read, as its tidy files tell; None where nothing is kept. courses:
    (end [s], `levels` of its channels) of each file."""
    series: dict[str, Course] = {}
    pauses: list[tuple[float, float]] = []
    readings: dict[str, Reading] = {}
    end = 0.0
    for to_s, levels in courses:
        end = max(end, to_s)
        if not levels:
            continue
        t_s = _numbers(levels["t_s"])
        for name, values in levels["values"].items():
            off = np.zeros(len(t_s), dtype=bool)
            off[levels["off"].get(name, [])] = True
            series[name] = Course(
                t_s,
                _numbers(values),
                known.quantities.get(name, ""),
                off,
                name in known.powered,
                name in known.around,
                levels.get("flickers", {}).get(name),
            )
        pauses += [(a, b) for a, b in levels["pauses"]]
        readings |= {n: Reading(**r) for n, r in levels["readings"].items()}
    if not series:
        return None
    stop_s = None if known.start_s is None else known.start_s + end
    return Levels(known.test, known.start_s, stop_s, series, tuple(pauses), known.warm), readings


def _numbers(values: Sequence[float | None]) -> Float1D:
    return np.array(values, dtype=np.float64)  # None is NaN


def verdicts(tests: Sequence[tuple[Levels, Mapping[str, Reading]]]) -> dict[str, Verdict]:
    """Test -> what is known of it beside the others. tests: in the order of the campaign file."""
    offsets: dict[str, dict[str, tuple[float, float | None]]] = {}
    constant: set[tuple[str, str]] = set()
    for (test, channel), off in offsets_between_tests([x for x, _ in tests]).items():
        offsets.setdefault(test, {})[channel] = round(off.size, 1), off.since_s
        constant |= {(test, channel)} if off.constant else set()
    readings: dict[str, dict[str, tuple[float, float, float, float]]] = {}
    seen = {(x.test, c): r for x, known in tests for c, r in known.items()}
    for (test, channel), r in read_elsewhere(seen).items():
        readings.setdefault(test, {})[channel] = r.step, r.finest, r.chance, r.alternates
    limits: dict[str, dict[str, Limits]] = {}
    for (test, channel), ends in ends_of_ranges(seen).items():
        limits.setdefault(test, {})[channel] = ends
    dead = dead_throughout([x for x, _ in tests])
    found: dict[str, Verdict] = {}
    for levels, _ in tests:
        part = foreign_part(levels)
        foreign = None if part is None else (_finite_or_none(part[0]), _finite_or_none(part[1]), part[2])
        still = tuple(sorted(channel for test, channel in dead if test == levels.test))
        verdict = Verdict(
            offsets.get(levels.test, {}),
            foreign,
            readings.get(levels.test, {}),
            still,
            limits.get(levels.test, {}),
            tuple(sorted(channel for test, channel in constant if test == levels.test)),
        )
        if verdict != Verdict():
            found[levels.test] = verdict
    return found


def _finite_or_none(x: float) -> float | None:
    return x if np.isfinite(x) else None
