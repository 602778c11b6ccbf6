"""What is missing: the stored answer of `diagnose`, told rung by rung. Looking at it computes nothing."""

from __future__ import annotations

from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from thermodata.chart.pack import script_json
from thermodata.effect import effects
from thermodata.effect.unbound import unbound
from thermodata.report.charts.courses import course_chart
from thermodata.report.charts.heat import heat_charts
from thermodata.report.collected.by_choice import asked_by_choice
from thermodata.report.collected.older import is_of_other_data
from thermodata.report.page.headline import capital
from thermodata.report.text.clauses import clauses
from thermodata.report.text.confirmed import confirmed_sentence, held_in_words
from thermodata.report.verdict.candidate_errors import beside, left_out_tests
from thermodata.report.verdict.could_hide import could_hide
from thermodata.report.verdict.explainable import explainable
from thermodata.report.verdict.log_faults import log_faults
from thermodata.report.verdict.refined import against_adding
from thermodata.report.verdict.verdict import causes, claims_of, probability, told, verdict_sentence
from thermodata.report.words.glossary import NOISE
from thermodata.report.words.numbers import duration, heat_lines, in_unit, number
from thermodata.report.words.of_response import of_response, worst_of
from thermodata.report.words.pieces import names_of_pieces
from thermodata.schema.answers.candidate import Candidate, LeftOut, Rung
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.slip_ids import named_slips
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import load_diagnosis
from thermodata.store.catalogue.models.fits import StoredModel, find_model
from thermodata.store.catalogue.models.stale import all_fitted_again
from thermodata.view.grid.describe import channel_infos
from thermodata.view.grid.load import data_version
from thermodata.view.lists.models import ModelRow, model_rows
from thermodata.view.lists.response_units import response_units, told_together, unit_of
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.pages.parts.confirmed import proposed
from thermodata.web.pages.parts.drawn import among, pair
from thermodata.web.pages.parts.locked import locked_tests, next_look
from thermodata.web.render import desk_of, page

# where the evidence behind a rung stands on the page
RUNG_TARGET = {
    "chance": "chance",
    "fall": "left",
    "tests": "left",
    "gain": "left",
    "others": "left",
    "worth": "course",
    "difference": "chance",
    "probability": "chance",
}
STUMBLES = {
    "chance": "chance does as well",
    "fall": "the error hardly falls",
    "tests": "in few tests",
    "gain": "its gain differs",
    "others": "in one test only",
    "worth": "too small",
    "difference": "one of its sensors says as much",
    "probability": "not likely enough",
}
JUDGED_BESIDE = "judged beside others"
_NOTHING = {
    "none": ("Nothing is missing", "What is left is noise, or what lags leave of any machine."),
    "unknown": ("Something is missing that has no name", "No effect of the library has its timing."),
    "not_testable": ("These tests can't tell", "An effect is claimed only where it also predicts a left-out test."),
}


def show(request: Request) -> Response:
    """GET /missing: model."""
    desk = desk_of(request)
    store = desk.store()
    models = model_rows(store)
    model = model_in(store, models, request.query_params.get("model"))
    if model is None:
        return page(
            request, "missing.html.j2", title="What is missing", command="thermodata fit model.yaml", model=None
        )
    found, stored = load_diagnosis(store, model.model), find_model(store, model.model)
    unit = unit_of(store, found.response, model.campaigns) if found else model.unit
    together = told_together(model.responses, response_units(store, model.responses, model.campaigns))
    locks = _locks(store, model)
    acts = desk.write and bool(locks["locked"])
    nothing = {"headline": "What does it miss?", "further": ""}
    answer = nothing if found is None else _answer(store, found, model, unit, acts=acts)
    return page(
        request,
        "missing.html.j2",
        title="What is missing",
        command=command(desk.store_path, "diagnose", model.model),
        models=models,
        model=model,
        found=found,
        unit=unit,
        error_of=worst_of(together, model.responses),
        **locks,
        unbound=_unbound(store, model),
        rung_target=RUNG_TARGET,
        stumbles=_stumbles,
        only_unlikely=_only_unlikely,
        among=among,
        pair=pair,
        confirm_command=lambda one: command(desk.store_path, "confirm", model.model, one),
        add_command=lambda *some: command(desk.store_path, "add", model.model, *(c.id for c in some)),
        **answer,
        **_of_older_data(store, models, stored, found),
    )


