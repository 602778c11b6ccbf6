"""Weak spots: windows where the residual stands out of its noise, ranked by what they cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.answers.diagnosis import WeakSpot
from thermodata.schema.words.places import is_spindle
from thermodata.view.grid.dataset import TestData

WINDOW_S = 1800.0
# a short test is cut into at least this many windows
WINDOWS_A_TEST = 12
STANDS_OUT = 1.3
SHOWN = 12
AFTER_WARM = "after a warm start"
_AT_REST_RPM = 5.0  # what an analogue speed still shows
_STEADY = 0.02  # of its size: a supply that stays so all test long says nothing of a window
_MOST = 0.75  # a level that stood for this share of a window is what it was; else it is said from where to where
_ALIKE = 0.05  # of the largest in the window: values that are one level
_HARDLY = 0.05  # of the window: a level that stood for less is not told


@dataclass(frozen=True, slots=True)
class _Window:
    test: TestData
    start: int
    stop: int
    sse: float
    n: int
    first: bool = False  # of its test


def weak_spots(tests: Sequence[tuple[TestData, Float1D, Bool1D]], noise: float) -> list[WeakSpot]:
    """tests: (test, residual of shape (n,), mask of shape (n,)). noise: floor of the response, in its unit.

    A window stands out where its RMS exceeds both three times the noise and 1.3 times the RMS of all; windows
    that touch are one spot; spots are ranked by squared error. What is left at the end of a test belongs to the window
    before it where it is shorter than half of one, and a single sample is no spot: its RMS is a reading.
    """
    total = sum(float(np.sum(r[m] ** 2)) for _, r, m in tests)
    count = sum(int(m.sum()) for _, _, m in tests)
    if not count:
        return []
    floor = max(3.0 * noise if np.isfinite(noise) else 0.0, STANDS_OUT * float(np.sqrt(total / count)))
    spots: list[_Window] = []
    for test, residual, mask in tests:
        spots += _windows(test, residual, mask, floor)
    spots.sort(key=lambda w: -w.sse)
    return [
        WeakSpot(
            campaign=w.test.campaign,
            test=w.test.test,
            from_s=float(w.test.t_s[w.start]),
            to_s=float(w.test.t_s[w.stop - 1] + w.test.t_s[1] - w.test.t_s[0]),  # where its last mean ends
            rmse_um=float(np.sqrt(w.sse / w.n)),
            state=", ".join([AFTER_WARM] * _is_warm(w) + [describe_state(w.test, w.start, w.stop)]),
            after_warm_start=_is_warm(w),
        )
        for w in spots[:SHOWN]
    ]


def _windows(test: TestData, residual: Float1D, mask: Bool1D, floor: float) -> list[_Window]:
    if len(test.t_s) < 2:
        return []
    # windows are counted from the first sample that counts: what came before is history
    counted = np.flatnonzero(mask)
    if not len(counted):
        return []
    begin, end = int(counted[0]), int(counted[-1]) + 1
    step = float(test.t_s[1] - test.t_s[0])
    width = max(2, round(min(WINDOW_S, (end - begin) * step / WINDOWS_A_TEST) / step))
    windows: list[_Window] = []
    for start, stop in _cut_into_windows(begin, end, width):
        m = mask[start:stop]
        n = int(m.sum())
        sse = float(np.sum(residual[start:stop][m] ** 2))
        if n == 0 or np.sqrt(sse / n) < floor:
            continue
        if windows and windows[-1].stop == start:
            last = windows.pop()
            windows.append(_Window(test, last.start, stop, last.sse + sse, last.n + n, last.first))
        else:
            windows.append(_Window(test, start, stop, sse, n, start == begin))
    return [w for w in windows if w.n > 1]


def _cut_into_windows(begin: int, end: int, width: int) -> list[tuple[int, int]]:
    """Rows begin:end in windows of `width`, the last one up to half longer or shorter."""
    starts = list(range(begin, end, width))
    if len(starts) > 1 and 2 * (end - starts[-1]) < width:
        starts.pop()
    return list(zip(starts, [*starts[1:], end], strict=True))


def _is_warm(window: _Window) -> bool:
    return window.first and window.test.start_state == "warm"


def describe_state(test: TestData, start: int, stop: int) -> str:
    """What the machine did in rows start:stop, in words: speeds, feeds, what was on, which way the air went.

    Only what occurred is said: the level that stood for most of the window, else from where to where it went."""
    words: list[str] = []
    turning, rests = False, list[str]()  # of spindles
    for name, info in test.channels.items():
        values = test.values.get(name)
        if values is None:
            continue
        part, t_s = values[start:stop], test.t_s[start:stop]
        part, t_s = part[np.isfinite(part)], t_s[np.isfinite(part)]
        if not len(part):
            continue
        if info.quantity in ("rotational_speed", "feed", "power", "load", "current", "voltage", "flow"):
            largest = float(np.nanmax(np.abs(values)))
            low, high = _levels(np.abs(part), largest)
            of_spindle = info.quantity == "rotational_speed" and (info.at is None or is_spindle(info.at))
            if of_spindle and (high < _AT_REST_RPM or high <= 0.01 * largest):
                rests.append(_when_it_stood(np.abs(part) <= max(_AT_REST_RPM, 0.01 * largest), t_s))
                continue
            if (
                info.quantity in ("current", "voltage")
                and largest - float(np.nanmin(np.abs(values))) < _STEADY * largest
            ):
                continue
            if high > 0.01 * largest:
                turning = turning or of_spindle
                span = _figure(high) if low == high else f"{_figure(low)} to {_figure(high)}"
                when = _when_it_stood(_where_level_stood(np.abs(part), high, largest), t_s) if low == high else ""
                words.append(f"{name} {span} {info.unit}{when}")
        elif info.quantity == "state" and (share := float(part.mean())) > _HARDLY:
            words.append(f"{name} on" if share > 1 - _HARDLY else f"{name} on {100 * share:.0f} % of the time")
        elif info.quantity == "temperature" and (info.at or "").startswith("hall"):
            rise = float(part[-1] - part[0])
            if abs(rise) > 0.3:
                words.append(f"{name} {'rising' if rise > 0 else 'falling'}")
    if rests and not turning:
        words.insert(0, f"spindle at rest{next(filter(None, rests), '')}")
    return ", ".join(words) if words else "idle"


def _levels(sizes: Float1D, largest: float) -> tuple[float, float]:
    """(from, to), values that occurred: alike where one level stood for most of it. largest: of the whole test."""
    ordered = np.sort(sizes)
    ends = np.searchsorted(ordered, ordered + max(_ALIKE * float(ordered[-1]), 0.01 * largest), side="right")
    counts = ends - np.arange(len(ordered))
    first = int(np.argmax(counts))
    if counts[first] >= _MOST * len(ordered):
        level = float(ordered[(first + int(ends[first]) - 1) // 2])
        return level, level
    low, high = (float(ordered[round(share * (len(ordered) - 1))]) for share in (_HARDLY, 1 - _HARDLY))
    return low if low > 0.01 * largest else 0.0, high


def _where_level_stood(sizes: Float1D, level: float, largest: float) -> Bool1D:
    """Where a level stood. largest: of the whole test."""
    return np.asarray(np.abs(sizes - level) <= max(_ALIKE * float(sizes.max()), 0.01 * largest))


def _when_it_stood(stood: Bool1D, t_s: Float1D) -> str:
    """' from 12 min on', of a level that stood for most of a window and not for all of it; '' where it stood for all.
    t_s: from the test's start."""
    share = float(stood.mean())
    if share >= 1 - _HARDLY:
        return ""
    first, last = int(np.argmax(stood)), len(stood) - 1 - int(np.argmax(stood[::-1]))
    at_once = float(stood[first : last + 1].mean()) >= 1 - _HARDLY
    if at_once and last == len(stood) - 1:
        return f" from {_time_in_words(float(t_s[first]))} on"
    if at_once and first == 0:
        return f" until {_time_in_words(float(t_s[last]))}"
    return f" for {100 * share:.0f} % of the time"


def _time_in_words(seconds: float) -> str:
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.0f} min"


def _figure(size: float) -> str:
    return f"{size:.0f}" if size >= 100 else f"{size:.2g}"
