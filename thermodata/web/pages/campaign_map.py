"""The campaign map: all tests of the store, searched, filtered and paged, each with what the model leaves of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from starlette.requests import Request
from starlette.responses import Response

from thermodata.report.words.glossary import IN_SAMPLE
from thermodata.report.words.numbers import base_role
from thermodata.store import Store
from thermodata.view.lists.models import ModelRow, fitted_last_of_each, model_rows
from thermodata.view.lists.overview import Sort, WantedTests, find_tests
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.pages.parts.calibrations import calibrations, failing
from thermodata.web.pages.parts.strip import FULL_COLOUR, strip_svg
from thermodata.web.query import number_in
from thermodata.web.render import desk_of, page

if TYPE_CHECKING:
    from thermodata.plugin import Float1D
    from thermodata.view.curves.residuals import Key

PER_PAGE = 50


def show(request: Request) -> Response:
    """GET /: find, campaign, machine, role, kind, sort, model, page.

    Without a model, each campaign has the one fitted last."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    campaign, named = given.get("campaign", ""), given.get("model", "")
    models = [m for m in model_rows(store) if campaign in ("", *m.campaigns)]
    of = _models_of(store, models, campaign, named)
    asked = WantedTests(
        find=given.get("find", "")[:200],
        campaign=campaign,
        role=given.get("role", ""),
        kind=given.get("kind", ""),
        machine=given.get("machine", ""),
        models={c: m.model for c, m in of.items()},
        sort=cast(Sort, given.get("sort", "file")),
        page=number_in(given, "page", 1),
        per_page=PER_PAGE,
    )
    found = find_tests(store, asked)
    shown = list({m.model: m for r in found.rows if (m := of.get(r.campaign))}.values())
    chosen = shown[0] if len(shown) == 1 else None
    strips = _strips(store, of, [(r.campaign, r.test) for r in found.rows])
    limits = _limits(strips, of)
    measured = calibrations(store, [*found.campaigns])
    return page(
        request,
        "campaign_map.html.j2",
        title="Tests",
        command=_command(desk.store_path, asked, chosen),
        found=found,
        asked=asked,
        models=models,
        of=of,
        named=next(iter(of.values())).model if named and of else "",
        shown=shown,
        chosen=chosen,
        # the other pages go on with what was asked for here
        onward=chosen.model if chosen and (named or campaign) else "",
        calibrations=measured,
        failing=failing(measured),
        strips={key: strip_svg(values, limits[of[key[0]].unit]) for key, values in strips.items()},
        limits=limits,
        units=list(dict.fromkeys(m.unit for m in shown)),
        in_sample=IN_SAMPLE
        if any(r.model_role and r.model_role != base_role(r.model_role) for r in found.rows)
        else None,
    )


def _models_of(store: Store, models: list[ModelRow], campaign: str, named: str) -> dict[str, ModelRow]:
    """Campaign -> the model whose errors its tests are shown with: a named one for all of its own."""
    if named:
        chosen = model_in(store, models, named)
        return dict.fromkeys(chosen.campaigns, chosen) if chosen else {}
    return {c: m for c, m in fitted_last_of_each(models).items() if campaign in ("", c)}


def _strips(store: Store, of: Mapping[str, ModelRow], keys: list[Key]) -> dict[Key, Float1D]:
    if not of:
        return {}
    from thermodata.view.curves.predictions import residual_strips  # numpy: a store without a model is shown without it

    by_model: dict[str, list[Key]] = {}
    for key in keys:
        if key[0] in of:
            by_model.setdefault(of[key[0]].model, []).append(key)
    return {key: y for model, own in by_model.items() for key, y in residual_strips(store, model, own).items()}


def _limits(strips: Mapping[Key, Float1D], of: Mapping[str, ModelRow]) -> dict[str, float]:
    """unit -> its scale, one for all strips of a page in it, or a small residual would look as bad as a large one."""
    by_unit: dict[str, list[Float1D]] = {}
    for (campaign, _), values in strips.items():
        by_unit.setdefault(of[campaign].unit, []).append(values)
    return {unit: _limit(found) for unit, found in by_unit.items()}


def _limit(strips: list[Float1D]) -> float:
    import numpy as np

    everything = np.concatenate(strips)
    there = np.abs(everything[np.isfinite(everything)])
    return float(np.quantile(there, FULL_COLOUR)) if len(there) else 1.0


def _command(store: Any, asked: WantedTests, model: ModelRow | None) -> str:
    """Of a model `compare` prints what is left of each test."""
    options = [("-c", asked.campaign), ("--machine", asked.machine), ("--role", asked.role), ("--kind", asked.kind)]
    options += [("--find", asked.find)]
    tests = command(store, "tests", *(word for name, value in options if value for word in (name, value)))
    return f"{tests} && {command(store, 'compare', model.model)}" if model else tests
