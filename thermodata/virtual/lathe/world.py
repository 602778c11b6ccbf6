"""One machine in one laboratory: which causes its geometry lets act, what the model knows, what the logs are like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal
from zlib import crc32

import numpy as np

from thermodata.errors import unknown_name
from thermodata.plugin import Bool1D
from thermodata.virtual.lathe.campaign import Stretch, stretches
from thermodata.virtual.lathe.causes import ALONE, CAUSES, KNOWN, OUTSIDE
from thermodata.virtual.lathe.logged.faults import blemish, slip
from thermodata.virtual.lathe.logged.recording import Run
from thermodata.virtual.lathe.logged.sensors import ALL, BY_NAME, Sensor, coarse
from thermodata.virtual.lathe.programme import DT_S
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.truth.case import Fault
from thermodata.virtual.truth.strata import Stratum

Axis = Literal["X", "Z"]
AXES: tuple[Axis, Axis] = ("X", "Z")
TREAD_UM = 2.0
WHITE_UM = 0.12
DRIFT_UM_12H = 0.8  # a slow walk of the probes that nothing logs
SPINDLE = "bearing_friction"
DECOY = "C14"
# times as large as in its best open test, and no cause is larger in a locked one
MOST_LOCKED = 3.0
# causes that one temperature drives, so that another one can go with it
BY_ONE_TEMPERATURE = tuple(c for c in KNOWN if c not in ("ring_expansion", "coolant_film", "hall_layers"))


@dataclass(frozen=True)
class World:
    """hidden: causes that act and that the model lacks. base: causes that act and that it has. scale: cause -> times
    its raw shift. faults: what is wrong with the logs. by_speed: the thin model knows the spindle's speed alone."""

    seed: int
    stratum: str
    axis: Axis
    hidden: tuple[str, ...]
    base: tuple[str, ...]
    by_speed: bool
    scale: Mapping[str, float]
    sensors: tuple[Sensor, ...]
    faults: tuple[Fault, ...]
    runs: tuple[Run, ...]
    decoy_of: str | None

    @property
    def campaign(self) -> str:
        return f"lathe-{self.stratum}-{self.seed}"

    @cached_property
    def rms_um(self) -> dict[str, dict[str, float]]:
        """cause -> test -> standard deviation of its contribution to the response [um]."""
        row = AXES.index(self.axis)
        return {
            c: {r.stretch.id: float(np.std(r.contributions[c][row])) for r in self.runs}
            for c in (*self.base, *self.hidden)
        }


def make_world(
    stratum: str, seed: int, *, hours: float = 9.0, tests: int | None = None, hide: str | None = None
) -> World:
    """The machine of a seed in a stratum; strata of one seed share its hall and programme. hours: of a usual test.

    tests: open ones, in place of the stratum's. hide: this cause, in place of a drawn one. Raises UsageError for a
    stratum or a cause that there is not.
    """
    if stratum not in STRATA:
        raise unknown_name("stratum", stratum, list(STRATA))
    if hide is not None and hide not in CAUSES:
        raise unknown_name("cause to hide", hide, list(CAUSES))
    kind = STRATA[stratum]
    # strata share hall and programme, which is what costs time, but not causes: else few seeds would be few machines.
    # The weak ones are the strong one's machines, so that what strength does can be read in pairs.
    pair = "strong" if stratum.startswith("weak") else stratum
    rng = np.random.default_rng([seed, crc32(pair.encode()), 32_416_190])
    course = stretches(seed, tests or kind.tests, kind.idle, hours)
    row = int(rng.random() < 0.5)
    order = [str(c) for c in rng.permutation(list(KNOWN))]
    thin = rng.random() < 0.5
    by_speed = rng.random() < 0.3
    target = {c: rng.uniform(5, 12) for c in CAUSES}
    sign = {c: rng.choice([-1.0, 1.0]) for c in CAUSES}
    luck = {s.name: rng.random() for s in ALL}
    hidden = _hidden(kind, order, rng, hide)
    thin = thin if kind.base == "either" else kind.base == "thin"
    base = _base(hidden, order, thin)
    scale = {
        c: float(target[c] * sign[c] * (kind.strength if c in hidden else 1.0) / _raw_size(c, course, row))
        for c in (*base, *hidden)
    }
    sensors = _sensors_logged(kind, hidden, base, luck, thin and by_speed)
    noise = np.random.default_rng([seed, 15_487_469])
    decoy_of = None
    # steps of DT_S by which the control's clock is behind, in all tests alike
    late = int(noise.choice([-1, 1]) * noise.integers(4, 17)) if kind.clock else 0
    runs = [_run_of(s, scale, sensors, noise, kind, late) for s in course]
    if kind.decoy:
        decoy_of = next(n for n in CAUSES[hidden[0]].sensors if BY_NAME[n].quantity == "temperature")
        sensors, runs = _with_decoy(sensors, runs, decoy_of, hidden[0], noise)
    runs, faults = _with_faults(runs, kind, row, [s for s in sensors if not _drives(s, hidden)], noise)
    if kind.clock:
        faults.append(Fault("clock_offset", "", None, late * DT_S, "plc"))
    return World(
        seed,
        stratum,
        AXES[row],
        hidden,
        base,
        thin and by_speed and SPINDLE in base,
        scale,
        sensors,
        tuple(faults),
        tuple(runs),
        decoy_of,
    )


