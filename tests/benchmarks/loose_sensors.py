"""At which limits a sensor that came loose is told, and what is told of sound machines (docs/artefacts.md).

    python loose_sensors.py --first-seed 2780 --seeds 8 --limits DROP LOWER

Machines of both kinds. On each, one temperature after the other is made loose, from the third test in which the others
foretell it to the end: the share `factor` of what its body does is left, at once, or through a lag of 25 min (slow).
Changed: all such temperatures of a machine together fall to a half, which no single sensor does.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.clocks.logs_compared import is_around
from thermodata.diagnosis.clocks.sides import in_order
from thermodata.diagnosis.sensors import loose
from thermodata.diagnosis.sensors.temperature_sums import TemperatureSums
from thermodata.effect.lag import lag
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import Dataset, TestData
from thermodata.virtual.gantry.binned import to_dataset as gantry
from thermodata.virtual.gantry.world import make_world as gantry_world
from thermodata.virtual.lathe.data import to_dataset as lathe
from thermodata.virtual.lathe.world import make_world as lathe_world

STRATA = ("strong", "none_thin")
LIMITS = {
    "DROP": (0.35, 0.45, 0.55, 0.65, 0.75),
    "LOWER": (0.55, 0.6, 0.65, 0.7),
    "LEFT": (0.1, 0.25, 0.5),
    "PARTED": (0.7, 0.85, 0.9),
    "TOO": (0.15, 0.25, 0.35),
    "TELLS": (0.1, 0.25, 0.5),
    "LEAST_K": (0.2, 0.5, 1.0),
}
KINDS = ((0.5, False), (0.5, True), (0.25, False), (0.25, True))
SLOW_S, STEP_S = 1500.0, 60.0


@dataclass(frozen=True, slots=True)
class Made:
    """A machine with one sensor loose. first: the first test in which it is."""

    data: Dataset
    name: str
    first: str


def machines(seeds: Sequence[int]) -> Iterator[tuple[str, Dataset]]:
    for seed in seeds:
        yield f"gantry {seed}", gantry(gantry_world(seed=seed), STEP_S)
        for stratum in STRATA:
            yield f"lathe {stratum} {seed}", lathe(lathe_world(stratum, seed))


def foretold(data: Dataset) -> dict[str, list[TestData]]:
    """temperature -> the tests, in their order, in which others foretell it; of those with four such tests and a share
    left that lets a factor be told."""
    tests = in_ordered(data)
    sums = TemperatureSums(data, tests, "")
    found = {f.name: [*f.before, *f.after] for f in loose._each_fall(sums, sums.names) if f.left <= loose.LEFT}
    return {name: some for name, some in found.items() if len(some) >= 4}


def in_ordered(data: Dataset) -> list[TestData]:
    rank = {key: i for i, key in enumerate(in_order(data.tests))}
    return sorted(data.tests, key=lambda t: rank[t.key])


def loosened(data: Dataset, names: Sequence[str], tells: Sequence[TestData], factor: float, slow: bool) -> Made:
    tests = in_ordered(data)
    first = next(i for i, t in enumerate(tests) if t.key == tells[2].key)
    after = {t.key for t in tests[first:]}
    air = next(n for n in sorted(data.channels) if is_around(data.channels[n]) and n in tests[0].values)

    def read(test: TestData, name: str) -> Float1D:
        rise = test.values[name] - test.values[air]
        slowly = lag(np.where(np.isfinite(rise), rise, 0.0), SLOW_S, data.step_s) if slow else rise
        return test.values[air] + factor * slowly

    def one(test: TestData) -> TestData:
        fallen = {n: read(test, n) for n in names if n in test.values} if test.key in after else {}
        return replace(test, values={**test.values, **fallen})

    return Made(replace(data, tests=tuple(one(t) for t in data.tests)), names[0], tells[2].test)


def right(made: Made) -> bool:
    """The right sensor, from the right test on, and no other."""
    found = loose.loose_sensors(made.data, "")
    return [(a.test, f"'{made.name}'" in a.why) for a in found] == [(made.first, True)]


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--first-seed", type=int, default=2780)
    asked.add_argument("--seeds", type=int, default=2)
    asked.add_argument("--limits", nargs="+", choices=LIMITS, default=list(LIMITS))
    given = asked.parse_args()
    sound, changed, broken = list[Dataset](), list[Dataset](), {kind: list[Made]() for kind in KINDS}
    with threadpool_limits(1):
        for name, data in machines(range(given.first_seed, given.first_seed + given.seeds)):
            sound.append(data)
            bodies = foretold(data)
            for kind, some in broken.items():
                some += [loosened(data, [body], tells, *kind) for body, tells in bodies.items()]
            if len(bodies) > 1:
                changed.append(loosened(data, list(bodies), next(iter(bodies.values())), 0.5, False).data)
            print(f"{name}: {len(data.tests)} tests, foretold: {', '.join(bodies) or 'none'}", flush=True)
        heads = [f"sound: told of {len(sound)}", f"changed: told of {len(changed)}"]
        heads += [
            f"{factor:g}{' and slow' if slow else ''}: right of {len(broken[factor, slow])}" for factor, slow in KINDS
        ]
        print(f"\n| | {' | '.join(heads)} |")
        print("|---" * (len(heads) + 1) + "|")
        for limit in given.limits:
            for value in LIMITS[limit]:
                with instead(loose, limit, value):
                    counts = [sum(bool(loose.loose_sensors(d, "")) for d in some) for some in (sound, changed)]
                    counts += [sum(map(right, some)) for some in broken.values()]
                print(f"| `{limit}` {value:g} | {' | '.join(map(str, counts))} |", flush=True)


@contextmanager
def instead(module: ModuleType, limit: str, value: float) -> Iterator[None]:
    """A limit of a module in place of the one that holds."""
    kept = getattr(module, limit)
    setattr(module, limit, value)
    try:
        yield
    finally:
        setattr(module, limit, kept)


if __name__ == "__main__":
    main()
