"""At which limits two exchanged temperatures are told, and what is told of sound machines (docs/artefacts.md).

    python exchanged_sensors.py --first-seed 2790 --seeds 4 --limits DROP LEFT

Machines of both kinds. On each, two temperatures drawn at random are exchanged in one test that is drawn, too, as often
as asked (`--draws`): whether both move there, and whether anything foretells them, is left to chance. Two that are as
good as one (RMS of their difference in that test under 0.5 K) can't be told and count by themselves.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from loose_sensors import instead, machines
from measure import table
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.sensors import exchanged
from thermodata.diagnosis.sensors import temperature_sums as sums
from thermodata.view.grid.dataset import Dataset

LIMITS = {
    "DROP": (0.6, 0.7, 0.8, 0.9),
    "EACH": (0.3, 0.5, 0.7),
    "LEFT": (0.15, 0.3, 0.5),
    "APART": (0.25, 0.5, 0.75),
    "LEAST_K": (0.25, 0.5, 1.0),
}


@dataclass(frozen=True, slots=True)
class Made:
    """A machine with two temperatures exchanged in a test. apart: RMS of their difference there [K], each about its
    mean."""

    data: Dataset
    names: frozenset[str]
    test: str
    apart: float


def made(data: Dataset, rng: np.random.Generator) -> Made | None:
    names = sums.TemperatureSums(data, data.tests, "").names
    test = data.tests[int(rng.integers(len(data.tests)))]
    there = [n for n in names if n in test.values and np.isfinite(test.values[n]).any()]
    if len(there) < 2:
        return None
    a, b = rng.choice(there, 2, replace=False).tolist()
    values, valid = dict(test.values), dict(test.valid)
    values[a], values[b] = values[b], values[a]
    valid[a], valid[b] = valid[b], valid[a]
    away = values[a] - values[b]
    tests = tuple(replace(t, values=values, valid=valid) if t is test else t for t in data.tests)
    return Made(replace(data, tests=tests), frozenset((a, b)), test.test, float(np.nanstd(away)))


def told(data: Dataset) -> set[tuple[str, frozenset[str]]]:
    return {
        (e.test.test, frozenset(e.names)) for tests in sums.machines(data) for e in exchanged.exchanges(data, tests)
    }


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--first-seed", type=int, default=2790)
    asked.add_argument("--seeds", type=int, default=2)
    asked.add_argument("--draws", type=int, default=4)
    asked.add_argument("--limits", nargs="*", choices=LIMITS, default=list(LIMITS))
    given = asked.parse_args()
    sound, broken = list[Dataset](), list[Made]()
    with threadpool_limits(1):
        for name, data in machines(range(given.first_seed, given.first_seed + given.seeds)):
            rng = np.random.default_rng([given.first_seed, len(sound)])
            sound.append(data)
            broken += [one for _ in range(given.draws) if (one := made(data, rng)) is not None]
            print(name, flush=True)
        rows = [("as they hold", *counts(sound, broken))]
        for limit in given.limits:
            for value in LIMITS[limit]:
                with instead(exchanged, limit, value):
                    rows.append((f"{limit} {value:g}", *counts(sound, broken)))
    print(table(["", "sound: told of", "apart by 0.5 K: right of", "less: told of", "another told beside"], rows))


def counts(sound: Sequence[Dataset], broken: Sequence[Made]) -> tuple[str, ...]:
    far = [m for m in broken if m.apart >= 0.5]
    near = [m for m in broken if m.apart < 0.5]
    answers = [(m, told(m.data)) for m in far]
    return (
        f"{sum(bool(told(d)) for d in sound)} of {len(sound)}",
        f"{sum((m.test, m.names) in found for m, found in answers)} of {len(far)}",
        f"{sum(bool(told(m.data)) for m in near)} of {len(near)}",
        str(sum(bool(found - {(m.test, m.names)}) for m, found in answers)),
    )


if __name__ == "__main__":
    main()
