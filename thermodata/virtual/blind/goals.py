"""The few figures that a rule is judged by, over all strata, each with its interval and its goal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from thermodata.virtual.blind.machines import STRATA
from thermodata.virtual.blind.rivals import RIVALS
from thermodata.virtual.blind.tally import NAMED, Row, Trials, asked, row, share_of


def overall(trials: Trials) -> list[Row]:
    """Rows of question, value (a share with its interval, or a median and a mean), goal. What no trial asks is left
    out."""

    def hiding(*counts: int) -> Trials:
        return [t for t in able if len(t["hidden"]) in counts]

    able, none = [t for t in trials if asked(t)], [t for t in trials if not t["hidden"]]
    strong, one = [t for t in trials if t["stratum"] == "strong"], hiding(1)
    several = [t for t in able if len(t["hidden"]) > 1]
    blind = [t for t in trials if STRATA[t["stratum"]].blind]
    outside = [t for t in trials if STRATA[t["stratum"]].outside]
    tried = [t for t in strong if t["rivals"]]
    first = [_count("one strong, logged: ranked first", strong, _leads, ">= 97 %")]
    first += [_count(f"one strong, logged: ranked first by {m}", tried, partial(_rival_leads, m), "") for m in RIVALS]
    found = [
        _count("one strong, logged: named right", strong, _is_named_right, ">= 90 %"),
        _count("one strong, logged: named wrong", strong, _ends("wrong"), "<= 2 %"),
        *first,
        _count("one, logged, any stratum: named right", one, _is_named_right, ""),
        _count("one, logged, any stratum: named wrong", one, _ends("wrong"), "<= 2 %"),
        _count("nothing hidden: false claim", none, _ends("false claim"), "<= 2 %"),
        _count("nothing hidden: none or refine", none, lambda t: t["verdict"] in ("none", "refine"), ""),
        _count("cause not logged: false claim", blind, _ends("false claim"), "<= 2 %"),
        _count("cause not logged: unknown", blind, lambda t: t["verdict"] == "unknown", ""),
        _count("outside of the library: false claim", outside, _ends("false claim"), ""),
        _count("two hidden: all found", hiding(2), _is_named_right, ">= 80 %"),
        _count("three hidden: all found", hiding(3), _is_named_right, ">= 80 %"),
        _count("several hidden: some found, nothing wrong", several, _ends(*NAMED, "told", "alike", "some"), ""),
        _count("several hidden: something wrong", several, _ends("wrong"), ""),
        _count("a cause to name: ranked first", able, _leads, ""),
        _count("a broken channel is claimed", [t for t in trials if t["broken"]], lambda t: t["broken_claimed"], "0"),
        _share("share of the drop, all machines", row("", able)["share"], "median >= 0.97, mean >= 0.9"),
        _share("share of the drop, where something is claimed", row("", able)["share_of_claims"], ""),
    ]
    return [r for r in found if r["value"] and r["value"]["of"]]


def _count(question: str, trials: Trials, hit: Callable[[Mapping[str, Any]], bool], goal: str) -> Row:
    return {"question": question, "value": share_of(sum(bool(hit(t)) for t in trials), len(trials)), "goal": goal}


def _share(question: str, value: Row | None, goal: str) -> Row:
    return {"question": question, "value": value, "goal": goal}


def _is_named_right(t: Mapping[str, Any]) -> bool:
    return bool(t["outcome"] in NAMED)


def _leads(t: Mapping[str, Any]) -> bool:
    return bool(t["first_mark"] in ("exact", "equivalent"))


def _ends(*outcomes: str) -> Callable[[Mapping[str, Any]], bool]:
    return lambda t: t["outcome"] in outcomes


def _rival_leads(method: str, t: Mapping[str, Any]) -> bool:
    return bool(t["rivals"][method])
