"""The clock of each source of a test: declared offsets, and offsets estimated from what two sources both logged."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from thermodata.calibration.result import CalibrationResult
from thermodata.errors import CalibrationError, SpecError, ThermodataError, unknown_name
from thermodata.plugin import Array, Int1D
from thermodata.reader.times.zone import local_to_utc_ns
from thermodata.schema.units.value import value_in
from thermodata.store.base.files import key_of
from thermodata.store.tidy.clock.beside_of import how_far_apart
from thermodata.store.tidy.clock.second_pass import choose_passes
from thermodata.store.tidy.clock.set_late import tell_clocks_set_late
from thermodata.store.tidy.clock.source_clock import Clock, Span, first_ns, is_relative
from thermodata.store.tidy.clock.undated import bases, tell_apart
from thermodata.store.tidy.keys import channel_text
from thermodata.store.tidy.plan.plan import SourcePlan, TestPlan
from thermodata.store.tidy.rows.on_change import STEPS, with_steps
from thermodata.store.tidy.values.series import TestSeries

if TYPE_CHECKING:
    from thermodata.calibration.clock.estimate import ClockEstimate


def clocks_of(
    store: Path, plan: TestPlan, calibrations: Mapping[str, CalibrationResult], known: Mapping[str, Clock]
) -> dict[str, Clock]:
    """The clocks of a test's sources. known: estimates of earlier runs by their key, for estimating reads data."""
    choose_passes(plan)
    tell_clocks_set_late(store, plan)
    base, notes = bases(plan)
    plan.notes += notes
    clocks: dict[str, Clock] = {}
    for name in _ordered(plan):
        source = plan.sources[name]
        spec = source.spec.clock
        declared = Clock(round((spec.offset or 0.0) * 1e9), spec.drift_ppm or 0.0, base[name])
        clocks[name] = declared
        there = plan.sources.get(spec.align_to) if spec.align_to else None
        if spec.align_to is None or not source.raws:
            continue
        if there is None or not there.raws:
            clocks[name] = Clock(
                declared.offset_ns,
                declared.drift_ppm,
                declared.base_ns,
                True,
                notes=(f"clock not aligned: source '{spec.align_to}' has no data in this test",),
            )
            continue
        alignment = _Alignment(plan, source, there, clocks, calibrations)
        clocks[name] = known.get(alignment.key) or alignment.estimate(store)
    tell_apart(plan, clocks)
    return clocks


def clock_to_json(clock: Clock) -> str:
    """For the table `source`."""
    return json.dumps(
        [
            *clock.notes,
            *(
                [
                    {
                        "clock_key": clock.key,
                        "offset_ns": clock.offset_ns,
                        "drift_ppm": clock.drift_ppm,
                        "base_ns": clock.base_ns,
                        "suspect": clock.suspect,
                        "notes": list(clock.notes),
                    }
                ]
                if clock.key
                else []
            ),
        ]
    )


def clock_from_json(text: str | None) -> Clock | None:
    """The estimate that an earlier run kept, or None."""
    items = json.loads(text or "[]")
    kept = next((i for i in items if isinstance(i, dict) and "clock_key" in i), None)
    if kept is None:
        return None
    return Clock(
        kept["offset_ns"], kept["drift_ppm"], kept["base_ns"], kept["suspect"], kept["clock_key"], tuple(kept["notes"])
    )


def _ordered(plan: TestPlan) -> list[str]:
    """Each source after the one that it is aligned to; SpecError for a circle or an unknown name."""
    done: list[str] = []

    def visit(name: str, above: tuple[str, ...]) -> None:
        if name in done:
            return
        if name in above:
            raise SpecError(
                "the clocks are aligned in a circle",
                where=f"sources.{name}.clock.align_to",
                got=" -> ".join((*above, name)),
                hint="take 'align_to' out of one of them: its clock is then what the others are aligned to",
            )
        there = plan.campaign.sources[name].clock.align_to
        if there is not None:
            if there not in plan.campaign.sources:
                raise unknown_name("source", there, list(plan.campaign.sources), where=f"sources.{name}.clock.align_to")
            visit(there, (*above, name))
        if name in plan.sources:
            done.append(name)

    for name in plan.sources:
        visit(name, ())
    return done


