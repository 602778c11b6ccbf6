"""The blind benchmark of the diagnosis, as a table by hidden effect.

    uv run python tests/benchmarks/diagnosis.py [--seeds 10] [--first-seed 0] [--hide EFFECT ...] [--not-logged]
                                                [--out trials.jsonl]

Every effect that the virtual machine can hide, and none; with --not-logged the channels of the hidden effect are not
in the log: right is then to claim nothing, and a claim of another family is false. --out keeps each trial as a line,
and goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from measure import machine, table

OUTCOMES = ("right", "equivalent", "family", "wrong", "false claim", "abstained")


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
        name = (trial["hidden"] or "none") + ("" if trial.get("logged", True) else " (not logged)")
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
    good = sum(t["outcome"] in ("right", "equivalent") for t in claims)
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
    from thermodata.virtual.benchmark import benchmark

    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--seeds", type=int, default=10)
    arguments.add_argument("--first-seed", type=int, default=0)
    arguments.add_argument("--hide", nargs="*", choices=[*HIDEABLE, "none"], metavar="EFFECT")
    arguments.add_argument("--not-logged", action="store_true")
    arguments.add_argument("--out", type=Path)
    given = arguments.parse_args()
    # without its sensors "none" is the same machine once more
    hides = given.hide or [*HIDEABLE, *([] if given.not_logged else ["none"])]
    trials = kept(given.out)
    done = {(t["hidden"], t["seed"], t["logged"]) for t in trials}
    for seed in range(given.first_seed, given.first_seed + given.seeds):
        for hide in hides:
            if (hide, seed, not given.not_logged) in done:
                continue
            for trial in benchmark([hide], [seed], logged=not given.not_logged):
                trials.append(trial.to_json())
                keep(given.out, trials[-1])
                print(f"{hide} {seed}: {trial.outcome} ({trial.found or trial.verdict})", file=sys.stderr)
    print(machine())
    print(report(trials))


if __name__ == "__main__":
    main()
