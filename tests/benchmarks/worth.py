"""What trials of the blind benchmark say where the right names are worth something (docs/benchmark.md).

    python tests/benchmarks/worth.py trials.jsonl [more.jsonl ...]

Many a hidden cause takes little off the locked tests, and some nothing, for these may not work it: whether it is named
there matters little to anybody. So the machines are told apart by the share of the locked error that the right names
take off. FILE is what `thermodata benchmark-diagnosis --out FILE` wrote; several are counted as one. Printed as
Markdown, as the page has it: all strata together, then a row a stratum.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from statistics import mean, median
from typing import Any

from thermodata.virtual.blind.rivals import RIVALS
from thermodata.virtual.blind.run import read
from thermodata.virtual.blind.tally import NAMED, asked, groups, wilson

Trial = Mapping[str, Any]
BANDS = ((-float("inf"), 0.0), (0.0, 0.1), (0.1, 0.3), (0.3, 0.5), (0.5, 0.7), (0.7, 1.0))
STATED = (0.0, 0.7, 0.8, 0.9, 1.01)


def worth(t: Trial) -> float | None:
    """Share of the locked error that the right names take off; negative where they add to it."""
    before, named = t["rmse_um"], t["rmse_um_named"]
    return 1 - named / before if before and named is not None else None


def named(t: Trial) -> bool:
    return t["outcome"] in NAMED


def first(t: Trial) -> bool:
    return t["first_mark"] in ("exact", "equivalent")


def wrong(t: Trial) -> bool:
    return t["outcome"] == "wrong"


def told(t: Trial) -> bool:
    return t["outcome"] == "told"


def reassured(t: Trial) -> bool:
    return t["verdict"] in ("none", "refine")


def false_claim(t: Trial) -> bool:
    return t["outcome"] == "false claim"


def beside(t: Trial) -> bool:
    return t["outcome"] == "family"


def count(trials: Sequence[Trial], hit: Callable[[Trial], bool]) -> str:
    """ "3 of 8 (14-69 %)"."""
    hits, of = sum(map(hit, trials)), len(trials)
    around = wilson(hits, of)
    return "-" if around is None else f"{hits} of {of} ({100 * around[0]:.0f}-{100 * around[1]:.0f} %)"


def best_rival(trials: Sequence[Trial]) -> str:
    tried = [t for t in trials if t["rivals"]]
    if not tried:
        return "-"
    shares = {m: sum(t["rivals"][m] for t in tried) / len(tried) for m in RIVALS}
    return max((f"{100 * share:.0f} %, {m}" for m, share in shares.items()), key=lambda s: float(s.split()[0]))


def worth_at_least(trials: Sequence[Trial], least: float) -> list[Trial]:
    return [t for t in trials if (w := worth(t)) is not None and w >= least]


def of_the_drop(trials: Sequence[Trial]) -> str:
    """Median, mean, and the mean where more than all counts as all."""
    shares = [t["share"] for t in trials if t["share"] is not None]
    if not shares:
        return "-"
    capped = mean(min(s, 1.0) for s in shares)
    return f"median {median(shares):.2f}, mean {mean(shares):.2f} ({capped:.2f}) of {len(shares)}"


def together(trials: Sequence[Trial]) -> list[tuple[str, str]]:
    """(question, answer) over all strata."""
    able = [t for t in trials if asked(t)]
    one = [t for t in able if len(t["hidden"]) == 1]
    nothing = [t for t in trials if not t["hidden"]]
    claims = [s for t in trials for s in t["stated"] if s["of"] == "claim" and s["probability"] is not None]
    found = [
        ("one cause hidden, logged: named right", count(one, named)),
        ("its cause named among twins, or as the other part", count(one, told)),
        ("named wrong", count(one, wrong)),
        ("takes off a tenth of the locked error: named right", count(worth_at_least(one, 0.1), named)),
        ("takes off 30 %: named right", count(worth_at_least(one, 0.3), named)),
        ("takes off 30 %: ranked first", count(worth_at_least(one, 0.3), first)),
        ("takes off half: named right", count(worth_at_least(one, 0.5), named)),
        ("takes off half: ranked first", count(worth_at_least(one, 0.5), first)),
        ("a cause to name: ranked first", count(able, first)),
        ("a cause to name: ranked first by the best simple method", best_rival(able)),
        ("nothing hidden: false claim", count(nothing, false_claim)),
        ("nothing hidden: none or refine", count(nothing, reassured)),
        ("a cause hidden, of any kind: none or refine", count([t for t in trials if t["hidden"]], reassured)),
    ]
    for stratum in ("not_logged", "outside"):
        own = [t for t in trials if t["stratum"] == stratum]
        found.append((f"{stratum}: false claim", count(own, false_claim)))
        found.append((f"{stratum}: a claim that names its part beside", count(own, beside)))
    found += [
        (f"{kind} hidden: all found", count([t for t in trials if t["stratum"] == kind], named))
        for kind in ("two", "three")
    ]
    found.append(("share of the drop, all machines", of_the_drop(able)))
    found.append(("share of the drop, where something is claimed", of_the_drop([t for t in able if t["claims"]])))
    refined = [t for t in nothing if t["rmse_um_refined"] is not None and t["rmse_um"]]
    found.append(("nothing hidden: the locked error falls with what refine offers first", count(refined, _falls)))
    for low, high in pairwise(STATED):
        own = [s for s in claims if low <= s["probability"] < high]
        found.append(
            (f"claims stated at {100 * low:.0f} to {min(100 * high, 100):.0f} %: a hidden cause", count(own, _right))
        )
    found += [
        (f"the right names take off {_band(low, high)}: right; first", _both(one, low, high)) for low, high in BANDS
    ]
    return found


def _band(low: float, high: float) -> str:
    return "nothing, or add to it" if low < 0 else f"{100 * low:.0f} to {100 * high:.0f} %"


def _falls(t: Trial) -> bool:
    return bool(t["rmse_um_refined"] < t["rmse_um"])


def _right(stated: Mapping[str, Any]) -> bool:
    return bool(stated["right"])


def _both(trials: Sequence[Trial], low: float, high: float) -> str:
    own = [t for t in trials if (w := worth(t)) is not None and low <= w < high]
    return f"{count(own, named)}; {sum(map(first, own))}"


def by_stratum(trials: Sequence[Trial]) -> list[str]:
    """A Markdown row a stratum, or number of causes where it is drawn, in which there is something to name."""
    found = []
    for name, of in groups(trials):
        own = [t for t in of if asked(t)]
        if own:
            cells = [
                f"`{name}`",
                count(own, named),
                str(sum(map(wrong, own))),
                str(sum(map(told, own))),
                count(worth_at_least(own, 0.1), named),
                count(own, first),
                best_rival(own),
                of_the_drop(own),
            ]
            found.append(f"| {' | '.join(cells)} |")
    return found


def main(files: Sequence[str]) -> None:
    trials = [t for file in files for t in read(Path(file))]
    print(f"{len(trials)} trials, rules {', '.join(sorted({t['rules'] for t in trials}))}\n\n| | |\n|---|---|")
    for question, answer in together(trials):
        print(f"| {question} | {answer} |")
    heads = (
        "stratum",
        "named right",
        "wrong",
        "told",
        "worth a tenth: right",
        "ranked first",
        "best simple",
        "share of the drop",
    )
    print(f"\n| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    print("\n".join(by_stratum(trials)))


if __name__ == "__main__":
    main(sys.argv[1:])
