"""The table of the blind benchmark: a row a stratum, counted from trials as they are written to a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import mean, median
from typing import Any

from thermodata.virtual.blind.rivals import RIVALS
from thermodata.virtual.lathe.strata import STRATA

Row = dict[str, Any]
NAMED = ("right", "equivalent")


def wilson(hits: int, of: int, z: float = 1.96) -> tuple[float, float] | None:
    """The interval of 95 % of a share, by Wilson's score (Wilson 1927); None of none."""
    if of == 0:
        return None
    p = hits / of
    middle = (p + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * (p * (1 - p) / of + z * z / (4 * of * of)) ** 0.5
    return max(middle - half, 0.0), min(middle + half, 1.0)


def rows(trials: Sequence[Mapping[str, Any]]) -> list[Row]:
    """One a stratum, in the order of `STRATA`, and two for all: with a cause to be named, and with none."""
    found = [_row(name, [t for t in trials if t["stratum"] == name]) for name in STRATA]
    asked = [t for t in trials if _asked(t)]
    found += [_row("all with a cause", asked), _row("all without", [t for t in trials if not _asked(t)])]
    return [r for r in found if r["machines"]]


def _asked(t: Mapping[str, Any]) -> bool:
    """Whether there is something that the diagnosis could name rightly."""
    kind = STRATA[t["stratum"]]
    return bool(t["hidden"]) and not kind.blind and not kind.outside


def _row(name: str, trials: Sequence[Mapping[str, Any]]) -> Row:
    asked = [t for t in trials if _asked(t)]
    rest = [t for t in trials if not _asked(t)]
    right = sum(t["outcome"] in NAMED for t in asked)
    false = sum(t["outcome"] == "false claim" for t in rest)
    shares = [t["share"] for t in asked if t["share"] is not None]
    tried = [t for t in asked if t["rivals"]]
    return {
        "stratum": name,
        "machines": len(trials),
        "asked": len(asked),
        "named": right,
        "named_interval": wilson(right, len(asked)),
        "exact": sum(t["outcome"] == "right" for t in asked),
        "told": sum(t["outcome"] == "told" for t in asked),
        "family": sum(t["outcome"] in ("family", "some") for t in asked),
        "wrong": sum(t["outcome"] == "wrong" for t in asked),
        "abstained": sum(t["outcome"] == "abstained" for t in asked),
        "ranked_first": sum(t["first"] in ("exact", "equivalent") for t in asked),
        "nothing_to_name": len(rest),
        "false_claims": false,
        "false_interval": wilson(false, len(rest)),
        "said_none": sum(t["verdict"] == "none" for t in rest),
        "known_again": sum(t["known_again"] > 0 for t in trials),
        "share_median": median(shares) if shares else None,
        "share_mean": mean(shares) if shares else None,
        "share_of": len(shares),
        "faults": sum(t["faults"] for t in trials),
        "faults_found": sum(t["faults_found"] for t in trials),
        "seconds": median(t["seconds"] for t in trials) if trials else None,
        "rivals_of": len(tried),
        "rivals": {m: sum(t["rivals"][m] for t in tried) for m in RIVALS} if tried else {},
    }


def table_rows(found: Sequence[Row]) -> list[Row]:
    """The same as text, for a terminal."""
    return [
        {
            "stratum": r["stratum"],
            "n": r["machines"],
            "named right": _share(r["named"], r["asked"], r["named_interval"]),
            "exact": r["exact"] if r["asked"] else "",
            "told": r["told"] if r["asked"] else "",
            "family": r["family"] if r["asked"] else "",
            "wrong": r["wrong"] if r["asked"] else "",
            "silent": r["abstained"] if r["asked"] else "",
            "first": _percent(r["ranked_first"], r["asked"]),
            "false claim": _share(r["false_claims"], r["nothing_to_name"], r["false_interval"]),
            "drop": ""
            if r["share_median"] is None
            else f"{r['share_median']:.2f} / {r['share_mean']:.2f} of {r['share_of']}",
            "faults": f"{r['faults_found']}/{r['faults']}" if r["faults"] else "",
            "s": f"{r['seconds']:.1f}",
            **{short: _percent(r["rivals"].get(m, 0), r["rivals_of"]) for m, short in SHORT.items()},
        }
        for r in found
    ]


SHORT = dict(zip(RIVALS, ("raw", "delay", "BIC", "LASSO", "SINDy"), strict=True))


def _percent(hits: int, of: int) -> str:
    return f"{hits / of:.0%}" if of else ""


def _share(hits: int, of: int, interval: tuple[float, float] | None) -> str:
    if interval is None:
        return ""
    return f"{hits}/{of} ({interval[0]:.0%}-{interval[1]:.0%})"
