"""A factor or an offset that a file states beside a signal, of which a campaign file says neither that it is to be
applied nor that the values have it: told, for counts of a converter are a number as good as any other."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from thermodata.errors import UsageError
from thermodata.plugin import Array, Float1D, Signal
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.stated_scale import Stated, line_that_applies, stated_scales
from thermodata.schema.files.campaign import Campaign, Channel, JumpCalibration, LinearCalibration, ScaleCalibration
from thermodata.schema.units.conversion import declared_conversion
from thermodata.schema.units.quantity import STATES
from thermodata.schema.units.scale import scaled_unit
from thermodata.schema.units.value import split_value
from thermodata.store.raw.columns import read_column
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.plan.plan import Bound, TestPlan

_ROWS = 200_000  # that are looked at
_FEW = 8  # different values, as of what is set, are whole by themselves
_LARGEST = 1e6  # counts, beyond which float32 has no fraction
_NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


def tell_unscaled(store: Path, plan: TestPlan) -> None:
    """Problems of a plan whose channels are bound: of whole numbers, which are counts; notes: where values have
    fractions, and most likely all of it. Nothing is told of values that stand in steps of the factor."""
    for bound in plan.bound.values():
        channel = bound.channel
        if bound.signal is None or channel.scaled or channel.quantity in STATES:
            continue
        told = set[str]()
        for raw in plan.sources[bound.source].streams[bound.stream]:
            signal = _as_in(raw, bound, plan)
            open_scales = [] if signal is None else _open_scales(signal, bound, plan.campaign)
            said = " and ".join(map(str, open_scales))
            if signal is None or not open_scales or said in told:
                continue
            told.add(said)
            values = _values(store, raw, signal)
            if not values.size or _are_in(values, open_scales):
                continue
            whole = bool((values == np.round(values)).all()) and np.unique(values).size > _FEW
            (plan.problems if whole else plan.notes).append(_note_of_scale(bound.name, raw, signal, open_scales, whole))


def _note_of_scale(name: str, raw: RawStream, signal: Signal, scales: Sequence[Stated], whole: bool) -> str:
    way = line_that_applies(scales, split_unit(signal.name)[0], signal.unit)
    what = "its whole numbers are stored as they stand" if whole else "its values are taken to have it"
    return (
        f"channel '{name}': {raw.source_path} says {' and '.join(map(str, scales))}, which the campaign file leaves "
        f"open: {what}; try: scaled: true in the channel where the values have it, or, where they still need it, {way}"
    )


def _as_in(raw: RawStream, bound: Bound, plan: TestPlan) -> Signal | None:
    """The signal of a channel as a file has it."""
    if bound.signal is None:
        return None
    own = plan.sources[bound.source].parts.get((raw.path, bound.signal.name))
    name = bound.signal.name if own is None else own.name
    return next((s for s in raw.signals if s.name == name), None)


def _open_scales(signal: Signal, bound: Bound, campaign: Campaign) -> list[Stated]:
    """What a file states of a signal and nobody answers."""
    stated = [s for s in stated_scales(signal) if s.kind != "sign"]
    return [s for s in stated if not _is_applied(s, bound, signal.unit, campaign)]


def _is_applied(stated: Stated, bound: Bound, unit: str | None, campaign: Campaign) -> bool:
    """Whether a campaign file has a factor or an offset in the unit of a channel, in a calibration, or in what derives
    from it. What is displaced has no offset: each test begins at zero."""
    channel = bound.channel
    for name in [channel.calibration] if isinstance(channel.calibration, str) else channel.calibration or []:
        own = campaign.calibrations.get(name)
        if isinstance(own, JumpCalibration):
            return True
        if isinstance(own, LinearCalibration | ScaleCalibration):
            moved = split_value(own.gain if stated.kind == "factor" else own.offset)
            if moved[0] != (1.0 if stated.kind == "factor" else 0.0) or _changes_unit(moved[1]):
                return True
    if any(_derives(c, bound.name, stated.number) for c in campaign.channels.values()):
        return True
    if stated.kind == "offset":
        return channel.quantity == "displacement"
    return channel.unit is not None and math.isclose(_factor(channel, unit), stated.number, rel_tol=1e-6)


def _changes_unit(ratio: str) -> bool:
    """Whether a gain has another unit on each side: 'um/V', and not 'um/um'."""
    above, _, below = ratio.partition("/")
    return bool(below) and above.strip() != below.strip()


def _derives(channel: Channel, name: str, number: float) -> bool:
    """Whether an expression reads a channel and has a number, or its inverse."""
    if channel.derive is None or not re.search(rf"(?<![\w.]){re.escape(name)}(?!\w)", channel.derive):
        return False
    said = [float(n) for n in _NUMBER.findall(channel.derive)]
    return any(math.isclose(n, x, rel_tol=1e-6) for n in said for x in (abs(number), 1 / abs(number)))


def _factor(channel: Channel, unit: str | None) -> float:
    """How many of the file's units one of the channel's is; of a file without a unit what scales the channel's."""
    try:
        return declared_conversion(channel.unit or "", unit)[0] if unit else scaled_unit(channel.unit or "")[0]
    except UsageError:
        return scaled_unit(channel.unit or "")[0]


def _values(store: Path, raw: RawStream, signal: Signal) -> Float1D:
    """Finite values of the first rows but zeros, which are zero in any scale; none of text. shape (n,)."""
    column: Array = read_column(store / raw.path, raw.columns[signal.name], 0, min(raw.rows, _ROWS))
    if column.dtype.kind not in "iuf":
        return np.empty(0)
    x = column.astype(np.float64)
    return np.asarray(x[np.isfinite(x) & (x != 0.0)])


def _are_in(values: Float1D, scales: Sequence[Stated]) -> bool:
    """Whether values stand in steps of a factor, and not in larger ones: what was scaled by it does."""
    factor = next((abs(s.number) for s in scales if s.kind == "factor"), None)
    shift = next((s.number for s in scales if s.kind == "offset"), 0.0)
    if factor is None:
        return False
    counts = np.unique((values - shift) / factor)
    near = np.round(counts)
    if counts.size < 3 or np.abs(counts).max() > _LARGEST or np.abs(counts - near).max() > 1e-2:
        return False
    return int(np.gcd.reduce(near.astype(np.int64))) == 1


__all__ = ["tell_unscaled"]
