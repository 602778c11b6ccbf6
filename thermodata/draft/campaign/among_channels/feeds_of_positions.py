"""The feed of an axis of which only the position is logged, proposed as its rate: friction goes with the speed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from thermodata.draft.campaign.parts import DerivedChannel, DraftChannel
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.words.naming import channel_name
from thermodata.errors import UsageError
from thermodata.plugin import Float1D
from thermodata.schema.units.conversion import linear_conversion

_SLOWEST_S = 5.0  # between samples of a movement
# few values are places where the tool stands, unless it goes on in more than that share of all rows: then its strokes
# keep step with the logger
_FEW, _IN_STEP = 8, 0.2
_LEAST_MM = 1.0  # that an axis goes; less is how it is held in place
# an axis moves from row to row by more than this share of its way, and does so in more than that share of its rows
_STEP, _MOVING = 1e-4, 0.05


def feeds_of_positions(channels: Sequence[DraftChannel], groups: Sequence[Group]) -> tuple[DerivedChannel, ...]:
    """A feed for each linear axis that moves within a log and has none. channels: of all sources."""
    of_source = {g.source: g for g in groups}
    taken = {c.name.lower() for c in channels}
    found: dict[str, DerivedChannel] = {}
    # an actual position before one that may be the commanded one
    for channel in sorted(_positions(channels), key=lambda c: bool(c.said.questions)):
        axis = str(channel.said.at).split(".")[1]
        if axis in found or _has_feed(channels, axis):
            continue
        seen = _goes_in(channel, of_source[channel.source])
        if not seen:
            continue
        name = channel_name(f"v_{axis}", taken)
        taken.add(name.lower())
        path = next((c.name for c in channels if c.said.quantity == "feed" and not _is_of_an_axis(c)), None)
        beside = f" ({path} may be that of the path of all axes)" if path else ""
        why = f"no feed of {axis.upper()} is logged{beside}; it is the rate of its position"
        if max(seen) <= _FEW:
            why += (
                f", seen at {max(seen)} places only: its strokes keep step with the logger, and the rate is too small"
            )
        found[axis] = DerivedChannel(name, f"rate({channel.name})", "feed", "m/min", f"axis.{axis}", why)
    return tuple(found[axis] for axis in sorted(found))


def _positions(channels: Sequence[DraftChannel]) -> list[DraftChannel]:
    return [c for c in channels if c.said.quantity == "position" and (c.said.at or "").startswith("axis.")]


def _has_feed(channels: Sequence[DraftChannel], axis: str) -> bool:
    at = (str(c.said.at).split(".") for c in channels if c.said.quantity == "feed")
    return any(place[:2] == ["axis", axis] for place in at)


def _is_of_an_axis(channel: DraftChannel) -> bool:
    return str(channel.said.at).startswith("axis.")


def _goes_in(channel: DraftChannel, group: Group) -> list[int]:
    """How many values it has, at most 9, in each file whose rows are dense enough and in a good part of which the axis
    goes on."""
    return [n for f in group.files for n, x in _courses(channel, f) if _goes(x, channel.said.unit)]


def _courses(channel: DraftChannel, file: RawFile) -> Iterator[tuple[int, Float1D]]:
    """The values of a channel in a file, where its samples are near enough to each other and it has many values, or
    goes on in many rows; and how many there are."""
    sample = file.sample
    for (stream, name), course in sample.courses.items():
        there = np.isfinite(course.values)
        if channel.signal not in (name, f"{stream}:{name}") or not there.any():
            continue
        values, apart_s = sample.values.get((stream, name)), sample.periods_s.get(stream, np.inf) / there.mean()
        if values is None or apart_s > _SLOWEST_S:
            continue
        if values.distinct > _FEW or values.moves > _IN_STEP:
            yield values.distinct, course.values[there]


def _goes(x: Float1D, unit: str | None) -> bool:
    way = float(np.ptp(x))
    return way * _mm(unit) >= _LEAST_MM and float(np.mean(np.abs(np.diff(x)) > _STEP * way)) > _MOVING


def _mm(unit: str | None) -> float:
    """How many mm one is; 1 where nobody says."""
    try:
        return linear_conversion(unit or "mm", "mm")[0]
    except UsageError:
        return 1.0
