"""Identification beside peers, on the same data, in one run: FIT of a free run on a test that no fit has seen.

    uv run --with sippy-unipi --with sysidentpy --with pastas --with statsmodels python tests/benchmarks/identify.py
    uv run --no-sync python tests/benchmarks/identify.py --joint 10 100     # how long joint fits take

Two true lags, 20 min and 3 h, 24 h at 1 Hz, 0.3 um of white noise, the temperature logged in steps of 0.1 K; or, with
`--machine`, others. A peer that is not installed is left out, and the table says so. Each has the same columns,
relative to the start. The input of SIPPY's ARX acts a step late: it is run as it is and with its input a step ahead,
ours at once and a step late, so that each stands beside its like. FIT is printed with both conventions of an offset:
from the first 10 min (what a control can know), and the best one (what papers often print). Processor time is that of
identification and free run, without the imports.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import joint_fit
import numpy as np
import peers

from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.predictions.score import fit_percent
from thermodata.plugin import Float1D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

# a script of this folder has the name of a package that SIPPY stands on
sys.path.remove(str(Path(__file__).resolve().parent))

HOURS = 24
ZERO_S = 600.0
MEMORY_S = 2400.0  # of slow noise
INFOS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
    "T": ChannelInfo("T", "temperature", "degC", "spindle.bearing"),
}


@dataclass(frozen=True)
class Made:
    """lags: (um/K, s); direct: um/K; white, slow: standard deviations of the noise [um], the slow one with a memory of
    40 min; step_k: of the temperature's digits."""

    lags: tuple[tuple[float, float], ...]
    direct: float = 0.0
    white: float = 0.3
    slow: float = 0.0
    step_k: float = 0.1


MACHINES = {
    "two lags": Made(((1.2, 1200.0), (2.0, 10800.0))),
    "direct": Made(((3.5, 5400.0),), direct=-1.5, step_k=0.01),
    "slow noise": Made(((1.5, 600.0), (2.5, 7200.0)), white=0.1, slow=0.8),
}


@dataclass(frozen=True)
class Record:
    """u: temperature from the start [K]; y: displacement [um]; both shape (n,), a sample a step_s."""

    u: Float1D
    y: Float1D
    step_s: float


@dataclass(frozen=True)
class Row:
    """fit_zero, fit_free: FIT [%] on the unseen test, offset from the first 10 min, or the best. seconds: processor
    time of identification and free run. why: in place of figures."""

    who: str
    method: str
    step_s: float
    fit_zero: float | None = None
    fit_free: float | None = None
    seconds: float | None = None
    why: str | None = None


