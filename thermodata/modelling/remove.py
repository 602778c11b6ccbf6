"""An effect taken out of a model, and the fit of before where that takes back what was added."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.modelling.model_file.resolve import term_ids
from thermodata.modelling.run import fit_once, load
from thermodata.modelling.versions.came_since import as_chosen, came_since
from thermodata.modelling.versions.result import make_result
from thermodata.modelling.versions.second_lag import is_lag_of
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files.model import Model
from thermodata.schema.words.sentences import listed
from thermodata.store.catalogue.data_version import again_where_data_changed

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.store.catalogue.models.fits import StoredModel


@again_where_data_changed
def remove(store: Store, ref: str, effect: str) -> FitResult:
    """A new version with one effect less: by its id, or its name where that is one effect only; its second lag goes
    with it, and the others keep their ids. Where that takes back all that was added to an earlier version, it is fitted
    as that one was; else verification tests that helped to choose what is left stay fitted. `before` has the parent's
    scores, `notes` what went. UsageError for no such effect."""
    from thermodata.store.catalogue.models.fits import find_model, model_chain

    parent = find_model(store, ref)
    ids = term_ids(parent.spec.effects)
    named = [i for i, e in zip(ids, parent.spec.effects, strict=True) if effect in (i, e.effect)]
    of = effect if effect in ids else named[0] if len(named) == 1 else None
    if of is None:
        raise UsageError(
            f"'{effect}' is {len(named)} effects of the model" if named else f"the model has no effect '{effect}'",
            where=f"model '{parent.spec.name}'",
            expected=", ".join(named or ids) or "a model with effects",
            got=effect,
            hint="name one by its id",
        )
    gone = [i for i in ids if i == of or is_lag_of(i, of)]
    kept = [e.model_copy(update={"id": i}) for i, e in zip(ids, parent.spec.effects, strict=True) if i not in gone]
    # an id that stands there by itself is not written
    bare = [e.model_copy(update={"id": None}) if e.id == e.effect else e for e in kept]
    effects = bare if term_ids(bare) == [e.id for e in kept] else kept
    old = load(store, parent.model, anew=True)
    before = make_result(old.fitted, old.data, parent.model).scores
    spec = as_chosen(parent, old.data).model_copy(update={"effects": effects})
    notes = [f"removed: {', '.join(gone)}"]
    chain = model_chain(store, parent.model)
    earlier = [m for m in chain[:-1] if _have_same_effects(m.spec, spec)]
    if earlier:
        spec = earlier[-1].spec
        notes.append(f"taken back: the effects, the tests and the fit are those of {earlier[-1].model} again")
    else:
        notes += stays(chain, of, [e.id for e in kept])
    if not earlier and spec.in_sample:
        notes.append("verification tests stay fitted (in-sample), for they helped to choose what is left")
        notes += came_since(spec, old.data)
    # a version of its own, whatever was fitted before: it comes of this parent, and the name leads to it
    own = spec.model_copy(update={"taken_back": parent.model})
    return fit_once(store, own, read=old.data, parent=parent.model, before=before, notes=notes)


def stays(chain: Sequence[StoredModel], of: str, kept: Sequence[str | None]) -> list[str]:
    """A sentence on what came with an effect and stays without it, as a second lag of another one does: what is left is
    not the version before. chain: the versions, oldest first. of: id of what goes. kept: ids of what is left."""
    for before, after in pairwise(chain):
        had, has = set(term_ids(before.spec.effects)), term_ids(after.spec.effects)
        if of in has and of not in had:
            stay = [i for i in has if i not in had and i in kept]
            does, which = ("stay", "them") if len(stay) > 1 else ("stays", "it")
            said = (
                f"{listed(stay)} came with {of} and {does}, so these are other effects than before: {before.model} is "
                f"the version before both; remove {which} too to take back all that came"
            )
            return [said] if stay else []
    return []


def _have_same_effects(one: Model, other: Model) -> bool:
    """Whether two versions have the same effects, however their ids are written."""
    mine, theirs = (
        [(i, e.model_copy(update={"id": None})) for i, e in zip(term_ids(m.effects), m.effects, strict=True)]
        for m in (one, other)
    )
    return mine == theirs
