"""`thermodata demo` over hidden effects and seeds: raw TDMS, CNC and MCAP files to the verdict, a process each.

    uv run python tests/benchmarks/demos.py --out demos.jsonl [--seeds 3] [--first-seed 0] [--jobs 2]
                                            [--hide EFFECT ...]

Takes about half a minute a demo. Each result is kept as a line of --out; a run that was stopped goes on from there.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from diagnosis import keep, kept, report
from measure import PROGRAM, machine, run


def demo(hide: str, seed: int) -> dict[str, Any]:
    """One demo in a folder that is deleted after it. A demo that fails is a result too."""
    with tempfile.TemporaryDirectory(prefix="thermodata-demo-") as folder:
        try:
            done = run([PROGRAM, "demo", Path(folder) / "demo", "--hide", hide, "--seed", seed, "--json"])
        except subprocess.CalledProcessError as error:
            return {"hidden": hide, "seed": seed, "outcome": "failed", "why": str(error.stderr)[-2000:]}
    result = done.answer
    return {
        **result,
        "hidden": hide,
        "seed": seed,
        "outcome": outcome(hide, seed, result),
        "seconds": done.seconds,
        "peak_mib": done.peak_mib,
    }


def outcome(hide: str, seed: int, result: dict[str, Any]) -> str:
    """Marked as the blind benchmark marks."""
    from thermodata.effect import effects
    from thermodata.virtual import make_world
    from thermodata.virtual.benchmark import mark, true_family

    if result["found"] is None:
        return "right" if hide == "none" else "abstained"
    if hide == "none":
        return "false claim"
    family = true_family(hide, make_world(hide, seed).axis, effects())
    return mark(hide, family, result["found"], result["family"], result["equivalents"])


def main() -> None:
    from thermodata.virtual import HIDEABLE

    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", type=Path, required=True)
    arguments.add_argument("--seeds", type=int, default=3)
    arguments.add_argument("--first-seed", type=int, default=0)
    arguments.add_argument("--jobs", type=int, default=2, choices=(1, 2))
    arguments.add_argument("--hide", nargs="*", choices=[*HIDEABLE, "none"], metavar="EFFECT")
    given = arguments.parse_args()
    trials = [t for t in kept(given.out) if t["outcome"] != "failed"]
    done = {(t["hidden"], t["seed"]) for t in trials}
    seeds = range(given.first_seed, given.first_seed + given.seeds)
    todo = [(h, s) for s in seeds for h in given.hide or [*HIDEABLE, "none"] if (h, s) not in done]
    with ThreadPoolExecutor(given.jobs) as pool:
        for trial in pool.map(lambda job: demo(*job), todo):
            trials.append(trial)
            keep(given.out, trial)
            print(f"{trial['hidden']} {trial['seed']}: {trial['outcome']} ({trial.get('found')})", file=sys.stderr)
    failed = [t for t in trials if t["outcome"] == "failed"]
    print(machine())
    print(report([t for t in trials if t["outcome"] != "failed"]))
    for trial in failed:
        print(f"failed: {json.dumps(trial)}")
    if failed:
        sys.exit(1)


if __name__ == "__main__":
    main()
