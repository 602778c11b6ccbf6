"""The page's figures as charts and heat maps (thermodata.chart); nothing here draws."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.chart import Axis, Chart, HeatMap, Limit, Panel, Series, Span, Strip
from thermodata.chart.band import SHADED, band_95
from thermodata.chart.decimate import MOST_POINTS, block_mean, block_size
from thermodata.plugin import Float1D
from thermodata.report.collected.data import Curve, TestPart
from thermodata.report.words.numbers import duration, number, typeset
from thermodata.schema.answers.diagnosis import WeakSpot

TIME = "time from the start of the test"
PANEL_EXTRA = 48  # [px] of a panel beside its plot: title, keys, margins
_TALL, _LOW, _MIDDLE = 230, 140, 170  # [px]
_MOST_VALUES = 240_000  # of all curves of a page: 2.7 bytes each
_LEAST_POINTS = 240


def points_for(parts: Sequence[TestPart]) -> int:
    """How many points a curve of the page may have, so that a page of many tests can still be mailed."""
    curves = sum(3 + len(p.contributions) + len(p.drivers) + len(p.lanes) for p in parts)
    return int(np.clip(_MOST_VALUES // max(curves, 1), _LEAST_POINTS, MOST_POINTS))


def part_chart(
    part: TestPart,
    weak: Sequence[tuple[int, WeakSpot]],
    styles: Mapping[str, tuple[str, str]],
    noise_um: float | None,
    unit: str,
    most: int,
    driven: Mapping[str, str] | None = None,
) -> Chart:
    """Measured and model, residual with weak spots, contributions, drivers, and the operating state below.

    weak: with their ranks over the whole page. driven: an effect -> its name with what drives it.
    """
    drawn = _Drawn(part, unit, block_size(len(part.measured), most))
    hours = _hours(part, drawn.size)
    whole = (part.start_s / 3600, (part.start_s + part.step_s * len(part.measured)) / 3600)
    panels: list[Panel | Strip] = [_measured(drawn), _residual(drawn, noise_um)]
    if part.contributions:
        panels.append(_contributions(drawn, styles, driven or {}))
    if part.drivers:
        panels.append(_drivers(part.drivers, drawn.size))
    panels += [_lane(c, hours, drawn.size) for c in part.lanes]
    return Chart(
        f"Test {part.test}: measured and modelled {part.response} with the residual, contributions, drivers and state",
        Axis(TIME, "h", range=whole),
        hours,
        panels,
        spans=[*_weak_spans(weak, unit), *_phase_spans(part)],
    )


@dataclass(frozen=True, slots=True)
class _Drawn:
    """A test as its panels show it: means of blocks of `size` samples. unit: of the residual."""

    part: TestPart
    unit: str
    size: int

    @property
    def style(self) -> str:
        """A machine that is measured now and then gives points; a line would hide where it was not measured."""
        return "points" if np.mean(np.isfinite(self.part.residual)) < 0.9 else "line"

    def series(self, name: str, values: Float1D, colour: str, sd: Float1D | None = None, **more: object) -> Series:
        shown = block_mean(values, self.size)
        band = None if sd is None else band_95(shown, block_mean(sd, self.size))
        own = self.part.unit if name in ("measured", "model") and self.part.unit else self.unit
        return Series(name, own, shown, colour, band=band, **more)  # type: ignore[arg-type]


def _measured(drawn: _Drawn) -> Panel:
    part = drawn.part
    curves = [
        drawn.series("measured", part.measured, "measured", style=drawn.style, width=1.4),
        drawn.series("model", part.predicted, "model", part.predicted_sd, width=2.0),
    ]
    return Panel(part.response, part.unit or drawn.unit, curves, height=_TALL)


def _residual(drawn: _Drawn, noise_um: float | None) -> Panel:
    curve = drawn.series("residual", drawn.part.residual, "residual", style=drawn.style, width=1.3)
    limits = _noise_limits(noise_um, drawn.part.step_s, drawn.unit)
    return Panel("residual: measured − model", drawn.unit, [curve], height=_LOW, zero=True, limits=limits)


def _contributions(drawn: _Drawn, styles: Mapping[str, tuple[str, str]], driven: Mapping[str, str]) -> Panel:
    shown = drawn.part.contributions
    looks = [styles.get(c.name, ("muted", "solid")) for c in shown]
    curves = [
        drawn.series(driven.get(c.name, c.name), c.values, colour, c.sd, dash=dash, label=c.name)
        for c, (colour, dash) in zip(shown, looks, strict=True)
    ]
    shaded = f", {SHADED}" if any(c.sd is not None for c in shown) else ""
    return Panel(f"contributions of the effects{shaded}", drawn.unit, curves, height=_MIDDLE)


def _hours(part: TestPart, size: int) -> Float1D:
    """Middles of the blocks [h]."""
    n = -(-len(part.measured) // size)
    return np.asarray((part.start_s + part.step_s * (np.arange(n) * size + (size - 1) / 2)) / 3600)


def _noise_limits(noise_um: float | None, step_s: float, unit: str) -> list[Limit]:
    if not noise_um:
        return []
    label = typeset(f"noise of {duration(step_s)} means ±{number(noise_um, 2)} {unit}")
    return [Limit(noise_um, label), Limit(-noise_um, "")]


def _drivers(drivers: Sequence[Curve], size: int) -> Panel:
    from thermodata.chart import effect_styles

    styles = effect_styles(c.name for c in drivers)
    curves = [
        Series(c.name, c.unit, block_mean(c.values, size), styles[c.name][0], dash=styles[c.name][1], width=1.3)
        for c in drivers
    ]
    return Panel("drivers", drivers[0].unit, curves, height=120)


def _lane(lane: Curve, hours: Float1D, size: int) -> Strip:
    """One operating state: only where it changes, for most of them rest for hours."""
    values = block_mean(lane.values, size)
    same = np.zeros(len(values), bool)
    same[1:-1] = (values[1:-1] == values[:-2]) | (np.isnan(values[1:-1]) & np.isnan(values[:-2]))
    course = Series(lane.name, lane.unit, values[~same], "lane", x=hours[~same], style="area", width=1.0)
    return Strip(course, lane.name)


def _weak_spans(weak: Sequence[tuple[int, WeakSpot]], unit: str) -> list[Span]:
    return [
        Span(
            w.from_s / 3600,
            w.to_s / 3600,
            "weak",
            typeset(f"{number(w.rmse_um, 2)} {unit}"),
            w.state,
            rank=rank,
            panels=(0, 1),
        )
        for rank, w in weak
    ]


def _phase_spans(part: TestPart) -> list[Span]:
    return [Span(a / 3600, b / 3600, "phase", name, panels=(0,)) for name, (a, b) in part.phases.items()]


def residual_scale(residuals: Sequence[Float1D]) -> float:
    """What the colours of the heat map reach to [unit of the response]: all but the most extreme hundredth."""
    seen = [np.abs(r[np.isfinite(r)]) for r in residuals]
    together = np.concatenate(seen) if seen else np.empty(0)
    return float(np.quantile(together, 0.99)) or 1.0 if len(together) else 1.0


def in_one_unit(parts: Sequence[TestPart], unit_of: Callable[[str], str]) -> dict[str, list[TestPart]]:
    """unit -> the parts whose residual is in it: kelvins have no colour on a scale of micrometres. unit_of: of a
    response."""
    found: dict[str, list[TestPart]] = {}
    for part in parts:
        found.setdefault(unit_of(part.response), []).append(part)
    return found


def overview_map(parts: Sequence[TestPart], unit: str, limit: float, *, several: bool) -> HeatMap:
    """The residual of every test as one coloured strip each: where the model fails, at a glance. parts: in one unit.
    limit: where the colours end. several: whether the model has several responses, so that a strip names its own."""
    size = block_size(max(len(p.residual) for p in parts), 400)
    strips = [block_mean(p.residual, size) for p in parts]
    columns = max(len(s) for s in strips)
    z = np.array([np.pad(s, (0, columns - len(s)), constant_values=np.nan) for s in strips])
    one = len({q.campaign for q in parts}) == 1
    names = [(p.test if one else f"{p.campaign}/{p.test}") + (f" {p.response}" if several else "") for p in parts]
    step_h = parts[0].step_s * size / 3600  # a model has one step
    about, lengths, targets = "Residual of every test", [len(s) for s in strips], [""] * len(parts)
    return HeatMap(
        about,
        Axis(TIME, "h"),
        unit,
        names,
        z,
        lengths,
        0.0,
        step_h,
        limit,
        targets=targets,
        figures=[typeset(number(_rms(p.residual))) for p in parts],
        figures_title=typeset(f"RMSE [{unit}]"),
    )


def _rms(residual: Float1D) -> float | None:
    seen = residual[np.isfinite(residual)]
    return float(np.sqrt(np.mean(seen**2))) if len(seen) else None


def height_of(chart: Chart | HeatMap) -> int:
    """About as high as it will be drawn [px], so that a page does not jump when it is."""
    if isinstance(chart, HeatMap):
        return 26 * len(chart.rows) + 90
    strips = sum(p.height + 20 for p in chart.panels if isinstance(p, Strip))
    panels = sum(p.height + PANEL_EXTRA for p in chart.panels if isinstance(p, Panel))
    return strips + panels + (17 * len(chart.rows) + PANEL_EXTRA if chart.rows else 0) + 66
