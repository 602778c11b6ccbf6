"""The tests of a campaign: what the machine is told to do, on a grid of 10 s, as a lab would plan it.

Each test excites a few sources; two mixed days excite most of them, and the last is locked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Float2D

STEP_S = 10.0
AXES = ("X", "Y", "Z")
MAX_SPEED = 10_000.0


@dataclass
class Operation:
    """One test. Arrays have shape (n,), those of axes (3, n) in the order X, Y, Z.

    speed, table_speed [rpm]; feed: mean |v| over the step [m/min]; position [mm]; stroke: (3, 2, n), the part
    of the screw that is travelled [mm]; cutting [kW]; the rest are flags. measuring: at the measuring position.
    """

    id: str
    kind: str
    role: str
    n: int
    home: Float1D
    conditions: dict[str, str] = field(default_factory=dict)
    phases: dict[str, tuple[float, float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = self.n
        self.speed: Float1D = np.zeros(n)
        self.table_speed: Float1D = np.zeros(n)
        self.feed: Float2D = np.zeros((3, n))
        self.position: Float2D = np.repeat(self.home[:, None], n, axis=1)
        self.stroke: Float2D = np.repeat(self.position[:, None, :], 2, axis=1)
        self.cutting: Float1D = np.zeros(n)
        self.coolant: Float1D = np.zeros(n)
        self.pump: Float1D = np.zeros(n)
        self.drives: Float1D = np.ones(n)
        self.door: Float1D = np.zeros(n)
        self.measuring: Bool1D = np.ones(n, dtype=np.bool_)

    @property
    def t_s(self) -> Float1D:
        return np.asarray(np.arange(self.n) * STEP_S, dtype=np.float64)

    def span(self, start_h: float, stop_h: float) -> slice:
        """The part of the test between two shares of its length (0..1)."""
        return slice(int(start_h * self.n), int(stop_h * self.n))

    def move(self, part: slice, axis: int, feed: float, half_stroke: float, cycle_s: float, measure_s: float) -> None:
        """Runs an axis to and fro; every cycle ends with a return to the measuring position."""
        i = np.arange(part.start, part.stop)
        moving = ((i - part.start) * STEP_S) % cycle_s < cycle_s - measure_s
        at = i[moving]
        lo, hi = self.home[axis] - half_stroke, self.home[axis] + half_stroke
        travelled = at * STEP_S / 60.0 * feed * 1000.0
        phase = np.mod(travelled, 2 * (hi - lo))
        self.position[axis, at] = lo + np.minimum(phase, 2 * (hi - lo) - phase)
        self.stroke[axis, 0, at], self.stroke[axis, 1, at] = lo, hi
        self.feed[axis, at] = feed
        self.measuring[at] = False

    def cut(self, part: slice, speed: float, power: float, coolant: bool, rng: np.random.Generator) -> None:
        """Cuts, with a return to the measuring position every few minutes while the spindle keeps turning."""
        self.speed[part] = speed
        if coolant:
            self.coolant[part] = 1.0
        cycle, rest = float(rng.integers(24, 40)) * STEP_S, 50.0
        for axis in (0, 1):
            self.move(part, axis, float(rng.uniform(0.8, 1.6)), 120.0, cycle, rest)
        busy = ~self.measuring[part]
        self.cutting[part] = power * busy * (1 + 0.05 * rng.standard_normal(len(busy)))


Fill = Callable[[Operation, np.random.Generator], None]


def _etve(op: Operation, rng: np.random.Generator) -> None:
    op.drives[:] = 0.0
    op.phases = {"idle": (0.0, op.n * STEP_S)}


def _constant(speed: float, until: float, then: float = 0.0) -> Fill:
    """Heating at one speed, perhaps a while at a second one, and cooling."""

    def fill(op: Operation, rng: np.random.Generator) -> None:
        op.speed[op.span(0.02, until)] = speed
        op.conditions = {"speed": f"{speed:.0f} rpm"}
        end = op.span(0.02, until).stop * STEP_S
        op.phases = {"heating": (0.0, end)}
        if then:
            second = op.span(until, until + 0.2)
            op.speed[second] = then
            op.phases["second"] = (end, second.stop * STEP_S)
            end = second.stop * STEP_S
        op.phases["cooling"] = (end, op.n * STEP_S)

    return fill


def _spectrum(op: Operation, rng: np.random.Generator) -> None:
    """Speeds change every 10 to 50 minutes, with rests, short pulses among them."""
    i = int(0.02 * op.n)
    while i < int(0.9 * op.n):
        length = int(rng.choice([60, 120, 180, 300]) * rng.uniform(0.8, 1.2))
        op.speed[i : i + length] = rng.choice([0, 1500, 3000, 4500, 6000, 7500, 9000, 10_000])
        i += length
    op.speed[int(0.92 * op.n) :] = 0.0


def _feed(axis: int, feeds: tuple[float, float]) -> Fill:
    def fill(op: Operation, rng: np.random.Generator) -> None:
        cycle = float(rng.integers(24, 42)) * STEP_S
        half = float(rng.uniform(140, 190))
        op.move(op.span(0.02, 0.36), axis, feeds[0], half, cycle, 50.0)
        op.move(op.span(0.52, 0.80), axis, feeds[1], half, cycle, 50.0)
        op.pump[op.span(0.0, 0.1)] = 1.0
        op.conditions = {"axis": AXES[axis], "feed": f"{feeds[0]:g} m/min"}

    return fill


def _table(op: Operation, rng: np.random.Generator) -> None:
    high = float(rng.uniform(350, 500))
    op.table_speed[op.span(0.03, 0.38)] = high
    op.table_speed[op.span(0.52, 0.75)] = 0.6 * high
    op.pump[op.span(0.0, 0.38)] = 1.0
    op.conditions = {"table_speed": f"{high:.0f} rpm"}


def _cutting(op: Operation, rng: np.random.Generator) -> None:
    """Heavy and light cuts, wet and dry, and air cuts between them."""
    start = 0.03
    for power, wet in ((3.0, False), (1.5, True), (0.0, False), (2.5, True), (3.5, False)):
        stop = start + float(rng.uniform(0.11, 0.15))
        op.cut(op.span(start, stop), float(rng.choice([2500, 3500, 4500])), power, wet, rng)
        start = stop + float(rng.uniform(0.01, 0.05))
    op.pump[op.span(0.0, 0.12)] = 1.0


def _fluids(op: Operation, rng: np.random.Generator) -> None:
    """Coolant without cutting and pump cycles, with the spindle at rest."""
    for start, length in ((0.05, 0.2), (0.42, 0.12), (0.66, 0.16)):
        begin = start + float(rng.uniform(0, 0.05))
        op.coolant[op.span(begin, begin + length)] = 1.0
    for start, length in ((0.15, 0.22), (0.55, 0.1), (0.74, 0.2)):
        begin = start + float(rng.uniform(0, 0.05))
        op.pump[op.span(begin, begin + length)] = 1.0


def _working_day(axis: int) -> Fill:
    """A working day: warm up, feeds, cuts, table, rests, in an order of its own."""

    def fill(op: Operation, rng: np.random.Generator) -> None:
        blocks = [str(b) for b in rng.permutation(["spin", "feed", "cut", "table", "fluid", "spin", "cut"])]
        at = 0.02
        for name in blocks:
            stop = min(at + float(rng.uniform(0.11, 0.14)), 0.97)
            part = op.span(at, stop)
            if name == "spin":
                half = (part.start + part.stop) // 2
                op.speed[part.start : half] = rng.choice([3000, 6000])
                op.speed[half : part.stop] = rng.choice([8000, 10_000])
            elif name == "feed":
                op.move(part, axis, float(rng.uniform(8, 16)), 160.0, 300.0, 50.0)
            elif name == "cut":
                op.cut(part, float(rng.choice([3000, 5000])), float(rng.uniform(2, 3.5)), bool(rng.random() < 0.6), rng)
            elif name == "table":
                op.table_speed[part] = float(rng.uniform(300, 500))
                op.pump[part] = 1.0
            else:
                op.coolant[part] = 1.0
                op.pump[op.span(at, min(stop + 0.05, 1.0))] = 1.0
            at = stop + float(rng.uniform(0.0, 0.02))

    return fill


def make_plan(rng: np.random.Generator, axis: int, hours: float, tests: int | None) -> list[Operation]:
    """The tests, 10 unless said otherwise. axis: the axis of the response (0..2), whose feed is tested.

    Fewer than 10 leave out the least telling first, more add spectra and mixed days; the locked day always stays.
    """
    n = round(hours * 3600 / STEP_S)
    home = np.array([rng.uniform(350, 450), rng.uniform(300, 400), rng.uniform(180, 300)]).round(0)
    low, high = float(rng.choice([1000, 1500, 2000])), float(rng.choice([8000, 9000, 10_000]))
    feed = float(rng.uniform(9, 16))
    letter = AXES[axis].lower()
    every: list[tuple[int, str, str, str, Fill]] = [
        (3, "etve", "etve", "calibration", _etve),
        (6, f"sp{low:.0f}", "spindle", "calibration", _constant(low, 0.6)),
        (1, f"sp{high:.0f}", "spindle", "calibration", _constant(high, 0.42, float(rng.choice([4000, 5000, 6000])))),
        (5, "spectrum", "spectrum", "verification", _spectrum),
        (4, f"feed_{letter}", "linear_axis", "calibration", _feed(axis, (round(feed, 1), round(feed * 0.5, 1)))),
        (7, "table", "rotary_axis", "calibration", _table),
        (8, "cutting", "cutting", "calibration", _cutting),
        (9, "fluids", "other", "calibration", _fluids),
        (2, "day1", "mixed", "verification", _working_day(axis)),
        (0, "day2", "mixed", "locked", _working_day(axis)),
    ]
    wanted = 10 if tests is None else tests
    chosen = [row for row in every if row[0] < wanted]
    for extra in range(10, wanted):
        filled: tuple[str, Fill] = ("mixed", _working_day(axis)) if extra % 2 else ("spectrum", _spectrum)
        chosen.insert(-1, (extra, f"{filled[0]}{extra}", filled[0], "verification", filled[1]))
    plan = []
    for _, name, kind, role, fill in chosen:
        op = Operation(name, kind, role, n, home)
        fill(op, rng)
        plan.append(op)
    return plan