def _raw_size(cause: str, course: Sequence[Stretch], row: int) -> float:
    """Standard deviation of a cause's raw shift along an axis in the open test in which it is largest [um]."""
    size = {s.id: float(np.std(CAUSES[cause].shift(s.heat)[row])) for s in course}
    best = max(size[s.id] for s in course if s.role != "locked")
    # an axis that rests in all open tests would move a locked one by kilometres
    return max(best, max(size.values()) / MOST_LOCKED, 1e-9)


def _drives(sensor: Sensor, hidden: tuple[str, ...]) -> bool:
    """Whether the first hidden cause acts by a sensor."""
    return bool(hidden) and sensor.name in CAUSES[hidden[0]].sensors


def _with_faults(
    runs: list[Run], kind: Stratum, row: int, sensors: Sequence[Sensor], rng: np.random.Generator
) -> tuple[list[Run], list[Fault]]:
    """The runs with what the stratum breaks in values, and what that is. sensors: that may break."""
    faults: list[Fault] = []
    if kind.sensor_fault:
        names = [s.name for s in sensors if s.quantity == "temperature"]
        runs, broken = blemish(runs, str(rng.choice(names)), rng)
        faults.append(broken)
    if kind.steps:
        runs, slipped = slip(runs, row, rng)
        faults += slipped
    return runs, faults


def _hidden(kind: Stratum, order: list[str], rng: np.random.Generator, hide: str | None) -> tuple[str, ...]:
    among = order
    if kind.blind:
        among = [c for c in order if c in ALONE]
    elif kind.outside:
        among = [str(c) for c in rng.permutation(list(OUTSIDE))]
    elif kind.decoy:
        among = [c for c in order if c in BY_ONE_TEMPERATURE]
    count = kind.hidden
    if kind.steps and rng.random() < 0.5:
        count = 0
    if hide is not None and count:
        among = [hide, *(c for c in among if c != hide)]
    return tuple(among[:count])


def _base(hidden: tuple[str, ...], order: list[str], thin: bool) -> tuple[str, ...]:
    """What the model knows: the spindle as a rule, and in a full one three causes more."""
    first = [SPINDLE] if SPINDLE not in hidden else ["hall_air"] if "hall_air" not in hidden else ["belt_motor"]
    rest = [c for c in reversed(order) if c not in hidden and c not in first]
    return tuple(first if thin else first + rest[:3])


