"""What an estimated source goes with: machine states, temperatures, hours of the day. And what it does not go with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from thermodata.diagnosis.unlogged.missing_heat import RESAMPLED, Course, MissingHeat
from thermodata.effect.lag import lag
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo, TestData

RESTS_AT_ZERO = ("rotational_speed", "feed", "flow", "state")
RESTS_ABOVE_ZERO = ("power", "load", "current", "torque", "pressure", "voltage")
STANDS = 0.05  # of the largest value: what moves less than this rests
SOURCE_RESTS = 0.15  # of its nearly largest value (95 %)
# the same for hours of the day: an estimate fades where its source is off, for hours, but long stays above this only
# where it is on
HOURS_REST = 0.5
ENOUGH = 0.05  # of the time that a channel must run, and rest, to say anything
# the source is on in this share of the time that the channel runs, and more often than while it rests, beyond chance
ON_WITH, MORE_OFTEN = 0.8, 0.25
OFF_WITH, NO_OFTENER = 0.6, 0.3
LAGS_S = (0.0, 600.0, 2400.0, 9600.0)
FOLLOWS, FOLLOWS_NOT = 0.7, 0.3
DAYS, MOST_DAYS, MOSTLY_ON = 3, 0.8, 0.6
STRONG, WEAK = 0.5, 0.15  # of the test in which it moves the response most

Verdict = Literal["with", "not", "undecided"]


@dataclass(frozen=True, slots=True)
class Companion:
    """One logged channel beside the source.

    on_with, on_without: share of the time in which the channel runs, and rests, that the source is on; None for a
    temperature. follows: share of the source's contribution that one lag of the channel gives; None for all else.
    """

    info: ChannelInfo
    verdict: Verdict
    on_with: float | None
    on_without: float | None
    follows: float | None

    @property
    def is_inverse(self) -> bool:
        """Whether the source is on while it is off: a clamp that is open, a guard."""
        return self.on_with is not None and self.on_without is not None and self.on_with < self.on_without


def companions(heat: MissingHeat, response: str, seed: int = 0) -> list[Companion]:
    """Every channel that can be compared, the closest first. A source that goes both ways is never on or off, so that
    only temperatures are compared with it, and none is ruled out by it."""
    infos = {name: info for c in heat.courses for name, info in c.test.channels.items() if name != response}
    found = []
    for info in infos.values():
        if info.is_mask:
            continue
        if info.quantity.startswith("temperature"):
            found.append(_companion_by_temperature(heat.courses, info, switched=heat.sign != 0))
        elif info.quantity in RESTS_AT_ZERO + RESTS_ABOVE_ZERO and heat.sign:
            found.append(_companion_by_activity(heat.courses, info, seed))
    return sorted((f for f in found if f is not None), key=_closeness, reverse=True)


def when_on(courses: Sequence[Course], above: float) -> list[Float1D]:
    """1 in the steps in which the source is on, else 0; a test each, shape (n,). above: of its nearly largest value."""
    large = float(np.quantile(np.concatenate([c.source for c in courses]), 0.95))
    return [(c.source > above * large).astype(np.float64) for c in courses]


def hours_of_day(heat: MissingHeat) -> list[float]:
    """Hours (UTC) at which the source is on in most of the days that cover them, where it is off at others."""
    if not heat.sign:
        return []
    shares: list[dict[int, float]] = []
    for course, is_on in zip(heat.courses, when_on(heat.courses, HOURS_REST), strict=True):
        if course.test.start_unix_s is None:
            continue
        middle = course.from_s + course.step_s * (np.arange(len(is_on)) + 0.5)
        hour = ((course.test.start_unix_s + middle) // 3600 % 24).astype(np.int64)
        shares.append({int(h): float(is_on[hour == h].mean()) for h in np.unique(hour)})
    if not shares or np.mean([s for day in shares for s in day.values()]) > MOSTLY_ON:
        return []
    days = {h: [day[h] for day in shares if h in day] for h in range(24)}
    return [float(h) for h, seen in days.items() if len(seen) >= DAYS and np.mean([s > 0.5 for s in seen]) >= MOST_DAYS]


def strong_and_weak_tests(heat: MissingHeat) -> tuple[list[TestData], list[TestData]]:
    """Tests in which the source moves the response at least half as much as where it does most, and hardly at all."""
    sizes = [float(np.nanstd(np.where(np.isfinite(c.residual), c.contribution, np.nan))) for c in heat.courses]
    most = max(sizes)
    strong = [(s, c.test) for s, c in zip(sizes, heat.courses, strict=True) if s >= STRONG * most]
    weak = [c.test for s, c in zip(sizes, heat.courses, strict=True) if s <= WEAK * most]
    return [test for _, test in sorted(strong, key=lambda both: -both[0])], weak


def _closeness(one: Companion) -> float:
    if one.follows is not None:
        return one.follows
    apart = (one.on_with or 0.0) - (one.on_without or 0.0)
    return abs(apart) if one.verdict == "with" else apart


def _companion_by_activity(courses: Sequence[Course], info: ChannelInfo, seed: int) -> Companion | None:
    """None where the channel hardly runs or hardly rests."""
    runs = _running_shares(courses, info)
    if runs is None:
        return None
    is_on = when_on(courses, SOURCE_RESTS)
    counts = np.array(
        [[u.sum(), (1 - u).sum(), (s * u).sum(), (s * (1 - u)).sum()] for u, s in zip(runs, is_on, strict=True)]
    )
    whole = counts.sum(axis=0)
    if min(whole[0], whole[1]) < ENOUGH * (whole[0] + whole[1]):
        return None
    with_, without = float(whole[2] / whole[0]), float(whole[3] / whole[1])
    rng, n = np.random.default_rng(seed), len(counts)
    drawn = np.array([counts[rng.integers(0, n, n)].sum(axis=0) for _ in range(RESAMPLED)])
    oftener = drawn[:, 2] / np.maximum(drawn[:, 0], 1e-9) - drawn[:, 3] / np.maximum(drawn[:, 1], 1e-9)
    verdict: Verdict = "undecided"
    if with_ >= ON_WITH and float(np.quantile(oftener, 0.05)) >= MORE_OFTEN:
        verdict = "with"
    elif info.quantity == "state" and without >= ON_WITH and float(np.quantile(-oftener, 0.05)) >= MORE_OFTEN:
        # a state may as well be named by what it holds back; a speed or a load makes no heat by its rest
        verdict = "with"
    elif with_ <= OFF_WITH and with_ - without <= NO_OFTENER:
        verdict = "not"
    return Companion(info, verdict, with_, without, None)


def _running_shares(courses: Sequence[Course], info: ChannelInfo) -> list[Float1D] | None:
    """The share of each step in which the channel runs, a test each, shape (n,); it rests where it was not logged."""
    values = [
        np.where(c.test.valid[info.name], c.test.values[info.name], np.nan) if info.name in c.test.values else None
        for c in courses
    ]
    seen = [np.abs(v[np.isfinite(v)]) for v in values if v is not None and np.isfinite(v).any()]
    if not seen:
        return None
    low, high = np.quantile(np.concatenate(seen), (0.05, 0.95))
    limit = STANDS * max(float(s.max()) for s in seen) if info.quantity in RESTS_AT_ZERO else float(low + high) / 2
    shares = []
    for course, v in zip(courses, values, strict=True):
        n = len(course.source)
        if v is None:
            shares.append(np.zeros(n))
            continue
        row = np.floor((course.test.t_s - course.from_s) / course.step_s).astype(np.int64)
        inside = (row >= 0) & (row < n)
        runs = np.bincount(row[inside], np.nan_to_num(np.abs(v[inside])) > limit, minlength=n)
        shares.append(runs / np.maximum(np.bincount(row[inside], minlength=n), 1))
    return shares


def _companion_by_temperature(courses: Sequence[Course], info: ChannelInfo, switched: bool) -> Companion | None:
    """None where it never moves or was not logged in all tests. switched: the source goes one way only. One that goes
    both ways is the residual itself, of which the known effects took what they could: the rest may look like nothing
    that warmed the machine."""
    wanted, rises = [], []
    for course in courses:
        if info.name not in course.test.values:
            return None
        t_s, values = course.test.t_s, course.test.values[info.name]
        seen = np.isfinite(values)
        if seen.sum() < 2:
            return None
        values = np.interp(t_s, t_s[seen], values[seen])
        step_s = float(t_s[1] - t_s[0])
        middle = course.from_s + course.step_s * (np.arange(len(course.source)) + 0.5)
        measured = np.isfinite(course.residual)
        moved = [np.interp(middle, t_s, lag(values - values[0], tau, step_s))[measured] for tau in LAGS_S]
        rises.append([x - x.mean() for x in moved])
        wanted.append(course.contribution[measured] - course.contribution[measured].mean())
    y = np.concatenate(wanted)
    best = 0.0
    for i in range(len(LAGS_S)):
        x = np.concatenate([r[i] for r in rises])
        if x @ x > 0 and y @ y > 0:
            best = max(best, float((x @ y) ** 2 / (x @ x) / (y @ y)))
    verdict: Verdict = "with" if best >= FOLLOWS else "not" if best <= FOLLOWS_NOT and switched else "undecided"
    return Companion(info, verdict, None, None, best)
