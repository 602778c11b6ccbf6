"""Machines that others made, kept: from raw logs through the commands to a verdict, and what is right of it.

    uv run python tests/benchmarks/outside.py run OUT.jsonl [--make small_mill] [--cases 0-23] [--jobs 2]
    uv run python tests/benchmarks/outside.py table OUT.jsonl [BEFORE.jsonl]

A make is a package of `makes/`: a machine with its laboratory, written by somebody who had not read the diagnosis.
`write(folder, case)` writes campaign.yaml, model.yaml and raw logs, and answers the truth:

    kind    one, half (one that acts in half of the tests), two, three, none, not_logged, outside or fault
    hidden  [{cause, um, right: [candidate ids], twins: [ids of other readings of its part or its heat]}]
    fault   what is wrong with the logs, or null

`run` goes on where OUT ends, a line a case. Claims are added and the better model is asked again while more is hidden
than is claimed. *Worth* is the share of the locked error that the first right name takes off, by `confirm`. A make has
been seen once rules were looked at on it: `table` counts then what a change of the rules keeps, and nothing more.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from statistics import median
from typing import Any

from measure import PROGRAM, table

MAKES = Path(__file__).parent / "makes"
ROUNDS = 3
DONE = (0, 3)  # exit codes of a command that answered
REFUSED = 2  # of one that says what is wrong with what it was asked
Truth = Mapping[str, Any]


@dataclass(frozen=True)
class Claim:
    id: str
    mark: str  # right, twin, wrong
    probability: float | None


@dataclass(frozen=True)
class Asked:
    """One case. worth: share of the locked error, None where nothing is hidden or the name is refused. first: mark of
    the candidate that is listed first. um: locked errors of the model, and with all claims. refined: what a verdict
    without a cause offers first, and locked errors without and with it."""

    make: str
    case: int
    kind: str
    hidden: list[str]
    worth: float | None
    verdict: str
    claims: list[Claim]
    found: list[str]
    first: Claim | None
    um: list[float | None]
    artefacts: list[str]
    fault: str | None
    losses: list[str]
    refined: tuple[Claim, float | None, float | None] | None = None


class RefusedError(RuntimeError):
    """A command refused what it was asked, and did not fail."""


class Lab:
    """The commands on one store."""

    def __init__(self, folder: Path, program: str) -> None:
        self.folder, self.program = folder, program

    def ask(self, *words: object) -> Any:
        told = [self.program, *map(str, words), "--store", str(self.folder / "store"), "--json"]
        done = subprocess.run(told, cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode not in DONE:
            kind = RefusedError if done.returncode == REFUSED else RuntimeError
            raise kind(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr[-2000:]}")
        return json.loads(done.stdout)


def make_of(name: str) -> Callable[[Path, int], Truth]:
    written: Callable[[Path, int], Truth] = import_module(f"makes.{name}").write
    return written


def ask(name: str, case: int, program: str) -> Asked:
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        truth = make_of(name)(folder, case)
        lab = Lab(folder, program)
        taken = lab.ask("ingest", folder / "campaign.yaml")
        model = lab.ask("fit", folder / "model.yaml")["model"]
        said = first = lab.ask("diagnose", model)
        claims: list[Mapping[str, Any]] = []
        asked_of, um = model, [said["locked_rmse_um"], None]
        for _ in range(ROUNDS):
            new = [c for c in said["candidates"] if c["claimed"]]
            claims += new
            if new:
                asked_of, before, um[1] = with_all(lab, asked_of, [c["id"] for c in new])
                um[0] = before if um[0] is None else um[0]
            if not new or len(claims) >= len(truth["hidden"]):
                break
            said = lab.ask("diagnose", asked_of)
        marked, found = marks(truth["hidden"], claims)
        listed = [c for c in first["candidates"] if not c["refinement"]][:1]
        return Asked(
            make=name,
            case=case,
            kind=truth["kind"],
            hidden=[h["cause"] for h in truth["hidden"]],
            worth=worth(lab, model, truth["hidden"]),
            verdict=first["verdict"],
            claims=marked,
            found=found,
            first=marks(truth["hidden"], listed)[0][0] if listed else None,
            um=um,
            artefacts=[a["kind"] for a in first["artefacts"]],
            fault=truth["fault"],
            losses=[str(loss) for loss in taken["losses"]],
            refined=refined(lab, model, first, truth["hidden"]) if first["verdict"] == "refine" else None,
        )


def with_all(lab: Lab, model: str, claims: Sequence[str]) -> tuple[str, float | None, float | None]:
    """(the model with all claims of its diagnosis, its locked errors without and with all of them)."""
    added = lab.ask("add", model, *claims)
    return added["model"], added["locked_rmse_um_before"], added["locked_rmse_um_after"]


def worth(lab: Lab, model: str, hidden: Sequence[Truth]) -> float | None:
    """Of the first right name alone: with two hidden, what is left of the other stands in both errors."""
    if not hidden or not hidden[0]["right"]:
        return None
    before, after = on_locked(lab, model, hidden[0]["right"][0])
    return None if not before or after is None else 1 - after / before


def on_locked(lab: Lab, model: str, candidate: str) -> tuple[float | None, float | None]:
    """Locked errors without and with it; None where they can't be asked of it."""
    try:
        said = lab.ask("confirm", model, candidate)
    except RefusedError:
        return None, None
    return said["locked_rmse_um_before"], said["locked_rmse_um_after"]


