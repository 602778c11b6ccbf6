"""What can be said of a residual that nothing logged explains: how slow it is, when and in which state it comes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.unlogged import first_seen, goes_with
from thermodata.diagnosis.unlogged.missing_heat import TAUS_S, Course, missing_heat
from thermodata.diagnosis.verdict.suspect import NOTHING_SUPPOSED, Supposed
from thermodata.modelling.terms.rms import rms
from thermodata.plugin import Float1D
from thermodata.schema.answers.diagnosis import WeakSpot
from thermodata.schema.answers.missing_heat import HeatCompanion, HeatCourse, MissingHeat, Unknown

DIGITS = 4  # of a course, which is many numbers


def characterise(
    problem: Problem,
    spots: Sequence[WeakSpot],
    supposed: Supposed = NOTHING_SUPPOSED,
    unread: float | None = None,
) -> Unknown:
    """How fast the autocorrelation decays, which hours of the day stand out, the states of the weak spots; and the
    missing heat itself, estimated, unless nobody knows of any. unread: how probable it is that no channel reads it
    (`not_logged`)."""
    warm = spots[0] if spots and spots[0].after_warm_start else None
    return Unknown(
        time_constants_h=_time_constants(problem),
        hours_of_day=_hours_that_stand_out(problem),
        states=list(dict.fromkeys(s.state for s in spots[:5])),
        heat=None if supposed.doubt == "all" else _heat(problem, supposed, warm),
        not_logged=unread,
    )


def _heat(problem: Problem, supposed: Supposed, warm: WeakSpot | None) -> MissingHeat | None:
    heat = missing_heat(problem)
    if heat is None:
        return None
    found = goes_with.companions(heat, problem.response)
    strong, weak = goes_with.strong_and_weak_tests(heat)
    low, high = heat.tau_range_s
    # the least alike first; a channel of what is likely it is not ruled out
    ruled_out = [c for c in reversed(found) if c.verdict == "not" and c.info.name not in supposed.channels]
    began_warm = None if warm is None else (warm.campaign, warm.test)
    return MissingHeat(
        time_constant_h=_rounded(heat.tau_s / 3600),
        time_constant_low_h=None if low <= TAUS_S[0] else _rounded(low / 3600),
        time_constant_high_h=None if high >= TAUS_S[-1] else _rounded(high / 3600),
        direction=None if not heat.sign else "+" if heat.sign > 0 else "-",
        agreed=heat.agreed if heat.sign else None,
        explained=_rounded(heat.explained),
        left_out=_rounded(heat.predicted),
        hours_of_day=goes_with.hours_of_day(heat),
        strong_tests=[first_seen.name_of(t, heat) for t in strong],
        weak_tests=[first_seen.name_of(t, heat) for t in weak],
        goes_with=[_companion(c) for c in found if c.verdict == "with"],
        goes_not_with=[_companion(c) for c in ruled_out],
        where=first_seen.where(heat, found, strong, weak, supposed, began_warm),
        courses=[_course(c) for c in heat.courses],
    )


def _companion(one: goes_with.Companion) -> HeatCompanion:
    shares = (None if s is None else _rounded(s) for s in (one.on_with, one.on_without, one.follows))
    on_with, on_without, follows = shares
    return HeatCompanion(channel=one.info.name, at=one.info.at, on_with=on_with, on_without=on_without, follows=follows)


def _course(course: Course) -> HeatCourse:
    return HeatCourse(
        campaign=course.test.campaign,
        test=course.test.test,
        from_s=course.from_s,
        step_s=course.step_s,
        source_um=[_rounded(x) for x in course.source],
        contribution_um=[_rounded(x) for x in course.contribution],
        residual_um=[_rounded(x) if np.isfinite(x) else None for x in course.residual],
    )


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def _time_constants(problem: Problem) -> list[float]:
    """Where the residual's autocorrelation, pooled over tests, falls to 1/e. Empty where it is white or never falls."""
    longest = max((len(b.residual) for b in problem.blocks), default=0) // 2
    if longest < 4:
        return []
    power = np.zeros(longest)
    count = np.zeros(longest)
    for block in problem.blocks:
        x = block.residual - block.residual.mean()
        n = len(x)
        spectrum = np.abs(np.fft.rfft(x, 2 * n)) ** 2
        auto = np.fft.irfft(spectrum)[:n]
        m = min(n, longest)
        power[:m] += auto[:m]
        count[:m] += n
    rho = power / np.maximum(count, 1)
    if rho[0] <= 0:
        return []
    below = np.flatnonzero(rho / rho[0] < np.exp(-1))
    if not len(below) or below[0] <= 1:
        return []
    return [float(round(below[0] * problem.step_s / 3600, 3))]


def _hours_that_stand_out(problem: Problem) -> list[float]:
    """Hours of the day (UTC) whose mean residual stands out in most of the days that cover them."""
    days: list[tuple[Float1D, Float1D]] = []
    for block in problem.blocks:
        if block.test.start_unix_s is None:
            continue
        hour = (block.test.start_unix_s + block.t_s) / 3600 % 24
        days.append((hour, block.residual))
    if len(days) < 3:
        return []
    whole = rms([r for _, r in days])
    hours = []
    for h in range(24):
        means = [
            float(r[(hour >= h) & (hour < h + 1)].mean()) for hour, r in days if ((hour >= h) & (hour < h + 1)).any()
        ]
        if len(means) >= 3 and abs(np.mean(means)) > whole and abs(np.sum(np.sign(means))) >= 0.8 * len(means):
            hours.append(float(h))
    return hours
