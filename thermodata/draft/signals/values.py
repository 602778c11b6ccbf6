"""What a signal's values say about it: their range, how they change, whether they are a switch."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np

from thermodata.calibration.quality.ends.limit import impossible, sentinels
from thermodata.calibration.quality.value import run_stats
from thermodata.draft.signals.numerals import bare_word, numerals_of
from thermodata.errors import UsageError
from thermodata.plugin import Array, Float1D
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.words.on_off import on_or_off

_FEW = 8
_LOOKED_AT = 2000  # rows, for how many values there are
_LEAST_COUNTED = 10
_NINES = re.compile(r"9{2,}\.?9{2,}")  # of any length, as a laser writes -99999.99999
_OVERFLOW, _FAR = 1e6, 100.0  # the smallest such mark, and how many times as large as all else it is

_MANY, _TAIL = 200, 0.005  # of so many values a share at each end may be spikes


@dataclass(frozen=True, slots=True)
class Values:
    """Of a sample of a signal. n: finite values; low and high: its range; step: the median of its changes from row to
    row; moves: the share of rows that differ from the one before; distinct: at most 9; whole: integers only; first,
    second: the first two of them; counts: each is one more than the one before; text: words of a switch, counted as 0
    and 1; numerals: texts that are numbers, measured ones by their fractions; units: where some of these have a unit,
    or a letter for thousands, behind them, such a one and a bare one ('7.5 K', '800'; '' where all have); read: ingest
    takes such texts for their numbers. body: the range of 99 % of many; None of few."""

    n: int
    low: float
    high: float
    median: float
    step: float
    moves: float
    distinct: int
    whole: bool
    first: float
    second: float
    counts: bool = False
    text: bool = False
    numerals: bool = False
    units: tuple[str, str] | None = None
    body: tuple[float, float] | None = None
    read: bool = False

    @property
    def counts_rows(self) -> bool:
        """1, 2, 3 ... or 0, 1, 2 ...: the number of a row."""
        return self.counts and self.n >= _LEAST_COUNTED and self.first in (0.0, 1.0)

    @property
    def constant(self) -> bool:
        return self.low == self.high

    @property
    def switch(self) -> bool:
        """Only 0 and 1, and both."""
        return self.distinct == 2 and (self.low, self.high) == (0.0, 1.0)

    @property
    def slow(self) -> bool:
        """It creeps: from row to row it changes by little of its range, as a temperature does."""
        return self.n >= 20 and self.distinct > _FEW and self.step <= 0.1 * max(self.high - self.low, 1e-12)

    @property
    def usual(self) -> tuple[float, float]:
        """Its range but for a spike."""
        return self.body or (self.low, self.high)

    def span(self) -> str:
        """'19.8 to 34.5', with as many digits as tell the two apart."""
        if self.constant:
            return f"{self.low:.4g}"
        digits = next((n for n in range(4, 17) if f"{self.low:.{n}g}" != f"{self.high:.{n}g}"), 17)
        return f"{self.low:.{digits}g} to {self.high:.{digits}g}"


def values_of(column: Array) -> Values | None:
    """None for text, but of a switch ('ON', 'aus') or of numbers, and for signals without a finite value. column:
    shape (n,)."""
    if column.dtype.kind in "OUS" and (switched := _switched(column)) is not None:
        made = values_of(switched)
        return None if made is None else replace(made, text=True)
    if column.dtype.kind in "OUS" and (kept := numerals_of(column.tolist())) is not None:
        made = values_of(kept.numbers)
        return None if made is None else replace(made, numerals=True, units=kept.units, read=kept.read)
    if column.dtype.kind not in "biuf" or not column.size:
        return None
    x = np.asarray(column, dtype=np.float64)
    x = _readings(x[np.isfinite(x)])
    if not x.size:
        return None
    change = np.abs(np.diff(x))
    return Values(
        int(x.size),
        float(x.min()),
        float(x.max()),
        float(np.median(x)),
        float(np.median(change[change > 0])) if (change > 0).any() else 0.0,
        float((change > 0).mean()) if change.size else 0.0,
        _distinct(x),
        bool((x == np.round(x)).all()),
        float(x[0]),
        float(x[min(1, x.size - 1)]),
        bool(x.size > 1 and (np.diff(x) == 1).all()),
        body=_body(x),
    )


def _distinct(x: Float1D) -> int:
    """How many values there are, at most 9: up to two counted in all rows, for a switch may be on in few of them; more
    in some. x: shape (n,), finite, n > 0."""
    low, high = x.min(), x.max()
    if ((x == low) | (x == high)).all():
        return 1 if low == high else 2
    some = np.unique(x[:: max(1, x.size // _LOOKED_AT)])
    return min(max(int(some.size), 3), _FEW + 1)


def _body(x: Float1D) -> tuple[float, float] | None:
    """x: shape (n,), finite."""
    if x.size < _MANY:
        return None
    low, high = np.quantile(x, [_TAIL, 1 - _TAIL])
    return float(low), float(high)


def _switched(column: Array) -> Float1D | None:
    """The words of a switch as 0 and 1, as ingest counts them; None where others stand among them. shape (n,)."""
    bare = {word: bare_word(word) for word in set(column.tolist())}
    numbers = {word: number for word, b in bare.items() if b and (number := on_or_off(b)) is not None}
    if not numbers or len(numbers) < sum(map(bool, bare.values())):
        return None
    return np.array([numbers.get(word, np.nan) for word in column.tolist()])


def _readings(x: Float1D) -> Float1D:
    """Without a logger's marks for "over range" and "no value", which are no reading: 1e+38, -9999, -99999.99999,
    1000000. x: shape (n,), finite; as it is where nothing else is left."""
    if not x.size:
        return x
    nines = np.array([end for end in (x.min(), x.max()) if _NINES.fullmatch(f"{abs(end):.10g}")], np.float64)
    marks = impossible(x, "displacement") | sentinels(x, run_stats(x), written=nines)
    largest = float(np.abs(x).max())
    if largest >= _OVERFLOW and np.log10(largest) == round(np.log10(largest)):
        # a full number of zeros, far above all else: catman writes 1000000
        there = np.abs(x) == largest
        others = np.abs(x[~there & ~marks])
        if others.size and largest > _FAR * float(others.max()):
            marks |= there
    return x[~marks] if not marks.all() else x


def least_reading(values: Values) -> float:
    """The lowest reading; without the zeros that a logger writes where it lost one."""
    return min(values.first, values.median) if values.low == 0.0 else values.low


def in_unit(values: Values | None, written: str | None, unit: str | None) -> Values | None:
    """A sample in another unit; as it is where either is none, or they have nothing in common."""
    if values is None or written is None or unit is None or written == unit:
        return values
    try:
        factor, offset = linear_conversion(written, unit)
    except UsageError:
        return values
    low, high, median = (x * factor + offset for x in (values.low, values.high, values.median))
    first, second = (x * factor + offset for x in (values.first, values.second))
    step = values.step * factor
    body = None if values.body is None else (values.body[0] * factor + offset, values.body[1] * factor + offset)
    own = replace(values, low=low, high=high, median=median, step=step, whole=False, first=first, second=second)
    return replace(own, body=body)


def joined(one: Values | None, other: Values | None) -> Values | None:
    """Of both samples together, the earlier one first; of the longer one what cannot be added."""
    if one is None or other is None:
        return one or other
    main = one if one.n >= other.n else other
    levels = main.distinct
    if one.constant and other.constant and one.low != other.low:
        levels = 2
    return Values(
        one.n + other.n,
        min(one.low, other.low),
        max(one.high, other.high),
        main.median,
        max(one.step, other.step) if min(one.step, other.step) == 0 else min(one.step, other.step),
        (one.moves * one.n + other.moves * other.n) / (one.n + other.n),
        max(levels, one.distinct, other.distinct),
        one.whole and other.whole,
        one.first,
        one.second,
        one.counts and other.counts,
        one.text and other.text,
        one.numerals and other.numerals,
        next((v.units for v in (one, other) if v.units is not None and v.units[1]), one.units or other.units),
        _joined_bodies(one, other),
        one.read and other.read,
    )


def _joined_bodies(one: Values, other: Values) -> tuple[float, float] | None:
    if one.body is None and other.body is None:
        return None
    return min(one.usual[0], other.usual[0]), max(one.usual[1], other.usual[1])
