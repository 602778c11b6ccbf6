"""A displacement that the logger holds while the spindle stands: one event a test, however often it stands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.calibration.quality.event import QualityEvent
from thermodata.errors import ThermodataError
from thermodata.plugin import Array
from thermodata.schema.units.quantity import PROBED
from thermodata.store.tidy.flags.measured.not_measuring import ONLY, joined
from thermodata.store.tidy.values.series import TestSeries

_POINTS = 20  # of an event, at which the speed is asked
_STANDS_RPM = 5.0
_STOOD = 0.9  # least share of the points: a speed may be logged a little late


def join_while_standing(events: Sequence[QualityEvent], series: TestSeries) -> list[QualityEvent]:
    """Events of held displacements while every spindle stands become one a channel; the others are left as they are."""
    bound = series.plan.bound
    held = [
        e
        for e in events
        if e.flag in ("held", "stuck")
        and e.channel in bound
        and bound[e.channel].channel.quantity in PROBED
        and e.detail != ONLY  # it does not count against the channel, whatever stands meanwhile
    ]
    if not held:
        return list(events)
    while_standing = {id(e) for e in held if _machine_stands(e, series)}
    kept = [e for e in events if id(e) not in while_standing]
    of_each: dict[tuple[str | None, str], list[QualityEvent]] = {}
    for event in held:
        if id(event) in while_standing:
            of_each.setdefault((event.channel, event.flag), []).append(event)
    for (channel, flag), some in of_each.items():
        count = f"{len(some)} stretches, the first: " if len(some) > 1 else ""
        kept.append(joined(channel, flag, some, f"while the spindle stands: {count}{some[0].detail}"))
    return sorted(kept, key=lambda e: (e.from_ns, e.channel or ""))


def _machine_stands(event: QualityEvent, series: TestSeries) -> bool:
    """Whether all speeds of rotation that the test logs are zero during an event; False where it logs none."""
    t_ns = np.linspace(event.from_ns, event.to_ns, _POINTS).astype(np.int64)
    speeds: list[Array] = []
    for name, bound in series.plan.bound.items():
        if bound.channel.quantity == "rotational_speed":
            try:
                speeds.append(series.sampled(name, t_ns)[0])
            except ThermodataError:  # a speed that can't be calibrated is told where it is made
                continue
    if not speeds:
        return False
    still = np.abs(np.nan_to_num(np.stack(speeds), nan=np.inf)).max(axis=0) < _STANDS_RPM
    return bool(still.mean() >= _STOOD)
