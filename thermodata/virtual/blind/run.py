"""Many trials at once, kept as they come, so that a long run can be stopped and go on."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from itertools import groupby
from multiprocessing import active_children
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError
from thermodata.virtual.blind.machines import STRATA
from thermodata.virtual.blind.rules import fingerprint
from thermodata.virtual.blind.trial import KEYS, judge
from thermodata.virtual.truth.strata import SEALED

Record = dict[str, Any]
Told = Callable[[int, int], None]
Pair = tuple[str, int]
TOGETHER = 8


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

    tell: is told how many are done, of how many. UsageError where `out` holds something else, trials of another
    version or of other rules, or trials of the other set of seeds.
    """
    rules = fingerprint()
    kept = read(out) if out is not None and out.exists() else []
    _refuse_mixtures(kept, seeds, rules, out)
    wanted = [(stratum, seed) for seed in seeds for stratum in strata]
    found = [t for t in kept if (t["stratum"], t["seed"]) in set(wanted)]
    done = {(t["stratum"], t["seed"]) for t in found}
    left = [pair for pair in wanted if pair not in done]

    def take(trial: Record) -> None:
        found.append({**trial, "rules": rules})
        if out is not None:
            with out.open("a", encoding="utf-8") as file:
                file.write(json.dumps(found[-1]) + "\n")
        if tell is not None:
            tell(len(found), len(wanted))

    if jobs == 1:
        for pairs in sharing_heat(left):
            for stratum, seed in pairs:
                take(one(stratum, seed, rivals))
    else:
        with _processes(jobs) as pool:
            for future in as_completed([pool.submit(several, pairs, rivals) for pairs in sharing_heat(left)]):
                for trial in future.result():
                    take(trial)
    return sorted(found, key=lambda t: (strata.index(t["stratum"]), t["seed"]))


@contextmanager
def _processes(jobs: int) -> Iterator[ProcessPoolExecutor]:
    """Processes to which Ctrl-C, which a terminal sends to all of them, says nothing: it is for who waits for them, and
    ends them with what they have begun."""
    others = set(active_children())
    with ProcessPoolExecutor(jobs, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN)) as pool:
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in set(active_children()) - others:
                process.terminate()
            raise


def sharing_heat(pairs: Sequence[Pair]) -> Iterator[list[Pair]]:
    """Strata whose machines of a seed do the same programme: solved once by the process that judges them.

    At most `TOGETHER`: what a process has not handed back is lost when a run is stopped.
    """

    def programme(pair: Pair) -> tuple[int, int, bool]:
        kind = STRATA[pair[0]]
        return pair[1], kind.tests, kind.idle

    for _, some in groupby(sorted(pairs, key=programme), key=programme):
        group = list(some)
        yield from (group[i : i + TOGETHER] for i in range(0, len(group), TOGETHER))


def several(pairs: Sequence[Pair], rivals: bool) -> list[Record]:
    return [one(stratum, seed, rivals) for stratum, seed in pairs]


def one(stratum: str, seed: int, rivals: bool) -> Record:
    """One trial as plain data; one thread, so that its processor time is the verdict's own."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        try:
            trial = judge(stratum, seed, rivals=rivals)
        except Exception as error:  # no machine may be left out of the count, so the run ends, and says where
            raise RuntimeError(f"the trial of stratum {stratum}, seed {seed} failed: {error}") from error
    record: Record = json.loads(json.dumps(trial.to_json()))
    return record


def read(path: Path) -> list[Record]:
    """The trials of a file. UsageError where a line is none, or one of another version of the benchmark."""
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
        here = trial.keys() - {"rules"}
        if here != KEYS or "rules" not in trial:
            lacks, more = sorted((KEYS | {"rules"}) - trial.keys()), sorted(here - KEYS)
            raise UsageError(
                "a trial of another version of the blind benchmark",
                where=f"{path}, line {number}",
                expected="the keys that this version writes",
                got="; ".join(
                    f"{what} {', '.join(keys[:6])}" for what, keys in (("no", lacks), ("unknown", more)) if keys
                ),
                hint="name another file: what was not kept cannot be marked anew",
            )
    return found


def _refuse_mixtures(kept: Sequence[Record], seeds: Sequence[int], rules: str, out: Path | None) -> None:
    for trial in kept:
        if (trial["seed"] in SEALED) != (seeds[0] in SEALED):
            raise UsageError(
                "development and sealed seeds would stand in one file",
                where=str(out),
                got=f"seed {trial['seed']} beside {seeds[0]}",
                hint="name another file",
            )
        if trial["rules"] != rules:
            raise UsageError(
                "verdicts of two rules would stand in one file",
                where=str(out),
                expected=f"rules {rules}, those of this code",
                got=f"rules {trial['rules']} (stratum {trial['stratum']}, seed {trial['seed']})",
                hint="name another file",
            )