def refined(
    lab: Lab, model: str, said: Mapping[str, Any], hidden: Sequence[Truth]
) -> tuple[Claim, float | None, float | None] | None:
    offered = next((c for c in said["candidates"] if c["refinement"]), None)
    if offered is None:
        return None
    return marks(hidden, [offered])[0][0], *on_locked(lab, model, offered["id"])


def marks(hidden: Sequence[Truth], claims: Sequence[Mapping[str, Any]]) -> tuple[list[Claim], list[str]]:
    """What each claim is, and which causes are found by their right name: each by one claim."""
    open_ = list(hidden)
    marked = []
    for c in claims:
        cause = next((h for h in open_ if c["id"] in h["right"]), None)
        if cause is not None:
            open_.remove(cause)
        marked.append(Claim(c["id"], "right" if cause is not None else _else(hidden, c), c["probability"]))
    return marked, [h["cause"] for h in hidden if h not in open_]


def _else(hidden: Sequence[Truth], c: Mapping[str, Any]) -> str:
    named = {c["id"], *c["equivalent"]}
    return "twin" if any(named & {*h["right"], *h["twins"]} for h in hidden) else "wrong"


def run(out: Path, names: Sequence[str], cases: Sequence[int], jobs: int, program: str) -> None:
    kept = {(row["make"], row["case"]) for row in read(out)} if out.exists() else set()
    todo = [(n, c) for n in names for c in cases if (n, c) not in kept]
    with ThreadPoolExecutor(jobs) as pool, out.open("a") as file:
        for (name, case), asked in zip(todo, pool.map(lambda pair: ask(*pair, program), todo), strict=True):
            file.write(json.dumps(asdict(asked)) + "\n")
            file.flush()
            print(f"{name} {case}: {asked.verdict} {[c.id for c in asked.claims]}", file=sys.stderr)


def read(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text().splitlines()]


def outcome(row: Mapping[str, Any]) -> str:
    said = {c["mark"] for c in row["claims"]}
    if row["hidden"] and len(row["found"]) == len(row["hidden"]) and "wrong" not in said:
        return "right"
    return next((mark for mark in ("wrong", "right", "twin") if mark in said), "silent").replace("right", "some")


