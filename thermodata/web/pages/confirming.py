"""Asking the locked tests of a candidate: what that opens, how often it was opened, one click, and what they said."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import Response

from thermodata.errors import UsageError
from thermodata.modelling.add import chosen_id
from thermodata.report.text.confirmed import confirmed_sentence, held_in_words
from thermodata.report.words.numbers import in_unit
from thermodata.store.catalogue.models.findings import load_diagnosis
from thermodata.store.catalogue.models.fits import find_model
from thermodata.view.lists.models import model_rows
from thermodata.view.lists.response_units import unit_of
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.pages.parts.confirmed import answer_of
from thermodata.web.pages.parts.drawn import pair
from thermodata.web.pages.parts.locked import locked_tests, next_look
from thermodata.web.render import desk_of, page


def show(request: Request) -> Response:
    """GET /confirm: model, candidate. What it opens, and what is known of it already; no lock is opened here."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    model = model_in(store, model_rows(store), given.get("model", ""))
    if model is None or not given.get("candidate"):
        raise UsageError("no candidate was named", hint="choose one on the page 'What is missing'")
    name, found = chosen_id(store, model.model, given["candidate"]), load_diagnosis(store, model.model)
    response = found.response if found else find_model(store, model.model).result.responses[0]
    answer = answer_of(store, model, name, response)
    unit = unit_of(store, response, model.campaigns)
    locked = [one for one in locked_tests(store, model) if not one.open]
    candidate = next((c for c in found.candidates if c.id == name), None) if found else None
    return page(
        request,
        "confirming.html.j2",
        title=f"Ask the locked tests of {name}",
        section="/missing",
        command=command(desk.store_path, "confirm", model.model, name),
        model=model,
        name=name,
        candidate=candidate,
        answer=answer,
        held=held_in_words(answer) if answer else "",
        said=in_unit(confirmed_sentence(answer), unit) if answer else "",
        most=max((max(t.rmse_um_before, t.rmse_um_after) for t in answer.tests), default=1.0) if answer else 1.0,
        locked=locked,
        next_look=next_look(locked),
        unit=unit,
        pair=pair,
    )
