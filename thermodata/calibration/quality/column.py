"""A column while its flags are found: what it is, what stands beside it, and what the rules said of it so far."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from thermodata.calibration.quality.ends.range import Limits
from thermodata.calibration.quality.event import QualityEvent, event_of, events_of
from thermodata.calibration.quality.last_row import Reading, last_row_repeats
from thermodata.calibration.quality.sun import least_count_of_sun
from thermodata.calibration.quality.time import TimeFlags
from thermodata.calibration.quality.value import RunStats, run_stats
from thermodata.calibration.quality.zeros import rows_of_zeros
from thermodata.plugin import Array, Bool1D, Float1D, Int1D
from thermodata.schema.flag import Flag
from thermodata.schema.units.quantity import STATES

# Quantities whose readings carry noise, so that an exactly constant stretch is suspicious.
ANALOG = frozenset(
    {
        "displacement",
        "tilt",
        "temperature",
        "temperature_difference",
        "voltage",
        "resistance",
        "humidity",
        "irradiance",
        "pressure",
    }
)


@dataclass(frozen=True, slots=True)
class ColumnInput:
    """A column. values: shape (n,), in the canonical unit (text for a label). flags: those that it already has
    (from the reader and from `calibrate`), kept and reported. range: (low, high) in the canonical unit. at: its place,
    where it is known. elsewhere: how it reads in other tests, where this one does not tell. limits: the ends of
    its range that other tests show. held: it is written on change: that it stands still says nothing. codes: those for
    "no value" in the unit that it was logged in, as they are in the canonical one."""

    values: Array
    quantity: str
    flags: Array | None = None
    range: tuple[float, float] | None = None
    at: str | None = None
    elsewhere: RunStats | None = None
    limits: Limits = (None, None)
    held: bool = False
    codes: Float1D | None = None

    @property
    def is_number(self) -> bool:
        """Whether it holds numbers, and no text."""
        return self.values.dtype.kind in "iuf"

    @property
    def is_float(self) -> bool:
        """Whether its values may be missing, or between two whole numbers."""
        return self.values.dtype.kind == "f"


@dataclass(frozen=True)
class Stream:
    """Columns that share their times. t_ns: shape (n,), as recorded; stats: of those whose readings carry noise."""

    t_ns: Int1D
    time: TimeFlags
    columns: Mapping[str, ColumnInput]

    @cached_property
    def stats(self) -> Mapping[str, RunStats]:
        """Channel -> how it runs, of columns of ANALOG quantities that nobody writes on change."""
        return {name: run_stats(x) for name, c in self.columns.items() if (x := _analog(c)) is not None}

    @cached_property
    def repeats_from(self) -> int | None:
        """See `last_row.last_row_repeats`."""
        told = {
            name: Reading(c.values, c.quantity, self.stats.get(name), c.elsewhere)
            for name, c in self.columns.items()
            if c.is_number and not c.held
        }
        return last_row_repeats(self.t_ns, told)

    @cached_property
    def filled(self) -> Bool1D:
        """Where any column of numbers has a value, shape (n,)."""
        found: Bool1D = np.zeros(len(self.t_ns), dtype=bool)
        for column in self.columns.values():
            if column.is_float:
                found |= np.isfinite(column.values)
        return found

    @cached_property
    def zeros(self) -> Bool1D:
        """See `rows_of_zeros`."""
        numbers = {k: c for k, c in self.columns.items() if c.is_number and c.quantity not in STATES}
        warm = {k: c.values for k, c in numbers.items() if c.quantity == "temperature"}
        return rows_of_zeros({k: c.values for k, c in numbers.items()}, warm, len(self.t_ns))


def _analog(column: ColumnInput) -> Float1D | None:
    if column.held or column.quantity not in ANALOG or not column.is_number or len(column.values) < 3:
        return None
    return np.asarray(column.values, dtype=np.float64)


@dataclass
class Marked:
    """A column with the flags that it has so far: each rule sees what those before it marked, and adds to it.

    flags: shape (n,), uint16. told: where an event says why a reading counts as none, shape (n,)."""

    name: str
    column: ColumnInput
    stream: Stream
    flags: Array = field(init=False)
    told: Bool1D = field(init=False)
    events: list[QualityEvent] = field(default_factory=list)

    def __post_init__(self) -> None:
        n, given = len(self.stream.t_ns), self.column.flags
        self.flags = np.zeros(n, np.uint16) if given is None else given.astype(np.uint16)
        self.told = np.zeros(n, dtype=bool)
        shapes = self.column.values.shape, self.flags.shape
        if any(shape != self.stream.t_ns.shape for shape in shapes):
            raise ValueError(
                f"column '{self.name}': shape {shapes[0]}, flags {shapes[1]}, time {self.stream.t_ns.shape}"
            )

    @cached_property
    def x(self) -> Float1D:
        """The readings, shape (n,), in the canonical unit."""
        return np.asarray(self.column.values, dtype=np.float64)

    @property
    def stats(self) -> RunStats | None:
        """How it runs; None where its readings carry no noise."""
        return self.stream.stats.get(self.name)

    @property
    def least_count_of_sun(self) -> float | None:
        """See `sun.least_count_of_sun`; None of a column without noise."""
        return None if self.stats is None else least_count_of_sun(self.x, self.column.quantity, self.stats)

    def beside(self, *quantities: str) -> dict[str, Array]:
        """Channel -> values of the other columns that carry noise: all of them, or those of some quantities."""
        columns = self.stream.columns
        return {
            k: columns[k].values
            for k in self.stream.stats
            if k != self.name and (not quantities or columns[k].quantity in quantities)
        }

    def has(self, flag: Flag, rows: slice = slice(None)) -> Bool1D:
        """Where it carries one of the flags, shape (n,), or in some rows."""
        carries: Bool1D = (self.flags[rows] & np.uint16(flag)) != 0
        return carries

    def mark(self, flag: Flag, hit: Bool1D, why: str) -> None:
        """Flags readings, shape (n,), and tells each stretch of them."""
        self.flags[hit] |= np.uint16(flag)
        self.tell(flag, hit, why)

    def tell(self, flag: Flag, hit: Bool1D, why: str) -> None:
        """Tells stretches of readings that carry the flag already."""
        self.events += events_of(self.name, flag, hit, self.stream.t_ns, why)
        self.told |= hit

    def mark_rows(self, flag: Flag, start: int, stop: int, why: str) -> None:
        """Flags and tells rows [start, stop)."""
        self.flags[start:stop] |= np.uint16(flag)
        self.events.append(event_of(self.name, flag, self.stream.t_ns, start, stop, why))
