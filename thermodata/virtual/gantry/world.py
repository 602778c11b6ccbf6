"""A world: one machine, one hall, one campaign, and the truth about each effect. `binned.dataset` is its fast path.

The displacement at the tool centre point is a sum of contributions, each an integral over the cells of one part
(elongation, bending) or a function of speed (the centrifugal shift); a contribution belongs to one effect of the
library. None is a first-order lag: a fitted sum of lags leaves what a distributed machine leaves.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from thermodata.errors import UsageError, nearest
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.files.model import Model
from thermodata.virtual.gantry.catalogue import EFFECTS, drivers_of
from thermodata.virtual.gantry.heat.hall import BOUNDARIES, Hall, air, smooth
from thermodata.virtual.gantry.heat.losses import spindle_power
from thermodata.virtual.gantry.heat.machine import Machine, build
from thermodata.virtual.gantry.heat.sensors import Sensor, make_sensors
from thermodata.virtual.gantry.heat.thermal import run
from thermodata.virtual.gantry.levers import Levers, Units, draw_levers
from thermodata.virtual.gantry.plan import AXES, MAX_SPEED, Operation, make_plan


@dataclass(frozen=True)
class Run:
    """One test as it was. readings: channel -> shape (n,) on the grid of 10 s. contributions: effect -> (3, n) [um]
    along X, Y, Z from the start of the test. displacement: (3, n) with the probes' slow noise [um]."""

    op: Operation
    start_unix_s: float
    readings: dict[str, Float1D]
    contributions: dict[str, Float2D]
    displacement: Float2D


@dataclass(frozen=True)
class World:
    """present: all effects that the machine has, the hidden one among them; known: those that the lab's model has.
    levers: effect -> (3,) along X, Y, Z."""

    seed: int
    hide: str
    axis: str
    machine: Machine
    hall: Hall
    sensors: tuple[Sensor, ...]
    present: tuple[str, ...]
    known: tuple[str, ...]
    levers: Levers
    noise_um: float
    white_um: float
    runs: tuple[Run, ...]

    @property
    def campaign(self) -> str:
        return f"virtual-{self.seed}"

    @property
    def machine_id(self) -> str:
        return f"V{100 + self.seed % 900}"

    @property
    def spindle(self) -> str:
        return f"SP{1 + self.seed % 3}"

    @property
    def response(self) -> str:
        return f"d{self.axis}"

    @property
    def axis_index(self) -> int:
        return AXES.index(self.axis)

    @cached_property
    def rms_um(self) -> dict[str, dict[str, float]]:
        """effect -> test -> standard deviation of its contribution to the response over the measured samples [um]."""
        return {
            e: {r.op.id: float(np.std(r.contributions[e][self.axis_index][r.op.measuring])) for r in self.runs}
            for e in self.present
        }

    def baseline(self) -> Model:
        """The model of the lab: the effects of the world that it knows."""
        return Model.model_validate(
            {
                "schema": "thermodata/model/1",
                "name": "baseline",
                "campaign": self.campaign,
                "response": {"axis": self.axis, "at": "tcp"},
                "step": "60 s",
                "effects": [{"effect": e, "drivers": drivers_of(e, self.axis)} for e in self.known],
            }
        )


Draw = Callable[[np.random.Generator, str, int, Units, Sequence[Operation]], Levers]
Knows = Callable[[np.random.Generator, str, Sequence[str]], tuple[str, ...]]


def all_but_the_hidden_one(rng: np.random.Generator, hide: str, present: Sequence[str]) -> tuple[str, ...]:
    """What the lab's model has, where a demonstration asks what is missing."""
    return tuple(e for e in present if e != hide)


def make_world(
    hide: str = "none",
    seed: int = 0,
    *,
    tests: int | None = None,
    hours: float = 12.0,
    measured: bool = True,
    draw: Draw = draw_levers,
    knows: Knows = all_but_the_hidden_one,
) -> World:
    """Simulates a campaign. measured=False leaves out the sensors that drive the hidden effect.

    draw: which effects the machine has, and their levers. knows: which of them the lab's model has. UsageError for an
    unknown effect, fewer than two tests or less than two hours.
    """
    _refuse_impossible(hide, seed, tests, hours)
    rng = np.random.default_rng([seed, 7919, sum(map(ord, hide))])
    axis = _axis(rng, hide)
    ops = make_plan(rng, axis, hours, tests)
    machine = build(rng, ops[0].home)
    hall = Hall.draw(rng)
    sensors, spare = make_sensors(rng)
    starts = _starts(rng, len(ops), hours)
    outside = [air(hall, op, hour, day, rng) for op, (day, hour) in zip(ops, starts, strict=True)]
    temperatures, units = _in_the_machine(machine, ops, outside, sensors, AXES[axis], rng)
    levers = draw(rng, hide, axis, units, ops)
    present = tuple(levers)
    known = knows(np.random.default_rng([seed, 7927, sum(map(ord, hide))]), hide, present)
    sensors = _placed(sensors, spare, present, AXES[axis], hide if not measured else None)
    noise, white = float(rng.uniform(0.3, 0.5)), float(rng.uniform(0.1, 0.25))
    runs = []
    for op, cells, unit, boundary, (day, hour) in zip(ops, temperatures, units, outside, starts, strict=True):
        contributions = {e: levers[e][:, None] * unit[e] for e in present}
        total = np.sum(list(contributions.values()), axis=0)
        total = total + np.stack([smooth(rng, op.n, noise, float(rng.uniform(600, 2400))) for _ in range(3)])
        readings = {s.name: s.read(_true(s, cells, boundary, op), rng) for s in sensors}
        runs.append(Run(op, EPOCH_S + 86_400.0 * day + 3600.0 * hour, readings, contributions, total))
    return World(seed, hide, AXES[axis], machine, hall, sensors, present, known, levers, noise, white, tuple(runs))


