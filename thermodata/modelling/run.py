"""Fitting with a store: load, fit, score, save. Everything that thinks is in the pure modules beside this one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.modelling.candidate import with_candidate, with_effect
from thermodata.modelling.fit import fit_model
from thermodata.modelling.fitted import FittedModel
from thermodata.modelling.portability import Portability, portability
from thermodata.modelling.result import make_result, model_id
from thermodata.modelling.table import prediction_tables
from thermodata.schema.model import EffectSpec, Model
from thermodata.schema.result import FitResult, Score
from thermodata.view.dataset import Dataset

if TYPE_CHECKING:
    from thermodata.store import Store


@dataclass(frozen=True)
class Loaded:
    """A model of the store, fitted again to the store's data (the fit is exact and takes milliseconds)."""

    identity: str
    parent: str | None
    fitted: FittedModel
    data: Dataset


def load(store: Store, ref: str, *, uncertainty: bool = False) -> Loaded:
    """ref: an id, a unique prefix, or a name (its newest version)."""
    from thermodata.store.catalogue.models import find_model

    stored = find_model(store, ref)
    data = load_data(store, stored.spec)
    return Loaded(stored.model, stored.parent, fit_model(stored.spec, data, uncertainty=uncertainty), data)


def load_data(store: Store, spec: Model) -> Dataset:
    from thermodata.view.load import load_dataset

    return load_dataset(store, list(spec.campaign_ids), spec.step)


def fit(
    store: Store, spec: Model, *, base: Path | None = None, parent: str | None = None, before: list[Score] | None = None
) -> FitResult:
    """Fit and save. base: the folder of the model file, which `file` of an effect is relative to."""
    from thermodata.store.catalogue.models import save_fit

    spec = _absolute(spec, base)
    data = load_data(store, spec)
    fitted = fit_model(spec, data)
    result = make_result(fitted, data, model_id(spec, data.data_version), parent=parent, before=before)
    save_fit(
        store,
        spec=spec,
        result=result,
        parent=parent,
        predictions=prediction_tables(fitted, data),
        data_version=data.data_version,
    )
    return result


def compare(store: Store, refs: Sequence[str]) -> list[FitResult]:
    """Each model's parameters, scores and checks on the store's data as it is now."""
    results = []
    for ref in refs:
        model = load(store, ref, uncertainty=True)
        results.append(make_result(model.fitted, model.data, model.identity, parent=model.parent))
    return results


def add(store: Store, ref: str, candidate: str | int | EffectSpec) -> FitResult:
    """A new version with one effect more: a rank or id of the stored diagnosis, or any 'effect:channels'; or with
    several gains of one that it has, 'gain_by:effect,condition'. `before` has the parent's scores."""
    from thermodata.store.catalogue.models import find_model

    parent = find_model(store, ref)
    old = load(store, parent.model)
    if isinstance(candidate, EffectSpec):
        grown = with_effect(parent.spec, candidate)
    else:
        grown = with_candidate(parent.spec, chosen_id(store, parent.model, candidate), old.data.channels)
    before = make_result(old.fitted, old.data, parent.model).scores
    return fit(store, grown, parent=parent.model, before=before)


def transfer(store: Store, ref: str) -> list[Portability]:
    """How far the model carries over to each test and machine of its campaigns; kept as findings of the model."""
    from thermodata.store.catalogue.models import save_findings

    model = load(store, ref)
    rows = portability(model.fitted, model.data)
    save_findings(store, model.identity, "portability", [(r.campaign, r.test, r.to_json()) for r in rows])
    return rows


def chosen_id(store: Store, model: str, candidate: str | int) -> str:
    """What a user names: the id of a rank of the stored diagnosis, or the name as it is; UsageError for no such
    rank."""
    from thermodata.store.catalogue.models import load_diagnosis

    name = str(candidate)
    if name.isdigit():
        diagnosis = load_diagnosis(store, model)
        if diagnosis is None:
            raise UsageError(f"model '{model}' has no diagnosis yet", hint=f"thermodata diagnose {model}")
        ranks = {c.rank: c.id for c in diagnosis.candidates}
        if int(name) not in ranks:
            raise UsageError(
                f"no candidate of rank {name}",
                expected=", ".join(f"{r} ({i})" for r, i in ranks.items()) or "none: the diagnosis has no candidates",
                got=name,
            )
        name = ranks[int(name)]
    return name


def _absolute(spec: Model, base: Path | None) -> Model:
    if not any(e.file for e in spec.effects):
        return spec
    effects = [
        e if e.file is None else e.model_copy(update={"file": str(((base or Path()) / e.file).resolve())})
        for e in spec.effects
    ]
    return spec.model_copy(update={"effects": effects})
