"""The rules by which a column's readings are flagged, each a function, in the order in which they are asked.

Each is conservative: what may be real is left alone, and said. A rule sees what those before it marked, for a reading
that counts as none tells nothing of those beside it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thermodata.calibration.quality.column import Marked
from thermodata.calibration.quality.ends.limit import (
    AT_END,
    NO_VALUE,
    SAY_RANGE,
    clipped,
    impossible,
    no_values,
    sentinels,
)
from thermodata.calibration.quality.event import QualityEvent
from thermodata.calibration.quality.frozen import drives_stand, frozen_runs
from thermodata.calibration.quality.own_beat import rows_of_others
from thermodata.calibration.quality.sudden.edges import without_pauses
from thermodata.calibration.quality.sudden.lone_step import lone_step
from thermodata.calibration.quality.sudden.spike import spikes
from thermodata.calibration.quality.sudden.step import Step, offset_steps, stood_before
from thermodata.calibration.quality.sun import RESTS_BELOW, is_clear_sky, rests
from thermodata.calibration.quality.value import RunStats, held_runs
from thermodata.plugin import Bool1D
from thermodata.schema.flag import NOT_FLAGGED, Flag
from thermodata.schema.units.quantity import STATES
from thermodata.schema.words.places import is_around, is_at_tool, is_fluid

# Quantities which can't leave and come back within a few samples. (Position, speed, power and flow can.)
_INERT = frozenset({"displacement", "tilt", "temperature", "temperature_difference", "humidity"})
# ... and of these which rest on no end: no pump that is off holds them at 0, and no air is more than saturated.
_FREEZES = ("temperature", "temperature_difference")
_PROBED = ("displacement", "tilt")
_AT_AN_END = Flag.SATURATED | Flag.OUT_OF_RANGE
_TOLD = Flag.HELD | Flag.STUCK | _AT_AN_END
Rule = Callable[[Marked], None]


def no_number_is_missing(seen: Marked) -> None:
    """A value that is no number; the first sample behind it is the first after a gap. In a row of another logger, whose
    columns stand beside this one, none was measured."""
    if not seen.column.is_float or (seen.stats is not None and np.isfinite(seen.stats.leap)):
        return
    missing = ~np.isfinite(seen.column.values)
    if missing.any():
        others = rows_of_others(seen.stream.t_ns, ~missing, seen.stream.filled)
        seen.flags[others] = (seen.flags[others] & ~np.uint16(Flag.OUT_OF_RANGE)) | np.uint16(Flag.NOT_MEASURING)
        missing &= ~others
    if missing.any():
        seen.mark(Flag.OUT_OF_RANGE, missing, "no number")
        after = np.flatnonzero(missing[:-1] & ~missing[1:]) + 1
        seen.flags[after] |= np.uint16(Flag.GAP)


def a_row_of_zeros_is_not_measured(seen: Marked) -> None:
    """What a program writes on all channels at once where it had no values. It is no fault of a sensor: no event."""
    if seen.column.quantity not in STATES:
        seen.flags[seen.stream.zeros] |= np.uint16(Flag.NOT_MEASURING)
        seen.told |= seen.stream.zeros


def beyond_or_at_the_declared_range(seen: Marked) -> None:
    """A reading past the range that somebody declared, or at one of its ends; what that was, `as_given` tells."""
    if not seen.column.is_float or seen.column.range is None:
        return
    x, (low, high) = seen.column.values, seen.column.range
    edge = AT_END * (high - low)
    with np.errstate(invalid="ignore"):
        beyond = (x < low - edge) | (x > high + edge)
        at_edge = ((x <= low + edge) | (x >= high - edge)) & ~beyond
    seen.flags[beyond] |= np.uint16(Flag.OUT_OF_RANGE)
    seen.flags[at_edge] |= np.uint16(Flag.SATURATED)


def no_sensor_reads_that(seen: Marked) -> None:
    """A reading that none of its quantity can be."""
    if seen.column.is_number:
        beyond = impossible(seen.column.values, seen.column.quantity, seen.stats) & ~seen.told
        if beyond.any():
            seen.mark(Flag.OUT_OF_RANGE, beyond, f"no {seen.column.quantity.replace('_', ' ')} can be that")


def a_code_stands_for_no_value(seen: Marked) -> None:
    """What a logger writes where it has no value: of a column with noise, or of a drive or a flow."""
    column = seen.column
    if seen.stats is not None:
        code = sentinels(seen.x, seen.stats, written=column.codes)
    elif column.is_number and column.quantity not in STATES:
        code = no_values(seen.x, column.quantity, column.codes)
    else:
        return
    code &= ~seen.told
    if code.any():
        seen.mark(Flag.OUT_OF_RANGE, code, NO_VALUE)


def stands_at_an_end_of_its_range(seen: Marked) -> None:
    """A reading at an end that other tests show, or at one that this test shows where nobody declared any. A column
    with codes for no value shows none: a code is an end, too."""
    if seen.stats is None:
        return
    declared = bool(seen.has(Flag.SATURATED).any())
    has_codes = any(event.detail == NO_VALUE for event in seen.events)
    at_end = _at_ends_of_other_tests(seen)
    if not has_codes and not declared:
        _mark_clipped(seen, seen.stats, at_end)


def _at_ends_of_other_tests(seen: Marked) -> Bool1D:
    at_end: Bool1D = np.zeros(len(seen.x), dtype=bool)
    for end, side in zip(seen.column.limits, ("lower", "upper"), strict=True):
        if end is None:
            continue
        with np.errstate(invalid="ignore"):
            here = (np.abs(seen.x - end.level) <= end.within) & ~seen.told
        at_end |= here
        if here.any():
            seen.mark(Flag.SATURATED, here, f"{side} limit {end.level:.6g}, again and again: {SAY_RANGE}")
    return at_end


def _mark_clipped(seen: Marked, own: RunStats, at_end: Bool1D) -> None:
    count, quantity = seen.least_count_of_sun, seen.column.quantity
    for hit, _, why in clipped(seen.x, own, quantity, rests_below=RESTS_BELOW.get(quantity)):
        where = np.flatnonzero(hit)
        if count and is_clear_sky(seen.x, seen.stream.t_ns, int(where[0]), int(where[-1]) + 1, count):
            continue
        if (hit & ~at_end).any():
            seen.mark(Flag.SATURATED, hit & ~at_end, why)


def as_given(seen: Marked) -> None:
    """Tells what the reader, the calibration or the declared range flagged, where no rule has told it."""
    given = [(flag, seen.has(flag) & ~seen.told) for flag in (Flag.OUT_OF_RANGE, Flag.SATURATED)]
    for flag, here in given:
        if here.any():
            seen.tell(flag, here, "")


def held_or_stuck(seen: Marked) -> None:
    """One reading for longer than chance explains. At the end of its range a reading stands still, and so does one of
    the sun at rest or about a clear noon."""
    if seen.stats is None:
        return
    x, t_ns, quantity, count = seen.x, seen.stream.t_ns, seen.column.quantity, seen.least_count_of_sun
    runs = held_runs(x, t_ns, seen.stats, seen.beside(), seen.stream.stats, seen.column.elsewhere)
    for start, stop, stuck, why in runs:
        if seen.has(_AT_AN_END, slice(start, stop)).all() or rests(x, t_ns, start, stop, quantity):
            continue
        if seen.stream.zeros[start:stop].all():
            continue
        if not (count and is_clear_sky(x, t_ns, start, stop, count)):
            seen.mark_rows(Flag.STUCK if stuck else Flag.HELD, start, stop, why)


def froze_while_it_was_logged(seen: Marked) -> None:
    """A temperature or a probe that flickered all the time and stands since; see `quality.frozen`."""
    column = seen.column
    alike = next((kind for kind in (_FREEZES, _PROBED) if column.quantity in kind), ())
    if seen.stats is None or not len(seen.stats.starts) or not alike or (alike is _FREEZES and is_at_tool(column.at)):
        return
    beside = seen.beside(*alike)
    stand = drives_stand([(c.quantity, c.values) for c in seen.stream.columns.values()]) if beside else None
    for start, stop, why in frozen_runs(seen.x, seen.stream.t_ns, seen.stats, beside, stand):
        if not seen.has(_TOLD, slice(start, stop)).any():
            seen.mark_rows(Flag.STUCK, start, stop, why)


def the_log_repeats_its_last_row(seen: Marked) -> None:
    """A log that died whole: what each of its readings says from there on, nobody measured; see `quality.last_row`."""
    start = seen.stream.repeats_from
    if start is None or not seen.column.is_number or seen.column.held or seen.has(_TOLD, slice(start, None)).any():
        return
    stop = len(seen.x)
    seen.mark_rows(
        Flag.HELD, start, stop, f"the log repeats its last row: all stands to its end, {stop - start} samples"
    )


def leaves_for_a_few_samples(seen: Marked) -> None:
    """A spike. Many of them may be what a log of measuring phases looks like: that is told, and not flagged."""
    if seen.stats is None or seen.column.quantity not in _INERT:
        return
    t_ns = seen.stream.t_ns
    hit, many = spikes(seen.x, seen.stats)
    hit = without_pauses(hit, seen.x, (seen.stream.time.flags & np.uint16(Flag.GAP)) != 0)
    where = np.flatnonzero(hit)
    if not many or not len(where):
        seen.mark(Flag.SPIKE, hit, "")
        return
    share = 100 * len(where) / len(seen.x)
    why = (
        f"{NOT_FLAGGED}: {share:.1f} % of the samples stand out for 1 to 3 samples: measuring phases? say when with "
        "'measuring'"
    )
    first, last = int(t_ns[where[0]]), int(t_ns[where[-1]])
    seen.events.append(QualityEvent(seen.name, Flag.SPIKE.word, first, last, len(where), why))


def steps_and_stays(seen: Marked) -> None:
    """A temperature that leaps by more than heat can do; or, where it stood on one tread for hours before, that was
    held until then."""
    column, t_ns = seen.column, seen.stream.t_ns
    if seen.stats is None or column.quantity != "temperature" or is_at_tool(column.at):
        return
    steps: list[Step] = list(offset_steps(seen.x, t_ns, seen.flags, seen.stream.time.flags, seen.stats))
    for step in steps:
        if seen.stream.zeros[step.start : step.stop].all():
            continue
        neighbours = [np.asarray(values, dtype=np.float64) for values in seen.beside("temperature").values()]
        since = stood_before(seen.x, t_ns, step, seen.stats, neighbours)
        why = f"a step of {step.size:+.1f} K {step.how}"
        if since is None:
            seen.mark_rows(Flag.OFFSET, step.start, step.stop, why)
        else:
            seen.mark_rows(Flag.HELD, since, step.start, f"on one tread, then {why}")


def steps_once_by_little(seen: Marked) -> None:
    """A temperature of a body that steps once, by less than heat could do in the time, but at once."""
    column = seen.column
    if seen.stats is None or column.quantity != "temperature" or seen.has(Flag.OFFSET).any():
        return
    if is_at_tool(column.at) or is_around(column.at) or is_fluid(column.at):
        return
    others = (np.asarray(values, dtype=np.float64) for values in seen.beside("temperature").values())
    step = lone_step(seen.x, seen.stream.t_ns, seen.flags, seen.stream.time.flags, seen.stats, others)
    if step is not None and not seen.stream.zeros[step.start :].all():
        seen.mark_rows(Flag.OFFSET, step.start, step.stop, f"a step of {step.size:+.1f} K {step.how}")


RULES: tuple[Rule, ...] = (
    no_number_is_missing,
    a_row_of_zeros_is_not_measured,
    beyond_or_at_the_declared_range,
    no_sensor_reads_that,
    a_code_stands_for_no_value,
    stands_at_an_end_of_its_range,
    as_given,
    held_or_stuck,
    froze_while_it_was_logged,
    the_log_repeats_its_last_row,
    leaves_for_a_few_samples,
    steps_and_stays,
    steps_once_by_little,
)