@dataclass(frozen=True, slots=True)
class _Alignment:
    """Of the clock of one source on that of another. declared: source -> its clock as far as it is known; calibrations:
    of the channels that both logged."""

    plan: TestPlan
    source: SourcePlan
    there: SourcePlan
    declared: Mapping[str, Clock]
    calibrations: Mapping[str, CalibrationResult]

    @property
    def key(self) -> str:
        """Of all that the estimate is made from."""
        own, other = self.declared[self.source.name], self.declared[self.there.name]
        names = [n for pair in self.source.spec.clock.by for n in (pair.here, pair.there)]
        bound = self.plan.bound
        channels = [channel_text(bound[n], self.calibrations) if n in bound else n for n in names]
        return key_of(
            "clock 2",
            repr([r.key for r in self.source.raws]),
            repr([r.key if not r.moved_ns else (r.key, r.moved_ns) for r in self.there.raws]),
            self.source.spec.clock.model_dump_json(),
            repr((other.offset_ns, other.drift_ppm, other.base_ns)),
            repr(own),
            *channels,
        )

    def estimate(self, store: Path) -> Clock:
        """The clock by declared events, else by what both logged; as declared, and suspect, where neither tells."""
        declared, there = self.declared[self.source.name], self.there.name
        reasons: list[str] = []
        best = self._by_events(reasons) or self._by_channels(store, reasons)
        if best is None:
            why = "; ".join(reasons) or "neither 'by' nor 'events' names anything that both logged"
            apart = how_far_apart(self.source, declared, self.there, self.declared[there])
            note = f"clock not aligned to '{there}': {apart}; {why}"
            return Clock(declared.offset_ns, declared.drift_ppm, declared.base_ns, True, self.key, (note,))
        how = (
            f"from {best.stretches} declared events"
            if self.source.spec.clock.events and np.isnan(best.correlation)
            else f"correlation {best.correlation:.3f}"
        )
        note = (
            f"clock aligned to '{there}': {best.offset_ns / 1e9:+.3f} s, drift {best.drift_ppm:+.1f} ppm, "
            f"uncertainty {best.uncertainty_ns / 1e9:.3f} s, {how}"
        )
        # the estimate's offset holds at its own origin, a Clock's at the first recorded time
        first = first_ns(self.source) + declared.offset_ns + declared.base_ns
        offset = declared.offset_ns + int(best.apply(np.array([first]))[0]) - first
        return Clock(offset, declared.drift_ppm + best.drift_ppm, declared.base_ns, False, self.key, (note,))

    def _by_events(self, reasons: list[str]) -> ClockEstimate | None:
        from thermodata.calibration.clock.events import offset_from_events

        source, there = self.source, self.there
        events = source.spec.clock.events
        if not events:
            return None
        own, other = self.declared[source.name], self.declared[there.name]
        try:
            here = [moment_ns(e.here, source, own, f"{i}.here") for i, e in enumerate(events, 1)]
            beside = [moment_ns(e.there, there, other, f"{i}.there") for i, e in enumerate(events, 1)]
            return offset_from_events(np.array(here, np.int64), np.array(beside, np.int64))
        except CalibrationError as error:
            reasons.append("; ".join(str(error).splitlines()))
            return None

    def _by_channels(self, store: Path, reasons: list[str]) -> ClockEstimate | None:
        from thermodata.calibration.clock.estimate import estimate_offset

        whole = Span(0, None, None, False, False)
        series = TestSeries(store, self.plan, self.declared, whole, self.calibrations)
        best = None
        for pair in self.source.spec.clock.by:
            try:
                for name in (pair.here, pair.there):
                    if name not in series.plan.bound:
                        raise SpecError(
                            f"no channel '{name}' in this test",
                            hint="align by a channel that both sources log in every test, or give this test's clock "
                            "under its 'clocks'",
                        )
                estimate = estimate_offset(*_column(series, pair.here), *_column(series, pair.there))
            except ThermodataError as error:
                reasons.append("; ".join(str(error).splitlines()))
                continue
            if best is None or abs(estimate.correlation) > abs(best.correlation):
                best = estimate
        return best


def moment_ns(moment: str | float, source: SourcePlan, clock: Clock, where: str) -> int:
    """A declared moment of a source on the test's time line [ns]: its local time, or a time since its first sample."""
    first = first_ns(source)
    try:
        naive = np.datetime64(datetime.fromisoformat(str(moment)).replace(tzinfo=None), "ns")
    except ValueError:
        recorded = first + round(value_in(moment, "s") * 1e9)
    else:
        recorded = int(local_to_utc_ns(np.array([naive]), source.spec.timezone)[0][0])
        if is_relative(source):
            raise SpecError(
                "a source that counts from its own start has no dates",
                got=str(moment),
                where=f"sources.{source.name}.clock.events.{where}",
                expected="a time since its first sample, e.g. 12.5 min",
                hint="give the moment as this source counts, or date its start with the test's 'start'",
            )
    return int(clock.correct(np.array([recorded], np.int64), first)[0])


def _column(series: TestSeries, name: str) -> tuple[Int1D, Array]:
    bound = series.plan.bound[name]
    t_ns = series.timeline((bound.source, bound.stream)).t_ns
    values = series.values(bound, 0, len(t_ns))[0]
    steps = series.as_written(bound).is_held and (bound.channel.quantity in STEPS or bound.channel.held)
    return with_steps(t_ns, values) if steps else (t_ns, values)
