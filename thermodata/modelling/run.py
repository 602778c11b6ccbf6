"""Fitting with a store: load, fit, score, save. Everything that thinks is in pure modules; models of a store are
compared in `comparing`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.fit.orders import Tried
from thermodata.modelling.inputs import coarse_readings, moved, shifted
from thermodata.modelling.inputs.roles import in_full, opened, resolve_roles
from thermodata.modelling.model_file import nested
from thermodata.modelling.model_file.not_installed import refuse_not_installed
from thermodata.modelling.model_file.prediction import as_effect as prediction
from thermodata.modelling.model_file.transfer.as_effect import NAME
from thermodata.modelling.predictions.carried_on import said_of_fit
from thermodata.modelling.predictions.table import prediction_tables
from thermodata.modelling.seen.profiles import Profiles, profiles_of
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.versions.as_kept import as_kept
from thermodata.modelling.versions.called_now import advised_by_names_now
from thermodata.modelling.versions.came_since import as_chosen
from thermodata.modelling.versions.result import make_result, model_id
from thermodata.schema.answers.result import FitResult, Score
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.store.catalogue.data_version import again_where_data_changed, refuse_changed
from thermodata.view.grid.dataset import Dataset

if TYPE_CHECKING:
    from thermodata.store import Store

# more keys of a result, that its fit tells
OfFit = Callable[[FittedModel, Dataset], Mapping[str, Any]]


@dataclass(frozen=True)
class Loaded:
    """A model of the store and its data as they are now. kept: they changed, and the parameters are those stored.
    fitted_to: the version of the data that these come from."""

    identity: str
    parent: str | None
    fitted: FittedModel
    data: Dataset
    kept: bool = False
    fitted_to: str = ""


def load(store: Store, ref: str, *, uncertainty: bool = False, anew: bool = False) -> Loaded:
    """ref: an id, a unique prefix, or a name (its newest version). On the data of its fit it is fitted again, which
    gives the same and takes milliseconds; where they changed its parameters are those that the store holds. anew: the
    fit to the data as they are now is what is asked for."""
    from thermodata.store.catalogue.models.fits import find_model

    stored = find_model(store, ref)
    refuse_not_installed(stored.spec, stored.model)
    data = load_data(store, stored.spec)
    kept = stored.data_version != data.data_version and not anew
    if kept:
        fitted = as_kept(stored.spec, stored.result, data, changed=stored.stale)
    else:
        fitted = fit_model(as_chosen(stored, data), data, uncertainty=uncertainty)
    fitted_to = stored.data_version if kept else data.data_version
    return Loaded(stored.model, stored.parent, fitted, data, kept, fitted_to)


def load_data(store: Store, spec: Model) -> Dataset:
    from thermodata.view.grid.load import load_dataset

    return coarse_readings.drawn(load_dataset(store, list(spec.campaign_ids), spec.step))


def fit_once(
    store: Store,
    spec: Model,
    *,
    base: Path | None = None,
    parent: str | None = None,
    before: list[Score] | None = None,
    read: Dataset | None = None,
    of_fit: OfFit | None = None,
    **said: list[str],
) -> FitResult:
    """Fit and save. base: the folder of the model file, which `file` of an effect is relative to. said: `added` and
    `notes` of the result, which say as well where the model's name leads to a newer version. read: the data that its
    caller looked at. of_fit: tells more of the result. DataChangedError where the data changed before it was kept."""
    from thermodata.store.catalogue.models.fits import save_fit
    from thermodata.store.catalogue.models.looks import count_locked_look

    spec = self_contained(store, spec, base)
    data = load_data(store, spec)
    check = partial(refuse_changed, campaigns=spec.campaign_ids, made_from=(read or data).data_version)
    with advised_by_names_now(store, spec.campaign_ids):
        fitted = fit_model(spec, data)
    result = make_result(fitted, data, model_id(spec, data.data_version), parent=parent, before=before)
    terms = [term.bound for response in fitted.responses for term in response.terms]
    names = {name for term in terms for test in data.tests if term.covers(test) for name in term.reads(test)}
    looked_at = opened(resolve_roles(spec, data), data)
    of_files = dict.fromkeys(note for term in terms for note in prediction.said(term.effect, data))
    notes = [
        *said.pop("notes", []),
        *coarse_readings.said(data, names),
        *shifted.said(data, names),
        *moved.said(data, names),
        *said_of_fit(fitted, data),
        *of_files,
        *_unlocked(looked_at),
    ]
    more = of_fit(fitted, data) if of_fit is not None else {}
    result = result.model_copy(update={**said, **more, "notes": notes})
    with store.reader() as con:  # before a look is counted
        check(con)
    if looked_at:  # first: a look that is counted for a fit that nobody kept does less harm than one that is not
        count_locked_look(store, result.model, looked_at, "the model uses it as an open test", once=True)
    save_fit(
        store,
        spec=spec,
        result=result,
        parent=parent,
        predictions=prediction_tables(fitted, data),
        data_version=data.data_version,
        check=check,
    )
    return result.model_copy(update={"notes": [*result.notes, *_led_past(store, result)]})


fit = again_where_data_changed(fit_once)


def _led_past(store: Store, result: FitResult) -> list[str]:
    """What was fitted before keeps its place among the versions, and its name leads to the newest of them."""
    from thermodata.store.catalogue.models.fits import find_model

    newest = find_model(store, result.name).model
    if newest == result.model:
        return []
    return [f"this model was fitted before: {result.model} is its name, '{result.name}' is the newer version {newest}"]


def _unlocked(tests: Sequence[tuple[str, str]]) -> list[str]:
    if not tests:
        return []
    return [
        f"locked in the campaign, and open in this model: {', '.join(in_full(tests))}; counted as a look, for what it "
        "says of the model is no longer new to it (calibrate_on, verify_on)"
    ]


def orders(store: Store, spec: Model, *, method: str | None = None, base: Path | None = None) -> list[Tried]:
    """Every order of the model's transfer functions that was tried, whether the file leaves them open or not; nothing
    is saved. method: in place of the file's. UsageError where the model has no function to identify."""
    effects = [_with_open_orders(e, method) for e in spec.effects]
    spec = self_contained(store, spec.model_copy(update={"effects": effects}), base)
    with advised_by_names_now(store, spec.campaign_ids):
        fitted = fit_model(spec, load_data(store, spec), uncertainty=False)
    found = [row for response in fitted.responses for row in response.tried]
    if not found:
        raise UsageError(
            f"model '{spec.name}' has no transfer function whose orders could be chosen",
            expected=f"an effect {{effect: {NAME}, drivers: {{u: ...}}}} without given coefficients",
            got=", ".join(e.effect for e in spec.effects) or "no effects",
        )
    return found


