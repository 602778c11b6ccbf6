"""Collects a report's data from a store: one fit to its data as they are now, and what its tables say beside it."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from thermodata.report.collected.by_choice import asked_by_choice, of_added
from thermodata.report.collected.data import ReportData, TestPart
from thermodata.report.collected.history import chain_units, versions
from thermodata.report.collected.older import what_is_older
from thermodata.report.collected.parts import by_role, parts_of
from thermodata.report.collected.records import written_conditions
from thermodata.report.collected.spots import weak_spots_of
from thermodata.report.verdict.verdict import claims_of
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.result import Score
from thermodata.view.lists.driven import driven

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.store import Store
    from thermodata.store.catalogue.models.fits import StoredModel
    from thermodata.view.grid.dataset import Dataset


@dataclass(frozen=True, slots=True)
class _Reason:
    """Why the last effect was added. said: the answer of an ancestor, None where none says so; shown: the same where
    the page shows it; of_fit, but_for, offered: see `ReportData`."""

    said: Diagnosis | None = None
    shown: Diagnosis | None = None
    of_fit: bool = False
    but_for: tuple[str, ...] = ()
    offered: bool = False


def collect(store: Store, ref: str) -> ReportData:
    """All of a report about a model (id, prefix or name). Opens no locked test."""
    from thermodata.modelling.model_file.not_installed import not_installed
    from thermodata.modelling.run import load
    from thermodata.modelling.seen.as_system import see
    from thermodata.modelling.versions.result import make_result
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import find_model, model_chain

    stored = find_model(store, ref)
    chain = model_chain(store, stored.model)
    loaded = load(store, stored.model, uncertainty=True, anew=True)
    diagnosis = load_diagnosis(store, stored.model)
    responses = tuple(r.name for r in loaded.fitted.responses)
    units = chain_units(store, chain)
    last = versions(chain, units)[-1]
    reason = _why_added(store, chain, loaded, removed_only=bool(last.removed and not last.added))
    # curves, scores and parameters are of one fit; what was kept may be of data that have changed since
    result = make_result(loaded.fitted, loaded.data, stored.model)
    lacking = {m.model: some for m in chain[:-1] if (some := not_installed(m.spec))}
    told = _told_as_stored(chain, lacking)
    scores = [m.result.scores if m.model in lacking else _scores_today(store, m, loaded) for m in chain[:-1]]
    scores.append(result.scores)
    conditions = written_conditions(r["spec"] for r in _rows(store, "select spec from campaign"))
    return ReportData(
        model=stored.model,
        name=stored.name,
        campaigns=stored.spec.campaign_ids,
        machine=_machines(loaded),
        responses=responses,
        unit=next((units[name] for name in responses if name in units), "um"),
        effects=tuple(t.id for t in loaded.fitted.responses[0].terms) if responses else (),
        created=_created(store, stored.model),
        parameters=result.readable,
        scores=by_role(result.scores),
        checks=result.checks,
        before=scores[-2] if len(chain) > 1 else stored.result.before or [],
        tests=tuple(by_role(parts_of(loaded.fitted, loaded.data, conditions))),
        versions=versions(chain, units, scores),
        units=units,
        driven=_driven(loaded),
        diagnosis=diagnosis,
        reason=reason.shown,
        reason_of_fit=reason.of_fit,
        reason_but_for=reason.but_for,
        left_on_locked=stored.result.locked_rmse_um_after,
        offered=reason.offered,
        by_choice=_by_choice(store, chain),
        weak=weak_spots_of(loaded, (reason.said, diagnosis)),
        calibrations=tuple(_calibrations(store, stored.spec.campaign_ids)),
        looks=_looks(store, stored.spec.campaign_ids),
        first=() if chain[0].model in lacking else tuple(by_role(_first(store, chain, loaded))),
        older=what_is_older(stored, loaded.data.data_version, diagnosis, reason.shown),
        systems=tuple(see(loaded.fitted, loaded.data)),
        as_stored=told,
    )


def _driven(loaded: Loaded) -> dict[str, str]:
    """An effect -> its name with what drives it in this fit."""
    places = {name: info.at for name, info in loaded.data.channels.items()}
    terms = (term for response in loaded.fitted.responses for term in response.terms)
    return {term.id: driven(term.id, term.binding.values(), places) for term in terms}


def _why_added(store: Store, chain: Sequence[StoredModel], loaded: Loaded, *, removed_only: bool) -> _Reason:
    """removed_only: the last version takes effects out, which no answer is a reason for."""
    from thermodata.modelling.versions.second_lag import without_second_lags
    from thermodata.modelling.versions.with_claims import adds_what_was_offered, is_fit_with_claims
    from thermodata.store.catalogue.models.findings import load_diagnosis

    earlier = [load_diagnosis(store, m.model) for m in chain[:-1]]
    asked = _reason(earlier)
    said = None if asked is None else earlier[asked]
    if asked is None or said is None:
        return _Reason()
    spec, before = chain[-1].spec, chain[asked].spec
    single, second = without_second_lags(spec)
    of_fit = is_fit_with_claims(spec, loaded.data, before, said)
    foretold = not of_fit and is_fit_with_claims(single, loaded.data, before, said)
    return _Reason(
        said,
        None if removed_only else said,
        of_fit,
        tuple(second) if foretold else (),
        not removed_only and adds_what_was_offered(spec, loaded.data, before, said),
    )


def _by_choice(store: Store, chain: Sequence[StoredModel]) -> tuple[Confirmed, ...]:
    """What the locked tests said of what the last version added, asked of the version before."""
    from thermodata.store.catalogue.models.findings import load_diagnosis

    found = load_diagnosis(store, chain[-2].model) if len(chain) > 1 else None
    if found is None:
        return ()
    asked = asked_by_choice(store, chain[-2].model, chain[-2].result.responses, found)
    return of_added(asked, chain[-1].result.added or [])


def _told_as_stored(chain: Sequence[StoredModel], lacking: Mapping[str, Any]) -> tuple[str, ...]:
    """What is told, here and on the page, of versions whose effects are not installed. lacking: by their models."""
    from thermodata.modelling.model_file.not_installed import as_stored

    told = tuple(dict.fromkeys(as_stored(lacking[m.model], m.name) for m in chain if m.model in lacking))
    for sentence in told:
        warnings.warn(f"an earlier version: {sentence}", stacklevel=3)
    return told


def _refitted(store: Store, version: StoredModel, loaded: Loaded) -> tuple[FittedModel, Dataset]:
    """A version of the same chain on the data as they are now."""
    from thermodata.modelling.fit.model import fit_model
    from thermodata.modelling.run import load_data

    same = (version.spec.campaign_ids, version.spec.step) == (loaded.fitted.spec.campaign_ids, loaded.fitted.spec.step)
    data = loaded.data if same else load_data(store, version.spec)
    return fit_model(version.spec, data, uncertainty=False), data


def _scores_today(store: Store, version: StoredModel, loaded: Loaded) -> list[Score]:
    if not version.stale:
        return version.result.scores
    from thermodata.modelling.predictions.score import scores

    return scores(*_refitted(store, version, loaded), version.model)


def _first(store: Store, chain: Sequence[StoredModel], loaded: Loaded) -> Iterable[TestPart]:
    """The tests as the chain's first version foretells them; nothing where there is no other version."""
    if len(chain) > 1:
        yield from parts_of(*_refitted(store, chain[0], loaded), {})


