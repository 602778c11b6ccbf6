"""What is true of a case: truth.json, as `outside.py` asks for it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

KINDS = (
    *["one"] * 9,
    *["weak"] * 4,  # one, of half the size and less
    *["two"] * 4,
    *["none"] * 3,
    *["not_logged"] * 2,  # the cause acts, its sensors are not in the logs
    "outside",  # physics that no channel tells
    "fault",  # of the logs; nothing is missing
)


class Named(Protocol):
    """A cause. right: candidate ids. gone: channels that are not there where it is not logged."""

    @property
    def right(self) -> str: ...
    @property
    def gone(self) -> str: ...


@dataclass(frozen=True)
class Plan:
    """What a case hides. axis: of the response; hidden: causes; weak: of half the size and less."""

    kind: str
    axis: str
    hidden: tuple[str, ...]
    weak: bool


def channels(ids: str) -> set[str]:
    """The channels of candidates `effect:channel[,channel]`, blanks between them."""
    return {channel for one in ids.split() for channel in one.split(":")[1].split(",")}


def shown_and_gone(asked: Plan, causes: Mapping[str, Named], base: Iterable[str]) -> tuple[set[str], set[str]]:
    """Channels that are logged at least, those of base among them, and those that are not."""
    if asked.kind == "not_logged":
        return set(base), {channel for k in asked.hidden for channel in causes[k].gone.split()}
    return set(base).union(*(channels(causes[k].right) for k in asked.hidden)), set()


def logged(ids: str, shown: Set[str]) -> list[str]:
    """Those candidates whose channels are all in the logs."""
    return [one for one in ids.split() if channels(one) <= shown]


def hidden(cause: str, um: float, right: str, twins: str, shown: Set[str], kind: str) -> dict[str, Any]:
    """A cause that the model lacks. um: what the displacement loses without it. twins: the same part or heat."""
    return {
        "cause": cause,
        "um": round(um, 2),
        "right": logged(right, shown) if kind != "not_logged" else [],
        "twins": logged(twins, shown),
    }


def write_truth(folder: Path, truth: dict[str, Any]) -> dict[str, Any]:
    (folder / "truth.json").write_text(json.dumps(truth, indent=1))
    return truth
