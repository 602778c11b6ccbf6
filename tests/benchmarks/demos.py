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
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median
from typing import Any

from measure import PROGRAM, machine, run, table

OUTCOMES = ("right", "equivalent", "told", "family", "wrong", "false claim", "abstained")


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
    from thermodata.virtual import make_world
    from thermodata.virtual.gantry.right_names import names_of

    if not result["claims"]:
        return "right" if hide == "none" else "abstained"
    if hide == "none":
        return "false claim"
    world = make_world(hide, seed)
    right = names_of(world.axis, world.sensors)[hide]
    effect, _, channels = result["claims"][0].partition(":")
    mark = right.mark(effect, channels.split(","), result["family"])
    if mark in ("family", "wrong") and right.among(result["equivalents"]):
        return "told"
    return "right" if mark == "exact" else mark


def kept(path: Path | None) -> list[dict[str, Any]]:
    """The trials of an earlier run; a line that was cut is left out."""
    found = []
    for line in path.read_text(encoding="utf-8").splitlines() if path and path.exists() else []:
        try:
            found.append(json.loads(line))
        except json.JSONDecodeError:
            print(f"{path}: left out: {line[:40]}", file=sys.stderr)
    return found


def keep(path: Path | None, trial: dict[str, Any]) -> None:
    if path:
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(trial) + "\n")


def middle(trials: Sequence[dict[str, Any]], key: str) -> str:
    """Median before -> after over the trials with a claim [um]."""
    pairs = [(t[f"{key}_before"], t[f"{key}_after"]) for t in trials if t[f"{key}_after"] is not None]
    if not pairs:
        return "-"
    return f"{median(a for a, _ in pairs):.2f} -> {median(b for _, b in pairs):.2f}"


def report(trials: Sequence[dict[str, Any]]) -> str:
    """A row for each hidden effect and one for all; errors are medians over the machines with a claim."""
    groups: dict[str, list[dict[str, Any]]] = {}
    for trial in trials:
        name = trial["hidden"] or "none"
        groups.setdefault(name, []).append(trial)
    named = [t for t in trials if t["outcome"] in OUTCOMES]
    rows = []
    for name, part in [*groups.items(), ("all", named)]:
        ends = [sum(t["outcome"] == o for t in part) for o in OUTCOMES]
        rows.append(
            [
                name,
                len(part),
                *(n or "" for n in ends),
                middle(part, "rmse_um"),
                middle(part, "locked_rmse_um"),
                f"{median(t['seconds'] for t in part):.1f}" if part else "",
            ]
        )
    claims = [t for t in named if t["found"]]
    fell = sum(t["rmse_um_after"] < t["rmse_um_before"] for t in claims)
    locked = [t for t in claims if t["locked_rmse_um_after"] is not None]
    locked_fell = sum(t["locked_rmse_um_after"] < t["locked_rmse_um_before"] for t in locked)
    # a machine that lacks nothing is right where nothing is claimed: that is no claim
    good = sum(t["outcome"] in ("right", "equivalent", "told") for t in claims)
    return "\n".join(
        [
            table(["hidden", "machines", *OUTCOMES, "error [um]", "locked [um]", "s"], rows),
            "",
            f"{len(claims)} claims of {len(named)} machines; right or told as equivalent {good} of {len(claims)}; "
            f"error falls in {fell} of {len(claims)}, on locked tests in {locked_fell} of {len(locked)}",
        ]
    )


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
