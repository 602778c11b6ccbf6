"""Tables of which a row holds the changed cells alone: an empty cell says that the value before it still stands.

Told by what was written: where a cell stands only because it changed, no value is followed by the same one, though it
moves to and fro by the finest steps that it knows, as noise does; a sensor that is read at a rate repeats itself then.
Rows in which every cell is filled are left out of this: such a log writes all it knows now and then. A few values that
somebody sets (0, 4000, 0), the first of them in the first row, are told as well.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from thermodata.errors import UsageError, nearest
from thermodata.plugin import Array, Bool1D, Float1D, Int1D
from thermodata.reader.signals.set_values import are_set
from thermodata.reader.text.cells.cell import number_of
from thermodata.reader.text.cells.values.no_value import EMPTY
from thermodata.reader.text.names.called_column import by_name, by_name_or_place
from thermodata.reader.text.names.header import split_unit
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.sentences import with_count

KEY = "stands"  # of a table's layout
CHANGES = "written where they change"  # of columns that do
DOUBT = "most cells are empty"  # of columns that may stand
_LEAST = 30  # written cells that prove it
_REPEATS = 0.02  # of them may repeat the one before: two rounded alike, a piece of the file left out between them
_CONTRARY, _LEAST_CONTRARY = 0.1, 5  # a share of repeats that a log of changes never has, of so many cells
_FINE, _MOST_FINE = 2.5, 0.5  # steps no larger than so many of the finest, of this share of the changes
_TO_AND_FRO = 3  # changes of either sign
_SPARSE = 0.2  # of the rows: a column with so few cells may be written on change in a log that is not
_SHOWN = 4
_READ = ("degC", "degF", "K", "um", "nm")

Verdict = Literal["stands", "written anew"]


@dataclass(frozen=True, slots=True)
class _Written:
    """The cells of a column in rows that are not full. cells: how many; repeats: share that repeats the one before;
    steps: between numbers that differ, shape (k,); even: whether they come in every n-th row; share: of the rows that
    have one; first: whether the first row has; values: the numbers among them, shape (m,);
    read: whether its header has a unit in which nobody sets anything: few whole um are readings of a dial gauge."""

    cells: int
    repeats: float
    steps: Float1D
    even: bool
    share: float
    first: bool
    values: Float1D
    read: bool

    @property
    def verdict(self) -> Verdict | None:
        """None where it tells nothing."""
        if self.cells >= _LEAST_CONTRARY and self.repeats > _CONTRARY:
            return "written anew"
        if self.is_sparse and self.first and self.values.size == self.cells + 1 and are_set(np.abs(self.values)):
            return None if self.read else "stands"
        if self.cells < _LEAST or self.repeats > _REPEATS or self.even or not self.steps.size:
            return None
        size = np.abs(self.steps)
        fine = float((size <= _FINE * size.min()).mean())
        ups = int((self.steps > 0).sum())
        moves = min(ups, self.steps.size - ups) >= _TO_AND_FRO
        return "stands" if fine >= _MOST_FINE and moves else None

    @property
    def proves(self) -> bool:
        """Whether it tells of the other columns too: of many cells."""
        return self.verdict == "stands" and self.cells >= _LEAST

    @property
    def is_sparse(self) -> bool:
        """Few cells that come at no rate, none of which repeats the one before."""
        return self.share < _SPARSE and bool(self.steps.size) and not self.repeats and not self.even

    @property
    def is_first_alone(self) -> bool:
        """The first row's cell alone, of what was looked at."""
        return self.first and self.share < _SPARSE and not self.cells and bool(self.values.size)


class Standing:
    """A column whose values stand over the empty cells behind them, block by block."""

    def __init__(self) -> None:
        self._last: tuple[Any, np.uint16] | None = None

    def over(self, values: Array, flags: Array | None, written: Bool1D) -> tuple[Array, Array | None]:
        """(values, flags) with what stands in the cells that are not written, shape (n,); before the first written one
        they stay as they are."""
        if not values.size:
            return values, flags
        marks = np.zeros(values.size, np.uint16) if flags is None else flags
        which = np.maximum.accumulate(np.where(written, np.arange(values.size), -1))
        held, told = values[np.maximum(which, 0)], marks[np.maximum(which, 0)]
        before = which < 0
        if before.any():
            held[before], told[before] = self._last if self._last is not None else (values[before], marks[before])
        if which[-1] >= 0:
            self._last = held[-1], told[-1]
        return held, None if flags is None and not told.any() else told