def _answer(store: Store, found: Diagnosis, model: ModelRow, unit: str, *, acts: bool) -> dict[str, Any]:
    """What the page tells of the kept answer. unit: of its response. acts: whether it has a button that opens locks."""
    shown, claims = told(found), claims_of(found)
    added = _added(found, model)
    missing = [c for c in claims if c.id not in added]
    first, rest = _headline(found)
    by_choice = asked_by_choice(store, model.model, model.responses, found)
    further, to_ask = proposed(rest, by_choice, acts=acts)
    title, text = _NOTHING.get(found.verdict, _NOTHING["none"])
    heat = found.unknown.heat if found.unknown else None
    drawn = heat_charts(heat.courses, unit, heat.direction is not None) if heat else []
    return {
        "headline": in_unit(first, unit),
        "further": [in_unit(clause, unit) for clause in further],
        "to_ask": to_ask,
        "by_choice": {name: in_unit(confirmed_sentence(answer), unit) for name, answer in by_choice.items()},
        "held": {name: held_in_words(answer) for name, answer in by_choice.items()},
        "about": _about(found, model, unit),
        "noise": _noise(found, unit),
        "of_response": capital(of_response(found)),
        "told": shown,
        "hides": in_unit(capital(could_hide(found)), unit),
        "faults": log_faults(found.artefacts),
        "slips": {(a.kind, a.campaign, a.test): name for name, a in named_slips(found)},
        "heat": heat,
        "heat_lines": heat_lines(heat) if heat else [],
        "heat_names": names_of_pieces(heat.courses) if heat else [],
        "heat_charts": [script_json(chart.as_json()) for chart in drawn],
        "nothing": {"title": title, "text": text},
        "charts": {c.rank: script_json(course_chart(c, unit).as_json()) for c in shown if c.courses},
        "most": {c.rank: max((r.rmse_um_before for r in c.left_out), default=1.0) for c in shown},
        "left_out": {c.rank: _left_out(c) for c in shown},
        "equivalents": {e for c in claims for e in c.equivalent},
        "rivals": [c for c in found.candidates if c not in shown],
        "added": added,
        "left_out_of": {c.id: left_out_tests([c]) for c in found.candidates},
        "both_with": {c.id: beside(c, found.rmse_um) for c in found.candidates},
        "against": {c.id: in_unit(against_adding(c), unit) for c in shown if c.refinement},
        "together": missing if len(missing) > 1 else [],
    }


def _of_older_data(
    store: Store, models: list[ModelRow], stored: StoredModel, found: Diagnosis | None
) -> dict[str, Any]:
    """Whether the answer was asked of the data as they were, and who has one of them as they are."""
    if found is None:
        return {}
    now = data_version(store, list(dict.fromkeys(stored.spec.campaign_ids)))
    older = is_of_other_data(found, stored.data_version, now)
    return {"older": older, "answered": _answered_now(store, models, stored, now) if older else None}


def _answered_now(store: Store, models: list[ModelRow], stored: StoredModel, now: str) -> ModelRow | None:
    """The same model fitted to the data as they are now, where that was diagnosed. now: their version."""
    for identity in all_fitted_again(store, stored):
        found = load_diagnosis(store, identity)
        if found is not None and not is_of_other_data(found, find_model(store, identity).data_version, now):
            return next(m for m in models if m.model == identity)
    return None


def _stumbles(candidate: Candidate, rung: Rung) -> str:
    """Over what, in as few words; the errors beside them are of all left-out tests, and a rule may look at others."""
    before, after = candidate.rmse_um_before, candidate.rmse_um_after
    if rung.name == "fall" and before is not None and after is not None:
        if after > before:
            return "the error rises"
        if after < (1 - (rung.limit or 0.0)) * before:
            falls = "rises" if (rung.value or 0.0) < 0 else "hardly falls"
            return f"the error {falls} {'beside others' if JUDGED_BESIDE in candidate.why else 'where it acts'}"
    if rung.name == "probability" and rung.value is not None:
        return f"not likely enough ({probability(rung.value)})"
    return STUMBLES.get(rung.name, rung.name.replace("_", " "))


def _only_unlikely(candidate: Candidate) -> bool:
    """Whether it keeps all other rules: then its sentence says why it is not likely."""
    return [r.name for r in candidate.rungs if not r.holds] == ["probability"]


def _left_out(candidate: Candidate) -> list[tuple[str, LeftOut]]:
    """(name, part), the largest error first; parts of one test in order where they are alike."""
    named = zip(names_of_pieces(candidate.left_out), candidate.left_out, strict=True)
    return sorted(named, key=lambda one: -one[1].rmse_um_before)


def _headline(found: Diagnosis) -> tuple[str, list[str]]:
    """The sentence of the terminal: (what it says first, each further clause), for seven lines in bold are no
    headline. Nor are several claims: they have a line each."""
    first, *rest = clauses(verdict_sentence(found))
    claims = claims_of(found)
    if len(claims) > 1 and first == f"missing: {causes(claims)}":
        return f"Missing: {len(claims)} effects", [*(causes([c]) for c in claims), *map(capital, rest)]
    return capital(first), [capital(clause) for clause in rest]


def _about(found: Diagnosis, model: ModelRow, unit: str) -> str:
    parts = [f"{model.label} leaves {number(found.rmse_um)} {unit} on left-out tests"] if found.rmse_um else []
    return "; ".join(filter(None, [*parts, explainable(found)]))


def _noise(found: Diagnosis, unit: str) -> str:
    """'Noise 0.05 um: how far a mean of 60 s scatters ...'; '' where none is known."""
    if not found.noise_um:
        return ""
    length = duration(found.noise_over_s) if found.noise_over_s else "a few samples"
    return f"Noise {number(found.noise_um)} {unit}: {NOISE.format(length=length)}"


def _locks(store: Store, model: ModelRow) -> dict[str, Any]:
    """What was opened and for what, what is locked, and which look the next one is."""
    known = locked_tests(store, model)
    return {
        "looks": [one for one in known if one.n],
        "locked": [one.test for one in known if not one.open],
        "next_look": next_look(known),
    }


def _unbound(store: Store, model: ModelRow) -> list[Any]:
    with store.reader() as con:
        infos = channel_infos(con, model.campaigns)
    channels = {name: info for table in infos.values() for name, info in table.items() if name not in model.responses}
    return unbound({n: e for n, e in effects().items() if e.family != "artefact"}, channels)


def _added(found: Diagnosis, model: ModelRow) -> set[str]:
    """Candidates that the model has already."""
    return {c.id for c in found.candidates if c.effect in model.effects and c.claimed}
