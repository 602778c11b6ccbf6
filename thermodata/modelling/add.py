"""The next version of a model: with an effect more, as a diagnosis ranks it or a user names it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.run import fit_once, load
from thermodata.modelling.versions.as_foretold import beside_foretold
from thermodata.modelling.versions.came_since import unasked
from thermodata.modelling.versions.candidate import note_of_response, with_candidate, with_effect
from thermodata.modelling.versions.result import make_result
from thermodata.modelling.versions.second_lag import with_second_lags
from thermodata.modelling.versions.slips import lines_of_test, with_lines
from thermodata.modelling.versions.unsound import heeding
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files.model import EffectSpec
from thermodata.store.catalogue.data_version import again_where_data_changed

if TYPE_CHECKING:
    from thermodata.store import Store


@again_where_data_changed
def add(store: Store, ref: str, *candidates: str | int | EffectSpec, plain: bool = False) -> FitResult:
    """A new version with further effects: each a rank or id of the stored diagnosis, or any 'effect:channels'; or with
    one that it has changed, 'gain_by:effect,condition' or 'phases:effect,heating,cooling'; or without a step of a probe
    that it told of a test, 'step:test' (`slips`); and with second lags where left-out tests want them (`second_lag`).
    plain: no second lags. Tests whose log the stored diagnosis found wrong are left out (`unsound`).
    `before` has the parent's scores, `added` the ids of what is new, `notes` why.
    UsageError where one is named twice."""
    from thermodata.store.catalogue.models.findings import load_diagnosis
    from thermodata.store.catalogue.models.fits import find_model

    parent = find_model(store, ref)
    old = load(store, parent.model, anew=True)
    if not candidates:
        raise UsageError(
            "nothing is named to add",
            expected="a rank or id of the diagnosis, or 'effect:channels'",
            hint="'thermodata diagnose MODEL' lists the candidates with their ranks",
        )
    found = load_diagnosis(store, parent.model)
    grown, names, slips = parent.spec, list[str](), list[str]()
    for candidate in candidates:
        if isinstance(candidate, EffectSpec):
            grown = with_effect(grown, candidate)
            continue
        name = chosen_id(store, parent.model, candidate)
        if name in names:
            raise UsageError(
                f"candidate '{name}' is named twice",
                expected="each once",
                got=str(candidate),
                hint="leave one of the two out",
            )
        names.append(name)
        lines = lines_of_test(name, grown, old.data, found, parent.result.responses)
        if lines and any(line in grown.effects for line in lines):
            raise UsageError(
                f"candidate '{name}' is in the model already",
                expected="each once",
                got=str(candidate),
                hint="'thermodata remove MODEL EFFECT' first, where it is to be put in otherwise",
            )
        slips += [name] if lines else []
        grown = with_lines(grown, lines) if lines else with_candidate(grown, name, old.data.channels)
    before = make_result(old.fitted, old.data, parent.model).scores
    by_it = found if found is not None and any(c.id in names for c in found.candidates) else None
    scored = {(s.campaign, s.test) for s in before}
    # what was found before the data changed may be mended
    diagnosis, since = None if parent.stale else found, unasked(parent, by_it, old.data, scored)
    grown, notes = heeding(grown, old.data, diagnosis.put_right if diagnosis is not None else None)
    if not plain and len(slips) < len(candidates):  # a slip taken out is no reason for another lag
        refined = with_second_lags(grown, old.data)
        of_one = found if found is not None and [found.response] == parent.result.responses else None
        said = beside_foretold(of_one, names, refined.lags)
        grown, notes = refined.spec, [*notes, *refined.notes, *filter(None, [said])]
    had = term_ids(parent.spec.effects)
    added = [i for i in term_ids(grown.effects) if i not in had]
    own = [e for e, i in zip(grown.effects, term_ids(grown.effects), strict=True) if i in added]
    named = dict.fromkeys(str(channel) for e in own for channel in e.drivers.values())
    notes = [*notes, *since, *filter(None, [note_of_response(list(named), old.data.channels)])]
    result = fit_once(store, grown, read=old.data, parent=parent.model, before=before, added=added, notes=notes)
    claims = [c for c in diagnosis.candidates if c.claimed] if diagnosis is not None else []
    all_taken = bool(claims) and {c.id for c in claims} <= set(names)
    if diagnosis is None or not all_taken or diagnosis.data_version != old.data.data_version:
        return result
    # the lock was opened for all claims together, on these data: what that gave is told, and nothing is opened again
    told = ("before", "after", "fitted")
    asked = {f"locked_rmse_um_{when}": getattr(claims[0], f"locked_rmse_um_{when}") for when in told}
    return result.model_copy(update=asked)


def chosen_id(store: Store, model: str, candidate: str | int, response: str | None = None) -> str:
    """What a user names: the id of a rank of the stored diagnosis, or the name as it is; UsageError for no such
    rank, and for one where the diagnosis is of another response than is named."""
    from thermodata.store.catalogue.models.findings import load_diagnosis

    name = str(candidate)
    if name.isdigit():
        diagnosis = load_diagnosis(store, model)
        if diagnosis is None:
            raise UsageError(f"model '{model}' has no diagnosis yet", hint=f"thermodata diagnose {model}")
        if response is not None and diagnosis.response != response:
            raise UsageError(
                f"rank {name} is one of the diagnosis of {diagnosis.response}",
                expected=f"an id, or a rank of the diagnosis of {response}",
                got=name,
                hint=f"thermodata diagnose {model} --response {response}",
            )
        ranks = {c.rank: c.id for c in diagnosis.candidates}
        if int(name) not in ranks:
            raise UsageError(
                f"no candidate of rank {name}",
                expected=", ".join(f"{r} ({i})" for r, i in ranks.items()) or "none: the diagnosis has no candidates",
                got=name,
                hint="a rank counts from 1 as 'thermodata diagnose MODEL' lists them; or name the candidate by its id",
            )
        name = ranks[int(name)]
    return name
