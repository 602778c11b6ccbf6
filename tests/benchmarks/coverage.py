"""How often the interval of 95 % of a fitted parameter holds the truth, over simulated machines.

    uv run --no-sync python tests/benchmarks/coverage.py --seeds 0:200
    uv run --no-sync python tests/benchmarks/coverage.py --seeds 0:12 --only lag --check 0.85:1.0
    uv run --no-sync python tests/benchmarks/coverage.py --seeds 0:50 --tests 8 --hours 24    # as many as labs have

The machines are heat balances integrated in steps of 10 s by Heun's rule, with noise drawn sample by sample: nothing of
the library's lags or of its simulated machines takes part. What is fitted is the model that the machine has; so what is
measured are the intervals, not the choice of a model. `width`: half of the interval as a share of the truth, median
(of a time constant: of its logarithm). `open`: intervals without an end, which leave no value out; so they hold the
truth, and say nothing: what is `held` less what is `open` are those that hold it and say something. Of an interval
that is open at one end the other counts. `where told`: without those that are open. In brackets: the interval of 95 %
of the share itself, by Wilson's score. `--check` counts an open interval as one that misses.

`--ahead` asks the bands of predictions instead: of each machine one more test is locked, the probe of the others errs
by a factor that its calibration says (0.2 %, k = 1), and what counts is the share of the locked test's samples inside
of the band of 95 %, from its first minutes as measured by a right probe. `lacking`: the same with the hall left out of
a model of two effects, so that the machine has what the model has not.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from time import process_time

import numpy as np

from thermodata.modelling.compare.ahead import ahead
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.predictions.predict import predict
from thermodata.plugin import Float1D
from thermodata.schema.agreed.certainty import Z95
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

LACKING = ", lacking"  # behind a case whose model has the first of its effects alone
SCALE = 0.002  # standard uncertainty of a probe's sensitivity
FINE_S, STEP_S = 10.0, 60.0
NOISES = ("white", "slow", "both", "uneven")
INFOS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
        ChannelInfo("T_spindle", "temperature", "degC", "spindle.bearing.front"),
        ChannelInfo("T_hall", "temperature", "degC", "hall"),
    )
}
LAG = {"effect": "transfer_function", "id": "spindle", "drivers": {"u": "T_spindle"}}
CASES: Mapping[str, Sequence[Mapping[str, object]]] = {
    "lag": [LAG | {"orders": [1, 1]}],
    "direct + lag": [LAG | {"orders": [2, 1]}],
    "two lags": [LAG | {"orders": [2, 2]}],
    "two effects": [
        LAG | {"orders": [1, 1]},
        {"effect": "transfer_function", "id": "hall", "orders": [1, 1], "drivers": {"u": "T_hall"}},
    ],
}


@dataclass(frozen=True)
class Machine:
    """truth: parameter as the fit names it -> value [um/K, min]. tests: as recorded."""

    truth: Mapping[str, float]
    tests: tuple[TestData, ...]


def make_machine(case: str, noise: str, seed: int, tests: int | None = None, hours: float | None = None) -> Machine:
    """2 to 6 tests of 6 to 12 h of one machine, or so many; the same seed has the same tests for every noise."""
    rng = np.random.default_rng([seed, list(CASES).index(case)])
    fast, slow = rng.uniform(10, 40), rng.uniform(60, 150)
    sign = rng.choice([-1.0, 1.0])
    truth: dict[str, float] = {
        "lag": {"spindle.tau": rng.uniform(15, 120), "spindle.gain": sign * rng.uniform(1, 5)},
        "direct + lag": {
            "spindle.tau": slow,
            "spindle.gain": sign * rng.uniform(1, 5),
            "spindle.direct": rng.uniform(-2, 2),
        },
        "two lags": {
            "spindle.tau_1": fast,
            "spindle.tau_2": slow + 60,
            "spindle.gain_1": sign * rng.uniform(1, 4),
            "spindle.gain_2": rng.choice([-1.0, 1.0]) * rng.uniform(1, 4),
        },
        "two effects": {
            "spindle.tau": fast,
            "spindle.gain": sign * rng.uniform(1, 4),
            "hall.tau": slow,
            "hall.gain": -rng.uniform(1, 4),
        },
    }[case]
    count, length = int(rng.integers(2, 7)), float(rng.uniform(6, 12))
    drawn = np.random.default_rng([seed, list(CASES).index(case), NOISES.index(noise)])
    made = tuple(_test(truth, noise, hours or length, k, rng, drawn) for k in range(tests or count))
    return Machine(truth, made)


def _test(
    truth: Mapping[str, float], noise: str, hours: float, k: int, rng: np.random.Generator, drawn: np.random.Generator
) -> TestData:
    steps = int(hours * 3600 / STEP_S) * int(STEP_S / FINE_S)
    minutes = np.arange(steps) * FINE_S / 60.0
    speed = np.zeros(steps)  # share of the highest
    at = int(rng.integers(60, 120))
    while at < steps:
        stay = int(rng.uniform(20, 150) * 60 / FINE_S)
        speed[at : at + stay] = rng.choice([0.0, 0.0, 0.3, 0.6, 1.0])
        at += stay
    hall = rng.uniform(0.5, 2) * np.sin(2 * np.pi * (minutes / 1440 + rng.uniform())) + _wandering(steps, 90, 0.6, rng)
    hall -= hall[0]
    spindle = _heated(14 * speed**1.4, hall, 25.0)
    y = np.zeros(steps)
    for name, drive in (("spindle", spindle), ("hall", hall)):
        y += truth.get(f"{name}.direct", 0.0) * drive
        for end in ("", "_1", "_2"):
            if f"{name}.tau{end}" in truth:
                y += truth[f"{name}.gain{end}"] * _heated(np.zeros(steps), drive, truth[f"{name}.tau{end}"])
    inside = int(STEP_S / FINE_S)
    n = steps // inside
    y_60, spindle_60, hall_60 = (v.reshape(n, inside).mean(axis=1) for v in (y, spindle, hall))
    t = np.arange(n) * STEP_S
    values = {
        "dZ": y_60 + 40 * drawn.normal() + _noise(noise, n, k, drawn),
        "T_spindle": 25 + spindle_60 + drawn.normal(0, 0.02, n),
        "T_hall": 21 + hall_60 + drawn.normal(0, 0.02, n),
    }
    known = {name: np.ones(n, bool) for name in values}
    return TestData("c", f"t{k}", "other", "calibration", t, values, known, np.ones(n, bool), channels=INFOS)


def _heated(power: Float1D, around: Float1D, tau_min: float) -> Float1D:
    """tau dx/dt = power + around - x from balance, by Heun's rule in steps of FINE_S; shape (n,)."""
    target = (power + around).tolist()
    h, x, out = FINE_S / 60.0 / tau_min, 0.0, [0.0]
    for now, then in pairwise(target):
        first = h * (now - x)
        second = h * (then - x - first)
        x += (first + second) / 2
        out.append(x)
    return np.array(out)


