"""The charts of a model: the residual of all tests, and one test as a whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from thermodata.chart import Chart, HeatMap, effect_styles
from thermodata.chart.decimate import MOST_POINTS
from thermodata.report.charts.figures import in_one_unit, overview_map, part_chart, residual_scale
from thermodata.report.collected.parts import test_parts
from thermodata.report.collected.spots import weak_spots_of
from thermodata.schema.units.unit import difference_unit

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.report.collected.data import TestPart
    from thermodata.store import Store


def pictures(store: Store, model: str, key: tuple[str, str], response: str) -> dict[str, Chart | HeatMap]:
    """Title -> chart. key: (campaign, test) of the one that is shown as a whole."""
    from thermodata.modelling.run import load
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import find_model

    stored = find_model(store, model)
    chain = [m for m in (stored.parent, stored.model) if m is not None]
    made: dict[str, Chart | HeatMap] = dict(overviews(store, chain, response))
    loaded = load(store, model, uncertainty=True)
    part = next(p for p in test_parts(loaded) if (p.campaign, p.test) == key and p.response == response)
    found = next((d for m in reversed(chain) if (d := load_diagnosis(store, m)) is not None), None)
    spots = [w for w in weak_spots_of(loaded, (found,)).get(response, []) if (w.campaign, w.test) == key]
    styles = effect_styles(c.name for c in part.contributions)
    noise = found.noise_um if found is not None and found.response == response else None
    made[f"{part.campaign}/{part.test}"] = part_chart(
        part, list(enumerate(spots, 1)), styles, noise, _units(loaded)[response], MOST_POINTS
    )
    return made


def overviews(store: Store, models: Sequence[str], response: str | None = None) -> dict[str, HeatMap]:
    """The residual of every open test by each model, on the scale of the first; a map for each unit."""
    from thermodata.modelling.run import load

    made: dict[str, HeatMap] = {}
    limits: dict[str, float] = {}
    for model in models:
        loaded = load(store, model)
        parts = _parts_of(test_parts(loaded), response)
        name, several = f"{loaded.fitted.spec.name} {loaded.identity}", len({p.response for p in parts}) > 1
        by_unit = in_one_unit(parts, _units(loaded).__getitem__)
        for unit, some in by_unit.items():
            limit = limits.setdefault(unit, residual_scale([p.residual for p in some]))
            about, of = f"Residual of every test by {name}", f" [{unit}]" if len(by_unit) > 1 else ""
            drawn = overview_map(some, unit, limit, several=several)
            made[f"residual by {name}{of}"] = replace(drawn, about=about)
    return made


def _parts_of(parts: Sequence[TestPart], response: str | None) -> list[TestPart]:
    return [p for p in parts if response in (None, p.response)]


def _units(loaded: Loaded) -> dict[str, str]:
    """response -> unit of its residual."""
    return {r.name: difference_unit(r.unit) for r in loaded.fitted.responses}
