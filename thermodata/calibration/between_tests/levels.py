"""What temperatures were like at a few moments of each test, and how far each lay from the others there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array, Bool1D, Float1D, Float2D

POINTS = 32  # of a test, evenly spread over it
LEAST_OTHERS = 3
_NEAR = 1.5  # of the times between points


@dataclass(frozen=True, slots=True)
class Course:
    """A channel at a few moments of a test. t_s, values: shape (n,), in time order; NaN where nothing valid is. off:
    shape (n,), where it is flagged as off already. powered: it stays warm or cold while the machine is switched on.
    around: it is not of the machine, and has seasons and weather of its own, or nobody says where it is. flickers: how
    far the next reading lies that it shows often between these moments, and all over the test; else None."""

    t_s: Float1D
    values: Float1D
    quantity: str = "temperature"
    off: Bool1D | None = None
    powered: bool = False
    around: bool = False
    flickers: float | None = None

    @property
    def sound(self) -> Float1D:
        """The values, NaN where it is off."""
        return self.values if self.off is None else np.where(self.off, np.nan, self.values)


@dataclass(frozen=True, slots=True)
class Levels:
    """What a test's channels were like. start_s: on the absolute clock [s]; None where the test has none. pauses:
    (from, to) [s] of the test in which nothing was logged. warm: the campaign file says that it started so."""

    test: str
    start_s: float | None
    end_s: float | None
    series: Mapping[str, Course]
    pauses: Sequence[tuple[float, float]] = field(default=())
    warm: bool = False


@dataclass(frozen=True, slots=True)
class _Stack:
    """Channels of a test at the times of one of its grids. of: the test; t_s: shape (m,); values: shape (k, m); own:
    channel -> row, of those that stand on this grid themselves."""

    of: int
    t_s: Float1D
    values: Float2D
    own: Mapping[str, int]


def differences_of(tests: Sequence[Levels]) -> list[dict[str, tuple[Float1D, Float1D]]]:
    """Of each test: channel -> (times, differences [K] from the median of the others), shape (m,)."""
    found: list[dict[str, tuple[Float1D, Float1D]]] = [{} for _ in tests]
    alike: dict[int, list[_Stack]] = {}
    for i, test in enumerate(tests):
        for stack in _stacks(i, test):
            alike.setdefault(len(stack.values), []).append(stack)
    for stacks in alike.values():
        # a median is of one column: those of many tests are taken at once
        values = np.concatenate([s.values for s in stacks], axis=1)
        differences = np.split(values - _median_of_others(values), np.cumsum([len(s.t_s) for s in stacks])[:-1], axis=1)
        for stack, d in zip(stacks, differences, strict=True):
            known = np.isfinite(d)
            for name, row in stack.own.items():
                if known[row].any():
                    found[stack.of][name] = stack.t_s[known[row]], d[row][known[row]]
    return found


def _stacks(i: int, test: Levels) -> list[_Stack]:
    """A test's temperatures at the times of each of its grids; none where there are too few of them."""
    sound = {n: (x.t_s, x.sound) for n, x in test.series.items() if x.quantity == "temperature"}
    sound = {n: (t_s, y) for n, (t_s, y) in sound.items() if np.isfinite(y).any()}
    if len(sound) <= LEAST_OTHERS:
        return []
    grids: list[Float1D] = []
    on: dict[str, int] = {}
    for name, (t_s, _) in sound.items():
        at = next((k for k, t in enumerate(grids) if t_s is t or np.array_equal(t_s, t)), len(grids))
        grids += [t_s] if at == len(grids) else []
        on[name] = at
    apart = [_median(np.diff(t)) if len(grids) > 1 and len(t) > 1 else np.inf for t in grids]
    return [
        _Stack(
            i,
            t_s,
            np.stack([y if on[n] == k else _course_at(t, y, t_s, apart[on[n]]) for n, (t, y) in sound.items()]),
            {n: row for row, n in enumerate(sound) if on[n] == k},
        )
        for k, t_s in enumerate(grids)
    ]


def _median(x: Float1D) -> float:
    """As numpy's, which takes ten times as long for a few numbers."""
    ordered, half = np.sort(x).tolist(), len(x) // 2
    if ordered[-1] != ordered[-1]:
        return float("nan")
    return float(ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2)


def _median_of_others(x: Float2D) -> Float2D:
    """Of each row the median of all other rows, column by column; NaN where these are fewer than three numbers."""
    column = np.arange(x.shape[1])
    order = np.argsort(x, axis=0)  # NaN last
    ordered, rank = x[order, column], np.argsort(order, axis=0)
    others = np.isfinite(x).sum(axis=0)[None] - np.isfinite(x)

    def nth(n: Array) -> Float2D:
        n = n + (n >= rank)
        return ordered[np.minimum(np.maximum(n, 0), len(x) - 1), column]

    median = (nth((others - 1) // 2) + nth(others // 2)) / 2
    return np.where(np.isfinite(x) & (others >= LEAST_OTHERS), median, np.nan)


def _course_at(own_s: Float1D, x: Float1D, t_s: Float1D, apart: float) -> Float1D:
    """A course x at other times than its own; NaN where its next point lies further away than its points from each
    other, apart [s] as a rule, and everywhere where both do not run at once: of one that follows the other, the points
    at the joint are no neighbours."""
    known = np.isfinite(x)
    near = np.abs(t_s[:, None] - own_s[known][None]).min(axis=1)
    at_once_s = min(float(own_s[known][-1]), float(t_s[-1])) - max(float(own_s[known][0]), float(t_s[0]))
    if np.isfinite(apart) and at_once_s <= _NEAR * apart:
        return np.full(len(t_s), np.nan)
    return np.where(near <= _NEAR * apart, np.interp(t_s, own_s[known], x[known]), np.nan)