def record(seed: int, step_s: float, machine: str = "two lags") -> Record:
    """A spindle spectrum: speeds of 10 min to 2 h, after 10 min of idling."""
    made, rng = MACHINES[machine], np.random.default_rng(seed)
    n, at = HOURS * 3600, 600
    heat = np.zeros(n)
    while at < n:
        length = int(rng.uniform(600, 7200))
        heat[at : at + length] = rng.choice([0.0, 6.0, 12.0])
        at += length
    warm = lag(heat, 900.0, 1.0)
    y = sum(gain * lag(warm, tau, 1.0) for gain, tau in made.lags) + made.direct * warm + rng.normal(0, made.white, n)
    if made.slow:
        # white noise through a lag has 1 / sqrt(2 tau / h) of its size left
        y = y + made.slow * np.sqrt(2 * MEMORY_S) * lag(rng.normal(0, 1, n), MEMORY_S, 1.0)
    read = np.round((22 + warm) / made.step_k) * made.step_k - 22
    width = int(step_s)
    u, y = (v[: n // width * width].reshape(-1, width).mean(axis=1) for v in (read, np.asarray(y)))
    return Record(u - u[0], y, step_s)


def ours(method: str, orders: tuple[int, int] | None, **more: int) -> Callable[[Record, Record], Float1D]:
    """The free run of a fit by this program; coefficients, as everybody counts them."""

    def run(train: Record, unseen: Record) -> Float1D:
        tests = tuple(_as_test(name, r) for name, r in (("train", train), ("unseen", unseen)))
        effect = {"effect": "transfer_function", "drivers": {"u": "T"}, "method": method, "orders": orders} | more
        spec = {"schema": "thermodata/model/1", "name": "m", "campaign": "c", "step": f"{train.step_s:g} s"}
        spec |= {"response": {"channel": "dZ"}, "calibrate_on": ["train"], "verify_on": ["unseen"], "effects": [effect]}
        data = Dataset(train.step_s, tests, INFOS)
        return fit_model(Model.model_validate(spec), data, uncertainty=False).responses[0].predict(tests[1])

    return run


def _part(r: Record, n: int) -> Record:
    return Record(r.u[:n], r.y[:n], r.step_s)


def _as_test(name: str, r: Record) -> TestData:
    n = len(r.y)
    valid = {k: np.ones(n, bool) for k in INFOS}
    t_s = np.arange(n) * r.step_s
    values = {"dZ": r.y, "T": 22.0 + r.u}
    return TestData("c", name, "spectrum", "none", t_s, values, valid, np.ones(n, bool), channels=INFOS)


METHODS: list[tuple[str, str, Callable[[Record, Record], Float1D]]] = [
    ("thermodata", "sum of 2 lags", ours("varpro", (2, 2))),
    ("thermodata", "OE(2,2)", ours("oe", (2, 2))),
    ("thermodata", "ARX(2,2), at once", ours("arx", (2, 2), delay=0)),
    ("thermodata", "ARX(2,2), a step late", ours("arx", (2, 2), delay=1)),
    ("thermodata", "ARX(2,2)", ours("arx", (2, 2))),
    ("thermodata", "ARX(4,4), at once", ours("arx", (4, 4), delay=0)),
    ("thermodata", "ARX(4,4), a step late", ours("arx", (4, 4), delay=1)),
    ("thermodata", "ARX(4,4)", ours("arx", (4, 4))),
    ("thermodata", "ARX, orders chosen", ours("arx", None)),
    *((who, method, run) for who, method, run in peers.METHODS),
]


def measured(who: str, method: str, run: Callable[[Record, Record], Float1D], train: Record, unseen: Record) -> Row:
    """One way on one pair of tests."""
    row = Row(who, method, train.step_s)
    start = time.process_time()
    try:
        predicted = np.asarray(run(train, unseen), dtype=np.float64)
    except ModuleNotFoundError as error:
        return Row(**{**asdict(row), "why": f"not installed: {error}"})
    except Exception as error:  # a peer may raise anything, and the table goes on
        return Row(**{**asdict(row), "why": f"{type(error).__name__}: {str(error)[:80]}"})
    seconds = time.process_time() - start
    if predicted.shape != unseen.y.shape or not np.isfinite(predicted).all():
        return Row(**{**asdict(row), "why": "its free run is not finite", "seconds": seconds})
    left = unseen.y - predicted
    first = np.arange(len(left)) * train.step_s < ZERO_S
    zero, free = (fit_percent(unseen.y, left - offset) for offset in (left[first].mean(), left.mean()))
    return Row(who, method, train.step_s, zero, free, seconds)


def main() -> None:
    """Print the table; medians over seeds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=float, nargs="+", default=[60.0, 1.0], help="[s]")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--machine", choices=list(MACHINES), default="two lags")
    parser.add_argument("--methods", default="", help="those alone whose name begins so: ARX")
    parser.add_argument("--only", help="of one of: " + ", ".join(dict.fromkeys(who for who, *_ in METHODS)))
    parser.add_argument("--joint", type=int, nargs="+", metavar="TESTS", help="joint fits of so many days instead")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if given.joint:
        found = joint_fit.rows(
            given.joint, 1, lambda row: None if given.json else print(joint_fit.line(row), flush=True)
        )
        if given.json:
            print(json.dumps([asdict(row) for row in found]))
        return
    rows = []
    for who, method, run in METHODS:  # imports, and what compiles at its first use
        if given.only in (None, who):
            measured(who, method, run, *(_part(record(k, 60.0), 600) for k in (0, 1)))
    for step_s in given.steps:
        pairs = [tuple(record(2 * k + j, step_s, given.machine) for j in (0, 1)) for k in range(given.seeds)]
        for who, method, run in METHODS:
            if given.only in (None, who) and method.startswith(given.methods):
                rows.append(_median([measured(who, method, run, *pair) for pair in pairs]))
                if not given.json:
                    print(_line(rows[-1]), flush=True)
    if given.json:
        print(json.dumps([asdict(row) for row in rows]))


def _median(rows: list[Row]) -> Row:
    bad = next((row for row in rows if row.why), None)
    if bad is not None:
        return bad
    middle = {k: float(np.median([getattr(r, k) for r in rows])) for k in ("fit_zero", "fit_free", "seconds")}
    return Row(rows[0].who, rows[0].method, rows[0].step_s, **middle)


def _line(row: Row) -> str:
    head = f"{row.step_s:5g} s  {row.who:12} {row.method:23}"
    if row.why:
        return f"{head} {row.why}"
    return f"{head} FIT {row.fit_zero:8.1f} from zero, {row.fit_free:8.1f} free; {row.seconds:8.3f} s of processor"


if __name__ == "__main__":
    main()
