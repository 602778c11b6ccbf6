"""What hidden causes do, as a multiple of their limit of detection, and which of them are named (docs/benchmark.md).

    python detection_limits.py --first-seed 600 --seeds 2 --strata strong weak_half

A machine of the second kind each. The limit is that of the cause's own name, beside all that was selected but it.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.diagnosis import case
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.claims.detection import limits
from thermodata.diagnosis.question.known import known
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.weigh.beside import beside
from thermodata.diagnosis.weigh.scored import ACTS
from thermodata.virtual.blind.trial import Trial, judge
from thermodata.virtual.lathe.data import contribution
from thermodata.virtual.lathe.right_names import RIGHT
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.lathe.world import make_world

ONE = [n for n, s in STRATA.items() if s.hidden == 1 and not s.blind and not s.outside]
EDGES = (0.9, 1.3)
FOUND = ("exact", "equivalent")


@dataclass(frozen=True, slots=True)
class Held:
    """size, limit: RMS where it acts [um]."""

    trial: Trial
    size: float
    limit: float


def held(stratum: str, seed: int) -> Held | None:
    """None where nothing is hidden, or the library has no name for it."""
    kept: list[Investigation] = []
    real = case.investigate

    def watched(*given: Any, **more: Any) -> Investigation:
        kept.append(real(*given, **more))
        return kept[-1]

    case.investigate = watched
    try:
        trial = judge(stratum, seed, rivals=False)
    finally:
        case.investigate = real
    first = kept[0]
    if not trial.hidden or first.selection is None:
        return None

    def marked(one: CandidateEffect) -> str:
        return RIGHT[trial.hidden[0]].mark(one.effect.name, one.channels, one.family)

    others = [m.alone for m in first.selection.members if marked(m.alone.candidate) not in FOUND]
    base = known(beside(first.problem, others), first.selection.noise)
    nobody = np.full(len(base.precision), -1)
    found = limits(base, [s.columns for s in first.selection.first.ranked], first.measure.spread, nobody)
    own = [one.least for one in found if marked(one.candidate) == "exact"]
    world = make_world(stratum, seed)
    opened = {b.test.test for b in first.problem.blocks}
    sizes = np.array([np.std(contribution(world, r)) for r in world.runs if r.stretch.id in opened])
    acts = sizes >= ACTS * sizes.max()
    return Held(trial, float(np.sqrt(np.mean(sizes[acts] ** 2))), min(own)) if own else None


def main() -> None:
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--first-seed", type=int, default=600)
    ask.add_argument("--seeds", type=int, default=1)
    ask.add_argument("--strata", nargs="+", default=ONE, choices=ONE)
    given = ask.parse_args()
    count: Counter[tuple[int, str]] = Counter()
    for seed in range(given.first_seed, given.first_seed + given.seeds):
        for stratum in given.strata:
            one = held(stratum, seed)
            if one is None:
                continue
            times = one.size / one.limit
            outcome = one.trial.outcome
            print(
                f"{stratum:13} {seed} {one.trial.hidden[0]:17} {one.size:6.2f} um {times:6.2f} x {outcome}", flush=True
            )
            said = "right" if outcome in ("right", "equivalent") else "unnamed" if outcome == "abstained" else "else"
            count[int(np.searchsorted(EDGES, times)), said] += 1
    for i, name in enumerate(("under 0.9", "0.9 to 1.3", "over 1.3")):
        row = {said: count[i, said] for said in ("right", "unnamed", "else")}
        print(f"{name:>11}: {row['right']} named right of {sum(row.values())}, {row['else']} named otherwise")


if __name__ == "__main__":
    main()
