"""What a second lag gives on locked tests when the right effect is added: turning centre, and the library's machine.

    uv run --no-sync python tests/benchmarks/second_lags.py run OUT.jsonl --seeds 600:621
    uv run --no-sync python tests/benchmarks/second_lags.py run OUT.jsonl --machine library --seeds 600:606
    uv run --no-sync python tests/benchmarks/second_lags.py table OUT.jsonl...

Every model is fitted to all open tests and scored on the locked ones, from their first samples on. `share of the drop`:
of the fall of that error which the right effect with one lag gives (so one lag is 1), where it gives a tenth at least.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, median
from time import process_time
from typing import Any

from measure import machine, table

from thermodata.diagnosis.locked.confirm import on_all_open, rmse
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.versions.second_lag import with_second_lags
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset

LEAST_FALL = 0.1  # of the locked error, for a share of it to mean something
SAME = 0.02  # an error that moves by less is the same
STRATA = ("strong", "decoy", "tests_16", "staircase")
HIDDEN = ("coolant", "feed_screw", "ambient_frame", "spindle_motor")


@dataclass(frozen=True)
class Case:
    """A machine, the model that lacks one effect, and what the truth would add."""

    stratum: str
    seed: int
    data: Dataset
    base: Model
    right: Sequence[EffectSpec]


def on_lathe(strata: Sequence[str], seeds: Sequence[int]) -> Iterator[Case]:
    from thermodata.virtual.lathe.data import channels_of, model_of, right_effect, to_dataset
    from thermodata.virtual.lathe.world import make_world

    for seed in seeds:
        for stratum in strata:
            world = make_world(stratum, seed)
            try:
                right = [right_effect(world, cause, channels_of(world)) for cause in world.hidden]
            except LookupError:
                continue
            yield Case(stratum, seed, to_dataset(world), model_of(world), right)


def on_library(hidden: Sequence[str], seeds: Sequence[int]) -> Iterator[Case]:
    from thermodata.virtual.gantry.binned import to_dataset
    from thermodata.virtual.gantry.catalogue import drivers_of
    from thermodata.virtual.gantry.world import make_world

    for seed in seeds:
        for hide in hidden:
            world = make_world(hide, seed)
            right = EffectSpec(effect=hide, drivers=dict(drivers_of(hide, world.axis)))
            yield Case(hide, seed, to_dataset(world, 60.0), world.baseline(), [right])


def measured(case: Case) -> dict[str, Any]:
    """Locked errors [um], scored from the first samples on and (`free`) with an offset a test; processor seconds."""
    opened = [t for t in case.data.tests if t.role != "locked"]
    closed = [t for t in case.data.tests if t.role == "locked"]

    def locked(spec: Model) -> dict[str, Any]:
        fitted = fit_model(on_all_open(spec, opened, closed), case.data, uncertainty=False).responses[0]
        usable = [t for t in closed if fitted.can_predict(t)]
        return {"um": rmse(fitted, usable), "free_um": rmse(fitted, usable, free=True)}

    named = case.base.model_copy(update={"effects": [*case.base.effects, *case.right], "in_sample": True})
    start = process_time()
    fit_model(named, case.data)
    plain = process_time()
    refined = with_second_lags(named, case.data)
    asked = process_time()
    return {
        "stratum": case.stratum,
        "seed": case.seed,
        "base": locked(case.base),
        "one_lag": locked(named),
        "two_lags": locked(refined.spec),
        "notes": refined.notes,
        "lags": [lag.of for lag in refined.lags],
        "of_the_added": sum(lag.of not in _ids(case.base) for lag in refined.lags),
        "effects": len(named.effects),
        "seconds_fit": plain - start,
        "seconds_second_lags": asked - plain,
    }


def _ids(spec: Model) -> list[str]:
    from thermodata.modelling.model_file.resolve import term_ids

    return term_ids(spec.effects)


def show(rows: Sequence[dict[str, Any]]) -> None:
    """A row a stratum, and one of all."""
    print(machine())
    names = [*dict.fromkeys(r["stratum"] for r in rows), "all"]
    lines = [_line(name, [r for r in rows if name in (r["stratum"], "all")]) for name in names]
    head = ["", "machines", "with a second lag", "share: median", "mean", "where one was taken: mean", "median"]
    head += ["error: better", "same", "worse", "its ratio", "with free offset", "worst", "fit [s]", "second lags [s]"]
    print(table(head, lines))


def _line(name: str, rows: Sequence[dict[str, Any]]) -> list[Any]:
    taken = [r for r in rows if r["lags"]]
    shares, some = _shares(rows), _shares(taken)
    ratio = [r["two_lags"]["um"] / r["one_lag"]["um"] for r in taken]
    free = [r["two_lags"]["free_um"] / r["one_lag"]["free_um"] for r in taken]
    return [
        name,
        len(rows),
        len(taken),
        *(f"{f(shares):.3f}" if shares else "-" for f in (median, fmean)),
        *(f"{f(some):.3f}" if some else "-" for f in (fmean, median)),
        sum(x < 1 - SAME for x in ratio),
        sum(abs(x - 1) <= SAME for x in ratio),
        sum(x > 1 + SAME for x in ratio),
        *(f"{median(x):.2f}" if x else "-" for x in (ratio, free)),
        f"{max(ratio):.2f}" if ratio else "-",
        *(f"{median(r[key] for r in rows):.2f}" for key in ("seconds_fit", "seconds_second_lags")),
    ]


def _shares(rows: Sequence[dict[str, Any]]) -> list[float]:
    out = []
    for r in rows:
        before, one, two = (r[key]["um"] for key in ("base", "one_lag", "two_lags"))
        if one <= (1 - LEAST_FALL) * before:
            out.append((before - two) / (before - one))
    return out


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = arguments.add_subparsers(dest="command", required=True)
    running = commands.add_parser("run")
    running.add_argument("out", type=Path)
    running.add_argument("--machine", choices=["lathe", "library"], default="lathe")
    running.add_argument("--seeds", default="600:621", help="first:past the last")
    running.add_argument("--strata", nargs="*", help="of the lathe; of the library, the effects that are hidden")
    showing = commands.add_parser("table")
    showing.add_argument("files", type=Path, nargs="+")
    given = arguments.parse_args()
    if given.command == "table":
        show([json.loads(line) for file in given.files for line in file.read_text(encoding="utf-8").splitlines()])
        return 0
    seeds = range(*(int(s) for s in given.seeds.split(":")))
    made = (
        on_lathe(given.strata or STRATA, seeds)
        if given.machine == "lathe"
        else on_library(given.strata or HIDDEN, seeds)
    )
    with given.out.open("a", encoding="utf-8") as file:
        for case in made:
            row = measured(case)
            file.write(json.dumps(row) + "\n")
            file.flush()
            print(f"{case.stratum} {case.seed}: {'; '.join(row['notes'])}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
