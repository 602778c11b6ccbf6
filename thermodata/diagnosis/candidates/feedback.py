"""What closes the position loop of an axis: behind a linear scale the growth of its screw does not reach the tool."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

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
    closed_by: str | None = getattr(effect, "closed_by", None)
    axes = {m[1] for c in channels if (m := _AXIS.match((c.at or "").lower()))}
    # of two motors of one axis, y1 and y2, the axis is declared
    return closed_by is not None and any(closed_by in (feedback.get(a), feedback.get(a[:1])) for a in axes)