def _sensors_logged(
    kind: Stratum, hidden: tuple[str, ...], base: tuple[str, ...], luck: Mapping[str, float], by_speed: bool
) -> tuple[Sensor, ...]:
    """What the model and the causes need, and of the others what this laboratory happens to log."""
    needed = {CAUSES[c].sensors[0] for c in (*base, *hidden) if CAUSES[c].sensors}
    needed |= {"A1_high", "A2_low"} if "hall_layers" in (*base, *hidden) else set()
    needed |= {"n_S"} if by_speed else set()
    gone = {n for c in hidden for n in CAUSES[c].sensors} if kind.blind else set()
    kept = [s for s in ALL if (s.name in needed or luck[s.name] < 0.75) and s.name not in gone]
    return tuple(coarse(s) for s in kept) if kind.coarse else tuple(kept)


def _run_of(
    s: Stretch,
    scale: Mapping[str, float],
    sensors: tuple[Sensor, ...],
    rng: np.random.Generator,
    kind: Stratum,
    late: int,
) -> Run:
    n = s.heat.work.n
    contributions = {c: k * np.stack(CAUSES[c].shift(s.heat)) for c, k in scale.items()}
    walk = np.cumsum(rng.standard_normal((2, n)), axis=1) * DRIFT_UM_12H * np.sqrt(DT_S / 43_200)
    total = np.asarray(sum(contributions.values(), np.zeros((2, n))) + walk + WHITE_UM * rng.standard_normal((2, n)))
    if kind.staircase:
        total = np.round(total / TREAD_UM) * TREAD_UM
    readings, valid = {}, {}
    holes = {
        src: _holes(n, rng) if kind.gaps else np.ones(n, dtype=np.bool_) for src in ("plc", "logger", "hall", "probes")
    }
    for sensor in sensors:
        x = sensor.read(sensor.true(s.heat.work, s.air, s.heat.full), rng)
        if late and sensor.source == "plc":
            x = x[np.clip(np.arange(n) - late, 0, n - 1)]
        readings[sensor.name] = x
        valid[sensor.name] = holes[sensor.source]
    return Run(s, contributions, total, readings, valid, holes["probes"])


def _holes(n: int, rng: np.random.Generator) -> Bool1D:
    """True where a logger wrote: two to four gaps of 5 to 60 min."""
    wrote = np.ones(n, dtype=np.bool_)
    for _ in range(int(rng.integers(2, 5))):
        at, size = int(rng.integers(20, n - 20)), int(rng.integers(10, 121))
        wrote[at : at + size] = False
    return wrote


def correlation(runs: list[Run] | tuple[Run, ...], one: str, other: str) -> float:
    """Of two sensors over all tests, each test from its own mean."""
    a, b = (np.concatenate([r.readings[n] - r.readings[n].mean() for r in runs]) for n in (one, other))
    return float(np.corrcoef(a, b)[0, 1])


def _with_decoy(
    sensors: tuple[Sensor, ...], runs: list[Run], driver: str, cause: str, rng: np.random.Generator
) -> tuple[tuple[Sensor, ...], list[Run]]:
    """A temperature elsewhere that lags behind the driver, as far as their correlation stays above 0.97."""
    places = {"hydraulic_oil": "axis.x.motor", "nut_x": "hydraulics"}
    wanted, low, high = rng.uniform(0.973, 0.99), 60.0, 14_400.0
    dust = [0.03 * rng.standard_normal(len(r.readings[driver])) for r in runs]
    for _ in range(25):
        tau = float(np.sqrt(low * high))
        decoy = Sensor(
            DECOY, "temperature", places.get(cause, "hydraulics"), "logger", BY_NAME[driver].true, tau, 0, 0.01
        )
        tried = [
            replace(
                r,
                readings={**r.readings, DECOY: decoy.read(r.readings[driver] + d, rng)},
                valid={**r.valid, DECOY: r.valid[driver]},
            )
            for r, d in zip(runs, dust, strict=True)
        ]
        low, high = (tau, high) if correlation(tried, driver, DECOY) > wanted else (low, tau)
        if low == tau:
            kept = decoy, tried
    decoy, tried = kept
    return (*sensors, decoy), tried
