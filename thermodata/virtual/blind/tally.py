"""The tables of the blind benchmark: a row a stratum, counted from trials as they are written to a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from statistics import mean, median
from typing import Any, get_args

from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.virtual.blind.machines import STRATA
from thermodata.virtual.blind.rivals import RIVALS

Row = dict[str, Any]
Trials = Sequence[Mapping[str, Any]]
NAMED = ("right", "equivalent")
ENDS = ("right", "told", "alike", "family", "some", "wrong", "abstained")
VERDICTS: tuple[str, ...] = get_args(Diagnosis.model_fields["verdict"].annotation)
WITH_A_CAUSE, WITHOUT = "all with a cause", "all without"
MISSING = {"1 missing": (1,), "2 missing": (2,), "3 missing": (3,), "4 to 6 missing": (4, 5, 6)}


def wilson(hits: int, of: int) -> tuple[float, float] | None:
    """The interval of 95 % of a share, by Wilson's score (Wilson 1927); None of none."""
    if of == 0:
        return None
    p, z = hits / of, 1.96
    middle = (p + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * (p * (1 - p) / of + z * z / (4 * of * of)) ** 0.5
    return max(middle - half, 0.0), min(middle + half, 1.0)


def share_of(hits: int, of: int) -> Row:
    """A count with its share's interval, as JSON has it."""
    return {"hits": hits, "of": of, "interval": wilson(hits, of)}


def asked(t: Mapping[str, Any]) -> bool:
    """Whether there is something that the diagnosis could name rightly."""
    kind = STRATA[t["stratum"]]
    return bool(t["hidden"]) and not kind.blind and not kind.outside


def groups(trials: Trials) -> list[tuple[str, Trials]]:
    """The trials of each stratum, in the order of `STRATA`; of strata that hide as many causes as are drawn, those with
    each number of them, too.

    Machines with nothing hidden and a thin model are told apart by what that model knows of the spindle: its speed
    alone, which leaves much over that is no missing cause, or the temperature of its bearing.
    """
    found = []
    for name in STRATA:
        own = [t for t in trials if t["stratum"] == name]
        found.append((name, own))
        if STRATA[name].base == "thin":
            found.append((f"{name}, by speed", [t for t in own if t["by_speed"]]))
            found.append((f"{name}, by heat", [t for t in own if not t["by_speed"]]))
    drawn = [t for t in trials if STRATA[t["stratum"]].more]
    found += [(name, [t for t in drawn if len(t["hidden"]) in of]) for name, of in MISSING.items()]
    return [(name, own) for name, own in found if own]


def rows(trials: Trials) -> list[Row]:
    """One a group, and two for all: with a cause to be named, and with none."""
    able, rest = [t for t in trials if asked(t)], [t for t in trials if not asked(t)]
    every = [*groups(trials), (WITH_A_CAUSE, able), (WITHOUT, rest)]
    return [row(name, own) for name, own in every if own]


def row(name: str, trials: Trials) -> Row:
    """Counts of some trials. named, false_claims and verdicts: hits, of, interval of 95 %. claimed_beside: claims of
    something else where the cause is not logged, that name it or its family too."""
    able = [t for t in trials if asked(t)]
    rest = [t for t in trials if not asked(t)]
    tried = [t for t in able if t["rivals"]]
    ends = {
        e: sum(t["outcome"] == e for t in able)
        for e in ("right", "told", "alike", "family", "some", "wrong", "abstained")
    }
    shares = [t["share"] for t in able if t["share"] is not None]
    of_claims = [t["share"] for t in able if t["share"] is not None and t["claims"]]
    broken = [t for t in trials if t["broken"] is not None]
    return {
        "stratum": name,
        "machines": len(trials),
        "by_speed": sum(t["by_speed"] for t in trials),
        "asked": len(able),
        "named": share_of(sum(t["outcome"] in NAMED for t in able), len(able)),
        "exact": ends.pop("right"),
        **ends,
        "claimed_again": sum("again" in t["marks"] for t in trials),
        "in_one_go": sum(t["outcome"] in NAMED and t["rounds"] == 1 for t in able),
        "ranked_first": share_of(sum(t["first_mark"] in ("exact", "equivalent") for t in able), len(able)),
        "verdicts_asked": _verdicts(able),
        "nothing_to_name": len(rest),
        "false_claims": share_of(sum(t["outcome"] == "false claim" for t in rest), len(rest)),
        "claimed_beside": sum(t["outcome"] == "family" for t in rest),
        "verdicts": _verdicts(rest),
        "known_again": sum(t["known_again"] > 0 for t in trials),
        "refined": sum(bool(t["refinements"]) for t in trials),
        "refined_beside_the_base": sum(t["beside_the_base"] > 0 for t in trials),
        "refined_drop": _middle(
            1 - t["rmse_um_refined"] / t["rmse_um"] for t in trials if t["rmse_um_refined"] is not None and t["rmse_um"]
        ),
        "share": _middle(shares),
        "share_of_claims": _middle(of_claims),
        "broken": len(broken),
        "broken_claimed": sum(t["broken_claimed"] for t in broken),
        "broken_first": sum(t["broken_first"] for t in broken),
        "faults": sum(t["faults"] for t in trials),
        "faults_found": sum(t["faults_found"] for t in trials),
        "seconds": median(t["seconds"] for t in trials) if trials else None,
        "rivals_of": len(tried),
        "rivals": {m: sum(t["rivals"][m] for t in tried) for m in RIVALS} if tried else {},
    }


def _verdicts(trials: Trials) -> Row:
    return {v: share_of(sum(t["verdict"] == v for t in trials), len(trials)) for v in VERDICTS}


def _middle(values: Iterable[float]) -> Row | None:
    found = list(values)
    return {"median": median(found), "mean": mean(found), "of": len(found)} if found else None