def _noise(kind: str, n: int, k: int, rng: np.random.Generator) -> Float1D:
    """[um]. uneven: slow, and twice as large in every other test."""
    size = {"white": 0.0, "slow": 0.6, "both": 0.5, "uneven": 0.4 * (1 + k % 2)}[kind]
    white = {"white": 0.5, "slow": 0.02, "both": 0.3, "uneven": 0.1}[kind]
    memory = rng.uniform(10, 60)  # [min]
    return rng.normal(0, white, n) + (_wandering(n, memory * 60 / STEP_S, size, rng) if size else 0.0)


def _wandering(n: int, memory: float, size: float, rng: np.random.Generator) -> Float1D:
    """A stationary Ornstein-Uhlenbeck process. memory: in samples; size: its standard deviation."""
    keep = float(np.exp(-1.0 / memory))
    x, out = float(rng.normal()), []
    for step in rng.normal(0, np.sqrt(1 - keep**2), n).tolist():
        out.append(x)
        x = keep * x + step
    return size * np.array(out)


@dataclass(frozen=True)
class Seen:
    """One parameter of one machine. width: half the interval as a share of the truth, inf where it is open, None where
    there is none."""

    case: str
    noise: str
    tests: int
    parameter: str
    inside: bool
    width: float | None
    seconds: float


