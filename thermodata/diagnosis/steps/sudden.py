"""What changes between two samples, beyond what the slopes beside it make in that time."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from thermodata.plugin import Bool1D, Float1D, Float2D, Int1D

HOLE_STEPS = 1.6  # a longer interval than this many usual ones is a hole
BESIDE = 5  # intervals that a slope beside a step is taken over
BACK_TO = 0.1  # of a step, that is left at the end of its side at most, where it is said to come back
NEARLY_ALL = 0.9  # of a step: what is said of how long it takes holds for so much of it
ALIKE = 1 / 3  # of a step, that its size beside it and that on a smooth course differ by at most
TIMES = 6  # constants that a return is asked for
BACK = 0.35  # of the squared error that what stays leaves: what comes back leaves less


def over_three(values: Float1D, t_s: Float1D) -> Float1D:
    """What changes over the interval before each sample and its two neighbours, shape (m,); NaN at ends and holes.

    What happens between two samples is whole in it, even where a mean over both parts it, or a clock is off by one.
    """
    change = np.full(len(values), np.nan)
    if len(values) >= 4:
        step = float(np.median(np.diff(t_s)))
        whole = t_s[3:] - t_s[:-3] < (2 + HOLE_STEPS) * step
        change[2:-1] = np.where(whole, values[3:] - values[:-3], np.nan)
    return change


def beyond_slopes(x: Float1D, t: Float1D, i: int, sign: float, side: int) -> float:
    """What x (shape (m,)) changes by over the three intervals around the one before sample i, in the direction of sign,
    beyond what the steeper of the slopes just before and after them makes in that time.

    A bend leaves nothing, however sharp: of its two slopes the steeper is taken off. Nor does a ramp, where it lasts as
    long as the slopes are taken over. side: samples that there are before and after, at least. NaN where a hole is.
    """
    many = min(BESIDE + 1, side - 1)  # samples
    rise = float(over_three(x[i - 2 : i + 2], t[i - 2 : i + 2])[2])
    before, after = slice(i - 1 - many, i - 1), slice(i + 1, i + 1 + many)
    steeper = max(np.sign(sign) * np.polyfit(t[s] - t[i], x[s], 1)[0] for s in (before, after))
    return float(np.sign(sign) * rise - steeper * (t[i + 1] - t[i - 2]))


def suddenly(x: Float1D, t: Float1D, side: int) -> Float1D:
    """`beyond_slopes` before each sample, in the direction of its own rise, shape (m,); 0 at ends and holes."""
    many = min(BESIDE + 1, side - 1)
    if len(x) <= 2 * many + 1:
        return np.zeros(len(x))
    y, at = sliding_window_view(x, many), sliding_window_view(t, many)
    dt = at - at.mean(axis=1)[:, None]
    slope = np.einsum("ij,ij->i", dt, y) / np.maximum(np.einsum("ij,ij->i", dt, dt), 1e-300)
    inner = np.arange(many + 1, len(x) - many)
    rise = over_three(x, t)[inner]
    sign = np.sign(rise)
    steeper = np.maximum(sign * slope[inner - 1 - many], sign * slope[inner + 1])
    beyond = np.zeros(len(x))
    beyond[inner] = np.abs(rise) - steeper * (t[inner + 1] - t[inner - 2])
    return np.maximum(np.nan_to_num(beyond), 0.0)


def most_sudden(x: Float1D, t: Float1D, among: Bool1D, side: int) -> tuple[int, float]:
    """(sample before which x, shape (m,), changes most suddenly of those in `among`, shape (m,); how many times as
    suddenly as it does anywhere else: not within half a side, where the same change is seen)."""
    sudden = suddenly(x, t, side)
    i = int(np.argmax(np.where(among, sudden, 0.0)))
    elsewhere = np.abs(np.arange(len(x)) - i) > side // 2
    most = float(sudden[elsewhere].max(initial=0.0))
    return i, float(sudden[i]) / max(most, 1e-9) if among[i] else 0.0


def size_of_step(x: Float1D, t: Float1D, i: int, side: int) -> float:
    """How far the lines through the samples just before and after the interval before sample i lie apart in its middle.
    The samples at both its ends are left out: one of them is the mean of both levels, where a step parts it."""
    many = min(BESIDE + 1, side - 1)
    at = (t[i - 1] + t[i]) / 2
    before, after = slice(i - 1 - many, i - 1), slice(i + 1, i + 1 + many)
    return float(np.polyfit(t[after] - at, x[after], 1)[1] - np.polyfit(t[before] - at, x[before], 1)[1])


def comes_back(x: Float1D, t: Float1D, i: int, side: int) -> bool:
    """Whether the step of x (shape (m,)) before sample i returns to where it came from within a side.

    On the same smooth course (a parabola over both sides), what decays to a tenth at most must leave much less squared
    error than what stays. The course carries what heat does beside it: a slip on a slope that leads back is still one.
    """
    rows, u = _both_sides(t, i, side)
    course, stays = np.vander(u, 3), np.where(rows >= i, 1.0, 0.0)
    slowest = 1 / float(np.log(1 / BACK_TO))
    decays = [stays * np.exp(-np.maximum(u, 0.0) / tau) for tau in np.geomspace(slowest / 2**3, slowest, TIMES)]
    left = [_squared_error(np.column_stack([course, after]), x[rows]) for after in (stays, *decays)]
    return min(left[1:]) < BACK * left[0]


def smooth_but_for(x: Float1D, t: Float1D, i: int, size: float, side: int, least: float) -> bool:
    """Whether x (shape (m,)) is one smooth course (a parabola over both sides) and a step of this size before sample i:
    the level that the two sides differ by is as large, give or take a third, and so many times its standard error.

    Straight lines over 20 min lie apart wherever the course bends; this course may.
    """
    rows, u = _both_sides(t, i, side)
    columns = np.column_stack([np.vander(u, 3), np.where(rows >= i, 1.0, 0.0)])
    if len(rows) <= columns.shape[1]:
        return False
    level = float(np.linalg.lstsq(columns, x[rows], rcond=None)[0][-1])
    scatter = float(np.sqrt(_squared_error(columns, x[rows]) / (len(rows) - columns.shape[1])))
    error = scatter * float(np.sqrt(np.linalg.pinv(columns.T @ columns)[-1, -1]))
    return 1 - ALIKE <= level / size <= 1 + ALIKE and abs(level) >= least * error


def _both_sides(t: Float1D, i: int, side: int) -> tuple[Int1D, Float1D]:
    """(the rows of a side before the step at sample i and of one behind it, their times from the step in sides)."""
    # one of the two samples at the step is the mean of both levels, where a step parts it
    rows = np.concatenate([np.arange(max(0, i - side), i - 1), np.arange(i + 1, min(len(t), i + side))])
    return rows, (t[rows] - t[i]) / (side * float(np.median(np.diff(t))))


def is_quick(x: Float1D, t: Float1D, i: int, size: float, side: int, noise: float) -> bool:
    """Whether a step of this size before sample i of x (shape (m,)) happens in the interval there and one of its
    neighbours, which share it where a mean parts it; all but a tenth, or what noise does. Of the slopes beside it the
    mean is taken off.

    What goes on for some minutes is heat that is carried away, and no slip.
    """
    many = min(BESIDE + 1, side - 1)
    slope = np.mean(
        [np.polyfit(t[s] - t[i], x[s], 1)[0] for s in (slice(i - 1 - many, i - 1), slice(i + 1, i + 1 + many))]
    )
    made = [float(x[b] - x[a] - slope * (t[b] - t[a])) for a, b in ((i - 2, i), (i - 1, i + 1))]
    rest = min(abs(size) - np.sign(size) * rise for rise in made)
    return bool(rest <= max((1 - NEARLY_ALL) * abs(size), noise))


def _squared_error(columns: Float2D, x: Float1D) -> float:
    """Squared error that the columns, shape (n, k), leave of x, shape (n,)."""
    return float(np.sum((x - columns @ np.linalg.lstsq(columns, x, rcond=None)[0]) ** 2))


def time_of_step(x: Float1D, t: Float1D, i: int, size: float) -> float:
    """The shortest time around the interval before sample i, of three intervals at most, in which nearly all of a step
    of this size happens [s]."""
    spans = ((i - 1, i), (i - 2, i), (i - 1, i + 1), (i - 2, i + 1))
    whole = [t[b] - t[a] for a, b in spans if (x[b] - x[a]) * np.sign(size) >= NEARLY_ALL * abs(size)]
    return float(min(whole, default=t[i + 1] - t[i - 2]))
