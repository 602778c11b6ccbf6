"""The courses of all temperatures: machines of several tests march side by side, each as if it were alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from thermodata.plugin import Float1D, Float2D
from thermodata.virtual.lathe.heat.course import AT, CELLS, TANK, TOUCH, Course, make_course
from thermodata.virtual.lathe.heat.fields import STACK, TANKS, Fields
from thermodata.virtual.lathe.heat.hall import Air
from thermodata.virtual.lathe.heat.losses import bearing_w, film_of
from thermodata.virtual.lathe.programme import DT_S, Work

WET_FILM = 130.0  # [W/m2/K] of coolant on what it wets
WETTED = ((AT["top"], 0.35), (AT["tool"], 0.03))  # covers of the bed and the turret: cell, area [m2]
SOAK_H = 30.0
INSIDE = np.concatenate([np.arange(CELLS)[STACK.where[name]] for name in ("part", "bracket", "turret", "saddle")])
# heat that crosses between bodies: two cells, conductance [W/K]
ACROSS = (
    (STACK.cell("quill", 0.7), STACK.cell("headstock", 0.95), 7.0),
    (STACK.cell("quill", 0.3), STACK.cell("headstock", 0.8), 5.0),
    (STACK.cell("headstock", 0), AT["top"], 1.0),
    (STACK.cell("saddle", 0), AT["top"], 0.5),
)


@dataclass(frozen=True, slots=True)
class Task:
    """One test of one machine. before: hall of the hours before it. working=False: the machine is off."""

    work: Work
    air: Air
    before: Air
    working: bool = True


@dataclass(slots=True)
class State:
    """T: shape (machines, cells), tank: shape (machines, lumps), warm: air of the working space [degC]."""

    T: Float2D
    tank: Float2D
    warm: Float1D


def solve(work: Work, air: Air, before: Air, working: bool = True, dt_s: float = DT_S) -> Fields:
    """Every course from balance with `before`, the hall of the hours before the test.

    working=False: the same hall around a machine that is off. dt_s divides DT_S; inputs are held within DT_S.
    """
    return solve_all([Task(work, air, before, working)], dt_s)[0]


def solve_all(tasks: Sequence[Task], dt_s: float = DT_S) -> list[Fields]:
    """The same for many, to the last bit, in a fraction of the time. ValueError where halls before differ in length."""
    order = sorted(range(len(tasks)), key=lambda k: -tasks[k].work.n)  # those that end first stand last
    some = [tasks[k] for k in order]
    state = _soak([t.before for t in some])
    lengths = [t.work.n for t in some]
    courses = _stacked([make_course(t.work, t.air, t.working, dt_s) for t in some])
    found = [Fields(np.empty((n, CELLS)), {name: np.empty(n) for name in TANKS}, np.empty(n)) for n in lengths]
    for i in range(lengths[0]):
        going = sum(n > i for n in lengths)
        state = State(state.T[:going], state.tank[:going], state.warm[:going])
        for k in range(going):
            found[k].rods[i], found[k].inside[i] = state.T[k], state.warm[k]
            for name, j in TANK.items():
                found[k].tanks[name][i] = state.tank[k, j]
        for _ in range(round(DT_S / dt_s)):
            state = _advance(state, courses, i, going, dt_s)
    return [found[order.index(k)] for k in range(len(tasks))]


def _soak(before: Sequence[Air]) -> State:
    """Machines that were off for the hours of `before`, from balance with its first."""
    n, many = len(before[0].low), len(before)
    if any(len(air.low) != n for air in before):
        raise ValueError("the halls before the tests differ in length")
    still = np.zeros(n)
    off = Work("idle", still, still, still, still, still, still, still, still, still)
    dt_s = SOAK_H * 3600 / n
    courses = _stacked([make_course(off, air, False, dt_s) for air in before])
    start = courses.low[0].copy()
    state = State(np.repeat(start[:, None], CELLS, axis=1), np.repeat(start[:, None], len(TANKS), axis=1), start.copy())
    for i in range(n):
        state = _advance(state, courses, i, many, dt_s)
    return State(state.T, state.tank, np.array([air.low[-1] for air in before]))  # doors were open


def _stacked(courses: Sequence[Course]) -> Course:
    """Courses side by side, shapes (n, machines, ...); a shorter one goes on as it ends."""
    longest = max(len(c.low) for c in courses)
    rows = [np.minimum(np.arange(longest), len(c.low) - 1) for c in courses]
    return Course(
        *(np.stack([getattr(c, f.name)[r] for c, r in zip(courses, rows, strict=True)], axis=1) for f in fields(Course))
    )


def _advance(s: State, c: Course, i: int, going: int, dt_s: float) -> State:
    """The first `going` machines after dt_s, driven by row i of their courses."""
    T, low, wet = s.T, c.low[i, :going], c.wet[i, :going]
    coolant = s.tank[:, TANK["coolant"]]
    around = c.around[i, :going].copy()
    around[:, INSIDE] = s.warm[:, None]
    h = film_of(T, around, c.forced[i, :going, None])
    h[:, STACK.where["part"]] += c.spin[i, :going, None]
    leak = h * STACK.skin
    bath = leak * around
    for cell, area in WETTED:
        leak[:, cell] += WET_FILM * area * wet
        bath[:, cell] += WET_FILM * area * coolant * wet
    leak[:, AT["foot"]] += 9.0
    bath[:, AT["foot"]] += 9.0 * c.floor[i, :going]
    P = c.power[i, :going].copy()
    for k in np.flatnonzero(c.speed[i, :going]):
        rpm = float(c.speed[i, k])
        P[k, AT["front"]] += bearing_w(rpm, T[k, AT["front"]])
        P[k, AT["rear"]] += 0.6 * bearing_w(rpm, T[k, AT["rear"]])
    # of heat that crosses, the partner stays where it was a step ago, which is stable for any step
    for a, b, g in ACROSS:
        leak[:, [a, b]] += g
        bath[:, [a, b]] += g * T[:, [b, a]]
    given = c.given[i, :going].copy()
    for name, (cell, g) in TOUCH.items():
        leak[:, cell] += g
        bath[:, cell] += g * s.tank[:, TANK[name]]
        given[:, TANK[name]] += g * T[:, cell]
    # what leaks is linear in T within the step, so the bath stands for leak times the outside
    outside = np.where(leak > 0, bath / np.maximum(leak, 1e-12), T)
    rest = given / c.loss[i, :going]
    tank = rest + (s.tank - rest) * c.decay[i, :going]
    space = c.space[i, :going] + 0.25 * (coolant - low) * wet
    warm = space + (s.warm - space) * float(np.exp(-dt_s / 900))
    return State(STACK.step(T, dt_s, leak, outside, P), tank, warm)
