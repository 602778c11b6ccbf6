"""The next version of a model: with an effect more, as a diagnosis ranks it or a user names it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.run import OfFit, fit_once, load
from thermodata.modelling.versions.as_foretold import beside_foretold
from thermodata.modelling.versions.came_since import unasked
from thermodata.modelling.versions.candidate import note_of_response, with_candidate, with_effect
from thermodata.modelling.versions.on_locked import errors_on_locked
from thermodata.modelling.versions.refitted_parent import on_the_same_tests
from thermodata.modelling.versions.result import make_result
from thermodata.modelling.versions.second_lag import with_second_lags
from thermodata.modelling.versions.slips import lines_of_test, with_lines
from thermodata.modelling.versions.unsound import heeding
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.store.catalogue.data_version import again_where_data_changed

if TYPE_CHECKING:
    from thermodata.effect.binding import Described
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store import Store
    from thermodata.store.catalogue.models.fits import StoredModel
    from thermodata.view.grid.dataset import Dataset


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
    grown = _with_candidates(store, parent, old.data, found, candidates)
    before = make_result(old.fitted, old.data, parent.model).scores
    by_it = found if found is not None and any(c.id in grown.names for c in found.candidates) else None
    scored = {(s.campaign, s.test) for s in before}
    # what was found before the data changed may be mended
    diagnosis, since = None if parent.stale else found, unasked(parent, by_it, old.data, scored)
    spec, notes = heeding(grown.spec, old.data, diagnosis.put_right if diagnosis is not None else None)
    if not plain and len(grown.slips) < len(candidates):  # a slip taken out is no reason for another lag
        refined = with_second_lags(spec, old.data)
        of_one = found if found is not None and [found.response] == parent.result.responses else None
        said = beside_foretold(of_one, grown.names, refined.lags)
        spec, notes = refined.spec, [*notes, *refined.notes, *filter(None, [said])]
    added, of_response = _ids_and_notes(parent.spec, spec, old.data.channels)
    alike = on_the_same_tests(parent.spec, spec, old.data, before)
    notes = [*notes, *since, *of_response, *_twins(found, grown.names), *alike]
    asked, of = _asked_of_locked(diagnosis, grown.names, old.data), parent.model
    return fit_once(store, spec, read=old.data, parent=of, before=before, of_fit=asked, added=added, notes=notes)


@dataclass(frozen=True, slots=True)
class _Grown:
    """A model with what is named to be added. names: candidates, by their ids; slips: those of them that take a step of
    a probe out."""

    spec: Model
    names: list[str]
    slips: list[str]


def _with_candidates(
    store: Store,
    parent: StoredModel,
    data: Dataset,
    found: Diagnosis | None,
    candidates: Sequence[str | int | EffectSpec],
) -> _Grown:
    """found: the stored diagnosis of the parent. UsageError where one is named twice, or is in the model already."""
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
        lines = lines_of_test(name, grown, data, found, parent.result.responses)
        if lines and any(line in grown.effects for line in lines):
            raise UsageError(
                f"candidate '{name}' is in the model already",
                expected="each once",
                got=str(candidate),
                hint="'thermodata remove MODEL EFFECT' first, where it is to be put in otherwise",
            )
        slips += [name] if lines else []
        grown = with_lines(grown, lines) if lines else with_candidate(grown, name, data.channels)
    return _Grown(grown, names, slips)


def _twins(found: Diagnosis | None, names: Sequence[str]) -> list[str]:
    """A note on what is added together though the tests can't tell it apart: what both do may be shared out in any way,
    and sum up to much more in a test that no fit has seen. found: what told so."""
    alike = {c.id: set(c.equivalent) for c in found.candidates} if found is not None else {}
    pairs = [(a, b) for a, b in combinations(names, 2) if b in alike.get(a, ()) or a in alike.get(b, ())]
    return [
        f"{a} and {b} are both added, and these tests can't tell them apart: what they do may be shared out between "
        "them in any way, and other tests be foretold worse; add one of them"
        for a, b in pairs
    ]


def _ids_and_notes(parent: Model, grown: Model, channels: Mapping[str, Described]) -> tuple[list[str], list[str]]:
    """(the ids of what is new; what is to be known of channels that are responses and drive it)."""
    had = term_ids(parent.effects)
    new = [(i, e) for i, e in zip(term_ids(grown.effects), grown.effects, strict=True) if i not in had]
    drivers = dict.fromkeys(str(channel) for _, effect in new for channel in effect.drivers.values())
    note = note_of_response(list(drivers), channels)
    return [i for i, _ in new], [note] if note else []


def _asked_of_locked(found: Diagnosis | None, names: Sequence[str], data: Dataset) -> OfFit | None:
    """What is told of a fit on the locked tests, where they were opened on these data for all claims together, and all
    are added: they are not opened again. found: of the parent. names: ids of what is added."""
    claims = [c for c in found.candidates if c.claimed] if found is not None else []
    all_taken = bool(claims) and {c.id for c in claims} <= set(names)
    if found is None or not all_taken or found.data_version != data.data_version:
        return None
    if claims[0].locked_rmse_um_after is None:
        return None
    return partial(errors_on_locked, found=found, claim=claims[0])


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
