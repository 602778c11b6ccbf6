"""What closes the position loop of an axis: behind a linear scale the growth of its screw does not reach the tool."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from thermodata.diagnosis.candidates.unread import AXIS, RUBS, MachinePart, part_of
from thermodata.effect.binding import Described
from thermodata.plugin import Effect
from thermodata.view.grid.dataset import TestData

_DECLARED = re.compile(r"axes\.(\w+)\.feedback")
_AXIS = re.compile(r"axis\.(\w+)")


def feedback_of_axes(tests: Iterable[TestData]) -> dict[str, str]:
    """Axis (in small letters) -> its feedback, of those for which all tests declare one and the same."""
    said = [{m[1].lower(): str(v) for k, v in t.conditions.items() if (m := _DECLARED.fullmatch(k))} for t in tests]
    return dict(set.intersection(*(set(one.items()) for one in said))) if said else {}


def is_kept_from_the_tool(effect: Effect, channels: Iterable[Described], feedback: Mapping[str, str]) -> bool:
    """Whether an effect does nothing at the tool, for what closes the loop of its axis. channels: that drive it."""
    axes = {m[1] for c in channels if (m := _AXIS.match((c.at or "").lower()))}
    return any(_loop_compensates(effect, axis, feedback) for axis in axes)


def kept_parts(
    library: Iterable[Effect], channels: Iterable[Described], feedback: Mapping[str, str]
) -> frozenset[MachinePart]:
    """The parts of the axes that channels sit at which do nothing at the tool either, whether a sensor reads them or
    none: no heat may be theirs instead."""
    heats = {part.heat for c in channels if (part := part_of(c.at)) and part.heat.startswith(AXIS)}
    return frozenset(
        MachinePart(heat, part.name)
        for effect in library
        for need in effect.needs
        for place in need.places
        if (part := part_of(place)) and part.name in RUBS
        for heat in heats
        if _loop_compensates(effect, heat.removeprefix(AXIS), feedback)
    )


def _loop_compensates(effect: Effect, axis: str, feedback: Mapping[str, str]) -> bool:
    """Whether the loop of an axis is closed by what keeps the effect from the tool. Of two motors of one axis, y1 and
    y2, the axis is declared."""
    closed_by: str | None = getattr(effect, "closed_by", None)
    return closed_by is not None and closed_by in (feedback.get(axis), feedback.get(axis[:1]))
