"""What is drawn on the page of a model, by the key of its chart: residuals of all tests, the heat that nobody logged,
systems, and each test with the weak spots in it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from thermodata.chart import Chart, HeatMap
from thermodata.report.charts.figures import in_one_unit, overview_map, part_chart, points_for, residual_scale
from thermodata.report.charts.heat import heat_charts
from thermodata.report.charts.system import system_charts
from thermodata.report.collected.data import ReportData, TestPart

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import WeakSpot
    from thermodata.schema.answers.missing_heat import MissingHeat

SPOTS_SHOWN = 10


def ranked_spots(data: ReportData) -> list[tuple[int, WeakSpot]]:
    """The weak spots of all responses that are worth a look, the costliest first, from 1 on; those in another unit than
    the first response's have no common cost with it, and stand behind."""
    found = [(data.unit_of(name) != data.unit, w) for name, spots in data.weak.items() for w in spots]
    costliest = sorted(found, key=lambda one: (one[0], -(one[1].rmse_um ** 2) * (one[1].to_s - one[1].from_s)))
    return list(enumerate((w for _, w in costliest[:SPOTS_SHOWN]), 1))


def figures_of(
    data: ReportData, styles: dict[str, tuple[str, str]], spots: list[tuple[int, WeakSpot]]
) -> dict[str, Chart | HeatMap]:
    """Every chart of the page by its key. styles: colour and dash by effect; spots: as `ranked_spots` has them."""
    made = _overviews(data)
    if heat := heat_of(data):
        drawn = heat_charts(heat.courses, data.unit_of(data.diagnosis), heat.direction is not None)
        made.update({f"heat{i}": figure for i, figure in enumerate(drawn)})
    for i, seen in enumerate(data.systems):
        made.update({f"system{i}-{name}": drawn for name, drawn in system_charts(seen, styles).items()})
    most = points_for(data.tests)
    for i, part in enumerate(data.tests):
        own = [(rank, w) for rank, w in spots if _is_of(part, data, w)]
        noise, unit = noise_of(data, part.response), data.unit_of(part.response)
        made[f"test{i}"] = part_chart(part, own, styles, noise, unit, most, data.driven)
    return made


def _overviews(data: ReportData) -> dict[str, Chart | HeatMap]:
    """The residuals of all tests as maps, one a unit, beside those of the first version in the same colours."""
    made: dict[str, Chart | HeatMap] = {}
    several, first = len(data.responses) > 1, in_one_unit(data.first, data.unit_of)
    for i, (unit, now) in enumerate(in_one_unit(data.tests, data.unit_of).items()):
        at, before = str(i or ""), first.get(unit, [])
        limit = residual_scale([t.residual for t in before or now])
        if before:
            about = f"Residual of every test in the first version, {data.versions[0].name}"
            made[f"first{at}"] = replace(overview_map(before, unit, limit, several=several), about=about)
        note = "" if i else "Point at a strip to read it; click to see its test there."
        targets = [f"test{j}" for j, t in enumerate(data.tests) if data.unit_of(t.response) == unit]
        made[f"overview{at}"] = replace(overview_map(now, unit, limit, several=several), note=note, targets=targets)
    return made


def _is_of(part: TestPart, data: ReportData, spot: WeakSpot) -> bool:
    same = (spot.campaign, spot.test) == (part.campaign, part.test)
    return same and any(w is spot for w in data.weak.get(part.response, ()))


def response_of(data: ReportData, spot: WeakSpot) -> str:
    """The response that a weak spot is of, '' where none has it."""
    return next((name for name, spots in data.weak.items() if any(w is spot for w in spots)), "")


def chart_of(data: ReportData, spot: WeakSpot) -> str:
    """The key of the chart that shows a weak spot, '' where there is none."""
    return next((f"test{i}" for i, part in enumerate(data.tests) if _is_of(part, data, spot)), "")


def noise_of(data: ReportData, response: str) -> float | None:
    """The noise of a response, as its diagnosis found it, in the response's unit; None where none was asked."""
    found = (d for d in (data.diagnosis, data.reason) if d and d.response == response)
    return next((d.noise_um for d in found if d.noise_um), None)


def heat_of(data: ReportData) -> MissingHeat | None:
    """The heat that no signal tells, where the diagnosis found some."""
    return data.diagnosis.unknown.heat if data.diagnosis and data.diagnosis.unknown else None