EPOCH_S = 1_771_801_200.0  # 2026-02-23 00:00 in Prague


def _refuse_impossible(hide: str, seed: int, tests: int | None, hours: float) -> None:
    """UsageError for what no campaign can be made of."""
    if hide != "none" and hide not in EFFECTS:
        close = nearest(hide, [*EFFECTS, "none"])
        raise UsageError(
            f"no effect '{hide}' to hide",
            expected=", ".join([*EFFECTS, "none"]),
            got=hide,
            hint=f"did you mean '{close}'?" if close else None,
        )
    if seed < 0:
        raise UsageError("a seed is a whole number from 0", expected="0, 1, 2, ...", got=str(seed))
    if tests is not None and not 2 <= tests <= 40:
        raise UsageError(
            "a campaign needs a test to learn from and a locked one", expected="2 to 40 tests", got=str(tests)
        )
    if not 2.0 <= hours <= 96.0:
        raise UsageError("tests of this length tell nothing about heat", expected="2 to 96 h", got=f"{hours} h")


def _in_the_machine(
    machine: Machine,
    ops: Sequence[Operation],
    outside: Sequence[Float2D],
    sensors: Sequence[Sensor],
    axis: str,
    rng: np.random.Generator,
) -> tuple[list[dict[str, Float1D]], list[dict[str, Float1D]]]:
    """Of each test: (sensor -> the temperature of its cell, shape (n,) [degC]; effect -> the course that a lever of 1
    makes a contribution, shape (n,))."""
    cells = [(s.name, s.cell) for s in sensors if isinstance(s.cell, tuple)]
    growing = [e for e in EFFECTS if e != "centrifugal_shift"]
    observe = np.zeros((len(cells) + len(growing), machine.network.size))
    for row, (_, (body, number)) in enumerate(cells):
        observe[row, machine.cells[body][number]] = 1.0
    for row, e in enumerate(growing, start=len(cells)):
        observe[row] = machine.growth[_part(e, axis)]
    temperatures, units = list[dict[str, Float1D]](), list[dict[str, Float1D]]()
    for op, field in zip(ops, run(machine, ops, outside, observe, rng), strict=True):
        temperatures.append({name: field[row] for row, (name, _) in enumerate(cells)})
        unit = {e: field[row] - field[row, 0] for row, e in enumerate(growing, start=len(cells))}
        units.append({**unit, "centrifugal_shift": (op.speed / MAX_SPEED) ** 2})
    return temperatures, units


def _axis(rng: np.random.Generator, hide: str) -> int:
    if hide in ("column_bending", "vertical_gradient"):
        return 1 if rng.random() < 0.6 else 2
    if hide != "none" and EFFECTS[hide].only_z:
        return 2
    return 1 if rng.random() < 0.12 else 2


def _placed(
    sensors: tuple[Sensor, ...], spare: frozenset[str], present: tuple[str, ...], axis: str, blind: str | None
) -> tuple[Sensor, ...]:
    """The sensors of this lab: the usual ones and what the effects of the machine need, without those of `blind`."""
    needed = frozenset(c for e in present for c in drivers_of(e, axis).values())
    gone = spare - needed
    if blind is not None and blind != "none":
        kept = frozenset(c for e in present if e != blind for c in drivers_of(e, axis).values())
        gone |= frozenset(drivers_of(blind, axis).values()) - kept
    return tuple(s for s in sensors if s.name not in gone)


def _starts(rng: np.random.Generator, tests: int, hours: float) -> list[tuple[int, float]]:
    """(day, local hour) of each test: in the morning or in the evening, with a night to soak between."""
    pitch = max(2, int(np.ceil((hours + 10) / 24)))
    return [(i * pitch, float(rng.choice([6.5, 7.5, 8.5, 18.0])) + float(rng.integers(0, 6)) / 6) for i in range(tests)]


def _part(effect: str, axis: str) -> str:
    return f"{effect}_{axis.lower()}" if effect in ("feed_screw", "feed_motor") else effect


def _true(sensor: Sensor, cells: dict[str, Float1D], boundary: Float2D, op: Operation) -> Float1D:
    if sensor.name in cells:
        return cells[sensor.name]
    if isinstance(sensor.cell, str):
        return np.asarray(boundary[BOUNDARIES.index(sensor.cell)])
    name, _, letter = sensor.name.partition("_")
    if name == "feed":
        return np.asarray(op.feed[AXES.index(letter)])
    if name == "pos":
        return np.asarray(op.position[AXES.index(letter)])
    plain = {
        "spindle_speed": op.speed,
        "table_speed": op.table_speed,
        "coolant_on": op.coolant,
        "pump_on": op.pump,
        "door_open": op.door,
    }
    return plain[sensor.name] if sensor.name in plain else spindle_power(op)