def _with_open_orders(effect: EffectSpec, method: str | None) -> EffectSpec:
    if effect.effect != NAME:
        return effect
    return effect.model_copy(update={"orders": None, "delay": None, "method": method or effect.method})


def profiles(store: Store, ref: str) -> Profiles:
    """The interval of every time constant of a stored model by its profile, and what the tests can't tell apart."""
    model = load(store, ref, anew=True)
    return profiles_of(model.fitted, model.data)


def self_contained(store: Store, spec: Model, base: Path | None = None) -> Model:
    """The spec with what it names from elsewhere: files by their full path, other models as they are now."""
    effects = []
    for effect in spec.effects:
        if effect.file is not None:
            effect = effect.model_copy(update={"file": str(((base or Path()) / effect.file).resolve())})
        if effect.effect == nested.NAME and effect.inside is None and effect.name is not None:
            inside = _model_named(store, effect.name, base)
            effect = effect.model_copy(update={"inside": inside.model_dump(mode="json", by_alias=True)})
        effects.append(effect)
    return spec.model_copy(update={"effects": effects})


def _model_named(store: Store, name: str, base: Path | None) -> Model:
    """A file beside the model's own, or a model of the store."""
    from thermodata.schema.files.load import load_model
    from thermodata.store.catalogue.models.fits import find_model

    path = (base or Path()) / name
    if name.endswith((".yaml", ".yml")):
        return self_contained(store, load_model(path), path.parent)
    return find_model(store, name).spec
