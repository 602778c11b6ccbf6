"""The plan of a MAT file: which of its arrays are times, which are signals, and what describes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.plugin import Array, Loss
from thermodata_reader_table.mat.tree import Numbers

MOST_SIGNALS = 100_000  # of a file
MOST_SCALES = 1000  # in one vector of factors
LOOK = 2000  # values by which a time is judged


@dataclass(frozen=True, slots=True)
class TimeVector:
    """A time of `length` rows. load: None for a grid of step_s from zero_s. texts: dates as text. unit: as the file
    says it, or None; said: what else it says of the time alone."""

    path: str
    length: int
    load: Callable[[int, int], Array] | None = None
    texts: tuple[str, ...] | None = None
    unit: str | None = None
    step_s: float = 0.0
    zero_s: float = 0.0
    said: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Column:
    """One signal: load(start, stop) of its rows; texts where it is one of words; said: what the file states of it
    alone."""

    name: str
    unit: str | None
    dtype: str
    length: int
    load: Callable[[int, int], Array]
    said: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Stream:
    """A time with the signals of its rows."""

    time: TimeVector
    columns: list[Column] = field(default_factory=list)
    properties: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Listed:
    """Names, units or scales of columns, in their order. of: the variable that they are called after, '' for none;
    called: the variable that holds them."""

    called: str
    of: str
    lines: tuple[str, ...]


@dataclass
class Scope:
    """One level of the file: its arrays by path, and what describes them. known: the names of its variables."""

    path: str
    above: Scope | None
    known: frozenset[str] = frozenset()
    columns: list[Column] = field(default_factory=list)
    matrices: list[tuple[str, Numbers]] = field(default_factory=list)
    times: list[TimeVector] = field(default_factory=list)
    names: list[Listed] = field(default_factory=list)
    units: list[Listed] = field(default_factory=list)
    scales: list[Listed] = field(default_factory=list)
    unit_of: dict[str, str] = field(default_factory=dict)
    time_unit: str | None = None
    step_s: float | None = None
    properties: dict[str, str] = field(default_factory=dict)


@dataclass
class Plan:
    """What is found so far. where: the file's name; wanted: the declared time, by name or number of its column; cut:
    whether the file is; stated: of signals by their names in small letters, the scales that variables called after them
    state, by the paths of these."""

    where: str
    wanted: Any = None
    cut: bool = False
    stated: dict[str, dict[str, str]] = field(default_factory=dict)
    streams: list[Stream] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    losses: list[Loss] = field(default_factory=list)


def upwards(scope: Scope | None) -> Iterator[Scope]:
    """A scope and those above it, the innermost first."""
    while scope is not None:
        yield scope
        scope = scope.above


def described(scope: Scope) -> dict[str, str]:
    """Scalars and texts of a scope, and of those above it."""
    found: dict[str, str] = {}
    for level in upwards(scope):
        for key, value in level.properties.items():
            if value and len(found) < 100:
                found.setdefault(key, value)
    return found


def rises(values: Array) -> bool:
    """Whether numbers rise with every value."""
    if values.dtype.kind not in "iuf" or values.size < 2:
        return False
    return bool(np.isfinite(values).all() and (values[1:] > values[:-1]).all())


def same_time(a: TimeVector, b: TimeVector) -> bool:
    """Whether two times are equal, value by value."""
    if a is b:
        return True
    if (a.length, a.unit, a.texts, a.step_s, a.zero_s) != (b.length, b.unit, b.texts, b.step_s, b.zero_s):
        return False
    if a.load is None or b.load is None:
        return a.load is b.load
    return all(np.array_equal(a.load(i, i + 500_000), b.load(i, i + 500_000)) for i in range(0, a.length, 500_000))