def _reason(earlier: Sequence[Diagnosis | None]) -> int | None:
    """The place of the ancestor whose answer says why the last effect was added. earlier: their answers, oldest first.
    Each claim of one answer may become a version of its own, so the answer may stand as many versions back as it has
    claims."""
    for back, found in enumerate(reversed(earlier), 1):
        if found is not None:
            return len(earlier) - back if back <= max(1, len(claims_of(found))) else None
    return None


def _machines(loaded: Loaded) -> str:
    return ", ".join(sorted({t.machine for t in loaded.data.tests if t.machine}))


def _created(store: Store, model: str) -> str:
    rows = _rows(store, "select created_at from model where model = ?", [model])
    return f"{rows[0]['created_at']:%Y-%m-%d %H:%M} UTC" if rows else ""


def _calibrations(store: Store, campaigns: Sequence[str]) -> list[dict[str, Any]]:
    marks = ", ".join("?" for _ in campaigns)
    rows = _rows(
        store, f"select * from calibration where campaign in ({marks}) order by campaign, calibration", list(campaigns)
    )
    return [{**row, "checks": json.loads(row["checks"] or "[]")} for row in rows]


def _looks(store: Store, campaigns: Sequence[str]) -> dict[str, int]:
    from thermodata.store.catalogue.models.looks import looks_of

    return {"/".join(key): len(looks) for key, looks in looks_of(store, campaigns).items()}


def _rows(store: Store, query: str, params: list[Any] | None = None) -> list[dict[str, Any]]:
    from thermodata.store.base.connection import fetch

    with store.reader() as con:
        found: list[dict[str, Any]] = fetch(con, query, params)
    return found
