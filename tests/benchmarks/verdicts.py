"""Whether two versions give the same verdicts, and what a verdict costs in processor seconds.

    uv run python tests/benchmarks/verdicts.py dump OUT.jsonl [--case NAME ...]
    uv run python tests/benchmarks/verdicts.py compare BEFORE.jsonl AFTER.jsonl

A case is a simulated machine: one effect hidden, two, none, or one whose sensors are not in the log. `dump` writes a
line for each case: the answer, every ranking behind it in full, and the seconds of `answer` (the fit of the model that
is asked about and the making of the data are no part of it). `compare` fails where an answer differs: words, verdicts,
order and p values exactly, other numbers by more than 1e-9 of themselves.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# one thread, as a lab's other work would leave it: seconds of processor time then mean work, not waiting
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from measure import machine, table

RELATIVE = 1e-9
EXACT = ("p_value",)
NOT_COMPARED = ("seconds",)
OF_ONE = ("explainable",)  # 1 - a ratio of errors: as exact as the ratio


@dataclass(frozen=True)
class Case:
    """forget: known effects that the baseline lacks besides the hidden one. few: channels left, None for all."""

    hide: str
    seed: int
    tests: int = 10
    logged: bool = True
    forget: int = 0
    few: int | None = None

    @property
    def name(self) -> str:
        words = [self.hide, self.seed, f"{self.tests}t"]
        words += ["not-logged"] * (not self.logged) + [f"two{self.forget}"] * bool(self.forget)
        words += [f"{self.few}c"] * (self.few is not None)
        return "-".join(map(str, words))


SAME = (
    Case("coolant", 3),
    Case("feed_screw", 1),
    Case("spindle_bearing", 2),
    Case("column_bending", 4),
    Case("tool_elongation", 5),
    Case("ambient_frame", 6),
    Case("none", 3),
    Case("none", 8),
    Case("coolant", 3, logged=False),
    Case("hydraulics", 2, logged=False),
    Case("spindle_friction", 7, logged=False),
    Case("coolant", 3, forget=1),
    Case("feed_motor", 4, forget=1),
    Case("table_bearing", 5, tests=3),
    Case("hydraulics", 1, tests=2),
    Case("probe_temperature", 9, few=25),
)
TIMED = (
    *(Case("none", 1, tests=n) for n in (5, 10, 20, 40)),
    Case("coolant", 3, few=25),
    Case("none", 3, few=25),
    Case("coolant", 3, logged=False, few=25),
    Case("coolant", 3, forget=1, few=25),
    Case("feed_screw", 1, tests=40, few=30),
    Case("coolant", 3, tests=40, logged=False, few=30),
)
CASES = {c.name: c for c in (*SAME, *TIMED)}


def dump(cases: Sequence[Case], out: Path) -> None:
    with out.open("w", encoding="utf-8") as file:
        for case in cases:
            line = diagnosed(case)
            file.write(json.dumps(line) + "\n")
            file.flush()
            print(f"{case.name}: {line['diagnosis']['verdict']} {line['seconds']:.2f} s", file=sys.stderr)


def diagnosed(case: Case) -> dict[str, Any]:
    """The answer and the rankings behind it, as plain values."""
    from dataclasses import replace

    from thermodata.diagnosis.answer import answer
    from thermodata.diagnosis.verdict import selection
    from thermodata.effect import effects
    from thermodata.modelling.fit.model import fit_model
    from thermodata.virtual.gantry.binned import to_dataset
    from thermodata.virtual.gantry.world import make_world

    world = make_world(case.hide, case.seed, tests=case.tests, measured=case.logged)
    spec, data = world.baseline(), to_dataset(world, 60.0)
    if case.forget:
        kept = [e for e in spec.effects if e.effect != "centrifugal_shift"]
        spec = spec.model_copy(update={"effects": kept[: -case.forget]})
    if case.few is not None:
        needed = {c for e in world.baseline().effects for c in e.drivers.values()} | {world.response}
        spare = [n for n in data.channels if n not in needed]
        gone = set(spare[: max(0, len(data.channels) - case.few)])
        infos = {n: c for n, c in data.channels.items() if n not in gone}
        tests = tuple(
            replace(
                t,
                values={n: v for n, v in t.values.items() if n not in gone},
                valid={n: v for n, v in t.valid.items() if n not in gone},
                channels=infos,
            )
            for t in data.tests
        )
        data = replace(data, tests=tests, channels=infos)
    library = effects()
    fitted = fit_model(spec, data, uncertainty=False)
    rankings: list[Any] = []
    original = selection.rank_in

    def watched(*words: Any, **named: Any) -> Any:
        found = original(*words, **named)
        rankings.append([s for s in found.ranked if len(s.rows)])
        return found

    selection.rank_in = watched  # type: ignore[assignment]
    try:
        start = time.process_time()
        found = answer(fitted, data, library, "verdicts").diagnosis
        seconds = time.process_time() - start
    finally:
        selection.rank_in = original
    return {
        "case": case.name,
        "channels": len(data.channels),
        "tests": len(data.tests),
        "diagnosis": found.model_dump(mode="json"),
        "rankings": [[plain(s) for s in ranked] for ranked in rankings],
        "seconds": seconds,
    }


def plain(scored: Any) -> dict[str, Any]:
    """All of a scored candidate; its shape by a few sums, which no change of more than rounding leaves as they are."""
    rows = range(1, len(scored.shape) + 1)
    return {
        "id": scored.candidate.id,
        "evidence": scored.evidence,
        "gained": scored.gained.tolist(),
        "sse_before": scored.sse_before.tolist(),
        "sse_after": scored.sse_after.tolist(),
        "own_before": scored.own_before.tolist(),
        "own_after": scored.own_after.tolist(),
        "size": scored.size.tolist(),
        "spread": scored.spread,
        "shape": [sum(v * math.sin(k * i) for i, v in zip(rows, scored.shape, strict=True)) for k in (0.01, 1.0)],
    }


def differences(before: Any, after: Any, where: str = "") -> Iterator[str]:
    """Where two answers differ."""
    key = where.rpartition(".")[2]
    if isinstance(before, dict) and isinstance(after, dict):
        for name in dict.fromkeys([*before, *after]):
            if name not in NOT_COMPARED:
                yield from differences(before.get(name), after.get(name), f"{where}.{name}")
    elif isinstance(before, list) and isinstance(after, list):
        if len(before) != len(after):
            yield f"{where}: {len(before)} items, then {len(after)}"
        size = max((abs(v) for v in before if isinstance(v, float)), default=0.0)
        for i, (a, b) in enumerate(zip(before, after, strict=False)):
            # a vector's elements are as exact as the vector
            if isinstance(a, float) and isinstance(b, float) and key not in EXACT:
                if not abs(a - b) <= RELATIVE * size:
                    yield f"{where}[{i}]: {a!r}, then {b!r}"
            else:
                yield from differences(a, b, f"{where}[{i}]")
    elif isinstance(before, float) and isinstance(after, float) and key not in EXACT:
        if key in OF_ONE:
            before, after = 1.0 - before, 1.0 - after
        if not math.isclose(before, after, rel_tol=RELATIVE, abs_tol=1e-13) and not (
            math.isnan(before) and math.isnan(after)
        ):
            yield f"{where}: {before!r}, then {after!r}"
    elif before != after:
        yield f"{where}: {before!r}, then {after!r}"


def largest_change(before: Any, after: Any) -> float:
    """Of all numbers but seconds, relative."""
    if isinstance(before, dict):
        return max((largest_change(v, after[k]) for k, v in before.items() if k not in NOT_COMPARED), default=0.0)
    if isinstance(before, list):
        return max((largest_change(a, b) for a, b in zip(before, after, strict=True)), default=0.0)
    if isinstance(before, float) and isinstance(after, float) and before != after:
        return abs(before - after) / max(abs(before), abs(after), 1e-13)
    return 0.0


def read(path: Path) -> dict[str, dict[str, Any]]:
    lines = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {line["case"]: line for line in lines}


def compare(before: Path, after: Path) -> int:
    """Prints a table; 1 where an answer differs."""
    old, new = read(before), read(after)
    rows, found = [], []
    for name in [n for n in old if n in new]:
        differs = list(differences(old[name], new[name], name))
        found += differs
        a, b = old[name]["seconds"], new[name]["seconds"]
        rows.append(
            [
                name,
                old[name]["tests"],
                old[name]["channels"],
                len(old[name]["rankings"]),
                old[name]["diagnosis"]["verdict"],
                f"{a:.2f}",
                f"{b:.2f}",
                f"{a / b:.1f}",
                f"{len(differs)} differ" if differs else f"equal ({largest_change(old[name], new[name]):.0e})",
            ]
        )
    print(machine())
    print(table(["case", "tests", "channels", "rankings", "verdict", "before [s]", "after [s]", "ratio", ""], rows))
    for line in found[:40]:
        print(line)
    return 1 if found or not rows else 0


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = arguments.add_subparsers(dest="command", required=True)
    dumping = commands.add_parser("dump")
    dumping.add_argument("out", type=Path)
    dumping.add_argument("--case", nargs="*", choices=list(CASES), default=list(CASES))
    comparing = commands.add_parser("compare")
    comparing.add_argument("before", type=Path)
    comparing.add_argument("after", type=Path)
    given = arguments.parse_args()
    if given.command == "compare":
        return compare(given.before, given.after)
    dump([CASES[name] for name in given.case], given.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
