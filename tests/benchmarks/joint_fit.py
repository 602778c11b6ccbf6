"""How long joint fits of many tests take: processor time with intervals and checks, beside the truth.

On one core, as the commands fit: with two, threads that wait for each other count as well, up to four times as much.

    uv run --no-sync python tests/benchmarks/joint_fit.py                      # ten and a hundred days, 43 short tests
    uv run --no-sync python tests/benchmarks/joint_fit.py --days 10 100 1000   # 1,000: 3 GB of memory

Days: tests of 24 h at 60 s, six effects of the library (five time constants, six gains). Short: 43 tests of 6 h as a
lathe logs them, temperatures in steps of 0.1 K, displacement in treads of 2 um, twelve minutes of each without a log;
two effects, and two functions whose orders are chosen. Times are medians over runs; memory is the process's most.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP_S = 60.0
SHORT = 43
INFOS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
        ChannelInfo("T_bearing", "temperature", "degC", "spindle.bearing.front"),
        ChannelInfo("T_nut", "temperature", "degC", "axis.z.nut"),
        ChannelInfo("T_tool", "temperature", "degC", "tool"),
        ChannelInfo("T_hall", "temperature", "degC", "hall"),
        ChannelInfo("speed", "rotational_speed", "rpm", "spindle"),
        ChannelInfo("coolant_on", "state", "1", "coolant.supply"),
    )
}
SIX = ("spindle_bearing", "feed_screw", "tool_elongation", "ambient_frame", "centrifugal_shift", "coolant")
TRUTH = {  # um/K, min
    "spindle_bearing.gain": 1.5,
    "spindle_bearing.tau": 20.0,
    "feed_screw.gain": 2.0,
    "feed_screw.tau": 90.0,
    "ambient_frame.gain": -3.0,
    "ambient_frame.tau": 240.0,
    "coolant.tau": 30.0,
}


@dataclass(frozen=True)
class Row:
    """seconds: processor time; worst: largest error of a known parameter, as a share of it; megabytes: of memory."""

    what: str
    tests: int
    samples: int
    seconds: float
    worst: float | None
    megabytes: int


def day(k: int) -> TestData:
    """24 h in which everything works at random, after ten minutes of rest."""
    rng = np.random.default_rng(k)
    n = 24 * 60 + 1
    t = np.arange(n) * STEP_S
    speed, feed = _blocks(rng, n, [0, 3000, 6000, 9000], 60), _blocks(rng, n, [0, 1], 90)
    cool, cut = _blocks(rng, n, [0, 1], 120), _blocks(rng, n, [0, 0, 1], 20)
    bearing, nut, tool = 3e-3 * lag(speed, 900, STEP_S), 8 * lag(feed, 2400, STEP_S), 15 * lag(cut, 120, STEP_S)
    hall = _hall(rng, t)
    y = 1.5 * lag(bearing, 1200, STEP_S) + 2.0 * lag(nut, 5400, STEP_S) - 1.7 * lag(tool, 180, STEP_S)
    y += -3.0 * lag(hall, 14400, STEP_S) - 8.0 * (speed / 1e4) ** 2 + 6.0 * lag(cool, 1800, STEP_S)
    values = {"dZ": y + rng.normal(0, 0.3, n) + rng.normal(0, 20), "speed": speed, "coolant_on": cool}
    for name, start, warm in (("bearing", 22, bearing), ("nut", 21, nut), ("tool", 21, tool), ("hall", 20, hall)):
        values[f"T_{name}"] = start + warm + rng.normal(0, 0.02, n)
    return _test(f"d{k}", t, values, np.ones(n, bool))


def short(k: int) -> TestData:
    """6 h of a lathe: a lag at the bearing, two of the hall's air, readings in steps, and slow noise."""
    rng = np.random.default_rng(10_000 + k)
    n = 6 * 60 + 1
    t = np.arange(n) * STEP_S
    bearing, hall = 3e-3 * lag(_blocks(rng, n, [0, 0, 1500, 3000], 45), 900, STEP_S), _hall(rng, t)
    y = 2.5 * lag(bearing, 1500, STEP_S) - 1.5 * lag(hall, 900, STEP_S) - 2.0 * lag(hall, 10800, STEP_S)
    y += rng.normal(0, 0.5, n) + 2.0 * lag(rng.normal(0, 1, n), 3000, STEP_S)
    values = {
        "dZ": np.round(y / 2) * 2 + rng.normal(0, 20),
        "T_bearing": np.round((22 + bearing) * 10) / 10,
        "T_hall": np.round((20 + hall) * 10) / 10,
    }
    logged = np.ones(n, bool)
    gap = int(rng.integers(0, n - 12))
    logged[gap : gap + 12] = False
    return _test(f"s{k}", t, {name: np.where(logged, v, np.nan) for name, v in values.items()}, logged)


