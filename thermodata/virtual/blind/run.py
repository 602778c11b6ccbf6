"""Many trials at once, kept as they come, so that a long run can be stopped and go on."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError
from thermodata.virtual.blind.trial import judge
from thermodata.virtual.lathe.strata import SEALED

Record = dict[str, Any]
Told = Callable[[int, int], None]


def run(
    strata: Sequence[str],
    seeds: Sequence[int],
    *,
    jobs: int = 1,
    rivals: bool = True,
    out: Path | None = None,
    tell: Told | None = None,
) -> list[Record]:
    """A trial of each stratum and seed. out: JSON lines; those of it that the run asks for are not made again.

    tell: is told how many are done, of how many. UsageError where `out` holds something else, or
    trials of the other set of seeds.
    """
    kept = read(out) if out is not None and out.exists() else []
    mixed = [t["seed"] for t in kept if (t["seed"] in SEALED) != (seeds[0] in SEALED)]
    if mixed:
        raise UsageError(
            "development and sealed seeds would stand in one file",
            where=str(out),
            got=f"seed {mixed[0]} beside {seeds[0]}",
            hint="name another file",
        )
    wanted = [(stratum, seed) for seed in seeds for stratum in strata]
    found = [t for t in kept if (t["stratum"], t["seed"]) in set(wanted)]
    done = {(t["stratum"], t["seed"]) for t in found}
    # strata of one seed follow each other: they share the heat of its machine
    left = [pair for pair in wanted if pair not in done]

    def take(trial: Record) -> None:
        found.append(trial)
        if out is not None:
            with out.open("a", encoding="utf-8") as file:
                file.write(json.dumps(trial) + "\n")
        if tell is not None:
            tell(len(found), len(wanted))

    if jobs == 1:
        for stratum, seed in left:
            take(one(stratum, seed, rivals))
    else:
        with ProcessPoolExecutor(jobs) as pool:
            for future in as_completed([pool.submit(one, stratum, seed, rivals) for stratum, seed in left]):
                take(future.result())
    return sorted(found, key=lambda t: (strata.index(t["stratum"]), t["seed"]))


def one(stratum: str, seed: int, rivals: bool) -> Record:
    """One trial as plain data; one thread, so that its processor time is the verdict's own."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        record: Record = json.loads(json.dumps(judge(stratum, seed, rivals=rivals).to_json()))
    return record


def read(path: Path) -> list[Record]:
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        try:
            trial = json.loads(line)
            found.append({**trial, "stratum": str(trial["stratum"]), "seed": int(trial["seed"])})
        except (ValueError, KeyError, TypeError) as error:
            raise UsageError(
                "not a trial of the blind benchmark",
                where=f"{path}, line {number}",
                expected="a line that --out wrote",
                got=line[:60],
                hint="name another file",
            ) from error
    return found
