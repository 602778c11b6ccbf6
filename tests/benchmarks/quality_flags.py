"""Flags on sound channels, and on the same with one defect each: how many are false, how many are found.

    uv run python tests/benchmarks/quality_flags.py [--sealed] [--machines 20]

A machine of numbers of its own (no part of `thermodata.virtual`): a spindle that works in blocks and shifts by
centrifugal force, parts with two time constants, a heater, a chiller, air with draughts, a set point, gauges of four
kinds; logged every 1 to 60 s for 4 to 10 h, with jitter, lost samples and pauses in which the machine works on.

Rules are made on the first seeds; the sealed ones (100,000 and up) were opened once they were frozen.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.between_tests.failing import offsets_between_tests
from thermodata.calibration.between_tests.foreign import foreign_part
from thermodata.calibration.between_tests.levels import POINTS, Course, Levels
from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.flags import flag_stream
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.flag import INVALID, Flag

SEALED = 100_000


@dataclass(frozen=True)
class Recording:
    """t_s: shape (n,). columns: channel -> (quantity, values)."""

    t_s: Float1D
    columns: dict[str, tuple[str, Float1D]]

    def flags(self, **changed: Array) -> dict[str, Array]:
        t_ns: Int1D = 1_750_000_000_000_000_000 + np.rint(self.t_s * 1e9).astype(np.int64)
        columns = {n: ColumnInput(changed.get(n, x), q) for n, (q, x) in self.columns.items()}
        return flag_stream(t_ns, columns)[0]


def lag(u: Float1D, dt: Float1D, tau_s: float, start: float = 0.0) -> Float1D:
    x, level = np.empty(len(u)), start
    for i, (value, step) in enumerate(zip(u, dt, strict=True)):
        level += (value - level) * (1 - np.exp(-step / tau_s))
        x[i] = level
    return x


def read(x: Float1D, tread: float) -> Float1D:
    return np.asarray(np.round(x / tread) * tread)


def record(rng: np.random.Generator, hours: float | None = None, step_s: float | None = None) -> Recording:
    """One sound test."""
    step_s = step_s or float(rng.choice([1.0, 5.0, 15.0, 60.0]))
    hours = hours or float(rng.uniform(4, 10)) * (0.5 if step_s == 1.0 else 1.0)
    n = int(hours * 3600 / step_s)
    # the machine runs on a grid of its own; a logger misses some of it
    dt = np.full(n, step_s)
    block = rng.choice([0.0, 0.0, 1500.0, 3000.0, 6000.0, 9000.0], size=max(2, int(hours * 3)))
    speed = np.repeat(block, -(-n // len(block)))[:n]
    u = (speed / 9000) ** 1.5
    hall = 21 + 0.8 * np.sin(np.arange(n) * step_s / 20_000 + rng.uniform(0, 6)) + np.cumsum(rng.normal(0, 0.003, n))
    heat = 0.6 * lag(u, dt, rng.uniform(600, 2400)) + 0.4 * lag(u, dt, rng.uniform(5000, 15_000))
    draughts = np.zeros(n)
    for at in rng.integers(5, n - 5, n // 80):
        draughts[at : at + rng.integers(1, 6)] += rng.exponential(0.4)
    heater_on = (np.arange(n) * step_s % 2400 < rng.uniform(500, 1500)).astype(float)
    chiller = 18 + 2.2 * (np.arange(n) * step_s % 1500 < 700) * lag(np.ones(n), dt, 60.0)
    growth = 35 * heat + 1.2 * (hall - hall[0]) + rng.uniform(2, 8) * (speed / 9000) ** 2
    noise = rng.normal
    columns: dict[str, tuple[str, Float1D]] = {
        "T_bearing": ("temperature", hall + 22 * heat + noise(0, 0.04, n)),
        "T_motor_1K": ("temperature", read(hall + 30 * heat + noise(0, 0.2, n), 1.0)),
        "T_column_01K": ("temperature", read(hall + 3 * lag(heat, dt, 4000.0) + noise(0, 0.05, n), 0.1)),
        "T_bed": ("temperature", lag(hall, dt, 9000.0, hall[0]) + noise(0, 0.02, n)),
        "T_air": ("temperature", hall + draughts + noise(0, 0.08, n)),
        "T_heater": ("temperature", hall + 45 * lag(heater_on, dt, rng.uniform(60, 500)) + noise(0, 0.1, n)),
        "T_chiller": ("temperature", chiller + noise(0, 0.05, n)),
        "T_set": ("temperature", np.repeat(rng.choice([20.0, 22.0, 30.0, 45.0], 4), -(-n // 4))[:n]),
        "dX_fine": ("displacement", 0.3 * growth + noise(0, 0.15, n)),
        "dY_tread": ("displacement", read(0.6 * growth + noise(0, rng.choice([0.03, 0.3]), n), 2.0)),
        "dZ_counts": (
            "displacement",
            read(read(growth + noise(0, rng.choice([0.03, 0.1]), n), 2.0) + noise(0, 0.1, n), 0.086),
        ),
        "dZ_smooth": ("displacement", growth + 0.005 * np.cumsum(noise(0, 1, n)) / 30),
        "speed": ("rotational_speed", speed),
    }
    kept = rng.random(n) > 0.002
    if rng.random() < 0.6:  # nobody logs while the machine works on
        a = int(rng.uniform(0.2, 0.7) * n)
        kept[a : a + int(rng.uniform(60, 5400) / step_s)] = False
    t_s = np.arange(n) * step_s + rng.uniform(0, 0.1 * step_s, n)
    return Recording(t_s[kept], {k: (q, x[kept]) for k, (q, x) in columns.items()})


def sound(seeds: range) -> tuple[int, int, Counter[str]]:
    """(channels, channels with a flag that rules samples out, what was flagged)."""
    channels, false, kinds = 0, 0, Counter[str]()
    for seed in seeds:
        r = record(np.random.default_rng(seed))
        for name, flags in r.flags().items():
            channels += 1
            wrong = int(np.bitwise_or.reduce(flags)) & int(INVALID)
            false += wrong > 0
            kinds.update(f"{name} {f.name}" for f in Flag if f and wrong & f)
    return channels, false, kinds


Defect = Callable[[np.random.Generator, Recording], tuple[str, Array, slice, Flag]]


def spike(rng: np.random.Generator, r: Recording) -> tuple[str, Array, slice, Flag]:
    name = str(rng.choice(["dX_fine", "dZ_counts", "dY_tread", "T_bearing", "T_motor_1K"]))
    x, at = r.columns[name][1].copy(), int(rng.integers(50, len(r.t_s) - 50))
    x[at : at + 2] += rng.choice([-1, 1]) * rng.uniform(30, 200)
    return name, x, slice(at, at + 2), Flag.SPIKE


def offset(rng: np.random.Generator, r: Recording) -> tuple[str, Array, slice, Flag]:
    name = str(rng.choice(["T_bearing", "T_column_01K", "T_bed", "T_motor_1K"]))
    x, at = r.columns[name][1].copy(), int(rng.uniform(0.3, 0.8) * len(r.t_s))
    x[at:] += rng.choice([-1, 1]) * rng.uniform(25, 60)
    return name, x, slice(at, None), Flag.OFFSET


def held(rng: np.random.Generator, r: Recording) -> tuple[str, Array, slice, Flag]:
    name = str(rng.choice(["dX_fine", "T_bearing", "T_bed"]))
    x, at = r.columns[name][1].copy(), int(rng.uniform(0.2, 0.6) * len(r.t_s))
    stop = at + max(60, int(0.1 * len(x)))
    x[at:stop] = x[at]
    return name, x, slice(at, stop), Flag.HELD


def stood(rng: np.random.Generator, r: Recording) -> tuple[str, Array, slice, Flag]:
    """Whole kelvins within 1 K for most of the test, then what the motor really has; only where that is far away."""
    name, n = "T_motor_1K", len(r.t_s)
    x, at = r.columns[name][1].copy(), int(0.7 * n)
    x[:at] = np.round(21.5 + 0.2 * np.sin(np.arange(at) / 50) + rng.normal(0, 0.05, at))
    x[at:] = np.round(np.maximum(x[at:], 21) + 17)
    return name, x, slice(0, at), Flag.HELD | Flag.OFFSET


def found(seeds: range, make: Defect) -> tuple[int, int]:
    """(defects, those of which most samples have the flag)."""
    hits = 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        r = record(rng)
        name, x, where, flag = make(rng, r)
        flags = r.flags(**{name: x})[name]
        share = np.mean((flags[where] & np.uint16(flag)) != 0)
        if make is stood:  # before or after the jump: either side is told
            share = max(share, np.mean((flags[where.stop :] & np.uint16(flag)) != 0))
        hits += share > 0.5
    return len(seeds), hits


def levels(name: str, r: Recording, start_s: float | None, wrong: dict[str, Float1D | float]) -> Levels:
    rows = np.linspace(0, len(r.t_s) - 1, POINTS).astype(int)
    series = {
        n: Course(r.t_s[rows], x[rows] + np.broadcast_to(wrong.get(n, 0.0), len(x))[rows], q)
        for n, (q, x) in r.columns.items()
        if q in ("temperature", "displacement")
    }
    gaps = np.flatnonzero(np.diff(r.t_s) > 5 * np.median(np.diff(r.t_s)))
    pauses = [(float(r.t_s[g]), float(r.t_s[g + 1])) for g in gaps]
    return Levels(name, start_s, None if start_s is None else start_s + r.t_s[-1], series, pauses)


def campaign(seed: int, *, dated: bool, drifts: bool = False, foreign: bool = False) -> tuple[int, int, int]:
    """(channels that are flagged rightly, that are flagged wrongly, parts that are called foreign) of six tests."""
    rng = np.random.default_rng(seed)
    broken, size = str(rng.choice(["T_bearing", "T_column_01K", "T_bed"])), float(rng.choice([-1, 1]) * 30)
    tests = []
    for k in range(6):
        r = record(rng, step_s=15.0)
        n = len(r.t_s)
        wrong: dict[str, Float1D | float] = {}
        if drifts and k >= 3:
            begin = rng.uniform(0.3, 0.8) * n
            wrong[broken] = size * np.clip((np.arange(n) - begin) / (0.1 * n), 0, 1) if k == 3 else size
        if foreign and k == 4:
            later = r.t_s > 0.75 * r.t_s[-1]
            wrong |= dict.fromkeys(r.columns, 70.0 * later)
            r = Recording(r.t_s + 900.0 * later, r.columns)
        tests.append(levels(f"t{k}", r, k * 86_400.0 if dated else None, wrong))
    off = offsets_between_tests(tests)
    want = {(f"t{k}", broken) for k in (3, 4, 5)} if drifts else set()
    parts = [t.test for t in tests if foreign_part(t) is not None]
    return len(want & set(off)), len(set(off) - want), len(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sealed", action="store_true")
    parser.add_argument("--machines", type=int, default=20)
    args = parser.parse_args()
    first = SEALED if args.sealed else 0
    seeds = range(first, first + args.machines)
    channels, false, kinds = sound(seeds)
    print(f"sound channels {channels}, with a false flag {false}: {dict(kinds) or 'none'}")
    for make in (spike, offset, held, stood):
        count, hits = found(seeds, make)
        print(f"{make.__name__}: found {hits} of {count}")
    for dated in (True, False):
        told = "with dates" if dated else "without dates"
        plain = np.array([campaign(s, dated=dated) for s in seeds])
        drifting = np.array([campaign(s, dated=dated, drifts=True) for s in seeds])
        print(
            f"{told}: {len(seeds)} sound campaigns of 6 tests: {plain[:, 1].sum()} false offsets, {plain[:, 2].sum()} "
            f"foreign parts; with a drift of 30 K from the fourth test on: {drifting[:, 0].sum()} of {3 * len(seeds)} "
            f"tests found, {drifting[:, 1].sum()} false"
        )
    parts = np.array([campaign(s, dated=False, foreign=True) for s in seeds])
    print(f"a foreign part in one of 6 tests: {(parts[:, 2] > 0).sum()} of {len(seeds)} found")


if __name__ == "__main__":
    main()
