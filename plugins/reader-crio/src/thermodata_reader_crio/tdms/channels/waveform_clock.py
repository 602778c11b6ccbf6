"""The time of TDMS rows: start, offset and increment of a waveform, in integers, so that nothing drifts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from thermodata.plugin import Bool1D, Int1D
from thermodata.reader.times.time_units import SECONDS
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.unit import is_unit
from thermodata_reader_crio.labview_clock import LAST_NS, step_ns
from thermodata_reader_crio.tdms.segments.metadata import Timestamp

_FREQUENCY = ("freq", "frekvenc", "fréq")  # the beginnings of its names, as LabVIEW calls the x of a spectrum


@dataclass(frozen=True, slots=True)
class Waveform:
    """start_ns: since 1970 UTC, or None where the file names no date; the sample interval as a fraction."""

    start_ns: int | None
    offset_ns: int
    step: Fraction

    @property
    def base_ns(self) -> int:
        """Time of the first sample: ns since 1970 UTC, or since the start."""
        return (self.start_ns or 0) + self.offset_ns

    def at(self, sample: int) -> int:
        """Time of a sample."""
        return self.base_ns + sample * self.step.numerator // self.step.denominator


def waveform(properties: Mapping[str, Any]) -> Waveform | None:
    """A channel's waveform clock, or None where it has no usable increment, or does not run over time."""
    increment, unit_s = properties.get("wf_increment"), _unit_s(properties.get("wf_xunit_string"))
    if (
        runs_over(properties) is not None
        or isinstance(increment, bool)
        or not isinstance(increment, int | float)
        or not math.isfinite(increment)
        or not 1e-12 < increment < 1e9
    ):
        return None
    start = properties.get("wf_start_time")
    start_ns = start.ns if isinstance(start, Timestamp) and start.seconds > 0 else None
    if start_ns is not None and not 0 < start_ns < LAST_NS:
        start_ns = None
    offset = properties.get("wf_start_offset", 0.0)
    usable = (
        not isinstance(offset, bool) and isinstance(offset, int | float) and math.isfinite(offset) and abs(offset) < 1e9
    )
    offset_ns = round(Fraction(repr(float(offset))) * unit_s * 1_000_000_000) if usable else 0
    return Waveform(start_ns, offset_ns, step_ns(float(increment)) * unit_s)


def runs_over(properties: Mapping[str, Any]) -> str | None:
    """What a waveform runs over that is no time: 'Hz' of a spectrum, 'mm' of a path; None where it is a time, or where
    nothing says what it is."""
    unit, name = (str(properties.get(key) or "").strip() for key in ("wf_xunit_string", "wf_xname"))
    return _other_than_time(unit, name)


@lru_cache(maxsize=256)
def _other_than_time(unit: str, name: str) -> str | None:
    if unit.lower() in SECONDS:
        return None
    if is_unit(unit):
        return None if converts(unit, "s") else unit
    return name if name.lower().startswith(_FREQUENCY) else None


def _unit_s(text: Any) -> Fraction:
    """The unit in which the increment and the offset of a waveform count [s]: seconds where it names no other."""
    seconds = SECONDS.get(text.strip().lower(), 1.0) if isinstance(text, str) else 1.0
    return Fraction(repr(seconds))


@dataclass(frozen=True, eq=False)
class Clock:
    """The clock of some rows, piece by piece: it starts anew where the file says so, and after a hole.

    row: first row of each piece, shape (k,); base_ns: time of its sample 0; origin: the number of its first sample;
    suspect: whether an unknown number of samples is missing before it.
    """

    row: Int1D
    base_ns: Int1D
    origin: Int1D
    steps: tuple[Fraction, ...]
    suspect: Bool1D
    absolute: bool

    def times(self, first: int, last: int) -> Int1D:
        """Times of rows [first, last), shape (n,)."""
        a = int(np.searchsorted(self.row, first, "right")) - 1
        b = int(np.searchsorted(self.row, last, "left"))
        parts = []
        for k in range(a, b):
            begin = max(first, int(self.row[k]))
            end = min(last, int(self.row[k + 1])) if k + 1 < self.row.size else last
            step, origin = self.steps[k], int(self.origin[k]) - int(self.row[k])
            whole, rest = divmod(step.numerator, step.denominator)
            i = np.arange(begin + origin, end + origin, dtype=np.int64)
            parts.append(i * whole + ((i * rest) // step.denominator if rest else 0) + int(self.base_ns[k]))
        return np.concatenate(parts) if parts else np.zeros(0, np.int64)

    def suspects(self, first: int, last: int) -> Bool1D | None:
        """Which of rows [first, last) lie behind a hole of unknown length; None: none of them."""
        if not self.suspect.any():
            return None
        piece = np.searchsorted(self.row, np.arange(first, last), "right") - 1
        found: Bool1D = self.suspect[piece]
        return found if found.any() else None

    def ends_before(self, rows: int) -> bool:
        """Whether all rows have a time that a store can hold."""
        ends = [*self.row[1:].tolist(), rows]
        return all(
            abs(int(base) + (int(origin) + max(0, end - int(row))) * step) < LAST_NS
            for row, end, base, origin, step in zip(self.row, ends, self.base_ns, self.origin, self.steps, strict=True)
        )

    def nearly(self, other: Clock, within_ns: int) -> bool:
        """Equal, but for a shift of less than `within_ns` and half a step."""
        if self is other:
            return True
        if (
            self.absolute != other.absolute
            or self.steps != other.steps
            or not np.array_equal(self.row, other.row)
            or not np.array_equal(self.suspect, other.suspect)
            or not np.array_equal(self.origin, other.origin)
        ):
            return False
        apart = np.abs(self.base_ns - other.base_ns)
        return all(d == 0 or d < min(within_ns, step / 2) for d, step in zip(apart.tolist(), self.steps, strict=True))


def counted(step_s: float) -> Clock:
    """The clock of rows of which the file says no time."""
    one = np.zeros(1, np.int64)
    return Clock(one, one, one, (step_ns(step_s),), np.zeros(1, bool), False)