ONE = ("one", "half")
SORTS: Mapping[str, Callable[[Mapping[str, Any]], bool]] = {
    "one, worth 30 %": lambda r: r["kind"] in ONE and r["worth"] is not None and r["worth"] >= 0.3,
    "one, worth 10 to 30 %": lambda r: r["kind"] in ONE and r["worth"] is not None and 0.1 <= r["worth"] < 0.3,
    "one, worth less": lambda r: r["kind"] in ONE and r["worth"] is not None and r["worth"] < 0.1,
    "one, worth not known": lambda r: r["kind"] in ONE and r["worth"] is None,
    "two or three": lambda r: r["kind"] in ("two", "three"),
    "nothing hidden": lambda r: r["kind"] == "none",
    "not logged, outside": lambda r: r["kind"] in ("not_logged", "outside"),
    "a fault of the logs": lambda r: r["kind"] == "fault",
}
OUTCOMES = ("right", "some", "twin", "wrong", "silent")


def rows(found: Sequence[Mapping[str, Any]]) -> Iterator[list[object]]:
    for make in [*sorted({r["make"] for r in found}), None]:
        for sort, is_one in SORTS.items():
            of = [r for r in found if is_one(r) and make in (None, r["make"])]
            if of:
                counts = [sum(outcome(r) == o for r in of) for o in OUTCOMES]
                first = sum(r["first"] is not None and r["first"]["mark"] == "right" for r in of)
                yield [make or "together", sort, len(of), *counts, first]


def refinements(found: Sequence[Mapping[str, Any]]) -> Iterator[list[object]]:
    """Of verdicts without a cause that offer a refinement: what the locked tests say of the first one."""
    for sort, is_one in SORTS.items():
        of = [r["refined"] for r in found if is_one(r) and r.get("refined")]
        falls = [1 - after / before for _, before, after in of if before and after is not None]
        if falls:
            named = sum(claim["mark"] in ("right", "twin") for claim, _, _ in of)
            yield [sort, len(of), sum(f > 0 for f in falls), f"{median(falls):.0%}", named]


def changed(before: Sequence[Mapping[str, Any]], now: Sequence[Mapping[str, Any]]) -> Iterator[list[object]]:
    old = {(r["make"], r["case"]): r for r in before}
    for r in now:
        was = old.get((r["make"], r["case"]))
        if was is not None and [c["id"] for c in was["claims"]] != [c["id"] for c in r["claims"]]:
            yield [r["make"], r["case"], ", ".join(r["hidden"]), *map(_shown, (was, r))]


def _shown(row: Mapping[str, Any]) -> str:
    claims = ", ".join(f"{c['id']} ({c['mark']})" for c in row["claims"])
    ends = " -> ".join("-" if um is None else f"{um:.2f}" for um in row["um"])
    return f"{row['verdict']}: {claims or '-'}; {ends} um"


def main() -> None:
    known = sorted(path.parent.name for path in MAKES.glob("*/__init__.py"))
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = asked.add_subparsers(dest="verb", required=True)
    running = verbs.add_parser("run")
    running.add_argument("out", type=Path)
    running.add_argument("--make", nargs="*", default=known, choices=known)
    running.add_argument("--cases", default="0-23", help="first-last, or numbers with commas between them")
    running.add_argument("--jobs", type=int, default=2)
    running.add_argument("--program", default=PROGRAM, help="another thermodata, to compare with")
    showing = verbs.add_parser("table")
    showing.add_argument("out", type=Path)
    showing.add_argument("before", type=Path, nargs="?")
    words = asked.parse_args()
    if words.verb == "run":
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        first, _, last = words.cases.partition("-")
        cases = range(int(first), int(last) + 1) if last else [int(c) for c in words.cases.split(",")]
        run(words.out, words.make, list(cases), words.jobs, words.program)
    else:
        found = read(words.out)
        print(table(["make", "hidden", "cases", *OUTCOMES, "first"], list(rows(found))))
        offered = list(refinements(found))
        print(table(["hidden", "refinements", "locked error falls", "by (median)", "of what is hidden"], offered))
        if words.before:
            print(table(["make", "case", "hidden", "before", "now"], list(changed(read(words.before), found))))


if __name__ == "__main__":
    main()
