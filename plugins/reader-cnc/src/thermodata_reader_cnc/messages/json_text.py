"""JSON as it stands in a line: numbers as they are written, keys that come twice refused, and limits on what is
untrusted."""

from __future__ import annotations

import json
from typing import Any

LONGEST = 1 << 20  # letters of one text
_LONGEST_KEY = 300  # patterns look at what keys say
_DEEPEST = 40  # brackets open at once: the parser of the standard library ends the process at some thousands


class Number(str):
    """A number as it is written: a time in nanoseconds since 1970 has more digits than a float."""

    __slots__ = ()


def _with_distinct_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key comes twice")
    if any(len(key) > _LONGEST_KEY for key in found):
        raise ValueError(f"a key of more than {_LONGEST_KEY} letters")
    return found


_DECODER = json.JSONDecoder(
    object_pairs_hook=_with_distinct_keys, parse_float=Number, parse_int=Number, parse_constant=Number
)


def loads(text: str) -> Any:
    """A text as Python values, its numbers as `Number`. ValueError where it is no JSON, a key comes twice, or it goes
    beyond the limits."""
    if len(text) > LONGEST:
        raise ValueError(f"longer than {LONGEST} letters")
    if text.count("{") + text.count("[") > _DEEPEST and _depth(text) > _DEEPEST:
        raise ValueError("brackets within brackets without end")
    return _DECODER.decode(text)


def _depth(text: str) -> int:
    """How many brackets are open at once, at most; those in texts count too."""
    open_now = most = 0
    for letter in text:
        if letter in "{[":
            open_now += 1
            most = max(most, open_now)
        elif letter in "}]":
            open_now -= 1
    return most
