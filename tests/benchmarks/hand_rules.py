"""Evidence against rules that are set by hand, on lathes of the blind benchmark (docs/benchmark.md).

    uv run --no-sync python tests/benchmarks/hand_rules.py --first-seed 40100 --seeds 12 --out trials.jsonl
    uv run --no-sync python tests/benchmarks/hand_rules.py --read trials.jsonl

Both are asked about the same machines, once each: the same tests with clocks put right and slips known, the same
candidates, the same baseline and the same locked tests, and `thermodata/virtual/truth/marking.py` marks both. The rules
stand in `by_hand/rules.py`. Of the claims by evidence it is told besides what two of the rules would make of
them: a promised fall beyond 2.8 times what a candidate does, and exchanged histories as a null. --minutes ends a run
after the machine that it is at; --out keeps each machine as a line, and goes on where it was stopped. Development seeds
only.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from statistics import median
from time import monotonic, process_time
from typing import Any

from by_hand.asked import Asked, asked_of
from by_hand.exchanged import p_of_claims
from by_hand.rules import KEPT, P_LIMIT, STEADIES, Found, Member, claimable, found_by_hand
from measure import table
from threadpoolctl import threadpool_limits

from thermodata.diagnosis.case import Case, case_of
from thermodata.diagnosis.clocks.ends_of_logs import UNKNOWN
from thermodata.diagnosis.concluded import Concluded, concluded
from thermodata.diagnosis.in_contract import in_contract
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.candidate import Candidate
from thermodata.virtual.blind.seeds import seeds_of
from thermodata.virtual.blind.tally import NAMED, wilson
from thermodata.virtual.blind.tally import asked as has_a_cause
from thermodata.virtual.lathe import case as lathe
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.truth.case import Case as Machine
from thermodata.virtual.truth.marking import claims_of, head_of, marks_of, outcome_of

Trial = Mapping[str, Any]
WHO = {
    "evidence": "evidence",
    "by_hand": "by hand, both nulls",
    "by_kernels": "by hand, kernels alone",
    "by_exchange": "by hand, exchange alone",
    "no_null": "by hand, no null",
}


def judge(stratum: str, seed: int) -> dict[str, Any]:
    """One machine, both answers."""
    machine = lathe.case_of(stratum, seed)
    data = machine.data
    case = case_of(fit_model(machine.spec, data, uncertainty=False), data, effects(), 0, UNKNOWN, None)
    begin = process_time()
    found = concluded(case, None)
    answer = in_contract(case, found, "benchmark", None, by_choice=False)
    seconds = process_time() - begin
    begin = process_time()
    asked = asked_of(case)
    by_hand = found_by_hand(asked)
    seconds_by_hand = process_time() - begin
    marking = _Marking(machine)
    return {
        "stratum": stratum,
        "seed": seed,
        "hidden": machine.key.hidden,
        "evidence": marking.of(claims_of(answer), head_of(answer), answer.verdict),
        "claims": _of_evidence(case, found, marking),
        **_of_rules(asked, by_hand, marking),
        "seconds": seconds,
        "seconds_by_hand": seconds_by_hand,
    }


class _Marking:
    """An answer against the truth of one machine."""

    def __init__(self, machine: Machine) -> None:
        self.key, self.nothing = machine.key, machine.nothing

    def of(self, claims: Sequence[Candidate], head: Candidate | None, verdict: str = "unknown") -> dict[str, Any]:
        marks, missed = marks_of(self.key, claims)
        return {
            "claims": [c.id for c in claims],
            "marks": marks,
            "outcome": outcome_of(verdict, marks, missed, self.nothing),
            "first": None if head is None else head.id,
            "first_right": head is not None and self.right(head),
        }

    def right(self, one: Candidate) -> bool:
        return self.key.is_hidden(one)


def _of_evidence(case: Case, found: Concluded, marking: _Marking) -> list[dict[str, Any]]:
    """What two of the rules would make of each claim."""
    p = p_of_claims(case, found) if found.judgement.claims else {}
    told = []
    for claim in found.judgement.claims:
        scored = claim.scored
        right = marking.right(_candidate(scored.candidate.id, scored.candidate))
        told.append(
            {"id": scored.candidate.id, "right": right, "promised": _promised(scored)} | {"p": p[scored.candidate.id]}
        )
    return told


def _promised(scored: Scored) -> float:
    """The fall of the squared error of left-out tests, in multiples of the square of what the candidate does there."""
    acts = scored.acts
    fall = (scored.sse_before - scored.sse_after)[acts].sum()
    return float(fall / (scored.size**2 * scored.rows)[acts].sum())


def _of_rules(asked: Asked, found: Found, marking: _Marking) -> dict[str, Any]:
    """The answer by each null, and each member with what the rules say of it."""
    each = asked.candidates.each
    causes = [n for n in found.first.tolist() if claimable(each[n])]
    head = _candidate(each[causes[0]].id, each[causes[0]]) if causes else None
    standing = [m for m in found.members if claimable(each[m.number]) and (m.kept is None or m.kept >= KEPT)]

    def answer(passes: Callable[[Member], bool]) -> dict[str, Any]:
        some = [_candidate(each[m.number].id, each[m.number]) for m in standing if passes(m)]
        return marking.of(some, head)

    members = [
        {
            "id": each[m.number].id,
            "right": marking.right(_candidate(each[m.number].id, each[m.number])),
            "cost": m.cost,
            "p_kernels": m.p_kernels,
            "p_exchanged": m.p_exchanged,
        }
        for m in standing
    ]
    return {
        "by_hand": answer(lambda m: m.p_kernels <= P_LIMIT and m.p_exchanged <= P_LIMIT),
        "by_kernels": answer(lambda m: m.p_kernels <= P_LIMIT),
        "by_exchange": answer(lambda m: m.p_exchanged <= P_LIMIT),
        "no_null": answer(lambda m: True),
        "members": members,
    }


def _candidate(name: str, of: Any) -> Candidate:
    """As marks are given: what else it may be is told where nothing reads that part."""
    empty = dict.fromkeys(("p_value", "rmse_um_before", "rmse_um_after", "fit_before", "fit_after"))
    return Candidate(
        rank=1,
        id=name,
        effect=of.effect.name,
        family=of.family,
        drivers=list(of.channels),
        claimed=True,
        unread=list(of.unread),
        **empty,
    )


def report(trials: Sequence[Trial]) -> str:
    """A row a stratum and who answers; then all together, and what each null lets pass."""
    rows = []
    groups = [(name, [t for t in trials if t["stratum"] == name]) for name in STRATA]
    for name, some in [*groups, ("all", list(trials))]:
        for who, words in WHO.items():
            if some and (name == "all" or who in ("evidence", "by_hand", "by_kernels")):
                rows.append([name, len(some), words, *_counts(some, who)])
    heads = [
        "stratum",
        "machines",
        "by",
        "one cause: right",
        "wrong",
        "several: all",
        "first",
        "nothing hidden: false",
        "not logged, outside: false",
    ]
    seconds = [median(t[key] for t in trials) for key in ("seconds", "seconds_by_hand")]
    cost = f"processor seconds: {seconds[0]:.1f} by evidence, {seconds[1]:.1f} by hand (median)"
    return "\n".join([table(heads, rows), "", *_nulls(trials), *_of_claims(trials), cost])


def _counts(trials: Sequence[Trial], who: str) -> Iterator[str]:
    able = [t for t in trials if has_a_cause(t)]
    one, several = ([t for t in able if (len(t["hidden"]) == 1) is single] for single in (True, False))
    blind = [t for t in trials if t["hidden"] and not has_a_cause(t)]
    none = [t for t in trials if not t["hidden"]]
    yield _share(one, lambda t: t[who]["outcome"] in NAMED)
    yield _share(one, lambda t: t[who]["outcome"] == "wrong")
    yield _share(several, lambda t: t[who]["outcome"] in NAMED)
    yield _share(able, lambda t: t[who]["first_right"])
    yield _share(none, lambda t: t[who]["outcome"] == "false claim")
    yield _share(blind, lambda t: t[who]["outcome"] == "false claim")


def _share(some: Sequence[Trial], hit: Callable[[Trial], bool]) -> str:
    hits, around = sum(map(hit, some)), wilson(sum(map(hit, some)), len(some))
    if around is None:
        return "-"
    return f"{hits} of {len(some)}" + (f" ({100 * around[0]:.0f}-{100 * around[1]:.0f} %)" if len(some) > 20 else "")


def _nulls(trials: Sequence[Trial]) -> Iterator[str]:
    """Of members of the hand-set rules that keep all other rules."""
    for words, passes in {
        "keep all other rules": lambda m: True,
        "p at most 1 %, kernels and slow noise": lambda m: m["p_kernels"] <= P_LIMIT,
        "p at most 1 %, exchanged histories": lambda m: m["p_exchanged"] <= P_LIMIT,
        "p at most 1 %, both": lambda m: max(m["p_kernels"], m["p_exchanged"]) <= P_LIMIT,
    }.items():
        some = [m for t in trials for m in t["members"] if passes(m)]
        right = sum(m["right"] for m in some)
        yield f"by hand, {words}: {right} right, {len(some) - right} wrong or false"


def _of_claims(trials: Sequence[Trial]) -> Iterator[str]:
    claims = [c for t in trials for c in t["claims"]]
    right, wrong = ([c for c in claims if c["right"] is is_right] for is_right in (True, False))
    yield f"by evidence: {len(right)} claims right, {len(wrong)} not"
    beyond = [sum(c["promised"] > STEADIES for c in some) for some in (right, wrong)]
    yield f"of these promise more than {STEADIES} times what they do: {beyond[0]} right, {beyond[1]} not"
    mixed = [sum(c["p"] > P_LIMIT for c in some) for some in (right, wrong)]
    yield f"of these have p above 1 % by exchanged histories: {mixed[0]} right, {mixed[1]} not"


def read(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--first-seed", type=int, default=40_100)
    arguments.add_argument("--seeds", type=int, default=12)
    arguments.add_argument("--strata", nargs="*", choices=STRATA, default=list(STRATA))
    arguments.add_argument("--minutes", type=float, default=float("inf"))
    arguments.add_argument("--out", type=Path)
    arguments.add_argument("--read", type=Path)
    given = arguments.parse_args()
    if given.read:
        print(report(read(given.read)))
        return
    trials = read(given.out) if given.out else []
    done, end = {(t["stratum"], t["seed"]) for t in trials}, monotonic() + 60 * given.minutes
    for seed in seeds_of(given.first_seed, given.seeds, sealed=False):
        for stratum in given.strata:
            if (stratum, seed) in done or monotonic() > end:
                continue
            with threadpool_limits(1):
                trials.append(judge(stratum, seed))
            if given.out:
                with given.out.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(trials[-1]) + "\n")
            print(stratum, seed, *(trials[-1][who]["outcome"] for who in WHO), sep="\t", file=sys.stderr)
    print(report(trials))


if __name__ == "__main__":
    main()
