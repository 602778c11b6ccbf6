"""When a test measures: a mask over samples, made first; averages are taken of what is left.

`when` is an expression or a range that must hold. `for`: it must hold for at least so long, else the stretch
does not count. `settle`: the first part of each stretch, while things come to rest, does not count.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.calibration.expression.parser import parse
from thermodata.errors import UsageError, nearest
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.files.campaign import Measuring
from thermodata.schema.flag import Flag
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.value import split_value

_OUT = int(Flag.OUT_OF_RANGE | Flag.SATURATED)
BREAK = 10.0  # a pause of so many periods ends a stretch


def measuring_names(measuring: str | Measuring | None) -> frozenset[str]:
    """The channels that a `measuring` reads (empty for a bare 'in_range')."""
    spec = long_form(measuring)
    names = set() if spec.when is None else set(parse(spec.when).names)
    if isinstance(spec.in_range, str):
        names |= {spec.in_range} - {"in_range"}
    elif spec.in_range:
        names |= set(spec.in_range)
    return frozenset(names)


def measuring_mask(
    t_ns: Int1D,
    measuring: str | Measuring | None,
    values: Mapping[str, Array],
    units: Mapping[str, str] | None = None,
    flags: Mapping[str, Array] | None = None,
) -> Bool1D:
    """True where the test measures; shape (n,). Everywhere, where nothing is declared.

    values: channel -> shape (n,), on the grid t_ns, in units[channel] (canonical). flags: channel -> uint16, for
    'in_range' (of one channel by name, or of all in `flags`): in the sensor's range, and a number.
    Raises UsageError for a channel that isn't there.
    """
    spec = long_form(measuring)
    mask: Bool1D = np.ones(len(t_ns), dtype=bool)
    if spec.when is not None:
        mask &= parse(spec.when).evaluate_bool(values, units)
    if isinstance(spec.in_range, str):
        mask &= _sensor_in_range(spec.in_range, values, flags or {}, len(t_ns))
    elif spec.in_range:
        for name, (low, high) in spec.in_range.items():
            _require_channel(name, values)
            unit = (units or {}).get(name)
            x = np.asarray(values[name], dtype=np.float64)
            mask &= (x >= _limit(low, unit)) & (x <= _limit(high, unit))
    if spec.settle > 0 or (spec.for_ or 0) > 0:
        mask = _settled_and_long(np.asarray(t_ns), mask, spec.settle, spec.for_ or 0.0)
    return mask


def stretches(t_ns: Int1D, mask: Bool1D) -> tuple[Int1D, Int1D]:
    """(first, past-the-last) row of each stretch of True; a pause in the log ends a stretch too."""
    mask = np.asarray(mask, dtype=bool)
    if not mask.any():
        return np.empty(0, np.int64), np.empty(0, np.int64)
    joined = mask[1:] & mask[:-1]
    dt = np.diff(t_ns)
    if len(dt):
        joined &= dt <= BREAK * max(float(np.median(dt)), 1.0)
    first = np.flatnonzero(mask & np.concatenate([[True], ~joined]))
    last = np.flatnonzero(mask & np.concatenate([~joined, [True]])) + 1
    return first.astype(np.int64), last.astype(np.int64)


def long_form(measuring: str | Measuring | None) -> Measuring:
    """The same with its parts by name; nothing in it where nothing is declared."""
    if isinstance(measuring, Measuring):
        return measuring
    if measuring is None:
        return Measuring()
    return Measuring(in_range="in_range") if measuring.strip() == "in_range" else Measuring(when=measuring)


def _require_channel(name: str, names: Mapping[str, object]) -> None:
    if name not in names:
        close = nearest(name, list(names))
        raise UsageError(
            f"measuring: no channel '{name}'",
            where=f"in_range: {name}",
            expected=", ".join(sorted(names)) or "nothing: there is none",
            got=name,
            hint=f"did you mean '{close}'?" if close else None,
        )


def _sensor_in_range(name: str, values: Mapping[str, Array], flags: Mapping[str, Array], n: int) -> Bool1D:
    mask: Bool1D = np.ones(n, dtype=bool)
    if name != "in_range":
        _require_channel(name, {**flags, **values})
    for channel in flags if name == "in_range" else [name]:
        if channel in flags:
            mask &= (np.asarray(flags[channel]) & _OUT) == 0
        if channel in values and np.asarray(values[channel]).dtype.kind == "f":
            mask &= np.isfinite(values[channel])
    return mask


def _limit(limit: str | float | int, unit: str | None) -> float:
    value, written = split_value(limit)
    if not written or unit is None:
        return value
    factor, offset = linear_conversion(written, unit)
    return factor * value + offset


def _settled_and_long(t_ns: Int1D, mask: Bool1D, settle_s: float, for_s: float) -> Bool1D:
    first, last = stretches(t_ns, mask)
    kept: Bool1D = np.zeros(len(mask), dtype=bool)
    dt = np.diff(t_ns)
    period = float(np.median(dt)) if len(dt) else 0.0
    for a, b in zip(first.tolist(), last.tolist(), strict=True):
        # n samples cover n periods, so ten samples at 1 Hz hold for 10 s
        if float(t_ns[b - 1] - t_ns[a]) + period >= for_s * 1e9 * (1 - 1e-9):
            kept[a:b] = (t_ns[a:b] - t_ns[a]) >= settle_s * 1e9
    return kept
