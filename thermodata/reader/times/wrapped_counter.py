"""A counter of 16 or 32 bits that begins anew where it is full: from 65 000 ms to 4464. Its rows keep their step
through that, which no clock does that is set."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Array

_FULL = (1 << 16, 1 << 32)  # counts
_FEWEST = 10  # rows that show a step
_LATEST = 4  # steps: a row that comes later after the counter began anew is of one that was set
_LOOKED_AT = 1000  # rows at either end of a column
_EVEN, _MOST_ODD = 0.1, 0.05  # of a step, by which rows may come late; the share of those that come later


class Counter:
    """The counts of rows, chunk after chunk, gone on with where they begin anew."""

    def __init__(self) -> None:
        self.full = 0  # counts at which it begins anew; 0 where it was not seen to
        self.times = 0  # that it began anew
        self._last: float | None = None

    def gone_on(self, counts: npt.NDArray[np.float64], peek: bool = False) -> npt.NDArray[np.float64]:
        """Counts that rise, shape (n,), NaN where a row has none. peek: the counter does not go on."""
        good = np.isfinite(counts)
        own = counts[good]
        chain = own if self._last is None else np.concatenate([[self._last], own])
        steps = np.diff(chain)
        full = self.full or next((f for f in _FULL if _begins_anew(chain, steps, f)), 0)
        if not own.size or not full:
            self._last = self._last if peek or not own.size else float(own[-1])
            return counts
        on = steps % full
        turns = np.cumsum((steps < 0) & (on < _LATEST * np.median(on)))
        added = (self.times + (turns if self._last is not None else np.concatenate([[0], turns]))) * float(full)
        out = counts.copy()
        out[good] = own + added
        if not peek:
            self.full, self.times, self._last = full, int(added[-1] // full), float(own[-1])
        return out

    def note(self, name: str) -> str | None:
        """What is told of a counter that began anew; None of another."""
        return (
            f"'{name}' begins anew at {self.full}, as a counter does that is full: counted on" if self.times else None
        )


def _begins_anew(chain: npt.NDArray[np.float64], steps: npt.NDArray[np.float64], full: int) -> bool:
    """Whether counts are whole, fit in a counter, and fall only where it is full: the step goes on through that."""
    if chain.size < _FEWEST or not (steps < 0).any() or chain.min() < 0 or not full / 2 < chain.max() < full:
        return False
    on = steps % full
    step = float(np.median(on))
    odd = np.abs(on - step) > _EVEN * step
    falls = steps < 0
    return bool((chain == np.rint(chain)).all() and odd.mean() <= _MOST_ODD and not odd[falls].any())


def gone_on(counts: Array, name: str) -> tuple[Array, str | None]:
    """(a whole column of counts, gone on with where they begin anew, shape (n,); what is told of it)."""
    if counts.dtype.kind not in "iuf":
        return counts, None
    counter = Counter()
    on = counter.gone_on(counts.astype(np.float64))
    return (on, counter.note(name)) if counter.times else (counts, None)


def may_begin_anew(load: Callable[[int, int], Array], rows: int) -> bool:
    """Whether a column may hold a counter that begins anew: it ends far below where its first steps lead to. load:
    gives its values from a row up to another; rows: how many there are. Looks at both ends only."""
    first = load(0, min(rows, _LOOKED_AT)) if rows >= _FEWEST else np.empty(0)
    if first.size < _FEWEST or first.dtype.kind not in "iuf":
        return False
    last = load(max(0, rows - _LOOKED_AT), rows)
    ends = np.concatenate([first, last]).astype(np.float64)
    ends = ends[np.isfinite(ends)]
    if ends.size < _FEWEST or not (ends == np.rint(ends)).all() or ends.min() < 0 or ends.max() >= _FULL[-1]:
        return False
    led_to = ends[0] + float(np.median(np.diff(ends[: min(rows, _LOOKED_AT)]))) * (rows - 1)
    return bool(ends[-1] < led_to / 2 or (np.diff(ends) < 0).any())
