"""Readings that repeat because the logger repeats them between two moments that are measured, or that stand out from a
probe in the air on both sides of a short one: of what `measuring` leaves, each sample is a reading of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.flags import flag_stream
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.flag import Flag

# of the span of what is measured: so far off all other readings, an end of the range is none, as where stays at an end
# are told (quality/ends/stays.py)
APART = 0.1
STANDS = 4  # stretches that are measured, and the same value in all of them and between: it stands still indeed
# what a value is accused of for coming again, and for standing out from what is no measurement beside it
DOUBTED = np.uint16(Flag.HELD | Flag.STUCK | Flag.SATURATED | Flag.SPIKE)
# as which of these one value is told hangs on how much of the log stands on it: each bears out the others
_COMES_AGAIN = np.uint16(Flag.HELD | Flag.STUCK | Flag.SATURATED)


def cleared(
    t_ns: Int1D, columns: Mapping[str, ColumnInput], flags: Mapping[str, Array], masks: Mapping[str, Bool1D]
) -> dict[str, Array]:
    """flags, shape (n,) each, without those of DOUBTED on measured samples that neither these alone, side by side, bear
    out, nor one value through STANDS stretches. columns: with the flags that they had before they were judged, which
    stay. masks: where a channel is measured, shape (n,); of channels that are measured at times only."""
    found = dict(flags)
    alike: dict[bytes, list[str]] = {}
    for name, mask in masks.items():
        if bool(mask.all()) or not (_accused(columns[name], flags[name]) & DOUBTED)[mask].any():
            continue
        alike.setdefault(mask.tobytes(), []).append(name)
    for names in alike.values():
        mask = masks[names[0]]
        alone, _ = flag_stream(t_ns[mask], {n: _part(c, mask) for n, c in columns.items()})
        for name in names:
            doubted = _accused(columns[name], flags[name])[mask] & DOUBTED & ~_borne_out(alone[name])
            doubted[_same_through_stretches(columns[name].values, mask)[mask]] = 0
            doubted[_far_off(columns[name].values[mask], (flags[name][mask] & Flag.SATURATED) != 0)] = 0
            found[name] = flags[name].copy()
            found[name][mask] &= ~doubted
    return found


def _borne_out(flags: Array) -> Array:
    again = np.where((flags & _COMES_AGAIN) != 0, _COMES_AGAIN, np.uint16(0))
    return np.asarray(flags | again)


def _same_through_stretches(values: Array, mask: Bool1D) -> Bool1D:
    """Where a value stays the same through STANDS measured stretches and more, shape (n,)."""
    run = np.cumsum(np.concatenate([[True], values[1:] != values[:-1]])) - 1
    stretch = np.cumsum(mask & ~np.concatenate([[False], mask[:-1]]))
    pairs = np.unique(np.stack([run[mask], stretch[mask]]), axis=1)
    counted = np.bincount(pairs[0], minlength=int(run[-1]) + 1)
    return np.asarray(counted[run] >= STANDS)


def _far_off(values: Array, at_end: Bool1D) -> Bool1D:
    """Where a value at the end of a range is far from all else that is measured, shape (n,): a probe that is not in
    reach yet, and no reading that the logger repeated. values: of the measured samples."""
    found = np.zeros_like(at_end)
    if not at_end.any():  # nor are words numbers
        return found
    rest = values[~at_end & np.isfinite(values)]
    if not len(rest):
        return found
    within = np.concatenate([rest, values[at_end]])
    nearest = np.clip(values[at_end], rest.min(), rest.max())
    found[at_end] = np.abs(values[at_end] - nearest) > APART * np.ptp(within)
    return found


def _accused(column: ColumnInput, flags: Array) -> Array:
    return flags if column.flags is None else flags & ~column.flags


def _part(column: ColumnInput, mask: Bool1D) -> ColumnInput:
    return replace(column, values=column.values[mask], flags=None if column.flags is None else column.flags[mask])
