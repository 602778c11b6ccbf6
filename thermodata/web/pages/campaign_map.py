"""The campaign map: all tests of the store, searched, filtered and paged, each with what the model leaves of it."""

from __future__ import annotations

from typing import Any, cast

from starlette.requests import Request
from starlette.responses import Response

from thermodata.report.words.glossary import IN_SAMPLE
from thermodata.report.words.numbers import base_role
from thermodata.store import Store
from thermodata.view.lists.models import ModelRow, model_rows
from thermodata.view.lists.overview import Asked, Sort, find_tests
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.pages.parts.strip import FULL_COLOUR, strip_svg
from thermodata.web.query import number_in
from thermodata.web.render import desk_of, page

PER_PAGE = 50


def show(request: Request) -> Response:
    """GET /: find, campaign, role, kind, sort, model, page."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    models = model_rows(store)
    chosen = model_in(store, models, given.get("model"))
    asked = Asked(
        find=given.get("find", "")[:200],
        campaign=given.get("campaign", ""),
        role=given.get("role", ""),
        kind=given.get("kind", ""),
        model=chosen.model if chosen else "",
        sort=cast(Sort, given.get("sort", "file")),
        page=number_in(given, "page", 1),
        per_page=PER_PAGE,
    )
    found = find_tests(store, asked)
    strips = _strips(store, chosen.model, [(r.campaign, r.test) for r in found.rows]) if chosen else {}
    limit = _limit(strips)
    return page(
        request,
        "campaign_map.html.j2",
        title="Tests",
        command=_command(desk.store_path, asked, chosen),
        found=found,
        asked=asked,
        models=models,
        chosen=chosen,
        strips={key: strip_svg(values, limit) for key, values in strips.items()},
        limit=limit,
        unit=_unit(chosen),
        in_sample=IN_SAMPLE
        if any(r.model_role and r.model_role != base_role(r.model_role) for r in found.rows)
        else None,
    )


def _strips(store: Store, model: str, keys: list[tuple[str, str]]) -> dict[Any, Any]:
    from thermodata.view.curves.predictions import residual_strips  # numpy: a store without a model is shown without it

    return residual_strips(store, model, keys)


def _limit(strips: dict[Any, Any]) -> float:
    """One scale for all strips of a page, or a small residual would look as bad as a large one."""
    if not strips:
        return 1.0
    import numpy as np

    everything = np.concatenate(list(strips.values()))
    there = np.abs(everything[np.isfinite(everything)])
    return float(np.quantile(there, FULL_COLOUR)) if len(there) else 1.0


def _command(store: Any, asked: Asked, model: ModelRow | None) -> str:
    """Of a model `compare` prints what is left of each test."""
    options = [("-c", asked.campaign), ("--role", asked.role), ("--kind", asked.kind), ("--find", asked.find)]
    tests = command(store, "tests", *(word for name, value in options if value for word in (name, value)))
    return f"{tests} && {command(store, 'compare', model.model)}" if model else tests


def _unit(model: ModelRow | None) -> str:
    return model.unit if model else "um"