def intervals(case: str, noise: str, seed: int, tests: int | None = None, hours: float | None = None) -> Iterator[Seen]:
    machine = make_machine(case, noise, seed, tests, hours)
    data = Dataset(STEP_S, machine.tests, INFOS)
    spec = {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": "60 s"}
    model = Model.model_validate(spec | {"response": {"axis": "Z"}, "effects": CASES[case]})
    began = process_time()
    found = fit_model(model, data).parameters()
    seconds = process_time() - began
    for name, true in machine.truth.items():
        p = found[name]
        kind = name.partition("_")[0]  # two lags of one driver are one kind
        inside = (p.low is None or p.low <= true) and (p.high is None or true <= p.high)
        if p.low is None or p.high is None:
            known = p.low is not None or p.high is not None
            yield Seen(case, noise, len(machine.tests), kind, known and inside, np.inf if known else None, seconds)
            continue
        half = np.log(p.high / p.low) / 2 if kind.endswith(".tau") else (p.high - p.low) / 2 / abs(true)
        yield Seen(case, noise, len(machine.tests), kind, inside, float(half), seconds)


@dataclass(frozen=True)
class Foretold:
    """A locked test. inside: share of its samples in the band; half: median half width; rmse: of what is left [um]."""

    case: str
    noise: str
    inside: float
    half: float
    rmse: float


def foretold(case: str, noise: str, seed: int, tests: int | None = None, hours: float | None = None) -> Foretold | None:
    """None where the model has no band."""
    machine = make_machine(case.removesuffix(LACKING), noise, seed, (tests or 4) + 1, hours)
    factor = 1.0 + SCALE * float(np.random.default_rng([seed, 99]).normal())
    info = replace(INFOS["dZ"], scale_pct=100 * SCALE)
    *fitted, last = machine.tests
    scaled = [replace(t, values={**t.values, "dZ": factor * t.values["dZ"]}) for t in fitted]
    last = replace(last, role="locked")
    made = tuple(replace(t, channels={**INFOS, "dZ": info}) for t in (*scaled, last))
    data = Dataset(STEP_S, made, INFOS)
    effects = CASES[case.removesuffix(LACKING)]
    spec = {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": "60 s"}
    kept = effects[:1] if case.endswith(LACKING) else effects
    model = fit_model(Model.model_validate(spec | {"response": {"axis": "Z"}, "effects": kept}), data)
    band = ahead(model, data)
    p = next(band.of(p) for p in predict(model, data)[0] if p.test == last.test)
    if p.half is None:
        return None
    gap = last.values["dZ"] - p.predicted
    gap = gap - gap[last.t_s < last.zero_s].mean()
    inside = float(np.mean(np.abs(gap) <= p.half))
    return Foretold(case, noise, inside, float(np.median(p.half)), float(np.sqrt(np.mean(gap**2))))


def table_ahead(found: Sequence[Foretold]) -> list[str]:
    lines = [
        "| case | noise | tests | inside [%] | tests with 90 % inside [%] | half [um] | left [um] |",
        "|---" * 7 + "|",
    ]
    keys = [
        *dict.fromkeys((f.case, f.noise) for f in found),
        *((c, "all") for c in dict.fromkeys(f.case for f in found)),
    ]
    for case, noise in [*keys, ("all", "all")]:
        own = [f for f in found if case in (f.case, "all") and noise in (f.noise, "all")]
        most = sum(f.inside >= 0.9 for f in own)
        half, left = (float(np.median([getattr(f, k) for f in own])) for k in ("half", "rmse"))
        inside = 100 * float(np.mean([f.inside for f in own]))
        lines.append(
            f"| {case} | {noise} | {len(own)} | {inside:.1f} | {_of(most, len(own))} | {half:.3g} | {left:.3g} |"
        )
    return lines


def table(seen: Sequence[Seen]) -> list[str]:
    lines = [
        "| case | noise | parameter | machines | held [%] | open [%] | where told [%] | width | ms a fit |",
        "|---" * 9 + "|",
    ]
    keys = dict.fromkeys((s.case, s.noise, s.parameter) for s in seen)
    rows = [(key, [s for s in seen if (s.case, s.noise, s.parameter) == key]) for key in keys]
    rows += [
        ((case, "all", "all"), [s for s in seen if s.case == case]) for case in dict.fromkeys(s.case for s in seen)
    ]
    few = [s for s in seen if s.tests <= 3]
    for case, noise in dict.fromkeys((s.case, s.noise) for s in seen):
        rows.append(((case, noise, "all"), [s for s in seen if (s.case, s.noise) == (case, noise)]))
    for noise in dict.fromkeys(s.noise for s in seen):
        rows.append((("all", noise, "all"), [s for s in seen if s.noise == noise]))
    rows += [(("all", "all", "all"), list(seen)), (("all", "2 or 3 tests", "all"), few)]
    for (case, noise, parameter), own in rows:
        if not own:
            continue
        widths = [s.width for s in own if s.width is not None]
        inside, none = sum(s.inside for s in own), len(own) - len(widths)
        lines.append(
            f"| {case} | {noise} | {parameter} | {len(own)} | {_of(inside + none, len(own))} "
            f"| {100 * none / len(own):.1f} | {_of(inside, len(widths))} "
            f"| {np.median(widths) if widths else float('nan'):.3f} "
            f"| {1000 * float(np.median([s.seconds for s in own])):.0f} |"
        )
    return lines


def _of(hits: int, count: int) -> str:
    """A share with Wilson's interval of 95 % [%]."""
    if not count:
        return "-"
    share, z2 = hits / count, Z95**2
    middle = (share + z2 / 2 / count) / (1 + z2 / count)
    half = Z95 * np.sqrt(share * (1 - share) / count + z2 / 4 / count**2) / (1 + z2 / count)
    return f"{100 * share:.1f} ({100 * (middle - half):.1f}-{100 * (middle + half):.1f})"


def _share(seen: Sequence[Seen]) -> float:
    return sum(s.inside for s in seen) / max(1, len(seen))


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="0:200", help="FROM:TO, one machine each")
    parser.add_argument("--only", choices=list(CASES), action="append")
    parser.add_argument("--noise", choices=NOISES, action="append")
    parser.add_argument("--tests", type=int, help="of each machine (default: 2 to 6)")
    parser.add_argument("--hours", type=float, help="of each test (default: 6 to 12)")
    parser.add_argument("--check", help="LOW:HIGH, shares that the truth must lie in the intervals, else exit code 1")
    parser.add_argument("--ahead", action="store_true", help="bands of predictions on a locked test, not intervals")
    given = parser.parse_args(words)
    first, last = map(int, given.seeds.split(":"))
    if given.ahead:
        asked = (
            foretold(case, noise, seed, given.tests, given.hours)
            for case in given.only or [*CASES, f"two effects{LACKING}"]
            for noise in given.noise or NOISES
            for seed in range(first, last)
        )
        ahead_of = [one for one in asked if one is not None]
        print("\n".join(table_ahead(ahead_of)))
        share = float(np.mean([f.inside for f in ahead_of]))
        low, high = map(float, (given.check or "0:1").split(":"))
        return 0 if low <= share <= high else 1
    seen = [
        one
        for case in given.only or CASES
        for noise in given.noise or NOISES
        for seed in range(first, last)
        for one in intervals(case, noise, seed, given.tests, given.hours)
    ]
    print("\n".join(table(seen)))
    if given.check is None:
        return 0
    low, high = map(float, given.check.split(":"))
    return 0 if low <= _share(seen) <= high else 1


if __name__ == "__main__":
    sys.exit(main())