def _blocks(rng: np.random.Generator, n: int, choices: Sequence[float], length: int) -> Float1D:
    out = np.repeat(rng.choice(choices, n // length + 1), length)[:n].astype(np.float64)
    out[:10] = 0.0
    return out


def _hall(rng: np.random.Generator, t_s: Float1D) -> Float1D:
    phase = rng.uniform()
    return np.asarray(2 * (np.sin(2 * np.pi * (t_s / 86400 + phase)) - np.sin(2 * np.pi * phase)))


def _test(name: str, t_s: Float1D, values: Mapping[str, Float1D], logged: Bool1D) -> TestData:
    channels = {c: INFOS[c] for c in values}
    valid = dict.fromkeys(values, logged)
    return TestData(
        "c", name, "other", "calibration", t_s, dict(values), valid, np.ones(len(t_s), bool), {}, "m1", channels
    )


def measured(
    what: str, effects: Sequence[object], tests: Sequence[TestData], runs: int, truth: Mapping[str, float] | None = None
) -> Row:
    model = Model.model_validate(
        {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": "60 s"}
        | {"response": {"axis": "Z", "at": "tcp"}, "effects": list(effects)}
    )
    data = Dataset(STEP_S, tuple(tests), INFOS)
    seconds = []
    for _ in range(runs):
        began = time.process_time()
        found = fit_model(model, data).parameters()
        seconds.append(time.process_time() - began)
    wrong = [abs(found[name].value / true - 1) for name, true in (truth or {}).items()]
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    samples = sum(int(np.isfinite(t.values["dZ"]).sum()) for t in tests)
    return Row(what, len(tests), samples, float(np.median(seconds)), max(wrong, default=None), most)


def rows(days: Sequence[int], runs: int, say: Callable[[Row], None]) -> list[Row]:
    """Of all sizes; each is said as soon as it is measured."""
    measured("warm up", [{"effect": e} for e in SIX], [day(k) for k in range(2)], 1)  # imports
    functions = [
        {"effect": "transfer_function", "id": "bearing", "drivers": {"u": "T_bearing"}},
        {"effect": "transfer_function", "id": "hall", "drivers": {"u": "T_hall"}},
    ]
    lathe = [short(k) for k in range(SHORT)]
    found = []
    for what, effects in (
        ("6 h, two effects", [{"effect": "spindle_bearing"}, {"effect": "ambient_frame"}]),
        ("6 h, two functions, orders chosen", functions),
    ):
        found.append(measured(what, effects, lathe, runs))
        say(found[-1])
    for count in sorted(days):
        tests = [day(k) for k in range(count)]
        found.append(
            measured("24 h, six effects", [{"effect": e} for e in SIX], tests, runs if count < 500 else 1, TRUTH)
        )
        say(found[-1])
    return found


def line(row: Row) -> str:
    worst = "" if row.worst is None else f", parameters within {100 * row.worst:.2g} %"
    return (
        f"{row.tests:5d} tests of {row.what:34} {row.samples:8d} samples {row.seconds:7.2f} s of processor, "
        f"{1000 * row.seconds / row.tests:6.1f} ms a test, {row.megabytes} MB{worst}"
    )


def main() -> None:
    """Print a line a size."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, nargs="*", default=[10, 100], help="numbers of tests of 24 h")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    found = rows(given.days, given.runs, lambda row: None if given.json else print(line(row), flush=True))
    if given.json:
        print(json.dumps([asdict(row) for row in found]))


if __name__ == "__main__":
    main()