def find_standing(columns: Mapping[str, Sequence[str]]) -> tuple[frozenset[str], str | None]:
    """(the columns whose empty cells say that nothing changed, a note). columns: name -> sampled cells, of one number
    of rows, the time not among them."""
    names = list(columns)
    filled = np.array([[bool(c.strip()) for c in columns[name]] for name in names], bool)
    gaps = [k for k in range(len(names)) if not filled[k].all() and filled[k].any()]
    if not gaps:
        return frozenset(), None
    full: Bool1D = np.asarray(filled[gaps].all(axis=0) & (len(gaps) > 1))
    said = {k: _how_written(names[k], columns[names[k]], filled[k], full) for k in range(len(names)) if filled[k].any()}
    verdicts = {k: one.verdict for k, one in said.items()}
    whole = any(one.proves for one in said.values()) and "written anew" not in verdicts.values()
    wordless = [k for k in gaps if not any(c.strip().casefold() in EMPTY for c in columns[names[k]] if c.strip())]
    stands = [names[k] for k in wordless if whole or verdicts[k] == "stands"]
    if stands:
        shown = with_count(stands, _SHOWN)
        note = f"{shown}: {CHANGES}: each value stands over the empty cells behind it"
        return frozenset(
            names if whole and len(stands) == len(gaps) else stands
        ), f"{note}; else table: {{{KEY}: none}}"
    doubtful = [
        k
        for k in wordless
        if said[k].is_sparse or said[k].is_first_alone or _sparse_later(names[k], columns[names[k]], filled[k], full)
    ]
    # of cells in rows of all alone nobody knows whether they repeat
    again = "" if any(said[k].is_first_alone for k in doubtful) else ", and no value repeats the one before"
    return frozenset(), _doubt([names[k] for k in doubtful], again)


def _sparse_later(name: str, cells: Sequence[str], filled: Bool1D, full: Bool1D) -> bool:
    """Whether a column has a cell in every row at first, and few that come at no rate from there on."""
    head = int(np.argmin(filled))
    later = _how_written(name, cells[head:], filled[head:], full[head:]) if filled[head:].any() else None
    return head > 1 and later is not None and later.is_sparse


def _doubt(sparse: Sequence[str], again: str) -> str | None:
    """A note on columns of few numbers. again: what is known of how these repeat."""
    if not sparse:
        return None
    shown = ", ".join(f"'{name}'" for name in sparse[:_SHOWN])
    return (
        f"{shown}: {DOUBT}{again}: where each stands until the next one, "
        f"declare table: {{{KEY}: [{', '.join(map(_in_yaml, sparse[:_SHOWN]))}]}}, or all; else none"
    )


def _in_yaml(name: str) -> str:
    """A name as a list of YAML has it: in quotes where its brackets or commas would be the list's."""
    return name if re.fullmatch(r"[^\W\d][\w .-]*", name) else f"'{name.replace(chr(39), chr(39) * 2)}'"


def declared_standing(
    said: object, names: Sequence[str], where: str, every: Sequence[str] = ()
) -> frozenset[str] | None:
    """The columns that the campaign file declares; None where it says nothing. names: of those that may stand; every:
    of all columns of the table, by whose places one may be declared. UsageError for a name that is none."""
    if said is None:
        return None
    if isinstance(said, str):
        return frozenset(names if said == "all" else ())
    assert isinstance(said, list | tuple)
    found: set[str] = set()
    for name in map(str, said):
        place = by_name_or_place(name, every) if every else by_name(name, names)
        told = None if place is None else (every or names)[place]
        if told is None or told not in names:
            close = nearest(name, names)
            raise UsageError(
                f"no column '{name}' in the table, which {KEY} declares",
                where=where,
                expected=", ".join(names[:12]),
                got=name,
                hint=f"did you mean '{close}'?" if close else None,
            )
        found.add(told)
    return frozenset(found)


def _how_written(name: str, cells: Sequence[str], filled: Bool1D, full: Bool1D) -> _Written:
    rows: Int1D = np.flatnonzero(filled)
    texts = [cells[k].strip() for k in rows.tolist()]
    own = ~full[rows[1:]]
    again = np.array([a == b for a, b in pairwise(texts)], bool)[own]
    values = np.array([np.nan if (v := number_of(c)) is None else v for c in texts], np.float64)
    steps = np.diff(values)[own]
    apart = set(np.diff(rows).tolist())
    return _Written(
        int(own.sum()),
        float(again.mean()) if again.size else 0.0,
        steps[np.isfinite(steps) & (steps != 0)],
        len(rows) > 2 and len(apart) == 1 and 1 not in apart,
        len(rows) / max(1, len(cells)),
        bool(filled[0]),
        values[np.isfinite(values)],
        normal_unit(split_unit(name)[1] or "") in _READ,
    )
