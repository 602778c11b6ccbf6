"""What a page proposes for one test, put into the test's line of the campaign file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from thermodata.draft.writing.in_line import set_in_line
from thermodata.draft.writing.write import flow, scalar
from thermodata.errors import UsageError
from thermodata.schema.files.load import parse_campaign
from thermodata.schema.strict.lines import Document, parse_document

EVERY = "*"  # no name of a test


def put(text: str, test: str, proposed: str) -> str:
    """The text with a line such as `measuring: "feed_Z == 0"` in this test, or in EVERY one that has a line of its own.
    What a test has already stays: a second rule must hold beside the first, a phase stands beside the others; a window
    is replaced. SpecError where the file would not load then; UsageError for a test that has no line of its own, a rule
    that can't be joined, or stretches of time for every test."""
    document = parse_document(text, Path("campaign.yaml"))
    given = parse_document(proposed, Path("proposed")).data
    key = next(iter(given), None) if isinstance(given, dict) and len(given) == 1 else None
    if key not in _JOINED:
        raise UsageError("this is put into no test", got=proposed[:200], expected=" or ".join(_JOINED))
    if test == EVERY and key != "measuring":
        raise UsageError("a stretch of time belongs to one test", got=proposed[:200], expected="measuring for all")
    lines = text.splitlines()
    for at in _listed(document) if test == EVERY else [_place(document, test)]:
        value = _JOINED[key](document.data["tests"][at].get(key), given[key])
        number = document.line["tests", at] - 1
        lines[number] = set_in_line(lines[number], key, value, ("tests", at))
    made = "\n".join(lines) + "\n"
    parse_campaign(made, "campaign.yaml")
    return made


def _listed(document: Document) -> list[int]:
    """Places of the tests that have a line of their own."""
    return [i for i, test in enumerate(document.data.get("tests") or []) if isinstance(test, dict)]


def _place(document: Document, test: str) -> int:
    at = next((i for i in _listed(document) if str(document.data["tests"][i].get("id")) == test), None)
    if at is None:
        raise UsageError(
            f"'{test}' has no line of its own in the campaign file",
            expected="a test in the list 'tests'",
            hint="tests that come from 'tests_from' are changed there, by hand",
        )
    return at


def _rule(before: Any, rule: Any) -> str:
    """Both hold: expressions are joined, ranges stand beside each other."""
    one, two = _long(before), _long(rule)
    made = {**one, **two}
    if "when" in one and "when" in two:
        first, second = str(one["when"]), str(two["when"])
        made["when"] = first if _says(first, second) else f"{_bracketed(first)} and {_bracketed(second)}"
    if "in_range" in one and "in_range" in two:
        if not (isinstance(one["in_range"], Mapping) and isinstance(two["in_range"], Mapping)):
            raise UsageError(
                "the test has a measuring rule of another form",
                got=str(before)[:200],
                hint=f"add '{rule}' to it by hand",
            )
        made["in_range"] = {**one["in_range"], **two["in_range"]}
    return scalar(made["when"]) if set(made) == {"when"} else f"{{{flow(made)}}}"


def _long(rule: Any) -> dict[str, Any]:
    """`measuring` in its long form."""
    if rule is None:
        return {}
    if isinstance(rule, Mapping):
        return dict(rule)
    return {"in_range": rule} if rule == "in_range" else {"when": str(rule)}


def _says(rule: str, part: str) -> bool:
    """Whether a part stands in a rule as one of the conditions that all must hold: '== 0' begins '== 0.5', and what
    stands before an 'or' need not hold."""
    return part == rule or (" or " not in rule and part in rule.split(" and "))


def _bracketed(rule: str) -> str:
    return f"({rule})" if " or " in rule else rule


def _window(_before: Any, window: Any) -> str:
    return "[" + ", ".join(scalar(end) for end in window) + "]"


def _phases(before: Any, phases: Any) -> str:
    """A name that is taken gets a number."""
    made: dict[str, Any] = dict(before) if isinstance(before, Mapping) else {}
    for name, span in phases.items():
        free = (n for n in (name, *(f"{name}{i}" for i in range(2, 1000))) if n not in made)
        made[next(free)] = span
    return f"{{{flow(made)}}}"


_JOINED: dict[str, Callable[[Any, Any], str]] = {"measuring": _rule, "window": _window, "phases": _phases}
