"""Finds a jump test's plateaus in the voltage, and which of its steps are the commanded moves.

A step is where the median of a window after differs from the median of a window before (medians: a spike does
not make a step; two windows close together: a drift hardly does). The moves are then the run of steps, in order,
that one sensitivity explains; steps of the lead-in and the tail are left over.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Bool1D, Float1D

_CELLS_PER_DWELL = 40
_WINDOW, _GAP = 0.2, 0.05  # of a dwell
_TOLERANCE = 0.30  # a probe may be this nonlinear and still be matched
_MOST_STEPS = 80


@dataclass(frozen=True, slots=True)
class Step:
    """A step: its time [s], size [V], and the ends of its ramp [s]."""

    t_s: float
    size: float
    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class Plateau:
    """mean, slope [/s], noise (standard deviation about the slope), n samples used; times [s]."""

    t_s: float
    from_s: float
    to_s: float
    mean: float
    slope: float
    noise: float
    n: int


@dataclass(frozen=True, slots=True)
class Match:
    """The steps that are the moves; volts_per_um by them; misfit: their scatter about it, relative."""

    steps: tuple[Step, ...]
    volts_per_um: float
    misfit: float
    rivals: tuple[float, ...] = ()  # sensitivities of equally good matches of other sign


def cells(t_s: Float1D, volts: Float1D, dwell_s: float) -> tuple[Float1D, Float1D]:
    """(times, medians) of cells of dwell/40, at least 1 sample each; shapes (m,)."""
    duration = float(t_s[-1] - t_s[0])
    count = int(min(max(duration / (dwell_s / _CELLS_PER_DWELL), 1), len(t_s), 200_000))
    edges = np.searchsorted(t_s, np.linspace(t_s[0], t_s[-1], count + 1)[1:-1])
    bounds = np.unique(np.concatenate([[0], edges, [len(t_s)]]))
    lengths = np.diff(bounds)
    if lengths.max() == 1:
        return t_s, volts
    # one sort of a padded table is far quicker than a median a cell
    table = np.full((len(lengths), int(lengths.max())), np.nan)
    row = np.repeat(np.arange(len(lengths)), lengths)
    table[row, np.arange(len(volts)) - bounds[row]] = volts
    table.sort(axis=1)
    half = (lengths - 1) // 2
    rows = np.arange(len(lengths))
    return t_s[bounds[:-1] + half], (table[rows, half] + table[rows, lengths // 2]) / 2


def find_steps(t_s: Float1D, volts: Float1D, dwell_s: float) -> tuple[list[Step], float]:
    """All significant steps in order of time, and the noise of a cell [V]. volts: finite, t_s: increasing."""
    t, v = cells(t_s, volts, dwell_s)
    if len(v) < 3:
        return [], 0.0  # a file that was cut behind its first samples
    cell = float(np.median(np.diff(t)))
    window, gap = max(2, round(_WINDOW * dwell_s / cell)), max(1, round(_GAP * dwell_s / cell))
    if len(v) < 2 * window + gap + 1:
        return [], 0.0
    noise = _noise(v)
    medians = np.median(np.lib.stride_tricks.sliding_window_view(v, window), axis=1)
    jump = medians[window + gap :] - medians[: -(window + gap)]
    centre = np.arange(len(jump)) + window + gap // 2
    # a drift adds the same to every difference; its own scatter is what a step must stand out of (the 30 %
    # quantile, for where moves follow each other closely up to half of the differences hold a step)
    jump = jump - np.median(jump)
    scatter = float(np.quantile(np.abs(jump), 0.3)) / 0.385
    threshold = max(6.0 * noise / np.sqrt(window), 8.0 * scatter, 1e-12 * float(np.abs(v).max() or 1.0))
    tolerance = 4.0 * noise / np.sqrt(window)
    order = np.argsort(-np.abs(jump), kind="stable")
    taken = np.zeros(len(jump), dtype=bool)
    steps: list[Step] = []
    for k in order[np.abs(jump[order]) > threshold].tolist():
        if not taken[k]:
            # on a slow ramp the difference has a flat top, with ripples of the cells
            ripple = max(tolerance, 0.05 * abs(float(jump[k])))
            low, high = _flanks(jump * np.sign(jump[k]), k, threshold, ripple, window + gap, taken)
            taken[low : high + 1] = True
            # at the flank's foot the window on the far side just touches the ramp
            reach = window + gap // 2 - 1
            steps.append(_step(t, v, int(centre[low]) + reach, int(centre[high]) - reach, int(centre[k]), window))
        if len(steps) >= _MOST_STEPS:
            break
    return sorted((s for s in steps if s.size != 0), key=lambda s: s.t_s), noise


def _flanks(
    height: Float1D, peak: int, threshold: float, tolerance: float, least: int, taken: Bool1D
) -> tuple[int, int]:
    """The first and last row of a step around its peak: as far as it falls, so that a slow ramp is one step, and
    at least as far as the windows that make a sharp one."""
    ends = []
    for way in (-1, 1):
        i, lowest = peak, float(height[peak])
        while 0 <= i + way < len(height) and not taken[i + way]:
            following = float(height[i + way])
            if following > lowest + tolerance or (following < threshold and abs(i + way - peak) > least):
                break
            lowest = min(lowest, following)
            i += way
        ends.append(i)
    return ends[0], ends[1]


def _noise(v: Float1D) -> float:
    second = v[2:] - 2 * v[1:-1] + v[:-2]  # blind to level and slope
    return 1.4826 * float(np.median(np.abs(second - np.median(second)))) / np.sqrt(6.0) if len(v) > 4 else 0.0


def _step(t: Float1D, v: Float1D, low: int, high: int, centre: int, window: int) -> Step:
    """Its size, middle and ramp, where the voltage leaves 5 % and reaches 95 % of the way. low, high: the ramp's ends
    to a cell or two."""
    low, high = min(max(low, 0), centre), max(min(high, len(v) - 1), centre)
    before = float(np.median(v[max(0, low - window) : max(low, 1)]))
    after = float(np.median(v[min(high + 1, len(v) - 1) : high + 1 + window]))
    size = after - before
    if size == 0:
        return Step(float(t[centre]), 0.0, float(t[centre]), float(t[centre]))
    a, b = max(0, low - window), min(len(v), high + 1 + window)
    way = (v[a:b] - before) / size
    middle = int(np.argmax(way > 0.5))
    below, above = np.flatnonzero(way[: middle + 1] < 0.05), np.flatnonzero(way[middle:] > 0.95)
    start = a + (int(below[-1]) if len(below) else 0)
    stop = a + middle + int(above[0]) if len(above) else b - 1
    return Step(float((t[start] + t[stop]) / 2), size, float(t[start]), float(t[stop]))


def match_moves(steps: list[Step], moves_um: list[float], dwell_s: float, sign: float = 0.0) -> Match | None:
    """The run of steps that fits the moves in order with one sensitivity; None where none does. sign: of the
    sensitivity; 0: either.

    Steps between matched ones may be left over, at a price (a disturbance); every move needs its step.
    """
    if len(steps) < len(moves_um):
        return None
    sizes = np.array([s.size for s in steps])
    times = np.array([s.t_s for s in steps])
    best: list[tuple[float, Match]] = []
    for first in range(len(steps) - len(moves_um) + 1):
        k = sizes[first] / moves_um[0]
        if k * sign < 0:
            continue
        chain, cost = _follow(sizes, times, moves_um, k, first, dwell_s)
        if chain is None:
            continue
        picked, wanted = sizes[chain], np.asarray(moves_um)
        k = float(picked @ wanted / (wanted @ wanted))
        misfit = float(np.max(np.abs(picked - k * wanted) / np.abs(k * wanted)))
        if misfit <= _TOLERANCE:
            best.append((cost + misfit, Match(tuple(steps[i] for i in chain), k, misfit)))
    if not best:
        return None
    best.sort(key=lambda pair: pair[0])
    cost, match = best[0]
    rivals = tuple(m.volts_per_um for c, m in best[1:] if c < cost + 0.25 and m.volts_per_um * match.volts_per_um < 0)
    return Match(match.steps, match.volts_per_um, match.misfit, rivals)


def _follow(
    sizes: Float1D, times: Float1D, moves: list[float], k: float, first: int, dwell_s: float
) -> tuple[list[int] | None, float]:
    """From a first step, the next one each time that fits its move; the cost of odd dwells and of left-over steps."""
    chain, cost = [first], 0.0
    smallest = min(abs(m) for m in moves) * abs(k)
    for move in moves[1:]:
        fits = []
        skipped = 0.0
        for i in range(chain[-1] + 1, len(sizes)):
            off = abs(sizes[i] - k * move) / abs(k * move)
            if off <= 2 * _TOLERANCE:
                ratio = max(times[i] - times[chain[-1]], 1e-9) / dwell_s
                fits.append((off + 0.2 * max(abs(float(np.log(ratio))) - 0.7, 0.0) + skipped, i))
            skipped += min(abs(sizes[i]) / smallest, 2.0)
            if skipped > 4.0 * len(moves) or len(fits) > 2:
                break
        if not fits:
            return None, np.inf
        price, chosen = min(fits)
        chain.append(chosen)
        cost += price / len(moves)
    return chain, cost


def plateaus(t_s: Float1D, volts: Float1D, match: Match, steps: list[Step], dwell_s: float) -> list[Plateau]:
    """The len(moves) + 1 plateaus around the matched steps, without ramps, spikes and neighbouring steps."""
    inner = match.steps
    earlier = [s.to_s for s in steps if s.t_s < inner[0].t_s]
    later = [s.from_s for s in steps if s.t_s > inner[-1].t_s]
    starts = [max([float(t_s[0]), inner[0].from_s - dwell_s, *earlier])] + [s.to_s for s in inner]
    ends = [s.from_s for s in inner] + [min([float(t_s[-1]), inner[-1].to_s + dwell_s, *later])]
    return [_plateau_between(t_s, volts, a, b) for a, b in zip(starts, ends, strict=True)]


def at_rest(t_s: Float1D, start: float, end: float) -> Bool1D:
    """Which samples of a plateau from start to end [s] its mean is taken of, but for spikes. t_s: shape (n,)."""
    # the ramp's ends are known to a cell; a sixth at either side also lets the axis come to rest
    margin = (end - start) / 6
    return (t_s >= start + margin) & (t_s <= end - margin)


def _plateau_between(t_s: Float1D, volts: Float1D, start: float, end: float) -> Plateau:
    inside = at_rest(t_s, start, end)
    t, v = t_s[inside], volts[inside]
    if len(t) < 3:
        return Plateau((start + end) / 2, start, end, float("nan"), 0.0, 0.0, len(t))
    slope, level = _robust_line(t - t.mean(), v)
    rest = v - level - slope * (t - t.mean())
    spread = 1.4826 * float(np.median(np.abs(rest - np.median(rest))))
    keep = np.abs(rest - np.median(rest)) <= max(5 * spread, 1e-12)
    t, v = t[keep], v[keep]
    middle = float(t.mean())
    slope, level = (float(c) for c in np.polyfit(t - middle, v, 1)) if len(t) > 4 else (0.0, float(v.mean()))
    # of three or four samples the slope is not known, and their scatter about the mean is the most that is noise
    noise = float(np.std(v - level - slope * (t - middle), ddof=2 if len(t) > 4 else 1)) if len(t) > 1 else 0.0
    return Plateau(middle, start, end, level, slope, noise, len(t))


def _robust_line(t: Float1D, v: Float1D) -> tuple[float, float]:
    """Slope by the medians of the outer thirds, level by the median: spikes don't move it."""
    third = max(1, len(t) // 3)
    run = float(np.median(t[-third:]) - np.median(t[:third]))
    slope = float(np.median(v[-third:]) - np.median(v[:third])) / run if run > 0 else 0.0
    return slope, float(np.median(v - slope * t))
