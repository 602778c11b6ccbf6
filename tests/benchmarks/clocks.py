"""Clocks that are off, in all tests or in one: how many are told, of which source, and by the right shift.

    uv run python tests/benchmarks/clocks.py [--first-seed 712] [--seeds 8]

Lathes of the blind benchmark, whose logs agree, are asked as they are; then all that one source logged is moved by one
or two hours, in all tests, in one of those with a day's or an axis's work, or in all from one on. Right: the shift to
10 min, of the source that was moved. Other source: as far, but the other of two is blamed. Neither: it is said that the
two disagree. Of some: of all tests only some are told. False alarm: any clock that is said beside, by another shift.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import replace

import numpy as np

from thermodata.diagnosis.clocks.moves import moved
from thermodata.diagnosis.sound import sound
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.schema.answers.diagnosis import Artefact, ClockMoved
from thermodata.view.grid.dataset import Dataset
from thermodata.virtual.lathe.data import model_of, to_dataset
from thermodata.virtual.lathe.world import make_world

STRATA = ("strong", "none_full", "tests_5")
MINUTES = (-120, -60, 60, 120)
TO_MIN = 10.0
HOME = "probes"  # where the displacement is logged
SOURCES = ("logger", "plc", HOME)
WORK = ("day", "spectrum", "stroke_x", "stroke_z", "wet")


def logged_late(data: Dataset, source: str, minutes: float, test: str = "") -> Dataset:
    shift_s = {n: 60.0 * minutes for n, c in data.channels.items() if c.source == source}
    return replace(data, tests=tuple(moved(t, shift_s) if test in ("", t.test) else t for t in data.tests))


def said(fitted: FittedModel, data: Dataset) -> tuple[list[ClockMoved], list[Artefact]]:
    opened = [t for t in data.tests if t.role != "locked"]
    found = sound(fitted, 0, data, opened, effects())
    return found.put_right.clocks, [f for f in found.faults if f.kind == "clock_offset"]


def outcome(source: str, minutes: float, test: str, clocks: list[ClockMoved], faults: list[Artefact]) -> list[str]:
    """The fault's own first; then each that is said beside it. Of the displacement's log all others are moved."""
    beside = [
        f
        for f in faults
        if f.test != test and (test or not any(c.test == f.test and by_as_much(c, minutes) for c in clocks))
    ]
    return [_of_its_own(source, minutes, test, clocks, faults), *["false alarm"] * len(beside)]


def outcome_from(source: str, minutes: float, off: set[str], clocks: list[ClockMoved], opened: set[str]) -> list[str]:
    """Of a source that is late from one test on. Right: in two open tests and more, and in none before."""
    named = [c for c in clocks if (c.source != HOME if source == HOME else c.source == source)]
    sign = 1 if source == HOME else -1
    right = [c for c in named if c.test and abs(c.moved_s / 60 - sign * minutes) <= TO_MIN]
    moved_in = {c.test for c in right} & opened
    if len(right) < len(clocks) or moved_in - off:
        return ["wrong shift"]
    return ["right" if len(moved_in) > 1 else "of some" if moved_in else "silent"]


def by_as_much(clock: ClockMoved, minutes: float) -> bool:
    return abs(abs(clock.moved_s / 60) - abs(minutes)) <= TO_MIN


def _of_its_own(source: str, minutes: float, test: str, clocks: list[ClockMoved], faults: list[Artefact]) -> str:
    by = {c.source: c.moved_s / 60 for c in clocks if c.test == test}
    others = {s: m for s, m in by.items() if s != HOME}
    if source == HOME:
        right = bool(others) and all(abs(m - minutes) <= TO_MIN for m in others.values())
    else:
        right = set(by) == {source} and abs(by[source] + minutes) <= TO_MIN
    if right:
        return "right"
    if source != HOME and len(by) == 1 and abs(next(iter(by.values())) - minutes) <= TO_MIN:
        return "other source"
    if by:
        return "wrong shift"
    if any(f.test == test for f in faults):
        return "neither"
    return "of some" if any(by_as_much(c, minutes) for c in clocks) else "silent"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--first-seed", type=int, default=712)
    parser.add_argument("--seeds", type=int, default=8)
    given = parser.parse_args()
    counts: dict[str, Counter[str]] = {}
    rng, of_parts = np.random.default_rng(given.first_seed), np.random.default_rng(given.first_seed + 1)
    for seed in range(given.first_seed, given.first_seed + given.seeds):
        for stratum in STRATA:
            world = make_world(stratum, seed)
            data = to_dataset(world)
            fitted = fit_model(model_of(world), data, uncertainty=False)
            _, faults = said(fitted, data)
            counts.setdefault("not moved", Counter()).update(
                ["silent"] if not faults else ["false alarm"] * len(faults)
            )
            working = [t.test for t in data.tests if t.role != "locked" and t.test.partition("_")[2] in WORK]
            for source in SOURCES:
                for test in ("", str(rng.choice(working))):
                    minutes = float(rng.choice(MINUTES))
                    late = logged_late(data, source, minutes, test)
                    row = f"{source}, {'one test' if test else 'all tests'}"
                    counts.setdefault(row, Counter()).update(outcome(source, minutes, test, *said(fitted, late)))
                order = [t.test for t in data.tests]
                off = set(order[int(of_parts.integers(1, len(order) - 1)) :])
                minutes, late = float(of_parts.choice(MINUTES)), data
                for test in off:
                    late = logged_late(late, source, minutes, test)
                opened = {t.test for t in data.tests if t.role != "locked"}
                clocks, _ = said(fitted, late)
                row = f"{source}, from a test on"
                counts.setdefault(row, Counter()).update(outcome_from(source, minutes, off, clocks, opened))
    columns = ("right", "other source", "neither", "of some", "wrong shift", "silent", "false alarm")
    print(f"| moved by one or two hours | {' | '.join(columns)} |\n|---|{'---|' * len(columns)}")
    for row, found in counts.items():
        print(f"| {row} | {' | '.join(str(found[c]) for c in columns)} |")


if __name__ == "__main__":
    main()
