"""Adding an effect: what is known before, one click, and its progress."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import Response

from thermodata.errors import UsageError
from thermodata.store.catalogue.models import find_model, load_diagnosis
from thermodata.view.response_units import unit_of
from thermodata.web.command import command
from thermodata.web.pages.drawn import pair
from thermodata.web.render import desk_of, page


def show(request: Request) -> Response:
    """GET /add: model, candidate. What the stored answer says of it; nothing is fitted here."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    name = given.get("candidate", "")
    if not name:
        raise UsageError("no candidate was named", hint="choose one on the page 'What is missing'")
    model = find_model(store, given.get("model", ""))
    found = load_diagnosis(store, model.model)
    candidate = next((c for c in (found.candidates if found else []) if name in (c.id, str(c.rank))), None)
    return page(
        request,
        "adding.html.j2",
        title=f"Add {name}",
        section="/missing",
        command=command(desk.store_path, "add", model.model, name),
        model=model,
        name=candidate.id if candidate else name,
        candidate=candidate,
        unit=unit_of(store, found.response if found else model.result.responses[0], model.spec.campaign_ids),
        pair=pair,
    )
