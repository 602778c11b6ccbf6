"""Adding an effect: what is known before, one click, and its progress."""

from __future__ import annotations

from dataclasses import dataclass

from starlette.requests import Request
from starlette.responses import Response

from thermodata.errors import UsageError
from thermodata.modelling.add import chosen_id
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.report.verdict.candidate_errors import beside, left_out_tests
from thermodata.report.verdict.verdict import claims_of
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Artefact, Diagnosis
from thermodata.schema.answers.slip_ids import named_slips
from thermodata.schema.words.sentences import listed
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import load_diagnosis
from thermodata.store.catalogue.models.fits import StoredModel, find_model
from thermodata.view.grid.describe import channel_infos
from thermodata.view.lists.models import model_rows
from thermodata.view.lists.response_units import unit_of
from thermodata.web.command import command
from thermodata.web.pages.parts.drawn import pair
from thermodata.web.render import desk_of, page


@dataclass(frozen=True, slots=True)
class Chosen:
    """What is added. candidate: what the stored answer says of it. slips: of a probe, which a slip is taken out by."""

    name: str
    candidate: Candidate | None
    slips: list[Artefact]

    @property
    def told(self) -> bool:
        """Whether the stored answer asks for it, or offers it."""
        return bool(self.slips or (self.candidate and (self.candidate.claimed or self.candidate.refinement)))


def show(request: Request) -> Response:
    """GET /add: model, candidate (one or several). What the stored answer says of them; nothing is fitted here."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    names = list(dict.fromkeys(filter(None, given.getlist("candidate"))))
    if not names:
        raise UsageError("no candidate was named", hint="choose one on the page 'What is missing'")
    model = find_model(store, given.get("model", ""))
    found = load_diagnosis(store, model.model)
    chosen = [_chosen(store, model, found, name) for name in names]
    name = listed([c.name for c in chosen])
    return page(
        request,
        "adding.html.j2",
        title=f"Add {name}",
        section="/missing",
        command=command(desk.store_path, "add", model.model, *names),
        model=model,
        label=next(m.label for m in model_rows(store) if m.model == model.model),
        name=name,
        chosen=chosen,
        left_out_of=left_out_tests([c.candidate for c in chosen if c.candidate]),
        both_with={c.name: beside(c.candidate, found.rmse_um) for c in chosen if c.candidate and found},
        whole=_whole(found, chosen),
        unit=unit_of(store, found.response if found else model.result.responses[0], model.spec.campaign_ids),
        pair=pair,
    )


def _whole(found: Diagnosis | None, chosen: list[Chosen]) -> tuple[float, float] | None:
    """Errors on left-out tests of the model, and with what is chosen; None where the stored answer has none of these:
    it has them of all claims together."""
    if found is None or found.rmse_um is None or found.named_rmse_um is None:
        return None
    claims = {c.id for c in claims_of(found)}
    return (found.rmse_um, found.named_rmse_um) if {c.name for c in chosen} == claims else None


def _chosen(store: Store, model: StoredModel, found: Diagnosis | None, named: str) -> Chosen:
    slips = [slip for its, slip in named_slips(found) if its == named] if found else []
    return Chosen(named, None, slips) if slips else Chosen(*_candidate(store, model, found, named), [])


def _candidate(store: Store, model: StoredModel, found: Diagnosis | None, named: str) -> tuple[str, Candidate | None]:
    """(id, what the stored answer says of it). None for a choice of one's own: an effect on channels that there are.

    UsageError, as `add` has it, for a rank, an effect or channels that there are not."""
    name = chosen_id(store, model.model, named)
    candidate = next((c for c in (found.candidates if found else []) if c.id == name), None)
    if candidate is None:
        with store.reader() as con:
            infos = channel_infos(con, model.spec.campaign_ids)
        with_candidate(model.spec, name, {n: info for table in infos.values() for n, info in table.items()})
    return name, candidate
