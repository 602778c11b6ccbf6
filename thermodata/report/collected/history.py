"""The versions of a model: what each added to the one before it, and what it leaves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from thermodata.modelling.compare.common import lost_tests, on_common, predicted
from thermodata.modelling.versions.same_tests import UNSEEN, note_on_the_same_tests
from thermodata.report.collected.data import Errors, ResponseError, Version
from thermodata.report.words.numbers import change, in_sample, pooled
from thermodata.schema.answers.result import Score
from thermodata.schema.files.model import EffectSpec
from thermodata.view.lists.response_units import response_units, told_together

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.store.catalogue.models.fits import StoredModel

UNNAMED_TERMS = ("lag", "static")
"""Effects that are told by their channels: their names say nothing."""


def versions(
    chain: Sequence[StoredModel], units: Mapping[str, str], scored: Sequence[list[Score]] | None = None
) -> tuple[Version, ...]:
    """The chain as rows, oldest first, with what each version added to the one before it, or removed. units: of the
    responses' errors. scored: the scores of each, those that were kept with it where None. Errors are over the tests
    that all versions predict."""
    from thermodata.modelling.model_file.resolve import term_ids

    every = [m.result.scores for m in chain] if scored is None else list(scored)
    common = on_common(every)
    compared = min((len({key[:2] for key in predicted(some)}) for some in common), default=0)
    made: list[Version] = []
    known: dict[str, str] = {}
    words: dict[str, str] = {}
    for i, m in enumerate(chain):
        ids = term_ids(m.spec.effects)
        fresh = (
            [
                _in_words(spec, name) if name not in known else f"{name} by {_parted_by(spec)}"
                for spec, name in zip(m.spec.effects, ids, strict=True)
                if name not in known or known[name] != _parted_by(spec)
            ]
            if i
            else []
        )
        gone = [words[name] for name in known if name not in ids]
        names = m.result.responses
        together = told_together(names, units)
        shown = _errors(common[i], together)
        lost = lost_tests(every[i - 1], every[i]) if i else []
        made.append(
            Version(
                m.model,
                m.name,
                ", ".join(fresh) or None,
                shown.all_um,
                shown.calibration_um,
                shown.verification_um,
                m.stale,
                ", ".join(gone) or None,
                bool(in_sample(every[i])),
                units.get(names[0], "um"),
                tuple(
                    ResponseError(n, units.get(n, "um"), _errors(every[i], [n]), _errors(common[i], [n])) for n in names
                ),
                _errors(every[i], together),
                tuple(dict.fromkeys(f"{t.campaign}/{t.test}" for t in lost if t.response in names)),
                len({key[:2] for key in predicted(every[i])}),
                compared,
                _refitted(m.result.notes, every[i - 1], every[i]) if i else "",
            )
        )
        words = {name: _in_words(spec, name) for name, spec in zip(ids, m.spec.effects, strict=True)}
        known = {name: _parted_by(spec) for name, spec in zip(ids, m.spec.effects, strict=True)}
    return tuple(made)


def _refitted(notes: Sequence[str], before: Sequence[Score], after: Sequence[Score]) -> str:
    """See `Version.refitted`. notes: of the version."""
    unseen = in_sample(after) - in_sample(before)
    return (note_on_the_same_tests(notes) or UNSEEN) if unseen else ""


def how_it_went(errors: Sequence[float]) -> str:
    """'fell', 'rose' or 'changed', of the errors of versions, the first one first; 'stayed' where no one is another."""
    ways = {"-" if b < a else "+" for a, b in pairwise(errors) if a and change(a, b) != "0 %"}
    return {"": "stayed", "-": "fell", "+": "rose"}.get("".join(ways), "changed")


def history_rows(store: Store, ref: str) -> list[dict[str, Any]]:
    """The versions that led to a model, oldest first, as `thermodata history --json` prints them: *rmse_um over the
    tests that a version predicts, common over those that all do; gone: tests whose results were forgotten."""
    from thermodata.store.catalogue.models.fits import model_chain
    from thermodata.store.catalogue.models.stale import results_gone

    chain = model_chain(store, ref)
    units = chain_units(store, chain)
    return [
        {
            "model": v.model,
            "name": v.name,
            "parent": m.parent,
            "added": v.added,
            **_named(v.own),
            "stale": v.stale,
            "removed": v.removed,
            "in_sample": v.in_sample,
            "unit": v.unit,
            "tests": v.tests,
            "lost": list(v.lost),
            "gone": results_gone(store, m),
            "common": {"tests": v.compared, **_named(Errors(v.all_um, v.calibration_um, v.verification_um))},
            "responses": [
                {"response": r.response, "unit": r.unit, **_named(r.own), "common": _named(r.common)}
                for r in v.responses
            ],
        }
        for v, m in zip(versions(chain, units), chain, strict=True)
    ]


def chain_units(store: Store, chain: Sequence[StoredModel]) -> dict[str, str]:
    """The units of the errors of all responses that versions of a chain have."""
    names = dict.fromkeys(name for m in chain for name in m.result.responses)
    return response_units(store, list(names), {c for m in chain for c in m.spec.campaign_ids})


def _errors(scores: list[Score], of: Sequence[str]) -> Errors:
    roles = (("calibration", "verification"), ("calibration",), ("verification",))
    return Errors(*(pooled(scores, *some, responses=of) for some in roles))


def _named(one: Errors) -> dict[str, float | None]:
    return {
        "rmse_um": one.all_um,
        "calibration_rmse_um": one.calibration_um,
        "verification_rmse_um": one.verification_um,
    }


def _parted_by(spec: EffectSpec) -> str:
    """What its gain belongs to, as the model file has it; '' where one gain serves all."""
    return " and ".join([spec.gain_by] if isinstance(spec.gain_by, str) else spec.gain_by or [])


def _in_words(spec: EffectSpec, term: str) -> str:
    """An effect's name says what it is; a plain lag is told by its channel."""
    if spec.effect not in UNNAMED_TERMS:
        return term
    acts = f" in {' and '.join(spec.phases)}" if spec.phases else ""
    return f"{spec.effect}({', '.join(d if isinstance(d, str) else d.at for d in spec.drivers.values())}){acts}"
