"""What a test's temperatures were, at a few moments: enough to tell a sensor that failed between two tests."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.calibration.quality_between import POINTS, Levels, offsets_between_tests
from thermodata.schema.flag import INVALID
from thermodata.schema.places import is_at_tool

if TYPE_CHECKING:
    from thermodata.store.tidy.chunk import Column
    from thermodata.store.tidy.plan import Bound

Offsets = Mapping[str, float]  # channel -> [K]


class Sampler:
    """Picks POINTS samples of each temperature, evenly over rows start to stop, while a stream is walked through."""

    def __init__(self, bounds: Sequence[Bound], start: int, stop: int) -> None:
        self._rows = np.linspace(start, max(stop - 1, start), POINTS).astype(np.int64)
        self._points = {
            b.name: np.full(POINTS, np.nan)
            for b in bounds
            if b.channel.quantity == "temperature" and b.channel.derive is None and not is_at_tool(b.channel.at)
        }

    def take(self, first: int, columns: Mapping[str, Column]) -> None:
        """The next chunk: its first row, and its channels with their own flags."""
        for name, points in self._points.items():
            if name not in columns:
                continue
            column = columns[name]
            here = (self._rows >= first) & (self._rows < first + len(column.flags))
            at = self._rows[here] - first
            sound = (column.flags[at] & np.uint16(INVALID)) == 0
            points[here] = np.where(sound, column.values[at], np.nan)

    def series(self) -> dict[str, list[float | None]]:
        """Channel -> POINTS numbers, None where nothing valid is; ready for JSON."""
        return {
            name: [round(float(v), 3) if np.isfinite(v) else None for v in points]
            for name, points in self._points.items()
            if np.isfinite(points).any()
        }


def levels_of(test: str, start_s: float | None, rows: Sequence[Mapping[str, Any]]) -> Levels | None:
    """The temperatures of a test from the rows of its tidy files. None where its time of day is not known."""
    series: dict[str, Any] = {}
    end = 0.0
    for row in rows:
        if row["layer"] != "tidy" or row["part"] != "test":
            continue
        meta = json.loads(row["columns"])
        end = max(end, meta["to_s"])
        series |= {
            name: np.array([np.nan if v is None else v for v in values])
            for name, values in (meta.get("levels") or {}).items()
        }
    return None if start_s is None or not series else Levels(test, start_s, start_s + end, series)


def offsets_by_test(levels: Sequence[Levels]) -> dict[str, dict[str, float]]:
    """Test -> channel -> by how much a sensor is off that failed before this test [K]."""
    offsets: dict[str, dict[str, float]] = {}
    for (test, channel), size in offsets_between_tests(levels).items():
        offsets.setdefault(test, {})[channel] = round(size, 1)
    return offsets
