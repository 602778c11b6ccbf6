"""Dotted places and the patterns that effects name them with.

`spindle.bearing` holds `spindle.bearing.front` (a place holds all that is below it); `*` is any one part;
`{a}` is any one part too, the same in all needs of an effect (an axis letter), and `{s}spindle` any one that ends so:
`spindle`, `counter_spindle`, `milling_spindle`. `spindle.bearing?` holds `spindle` itself too, a whole whose parts are
not told apart, and none of its other parts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from thermodata.schema.words.places import every_place, is_known

_VARIABLE = re.compile(r"^\{(\w+)\}(\w*)$")
_OR_WHOLE = "?"
_PART = re.compile(r"\*|\{\w+\}\w*|\w[\w-]*")


def match(pattern: str, place: str | None, known: Mapping[str, str] | None = None) -> dict[str, str] | None:
    """The values of the pattern's variables where `place` lies at or below it, else None."""
    if place is None:
        return None
    found = dict(known or {})
    wanted, parts = pattern.lower().split("."), place.lower().split(".")
    if wanted[-1] == "*":  # hall.* holds hall itself: one sensor named 'hall'
        wanted = wanted[:-1]
    elif wanted[-1].endswith(_OR_WHOLE):
        wanted = wanted[:-1] if len(parts) == len(wanted) - 1 else [*wanted[:-1], wanted[-1].removesuffix(_OR_WHOLE)]
    if len(parts) < len(wanted):
        return None
    for want, part in zip(wanted, parts, strict=False):
        variable = _VARIABLE.match(want)
        if variable:
            name, end = variable.groups()
            if not part.endswith(end) or found.setdefault(name, part.removesuffix(end)) != part.removesuffix(end):
                return None
        elif want not in ("*", part):
            return None
    return found


def can_bind(pattern: str) -> bool:
    """Whether there can be a place that it holds: each part is a word, `*` or a variable, and none is empty."""
    return all(_PART.fullmatch(part) for part in part_alone(pattern).split("."))


def in_vocabulary(pattern: str) -> bool:
    """Whether a place of the vocabulary lies at or below it."""
    alone = part_alone(pattern)
    return is_known(alone) or any(match(alone, place) is not None for place in every_place())


def holds(place: str, other: str | None) -> bool:
    """Whether `other` lies at or below `place`."""
    return match(place, other) is not None


def part_alone(pattern: str) -> str:
    """The pattern without the whole that may stand for its part: `spindle.bearing` of `spindle.bearing?`."""
    return pattern.removesuffix(_OR_WHOLE)


def readable_place(pattern: str) -> str:
    """A pattern as a person reads it: `{s}spindle` is any spindle, `spindle.bearing?` the part or the whole."""
    part = part_alone(pattern).replace("{s}", "")
    return part if part_alone(pattern) == pattern else f"{part} or {part.rpartition('.')[0]}"
