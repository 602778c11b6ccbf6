"""When a test measures, chunk by chunk: stretches that count from their beginning, or only if they last, are found in
a look at the whole stream first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil

import numpy as np

from thermodata.calibration.measuring import BREAK, long_form, measuring_mask, measuring_names
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.files.campaign import Measuring
from thermodata.schema.units.quantity import canonical
from thermodata.store.tidy.plan.plan import TestPlan
from thermodata.store.tidy.values.chunk import Chunk, Column


def lasts(measuring: str | Measuring | None) -> bool:
    """Whether rows count only together with others: `settle` and `for`."""
    return isinstance(measuring, Measuring) and (measuring.settle > 0 or (measuring.for_ or 0) > 0)


def said(measuring: str | Measuring | None) -> str:
    """As it is declared, in a sentence."""
    spec = long_form(measuring)
    held = f"for {spec.for_:g} s" if spec.for_ else None
    within = spec.in_range if isinstance(spec.in_range, str) or spec.in_range is None else ", ".join(spec.in_range)
    parts = (spec.when, within and f"in_range: {within}".replace("in_range: in_range", "in_range"), held)
    return "; ".join(part for part in parts if part)


def measures(chunk: Chunk, column: Column, columns: Mapping[str, Column]) -> Bool1D:
    """Where the test measures with this channel, without `settle` and `for`; shape (n,).

    Raises UsageError for a channel that isn't there.
    """
    plan: TestPlan = chunk.series.plan
    spec = plan.test.measuring
    if isinstance(spec, Measuring):
        spec = spec.model_copy(update={"settle": 0.0, "for_": None})
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {column.bound.name: column.flags}
    for name in measuring_names(spec):
        bound = plan.bound.get(name)
        if bound is None:
            continue
        if name in columns:
            values[name], flags[name] = columns[name].values, columns[name].flags
        elif (bound.source, bound.stream) == chunk.member:
            values[name], flags[name] = chunk.values(bound)
        else:
            values[name], flags[name] = chunk.series.sampled(name, chunk.t_ns)
    units = {n: canonical(plan.bound[n].channel.quantity) for n in values}
    return measuring_mask(chunk.t_ns, spec, values, units, flags)


@dataclass(frozen=True, slots=True)
class Stretches:
    """The stretches that count. first, stop: rows, shapes (k,); since_ns: from when on, shape (k,)."""

    first: Int1D
    stop: Int1D
    since_ns: Int1D

    def mask(self, start: int, t_ns: Int1D) -> Bool1D:
        """Of the rows from start on, shape of t_ns."""
        if not len(self.first):
            return np.zeros(len(t_ns), dtype=bool)
        rows = np.arange(start, start + len(t_ns))
        which = np.maximum(np.searchsorted(self.first, rows, side="right") - 1, 0)
        counts: Bool1D = (rows >= self.first[which]) & (rows < self.stop[which]) & (t_ns >= self.since_ns[which])
        return counts


def find_stretches(parts: Iterable[tuple[int, Int1D, Bool1D]], period_ns: float, spec: Measuring) -> Stretches:
    """parts: (first row, times, mask) of the chunks of a stream in order; a pause in the log ends a stretch too."""
    stretches: list[tuple[int, int, int, int]] = []  # first row, past-the-last, first time, last time
    longest = BREAK * max(period_ns, 1.0)
    for start, t, mask in parts:
        goes_on = (
            bool(stretches)
            and stretches[-1][1] == start
            and len(t) > 0
            and bool(mask[0])
            and int(t[0]) - stretches[-1][3] <= longest
        )
        joined = mask[1:] & mask[:-1] & (np.diff(t) <= longest)
        first = np.flatnonzero(mask & np.concatenate([[True], ~joined]))
        last = np.flatnonzero(mask & np.concatenate([~joined, [True]]))
        for a, b in zip(first.tolist(), last.tolist(), strict=True):
            if goes_on and a == 0:
                stretches[-1] = (stretches[-1][0], start + b + 1, stretches[-1][2], int(t[b]))
            else:
                stretches.append((start + a, start + b + 1, int(t[a]), int(t[b])))
    least = (spec.for_ or 0.0) * 1e9 * (1 - 1e-9)
    # n samples cover n periods, so ten samples at 1 Hz hold for 10 s
    kept = np.array(
        [(a, b, t + ceil(spec.settle * 1e9)) for a, b, t, end in stretches if end - t + period_ns >= least], np.int64
    ).reshape(-1, 3)
    return Stretches(kept[:, 0], kept[:, 1], kept[:, 2])
